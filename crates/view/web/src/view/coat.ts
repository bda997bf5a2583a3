// What lies on the matter of a surface: a texture that sticks to it, and a film of blood over that. Both look the same as in pictures.

import { Color, DataTexture, LinearFilter, LinearMipmapLinearFilter, RepeatWrapping, RGBAFormat, SRGBColorSpace, UnsignedByteType } from "three";
import type { MeshPhysicalMaterial, Texture } from "three";
import type { TextureShape } from "../protocol";

/** What red, green and blue light loses on its way through blood, but for 1/e [m]. */
const ABSORPTION = [600e-6, 40e-6, 30e-6];
/** In which cells of the blood send light back, but for 1/e [m]. */
const SCATTERING = 150e-6;
/** What they send back of white light, from a film that nothing is seen through, in linear light. */
const BLOOD = [0.21, 0.004, 0.006];
/** Thickness of a film that shines as wet, but for 1/e [m]. */
const SHINING = 20e-6;
/** Of liquid. */
const ROUGHNESS = 0.06;
/** Charred, scorched, pale and white tissue. */
const TISSUE = [0x1a1412, 0x5c321e, 0xce8c7c, 0xf0ded0].map((colour) => new Color(colour).toArray());

const number = (value: number) => value.toExponential();
const vector = (numbers: number[]) => `vec3(${numbers.map(number).join(", ")})`;

const VERTEX = `
attribute float film;
attribute float look;
attribute vec3 rest;
attribute vec3 restNormal;
varying float vFilm;
varying float vLook;
varying vec3 vRest;
varying vec3 vRestNormal;`;

const FRAGMENT = `
varying float vFilm;
varying float vLook;
varying vec3 vRest;
varying vec3 vRestNormal;
/** None, a picture, mottled, spots, fibres. */
uniform int figure;
uniform float figureSize;
/** Width of the picture over its height. */
uniform float figureAspect;
uniform vec3 figureColours[2];
uniform sampler2D figureImage;

// PCG (O'Neill 2014), and noise of gradients (Perlin 2002)
uint mixed(uint number) {
  uint state = number * 747796405u + 2891336453u;
  uint word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
  return (word >> 22u) ^ word;
}
float alongGradient(uint hash, vec3 to) {
  uint h = hash & 15u;
  float u = h < 8u ? to.x : to.y;
  float v = h < 4u ? to.y : (h == 12u || h == 14u ? to.x : to.z);
  return ((h & 1u) == 0u ? u : -u) + ((h & 2u) == 0u ? v : -v);
}
float noise(vec3 place) {
  vec3 low = floor(place);
  vec3 within = place - low;
  vec3 fade = within * within * within * (within * (within * 6.0 - 15.0) + 10.0);
  float sum = 0.0;
  for (int corner = 0; corner < 8; corner++) {
    vec3 at = vec3(corner & 1, (corner >> 1) & 1, (corner >> 2) & 1);
    ivec3 lattice = ivec3(low + at);
    vec3 weights = mix(1.0 - fade, fade, at);
    uint hash = mixed(uint(lattice.x) + mixed(uint(lattice.y) + mixed(uint(lattice.z))));
    sum += weights.x * weights.y * weights.z * alongGradient(hash, within - at);
  }
  return sum;
}
float octaves(vec3 place) {
  return noise(place) + noise(2.0 * place) / 2.0 + noise(4.0 * place) / 4.0 + noise(8.0 * place) / 8.0;
}
vec3 figureColour(vec3 place, vec3 normal) {
  if (figure == 1) {
    vec3 shares = pow(abs(normal), vec3(4.0));
    shares /= max(shares.x + shares.y + shares.z, 1e-9);
    // its rows go down
    vec2 along = vec2(1.0, -figureAspect);
    return shares.x * texture2D(figureImage, along * place.zy).rgb + shares.y * texture2D(figureImage, along * place.xz).rgb
      + shares.z * texture2D(figureImage, along * place.xy).rgb;
  }
  float share = figure == 2 ? clamp(0.5 + 0.7 * octaves(place), 0.0, 1.0)
    : figure == 3 ? smoothstep(0.12, 0.32, noise(place))
    : smoothstep(-0.3, 0.3, octaves(vec3(place.x / 10.0, place.yz)));
  return mix(figureColours[0], figureColours[1], share);
}
/** Tissue of a colour of its own, charred from it to -1, pale from it to 1. */
vec3 tissueOf(vec3 own, float look) {
  vec3 half_way = look < 0.0 ? ${vector(TISSUE[1]!)} : ${vector(TISSUE[2]!)};
  vec3 end = look < 0.0 ? ${vector(TISSUE[0]!)} : ${vector(TISSUE[3]!)};
  float amount = min(abs(look), 1.0);
  return amount < 0.5 ? mix(own, half_way, 2.0 * amount) : mix(half_way, end, 2.0 * amount - 1.0);
}`;

