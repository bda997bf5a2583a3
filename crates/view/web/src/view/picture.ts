// The picture: camera, light, and all that is drawn in it.

import {
  Box3,
  DirectionalLight,
  HemisphereLight,
  Matrix4,
  NeutralToneMapping,
  PCFShadowMap,
  Plane,
  PMREMGenerator,
  Scene,
  SRGBColorSpace,
  Vector3,
  WebGLRenderer,
} from "three";
import type { BufferGeometry, Object3D, Texture } from "three";
import { RoomEnvironment } from "three/examples/jsm/environments/RoomEnvironment.js";
import type { ColourMap, FieldInfo, Frame, InsideShape, NetworkShape, SceneInfo, Surface, TextureShape, ToolShape } from "../protocol";
import type { Weight } from "../ui/notes";
import { Arrows } from "./arrows";
import { Body } from "./body";
import type { Style } from "./body";
import { Eye } from "./eye";
import { Furniture } from "./furniture";
import { Hands } from "./hands";
import type { Aim } from "./hands";
import { Obstacles } from "./obstacles";
import { Meanings } from "./meanings";
import { coloursOf, linearColours } from "./palette";
import { Quality } from "./quality";
import { Contours } from "./contours";
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
  /** That they are in. */
  unit: string;
  /** How far cells are apart, in their distance from the middle. */
  explode: number;
  /** Whether frames that carry bodies are drawn. */
  axes: boolean;
}

export interface Cut {
  axis: 0 | 1 | 2;
  /** Whether the half away from the eye is left; the section is seen on it. */
  isFarHalf: boolean;
  /** From the low end of all that is there, 0, to the high one, 1. */
  place: number;
}

/** Strengths of the light that throws shadows, of that from the sky, and of what that gains where no reflections are. */
const KEY = 2.4;
const SKY = 0.7;
const SKY_ALONE = 1.3;
/** Colours that are read are lit evenly: less from one side, more from all of them, the ground nearly as bright as the sky. */
const KEY_EVEN = 0.5 * KEY;
const SKY_EVEN = 0.8;
const GROUND = 0x8a7f78;
const GROUND_EVEN = 0xdcd8d4;
/** Balls are drawn as large at least [px]. */
const LEAST_BALL = 2.5;
/** A shape is looked at beside the bodies where both together are at most as many times as large as they are. */
const WITH_SHAPE = 2;
/** What is followed is come nearer to when it is smaller than this part of what the distance is of. */
const MUCH_SMALLER = 0.6;
/** By how much of what is too much the range of colours shrinks with each frame. */
const SHRINKING = 0.02;

export class Picture {
  readonly eye: Eye;
  readonly canvas: HTMLCanvasElement;
  bodies: Body[] = [];
  private readonly tools = new Tools();
  /** Diagonal of all bodies at rest [m]. */
  size = 1;
  private readonly renderer: WebGLRenderer;
  private readonly scene = new Scene();
  private readonly key = new DirectionalLight(0xfff4e6, KEY);
  private readonly sky = new HemisphereLight(0xeef4ff, GROUND, SKY);
  private readonly hands: Hands;
  private readonly furniture: Furniture;
  private readonly quality = new Quality(() => this.simplify());
  /** Made when they are first wanted: it takes a while on a machine that is slow. */
  private reflections: Texture | null = null;
  private obstacles: Obstacles | null = null;
  private skins: Skin[] = [];
  private readonly contours = new Contours();
  private arrows = new Arrows(1);
  private extras: Extras = { arrows: -1, unit: "", explode: 0, axes: true };
  private bounds = new Box3();
  private colours: Float32Array = new Float32Array(3 * 256);
  private field = -1;
  /** Of the blood over what it shows. */
  private over = -1;
  /** Whether its colours are how bodies look. */
  private isLook = false;
  private of: FieldInfo["of"] = "points";
  private style: Style = "smooth";
  private dark = false;
  private cut: Cut | null = null;
  /** On which side of the cut's axis the eye was when it was chosen. */
  private eyeSide = 1;
  /** Where that is; null without a cut, and while nothing is there to be cut. */
  private cutPlane: Plane | null = null;
  readonly meanings = new Meanings();
  /** Whether the view has been fitted to the scene's first frame: it alone tells where shapes and lone skins are. */
  private isFitted = false;
  /** The last frame of the scene. */
  private last: Frame | null = null;
  /** What is looked at: the camera stays while it is the same. */
  private subject = "";
  /** How much of the foot of the picture a legend takes [px]. */
  private legend = 0;
  /** Where the middle of all bodies was when the view last went along with them, and the size that its distance is of; null while it stays. */
  private followed: { middle: Vector3; size: number } | null = null;
  /** Whether what is in the picture is no longer as it was drawn. */
  private isStale = true;
  /** From where it was drawn. */
  private readonly drawnFrom = { view: new Matrix4(), projection: new Matrix4() };

