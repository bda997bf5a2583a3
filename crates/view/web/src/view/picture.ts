// The picture: camera, light, and all that is drawn in it.

import {
  Box3,
  DirectionalLight,
  HemisphereLight,
  NeutralToneMapping,
  PCFShadowMap,
  PerspectiveCamera,
  Plane,
  PMREMGenerator,
  Raycaster,
  Scene,
  SRGBColorSpace,
  Vector2,
  Vector3,
  WebGLRenderer,
} from "three";
import type { BufferGeometry, Object3D, Texture } from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { RoomEnvironment } from "three/examples/jsm/environments/RoomEnvironment.js";
import type { ColourMap, FieldInfo, Frame, InsideShape, NetworkShape, SceneInfo, Surface, ToolShape } from "../protocol";
import { Arrows } from "./arrows";
import { Body } from "./body";
import type { Style } from "./body";
import { Hands } from "./hands";
import { Obstacles } from "./obstacles";
import { Meanings } from "./meanings";
import { coloursOf, linearColours } from "./palette";
import { Quality } from "./quality";
import { Skin } from "./skin";
import { Tools } from "./tools";

/** Where a ray meets a body. */
export interface Hit {
  body: Body;
  point: Vector3;
  normal: Vector3;
}

/** What of the world is drawn beside its surfaces. */
export interface Extras {
  /** Number of the kind of arrows; -1 for none. */
  arrows: number;
  /** How far cells are apart, in their distance from the middle. */
  explode: number;
  /** Whether frames that carry bodies are drawn. */
  axes: boolean;
}

export interface Cut {
  axis: 0 | 1 | 2;
  /** From 0, nothing is left, to 1, all is. */
  place: number;
}

/** By how much of what is too much the range of colours shrinks with each frame. */
const SHRINKING = 0.02;

export class Picture {
  readonly camera = new PerspectiveCamera(32, 1, 0.01, 100);
  readonly controls: OrbitControls;
  readonly canvas: HTMLCanvasElement;
  bodies: Body[] = [];
  readonly tools = new Tools();
  /** Diagonal of all bodies at rest [m]. */
  size = 1;
  private readonly renderer: WebGLRenderer;
  private readonly scene = new Scene();
  private readonly key = new DirectionalLight(0xfff4e6, 2.4);
  private readonly sky = new HemisphereLight(0xeef4ff, 0x8a7f78, 0.7);
  private readonly hands: Hands;
  private readonly quality = new Quality(() => this.simplify());
  /** Made when they are first wanted: it takes a while on a machine that is slow. */
  private reflections: Texture | null = null;
  private readonly ray = new Raycaster();
  private obstacles: Obstacles | null = null;
  private skins: Skin[] = [];
  private arrows = new Arrows(1);
  private extras: Extras = { arrows: -1, explode: 0, axes: true };
  private bounds = new Box3();
  private up = new Vector3(0, 1, 0);
  private direction = new Vector3(-0.5, -0.45, -1);
  private colours: Float32Array = new Float32Array(3 * 256);
  private field = -1;
  private of: FieldInfo["of"] = "points";
  private style: Style = "smooth";
  private dark = false;
  private cut: Cut | null = null;
  private readonly cutPlane = new Plane();
  readonly meanings = new Meanings();
  private hasSkins = false;
  /** The last frame of the scene. */
  private last: Frame | null = null;
  /** What is looked at: the camera stays while it is the same. */
  private subject = "";

  constructor(
    private readonly place: HTMLElement,
    say: (text: string) => void,
    grab: (picture: Picture) => void,
  ) {
    this.renderer = new WebGLRenderer({ antialias: true, alpha: true, powerPreference: "high-performance" });
    const { renderer } = this;
    renderer.outputColorSpace = SRGBColorSpace;
    renderer.toneMapping = NeutralToneMapping;
    renderer.toneMappingExposure = 1;
    renderer.shadowMap.enabled = true;
    renderer.shadowMap.type = PCFShadowMap;
    renderer.localClippingEnabled = true;
    this.canvas = renderer.domElement;
    place.append(this.canvas);
    this.canvas.addEventListener("webglcontextlost", () => say("The graphics card has dropped the picture; the world goes on."));
    this.canvas.addEventListener("webglcontextrestored", () => say("The graphics card draws the picture again."));
    const labels = document.createElement("div");
    labels.className = "labels";
    place.append(labels);
    this.hands = new Hands(labels, () => this.size);
    this.scene.environmentIntensity = 0.45;
    this.key.castShadow = true;
    this.key.shadow.mapSize.set(2048, 2048);
    this.key.shadow.radius = 5;
    this.key.shadow.bias = -4e-4;
    this.key.shadow.normalBias = 0.01;
    this.scene.add(this.key, this.key.target, this.sky, this.hands.group, this.tools.group);
    // the hand comes before the camera: what it takes hold of does not turn the view
    grab(this);
    this.controls = new OrbitControls(this.camera, this.canvas);
    this.controls.enableDamping = true;
    this.controls.dampingFactor = 0.12;
    new ResizeObserver(() => this.resize()).observe(place);
    this.simplify();
  }