const COLOUR = `
if (figure > 0) diffuseColor.rgb = tissueOf(figureColour(vRest / figureSize, normalize(vRestNormal + vec3(0.0, 0.0, 1e-9))), vLook);
float thickness = max(vFilm, 0.0);
diffuseColor.rgb *= exp(-2.0 * thickness / ${vector(ABSORPTION)});
diffuseColor.rgb = mix(diffuseColor.rgb, ${vector(BLOOD)}, 1.0 - exp(-thickness / ${number(SCATTERING)}));
float wet = 1.0 - exp(-thickness / ${number(SHINING)});`;

/** Lays attributes of points over what a material shows: `film`, a thickness [m], and by where they rest a texture. */
export class Coat {
  private readonly uniforms = {
    figure: { value: 0 },
    figureSize: { value: 1 },
    figureAspect: { value: 1 },
    figureColours: { value: [new Color(), new Color()] },
    figureImage: { value: null as Texture | null },
  };
  /** What is laid on where no numbers are to be read. */
  private figure = 0;

  constructor(material: MeshPhysicalMaterial) {
    material.onBeforeCompile = (shader) => {
      Object.assign(shader.uniforms, this.uniforms);
      const put = (text: string, after: string, more: string) => text.replace(after, `${after}\n${more}`);
      const vertex = put(shader.vertexShader, "#include <common>", VERTEX);
      shader.vertexShader = put(vertex, "#include <begin_vertex>", "vFilm = film; vLook = look; vRest = rest; vRestNormal = restNormal;");
      let fragment = put(shader.fragmentShader, "#include <common>", FRAGMENT);
      fragment = put(fragment, "#include <color_fragment>", COLOUR);
      shader.fragmentShader = put(fragment, "#include <roughnessmap_fragment>", `roughnessFactor = mix(roughnessFactor, ${ROUGHNESS}, wet);`);
    };
  }

  setTexture({ figure, size, colours, width, height, pixels }: TextureShape): void {
    const { uniforms } = this;
    this.figure = figure + 1;
    uniforms.figureSize.value = size;
    uniforms.figureColours.value = [0, 3].map((at) => new Color().fromArray(colours, at));
    if (pixels.length === 0) return;
    uniforms.figureImage.value?.dispose();
    const image = new DataTexture(pixels, width, height, RGBAFormat, UnsignedByteType);
    Object.assign(image, {
      colorSpace: SRGBColorSpace,
      wrapS: RepeatWrapping,
      wrapT: RepeatWrapping,
      magFilter: LinearFilter,
      minFilter: LinearMipmapLinearFilter,
      generateMipmaps: true,
      needsUpdate: true,
    });
    uniforms.figureImage.value = image;
    uniforms.figureAspect.value = width / height;
  }

  /** Whether the texture is seen: not where colours are numbers to be read. */
  setShown(shown: boolean): void {
    this.uniforms.figure.value = shown ? this.figure : 0;
  }

  /** Whether there is a texture at all. */
  get isTextured(): boolean {
    return this.figure > 0;
  }

  dispose(): void {
    this.uniforms.figureImage.value?.dispose();
  }
}