  constructor(
    private readonly place: HTMLElement,
    say: (text: string, weight?: Weight) => void,
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
    this.canvas.addEventListener("webglcontextrestored", () => {
      // they were only there
      this.reflections = null;
      this.simplify();
      say("The graphics card draws the picture again.", "note");
    });
    const labels = document.createElement("div");
    labels.className = "labels";
    place.append(labels);
    this.furniture = new Furniture(place);
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
    this.eye = new Eye(this.canvas);
    new ResizeObserver(() => this.resize()).observe(place);
    this.simplify();
  }

  /** Another scene: bodies first among the surfaces, then obstacles. */
  begin(info: SceneInfo, surfaces: Surface[], networks: (NetworkShape | undefined)[]): void {
    this.isStale = true;
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
    this.field = this.over = -1;
    this.meanings.begin(null);
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
    // masses are as large as their balls
    const radius = networks.reduce((most, network) => network?.radii.reduce((most, radius) => Math.max(most, radius), most) ?? most, 0);
    if (!this.bounds.isEmpty()) this.bounds.expandByScalar(radius);
    this.size = this.bounds.isEmpty() ? 1 : Math.max(this.bounds.getSize(point).length(), 1e-6);
    this.eye.up.fromArray(info.up).normalize();
    this.eye.direction.fromArray(info.direction).normalize();
    this.bodies = ofBodies.map((surface, index) => new Body(index, info.bodies[index]!, surface, networks[index], this.size));
    this.skins = info.skins.map((skin, index) => new Skin(skin, skin.worn_by ?? info.bodies.length + index));
    this.skins.forEach((skin) => this.scene.add(skin.mesh));
    // those of the scene before
    this.contours.update(new Float32Array());
    this.scene.add(this.contours.lines);
    this.arrows = new Arrows(this.size);
    this.scene.add(this.arrows.group);
    this.obstacles = new Obstacles(info.obstacles, surfaces.slice(info.bodies.length), this.eye.up, this.bounds);
    this.scene.add(this.obstacles.group);
    this.bodies.forEach((body) => this.scene.add(body.group));
    this.setStyle(this.style, this.dark);
    this.setExtras(this.extras);
    this.placeLight();
    const subject = JSON.stringify([info.name, info.bodies.map(({ name, points }) => [name, points]), info.skins]);
    // begun anew, or shown again after the connection was lost, it is seen from where a person went
    this.isFitted = subject === this.subject;
    this.subject = subject;
    if (!this.isFitted) this.look();
    else {
      this.applyCut();
      this.goAlong();
    }
  }

  /** The cells of a body have come. */
  setInside(shape: InsideShape): void {
    this.isStale = true;
    this.bodies[shape.index]?.setInside(shape);
    this.bodies[shape.index]?.setCut(this.cutPlane);
  }

  addTool(shape: ToolShape): void {
    this.isStale = true;
    this.tools.add(shape);
  }

  /** Tools of a world that is gone. */
  clearTools(): void {
    this.isStale = true;
    this.tools.clear();
  }

  /** Points of a body that are pinned. */
  setPins(body: number, points: number[]): void {
    this.isStale = true;
    this.bodies[body]?.setPins(points);
  }

  setExtras(extras: Extras): void {
    this.isStale = true;
    this.extras = extras;
    for (const body of this.bodies) {
      body.setExplode(extras.explode);
      body.setAxes(extras.axes);
    }
  }

  show(frame: Frame): void {
    this.last = frame;
    frame.bodies.forEach((body, index) => this.bodies[index]?.update(body, frame.time));
    frame.skins.forEach((skin, index) => this.skins[index]?.update(skin));
    this.contours.update(frame.contours);
    this.obstacles?.move(frame.poses);
    this.hands.update(frame.hands);
    this.tools.update(frame.hands);
    if (!this.isFitted) {
      this.isFitted = true;
      this.look();
    }
    this.goAlong();
    this.paint(frame, SHRINKING);
  }

  /** Makes what is seen of the last frame anew: the look has changed. */
  repaint(): void {
    if (this.last) this.paint(this.last, 0);
  }

