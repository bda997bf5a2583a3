// How tissue looks beneath a film of blood, and how that shines: the same as in pictures.

import type { MeshPhysicalMaterial } from "three";

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

const vector = (numbers: number[]) => `vec3(${numbers.map((number) => number.toExponential()).join(", ")})`;

/** Lays the attribute `film`, a thickness of each point [m], over what a material shows. */
export function layBlood(material: MeshPhysicalMaterial): void {
  material.onBeforeCompile = (shader) => {
    const put = (text: string, after: string, more: string) => text.replace(after, `${after}\n${more}`);
    shader.vertexShader = put(shader.vertexShader, "#include <common>", "attribute float film;\nvarying float vFilm;");
    shader.vertexShader = put(shader.vertexShader, "#include <begin_vertex>", "vFilm = film;");
    let text = put(shader.fragmentShader, "#include <common>", "varying float vFilm;");
    text = put(
      text,
      "#include <color_fragment>",
      `float thickness = max(vFilm, 0.0);
      diffuseColor.rgb *= exp(-2.0 * thickness / ${vector(ABSORPTION)});
      diffuseColor.rgb = mix(diffuseColor.rgb, ${vector(BLOOD)}, 1.0 - exp(-thickness / ${SCATTERING.toExponential()}));
      float wet = 1.0 - exp(-thickness / ${SHINING.toExponential()});`,
    );
    text = put(text, "#include <roughnessmap_fragment>", `roughnessFactor = mix(roughnessFactor, ${ROUGHNESS}, wet);`);
    shader.fragmentShader = text;
  };
}