  /** Another scene: bodies first among the surfaces, then obstacles. */
  begin(info: SceneInfo, surfaces: Surface[], networks: (NetworkShape | undefined)[]): void {
    for (const body of this.bodies) {
      this.scene.remove(body.group);
      body.dispose();
    }
    for (const skin of this.skins) {
      this.scene.remove(skin.mesh);
      skin.dispose();
    }
    this.scene.remove(this.arrows.group);
    this.arrows.dispose();
    this.last = null;
    // a range that another world, or this one before, has widened tells nothing of this one
    this.field = -1;
    if (this.obstacles) {
      this.scene.remove(this.obstacles.group);
      this.obstacles.dispose();
    }
    const ofBodies = surfaces.slice(0, info.bodies.length);
    this.bounds = new Box3();
    const point = new Vector3();
    for (const { points } of ofBodies) {
      for (let i = 0; i < points.length; i += 3) this.bounds.expandByPoint(point.fromArray(points, i));
    }
    // one mass alone is as large as its ball
    const radius = Math.max(0, ...networks.flatMap((network) => [...(network?.radii.slice(0, 1) ?? [])]));
    if (!this.bounds.isEmpty()) this.bounds.expandByScalar(radius);
    this.size = this.bounds.isEmpty() ? 1 : Math.max(this.bounds.getSize(point).length(), 1e-6);
    this.up.fromArray(info.up).normalize();
    this.direction.fromArray(info.direction).normalize();
    this.bodies = ofBodies.map((surface, index) => new Body(index, info.bodies[index]!, surface, networks[index], this.size));
    this.skins = info.skins.map((skin, index) => new Skin(skin, skin.worn_by ?? info.bodies.length + index));
    this.skins.forEach((skin) => this.scene.add(skin.mesh));
    this.arrows = new Arrows(this.size);
    this.scene.add(this.arrows.group);
    this.obstacles = new Obstacles(info.obstacles, surfaces.slice(info.bodies.length), this.up, this.bounds);
    this.scene.add(this.obstacles.group);
    this.bodies.forEach((body) => this.scene.add(body.group));
    this.setStyle(this.style, this.dark);
    this.setCut(this.cut);
    this.setExtras(this.extras);
    this.light();
    const subject = JSON.stringify([info.name, info.bodies.map(({ name, points }) => [name, points]), info.skins]);
    // begun anew, or shown again after the connection was lost, it is seen from where a person went
    this.hasSkins = subject === this.subject;
    if (subject !== this.subject) this.fit();
    this.subject = subject;
  }

  /** The cells of a body have come. */
  setInside(shape: InsideShape): void {
    this.bodies[shape.index]?.setInside(shape);
    this.setCut(this.cut);
  }

  addTool(shape: ToolShape): void {
    this.tools.add(shape);
  }

  setExtras(extras: Extras): void {
    this.extras = extras;
    for (const body of this.bodies) {
      body.setExplode(extras.explode);
      body.setAxes(extras.axes);
    }
  }

  show(frame: Frame): void {
    this.last = frame;
    frame.bodies.forEach((body, index) => this.bodies[index]?.update(body));
    frame.skins.forEach((skin, index) => this.skins[index]?.update(skin));
    this.obstacles?.move(frame.poses);
    this.hands.update(frame.hands);
    this.tools.update(frame.hands);
    if (!this.hasSkins && frame.skins.length > 0) {
      // a skin that stands alone is known by its first frame
      this.hasSkins = true;
      this.fit();
    }
    this.paint(frame, SHRINKING);
  }