  /** Colours, sections, cells and arrows; the range of colours shrinks by a part of what is too much. */
  private paint({ bodies }: Frame, shrinking: number): void {
    this.isStale = true;
    const { meanings } = this;
    meanings.size = this.size;
    this.arrows.update(bodies, this.extras.arrows, this.dark, meanings.rest(this.extras.unit));
    meanings.longest = this.arrows.longest;
    const least = LEAST_BALL * this.eye.metresPerPixel(this.place.clientHeight);
    this.bodies.forEach((body) => body.setLeast(least));
    const values = bodies.map((body) => body.fields.get(this.field));
    meanings.follow(values, bodies, shrinking);
    // a skin hides what the colours of its body tell, and its inside
    for (const skin of this.skins) {
      const { worn_by } = skin.info;
      const isBare = worn_by !== null && (values[worn_by] !== undefined || this.cut !== null || this.extras.explode > 0);
      skin.mesh.visible = !isBare;
      if (worn_by !== null) this.bodies[worn_by]?.setBare(isBare);
    }
    const colouring = { of: this.of, range: meanings.range, map: this.colours, isLook: this.isLook };
    bodies.forEach(({ fields }, index) => this.bodies[index]?.colourBy(values[index], fields.get(this.over), colouring));
  }

  setTexture(shape: TextureShape): void {
    this.isStale = true;
    this.bodies[shape.index]?.setTexture(shape);
  }

  /** Colours by a field with this number; `map` is for quantities, classes and looks have colours of their own. */
  setColours(number: number, field: FieldInfo | undefined, map: ColourMap): void {
    const { classes = null, scale = null } = field ?? {};
    if (number !== this.field) this.meanings.begin(field ?? null);
    this.field = number;
    this.over = field?.over ?? -1;
    this.isLook = scale !== null;
    this.light();
    this.isStale = true;
    this.of = field?.of ?? "points";
    this.colours = classes ? coloursOf(classes) : linearColours(scale ?? map);
  }

  setStyle(style: Style, dark: boolean): void {
    this.isStale = true;
    this.style = style;
    this.dark = dark;
    this.bodies.forEach((body) => body.setStyle(style, dark));
    this.skins.forEach((skin) => skin.setStyle(style));
  }

  /** A cut that is as it was stays where it is, whatever moves. */
  setCut(cut: Cut | null): void {
    const before = this.cut;
    if (JSON.stringify(cut) === JSON.stringify(before)) return;
    this.cut = cut;
    this.placeCut(cut?.axis !== before?.axis);
  }

  /** Puts the cut where the bodies are now; `isNew`: the half that is left is the one that shows the section to the eye. */
  private placeCut(isNew: boolean): void {
    const { cut } = this;
    const bounds = this.boundsNow();
    this.cutPlane = null;
    if (cut && !bounds.isEmpty()) {
      // chosen once: it does not change sides while the view turns
      if (isNew) this.eyeSide = this.eye.towards.getComponent(cut.axis) > 0 ? 1 : -1;
      const side = cut.isFarHalf ? -this.eyeSide : this.eyeSide;
      const [low, high] = [bounds.min.getComponent(cut.axis), bounds.max.getComponent(cut.axis)];
      const place = low + (high - low) * cut.place;
      this.cutPlane = new Plane(new Vector3().setComponent(cut.axis, side), -side * place);
    }
    this.applyCut();
  }

  private applyCut(): void {
    this.isStale = true;
    const planes = this.cutPlane ? [this.cutPlane] : [];
    this.bodies.forEach((body) => body.setCut(this.cutPlane));
    this.skins.forEach((skin) => skin.setCut(planes));
    this.arrows.setCut(planes);
  }

  /** Whether the view goes along with the bodies. */
  follow(isWanted: boolean): void {
    if (isWanted === (this.followed !== null)) return;
    const bounds = this.boundsNow();
    this.followed = isWanted ? followedIn(bounds) : null;
    // they may have gone far already
    if (this.followed && !bounds.isEmpty()) this.eye.lookAt(this.followed.middle);
  }

  /** Goes where the bodies go, and as much farther away as they grow, from where a person went; nearer where they are much smaller. */
  private goAlong(): void {
    if (!this.followed) return;
    const bounds = this.boundsNow();
    // what is gone is waited for where it was
    if (bounds.isEmpty()) return;
    const { middle, size } = this.followed;
    const now = followedIn(bounds);
    this.eye.shift(now.middle.clone().sub(middle));
    const fitting = Math.max(now.size, Math.min(size, now.size / MUCH_SMALLER));
    if (size > 0) this.eye.goAway(fitting / size);
    this.followed = { middle: now.middle, size: fitting };
  }

  /** Begins to look at what is there. */
  private look(): void {
    this.fit();
    this.placeCut(true);
  }

  /** Looks at all bodies, and shapes near them, as they stand, from where the scene wants to be seen. */
  fit(): void {
    const bounds = this.boundsNow();
    if (bounds.isEmpty()) bounds.expandByPoint(new Vector3());
    if (diagonal(bounds) === 0) bounds.expandByScalar(0.5 * this.size);
    const most = WITH_SHAPE * diagonal(bounds);
    const all = bounds.clone();
    for (const shape of this.obstacles?.bounds ?? []) {
      if (diagonal(bounds.clone().union(shape)) <= most) all.union(shape);
    }
    this.eye.fit(all, bounds);
    if (this.followed) this.followed = followedIn(bounds);
    // balls are to be seen from there
    this.repaint();
  }

  /** Whether there is anything, and no part of it is in the picture. */
  get isOutOfSight(): boolean {
    const all = this.boundsOfEach();
    if (all.every((bounds) => bounds.isEmpty())) return false;
    const isSeen = ({ loose }: Body): boolean => loose !== null && this.eye.seesAny(loose.places, loose.reach);
    // what is loose may have left on all sides, and a box about it is everywhere
    const boxes = all.filter((bounds, index) => !bounds.isEmpty() && !this.bodies[index]?.loose);
    return !boxes.some((bounds) => this.eye.sees(bounds)) && !this.bodies.some(isSeen);
  }

  /** Of all bodies and skins as they stand. */
  private boundsNow(): Box3 {
    return this.boundsOfEach().reduce((all, bounds) => all.union(bounds), new Box3());
  }

  private boundsOfEach(): Box3[] {
    const point = new Vector3();
    const boundsOf = (positions: ArrayLike<number>, end: number): Box3 => {
      const bounds = new Box3();
      for (let i = 0; i < end; i += 3) bounds.expandByPoint(point.set(positions[i]!, positions[i + 1]!, positions[i + 2]!));
      return bounds;
    };
    const ofBodies = this.bodies.map(({ positions, loose }) => {
      const bounds = boundsOf(positions, positions.length);
      return bounds.isEmpty() ? bounds : bounds.expandByScalar(loose?.reach ?? 0);
    });
    const ofSkins = this.skins.map(({ mesh: { geometry } }) => {
      const positions = geometry.getAttribute("position")?.array;
      return positions ? boundsOf(positions, drawnNumbers(geometry)) : new Box3();
    });
    return [...ofBodies, ...ofSkins];
  }

  /** Draws what is not as it was drawn last: a machine that draws by software has the rest of its time for what comes. */
  draw(): void {
    this.eye.update();
    const { camera } = this.eye;
    camera.updateMatrixWorld();
    const { view, projection } = this.drawnFrom;
    if (!this.isStale && view.equals(camera.matrixWorld) && projection.equals(camera.projectionMatrix)) {
      this.quality.rested(performance.now());
      return;
    }
    this.isStale = false;
    view.copy(camera.matrixWorld);
    projection.copy(camera.projectionMatrix);
    this.renderer.render(this.scene, camera);
    this.furniture.update(this.eye, this.place.clientHeight);
    this.hands.placeLabels(this.eye.camera, this.place.clientWidth, this.place.clientHeight);
    this.quality.drawn(performance.now());
  }

  /** Draws once as well as can be, whatever the machine does in time, and hands the drawing on. */
  atItsBest<T>(use: (drawing: HTMLCanvasElement) => T): T {
    this.isStale = true;
    return this.quality.atBest(() => {
      this.renderer.render(this.scene, this.eye.camera);
      // the drawing is gone when the browser has shown it
      return use(this.canvas);
    });
  }

  /** Draws as well as the machine can. */
  private simplify(): void {
    this.isStale = true;
    const { shadows, reflections } = this.quality.now;
    this.key.castShadow = shadows;
    if (reflections && !this.reflections) {
      const environment = new PMREMGenerator(this.renderer);
      this.reflections = environment.fromScene(new RoomEnvironment(), 0.04).texture;
      environment.dispose();
    }
    this.scene.environment = reflections ? this.reflections : null;
    this.light();
    this.resize();
  }