  /** Makes what is seen of the last frame anew: the look has changed. */
  repaint(): void {
    if (this.last) this.paint(this.last, 0);
  }

  /** Colours, sections, cells and arrows; the range of colours shrinks by a part of what is too much. */
  private paint({ bodies }: Frame, shrinking: number): void {
    const { meanings } = this;
    this.arrows.update(bodies, this.extras.arrows, this.dark);
    meanings.longest = this.arrows.longest;
    const values = bodies.map((body) => body.fields.get(this.field));
    meanings.follow(values, bodies, shrinking);
    bodies.forEach((_, index) => this.bodies[index]?.colourBy(values[index], this.of, meanings.range, this.colours));
  }

  /** Colours by a field with this number; `map` is for quantities, classes have colours of their own. */
  setColours(number: number, field: FieldInfo | undefined, map: ColourMap): void {
    const classes = field?.classes ?? null;
    if (number !== this.field) this.meanings.begin(classes);
    this.field = number;
    this.of = field?.of ?? "points";
    this.colours = classes ? coloursOf(classes) : linearColours(map);
  }

  setStyle(style: Style, dark: boolean): void {
    this.style = style;
    this.dark = dark;
    this.bodies.forEach((body) => body.setStyle(style, dark));
    this.skins.forEach((skin) => skin.setStyle(style));
  }

  setCut(cut: Cut | null): void {
    this.cut = cut;
    if (cut) {
      const normal = new Vector3().setComponent(cut.axis, -1);
      const low = this.bounds.min.getComponent(cut.axis);
      const high = this.bounds.max.getComponent(cut.axis);
      this.cutPlane.set(normal, low + (high - low) * cut.place);
    }
    this.bodies.forEach((body) => body.setCut(cut ? this.cutPlane : null));
    this.skins.forEach((skin) => skin.setCut(cut ? [this.cutPlane] : []));
    this.arrows.setCut(cut ? [this.cutPlane] : []);
  }

  /** Looks at all bodies as they stand, from where the scene wants to be seen. */
  fit(): void {
    const bounds = new Box3();
    const point = new Vector3();
    const skins = this.skins.map(({ mesh }) => mesh.geometry);
    const ofSkins = skins.map((geometry) => geometry.getAttribute("position")?.array.slice(0, drawnNumbers(geometry)) ?? []);
    for (const positions of [...this.bodies.map((body) => body.positions), ...ofSkins]) {
      for (let i = 0; i < positions.length; i += 3) bounds.expandByPoint(point.fromArray(positions, i));
    }
    if (bounds.isEmpty()) bounds.expandByPoint(point.set(0, 0, 0));
    if (bounds.getSize(point).length() === 0) bounds.expandByScalar(0.5 * this.size);
    const centre = bounds.getCenter(new Vector3());
    const radius = Math.max(0.5 * bounds.getSize(point).length(), 1e-6);
    const half = 0.5 * this.camera.fov * (Math.PI / 180);
    const narrow = Math.min(half, Math.atan(Math.tan(half) * this.camera.aspect));
    const distance = (1.12 * radius) / Math.sin(narrow);
    this.camera.up.copy(this.up);
    this.camera.position.copy(centre).addScaledVector(this.direction, -distance);
    this.camera.near = distance / 200;
    this.camera.far = distance * 40;
    this.camera.updateProjectionMatrix();
    this.controls.target.copy(centre);
    this.controls.update();
  }

  draw(): void {
    this.controls.update();
    this.renderer.render(this.scene, this.camera);
    this.hands.placeLabels(this.camera, this.place.clientWidth, this.place.clientHeight);
    this.quality.drawn(performance.now());
  }

  /** Draws as well as the machine can. */
  private simplify(): void {
    const { shadows, reflections } = this.quality.now;
    this.key.castShadow = shadows;
    if (reflections && !this.reflections) {
      const environment = new PMREMGenerator(this.renderer);
      this.reflections = environment.fromScene(new RoomEnvironment(), 0.04).texture;
      environment.dispose();
    }
    this.scene.environment = reflections ? this.reflections : null;
    // what reflections give of light
    this.sky.intensity = reflections ? 0.7 : 2;
    this.resize();
  }