  /** Balances the lights for what is drawn. */
  private light(): void {
    const isRead = this.field >= 0 && !this.isLook;
    this.sky.intensity = SKY + (this.quality.now.reflections ? 0 : SKY_ALONE) + (isRead ? SKY_EVEN : 0);
    this.sky.groundColor.set(isRead ? GROUND_EVEN : GROUND);
    this.key.intensity = isRead ? KEY_EVEN : KEY;
  }

  /** The body under a place of the screen. */
  hit(event: { clientX: number; clientY: number }): Hit | null {
    const ray = this.eye.aimAt(event);
    this.bodies.forEach((body) => body.prepareForRay());
    this.skins.forEach((skin) => skin.prepareForRay());
    const bodies = new Map<Object3D, Body>();
    for (const body of this.bodies) body.targets.forEach((target) => bodies.set(target, body));
    const skins = this.skins.map((skin) => skin.mesh).filter(({ visible }) => visible);
    const hits = ray.intersectObjects([...bodies.keys(), ...skins], false);
    const met = hits.find((hit) => !this.cutPlane || this.cutPlane.distanceToPoint(hit.point) >= 0);
    if (!met) return null;
    const body = bodies.get(met.object) ?? this.wearer(met.object, met.point);
    const isSurface = body?.mesh === met.object;
    const normal = (isSurface ? met.normal?.clone() : null) ?? ray.ray.direction.clone().negate();
    return body ? { body, point: met.point, normal } : null;
  }

  /** How far bodies rise above a plane through a point, within a radius about it and by less than `most`. */
  heightAbove(point: Vector3, normal: Vector3, radius: number, most: number): number {
    let height = 0;
    const offset = new Vector3();
    for (const { positions } of this.bodies) {
      for (let at = 0; at < positions.length; at += 3) {
        offset.fromArray(positions, at).sub(point);
        const above = offset.dot(normal);
        const isNear = offset.lengthSq() - above * above < radius * radius;
        if (isNear && above > height && above < most) height = above;
      }
    }
    return height;
  }

  /** Shows where something will be thrown. */
  aim(aimed: Aim | null): void {
    this.isStale = true;
    this.hands.aim(aimed);
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

  /** The key light stands to the left above the camera's usual place, and its shadows cover all bodies. */
  private placeLight(): void {
    const centre = this.bounds.getCenter(new Vector3());
    const right = this.eye.direction.clone().cross(this.eye.up).normalize();
    const towards = this.eye.direction
      .clone()
      .multiplyScalar(-0.55)
      .addScaledVector(right, -0.6)
      .addScaledVector(this.eye.up, 1.05)
      .normalize();
    this.key.position.copy(centre).addScaledVector(towards, 3 * this.size);
    this.key.target.position.copy(centre);
    this.sky.position.copy(this.eye.up);
    const { camera } = this.key.shadow;
    const reach = 1.3 * this.size;
    Object.assign(camera, { left: -reach, right: reach, top: reach, bottom: -reach, near: 0.1 * this.size, far: 8 * this.size });
    camera.updateProjectionMatrix();
    this.key.shadow.normalBias = 0.004 * this.size;
  }

  private resize(): void {
    this.isStale = true;
    const width = Math.max(this.place.clientWidth, 1);
    const height = Math.max(this.place.clientHeight, 1);
    const { pixels } = this.quality.now;
    this.renderer.setPixelRatio(pixels < 1 ? pixels : Math.min(devicePixelRatio, pixels));
    this.renderer.setSize(width, height);
    this.eye.resize(width, height, this.legend);
    // a drawing of another size is empty until it is drawn on, and would be seen so
    if (this.subject !== "") this.renderer.render(this.scene, this.eye.camera);
  }

  /** How much of the foot of the picture a legend takes [px]. */
  setLegend(height: number): void {
    if (height === this.legend) return;
    this.legend = height;
    this.resize();
  }
}

function followedIn(bounds: Box3): { middle: Vector3; size: number } {
  return { middle: bounds.getCenter(new Vector3()), size: bounds.isEmpty() ? 0 : diagonal(bounds) };
}

function diagonal(bounds: Box3): number {
  return bounds.getSize(new Vector3()).length();
}

/** How many of a skin's numbers are positions of points that its triangles have. */
function drawnNumbers(geometry: BufferGeometry): number {
  const index = geometry.getIndex()?.array ?? [];
  let last = -1;
  for (let i = 0; i < geometry.drawRange.count; i++) last = Math.max(last, index[i]!);
  return 3 * (last + 1);
}