  /** The body under a place of the screen. */
  hit(event: { clientX: number; clientY: number }): Hit | null {
    this.aim(event);
    this.bodies.forEach((body) => body.prepareForRay());
    this.skins.forEach((skin) => skin.prepareForRay());
    const bodies = new Map<Object3D, Body>();
    for (const body of this.bodies) body.targets.forEach((target) => bodies.set(target, body));
    const skins = this.skins.map((skin) => skin.mesh);
    const hits = this.ray.intersectObjects([...bodies.keys(), ...skins], false);
    const met = hits.find((hit) => !this.cut || this.cutPlane.distanceToPoint(hit.point) >= 0);
    if (!met) return null;
    const body = bodies.get(met.object) ?? this.wearer(met.object, met.point);
    const isSurface = body?.mesh === met.object;
    const normal = (isSurface ? met.normal?.clone() : null) ?? this.ray.ray.direction.clone().negate();
    return body ? { body, point: met.point, normal } : null;
  }

  /** The body that wears a skin; of one over several bodies, the nearest. */
  private wearer(skin: Object3D, place: Vector3): Body | null {
    const known = this.skins.find(({ mesh }) => mesh === skin)?.info.worn_by;
    if (known !== null && known !== undefined) return this.bodies[known] ?? null;
    const point = new Vector3();
    const distance = ({ positions }: Body): number => {
      let least = Infinity;
      for (let i = 0; i < positions.length; i += 3) least = Math.min(least, point.fromArray(positions, i).distanceToSquared(place));
      return least;
    };
    const all = this.bodies.map((body) => [distance(body), body] as const).sort((a, b) => a[0] - b[0]);
    return all[0]?.[1] ?? null;
  }

  /** Cells that are known, of bodies that somebody looks into. */
  get cellCount(): number {
    return this.bodies.reduce((sum, body) => sum + body.cellCount, 0);
  }

  /** Towards the eye, unit. */
  get towardsEye(): Vector3 {
    return this.camera.getWorldDirection(new Vector3()).negate();
  }

  /** The place above a plane through a point, across the view, that a place of the screen lies on. */
  onPlane(event: { clientX: number; clientY: number }, point: Vector3): Vector3 | null {
    this.aim(event);
    const plane = new Plane().setFromNormalAndCoplanarPoint(this.camera.getWorldDirection(new Vector3()), point);
    return this.ray.ray.intersectPlane(plane, new Vector3());
  }

  /** The picture as a file. */
  save(): Promise<Blob | null> {
    this.draw();
    return new Promise((resolve) => this.canvas.toBlob(resolve, "image/png"));
  }

  private aim({ clientX, clientY }: { clientX: number; clientY: number }): void {
    const { left, top, width, height } = this.canvas.getBoundingClientRect();
    const at = new Vector2(((clientX - left) / width) * 2 - 1, 1 - ((clientY - top) / height) * 2);
    this.ray.setFromCamera(at, this.camera);
  }

  /** The key light stands to the left above the camera's usual place, and its shadows cover all bodies. */
  private light(): void {
    const centre = this.bounds.getCenter(new Vector3());
    const right = this.direction.clone().cross(this.up).normalize();
    const towards = this.direction
      .clone()
      .multiplyScalar(-0.55)
      .addScaledVector(right, -0.6)
      .addScaledVector(this.up, 1.05)
      .normalize();
    this.key.position.copy(centre).addScaledVector(towards, 3 * this.size);
    this.key.target.position.copy(centre);
    this.sky.position.copy(this.up);
    const { camera } = this.key.shadow;
    const reach = 1.3 * this.size;
    Object.assign(camera, { left: -reach, right: reach, top: reach, bottom: -reach, near: 0.1 * this.size, far: 8 * this.size });
    camera.updateProjectionMatrix();
    this.key.shadow.normalBias = 0.004 * this.size;
  }

  private resize(): void {
    const width = Math.max(this.place.clientWidth, 1);
    const height = Math.max(this.place.clientHeight, 1);
    const { pixels } = this.quality.now;
    this.renderer.setPixelRatio(pixels < 1 ? pixels : Math.min(devicePixelRatio, pixels));
    this.renderer.setSize(width, height);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
  }
}

/** How many of a skin's numbers are positions of points that its triangles have. */
function drawnNumbers(geometry: BufferGeometry): number {
  const index = geometry.getIndex()?.array ?? [];
  let last = -1;
  for (let i = 0; i < geometry.drawRange.count; i++) last = Math.max(last, index[i]!);
  return 3 * (last + 1);
}
