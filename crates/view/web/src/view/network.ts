// Links and balls of a body: sticks coloured by the state of their link, masses as large as they keep others off; in wires, lines
// and points, which any number of them may be.

import {
  BufferAttribute,
  BufferGeometry,
  DynamicDrawUsage,
  Group,
  LineBasicMaterial,
  LineSegments,
  Points,
  PointsMaterial,
} from "three";
import type { Material, Object3D, Plane } from "three";
import type { BodyFrame, FieldInfo, NetworkShape } from "../protocol";
import { Instances } from "./instances";
import { BODY_COLOURS, STATE_COLOURS, colourAt, linearOf } from "./palette";
import type { Range } from "./palette";

/** Radius of a stick, in the mean length of links; and least and most in the size of all bodies. */
const OF_LENGTH = 0.09;
const LEAST = 0.0009;
const MOST = 0.004;
/** Radius of masses that no link joins and nothing gives a size. */
const POINT = 0.007;
/** Of a mass in wires [px]. */
const DOT = 4;

type Wires = LineSegments<BufferGeometry, LineBasicMaterial>;
type Dots = Points<BufferGeometry, PointsMaterial>;
/** What a frame is painted with. */
type Painted = [BodyFrame, Float32Array | undefined, FieldInfo["of"], Range, Float32Array];

export class Network {
  readonly group = new Group();
  private readonly sticks: Instances;
  private readonly balls: Instances;
  private readonly radius: number;
  private readonly sizes: Float32Array;
  private readonly own: Float32Array;
  private readonly states = STATE_COLOURS.map(linearOf);
  private readonly links: Uint32Array;
  private readonly wires: Wires;
  private readonly dots: Dots;
  private isWire = false;
  private last: Painted | null = null;
  /** Balls are drawn as large at least: of one smaller than a pixel nothing is seen [m]. */
  least = 0;
  /** Of the largest ball [m]. */
  readonly largest: number;

  constructor(shape: NetworkShape, rest: Float32Array, index: number, size: number) {
    this.links = shape.links;
    this.own = linearOf(BODY_COLOURS[index % BODY_COLOURS.length]!);
    const count = shape.links.length / 2;
    this.radius = Math.min(MOST * size, Math.max(LEAST * size, OF_LENGTH * meanLength(shape.links, rest)));
    this.sizes = this.sizesOf(shape, rest.length / 3, size);
    this.largest = this.sizes.reduce((most, radius) => Math.max(most, radius), 0);
    this.sticks = new Instances("stick", count);
    this.balls = new Instances("ball", this.sizes.filter((radius) => radius > 0).length);
    this.wires = new LineSegments(coloured(2 * count), new LineBasicMaterial({ vertexColors: true }));
    const dot = new PointsMaterial({ vertexColors: true, size: DOT, sizeAttenuation: false });
    this.dots = new Points(coloured(this.sizes.length), dot);
    this.wires.frustumCulled = this.dots.frustumCulled = false;
    this.group.add(this.sticks.mesh, this.balls.mesh, this.wires, this.dots);
    this.setWire(false);
  }

  /** Whether lines and points stand for it. */
  setWire(isWire: boolean): void {
    this.isWire = isWire;
    this.sticks.mesh.visible = this.balls.mesh.visible = !isWire;
    this.wires.visible = this.dots.visible = isWire;
    if (this.last) this.update(...this.last);
  }

  /** What a ray may meet. */
  get targets(): Object3D[] {
    return [this.sticks.mesh, this.balls.mesh];
  }

  prepareForRay(): void {
    // rays meet what is solid
    if (this.isWire && this.last) this.fill(...this.last);
    this.sticks.prepareForRay();
    this.balls.prepareForRay();
  }

  update(
    frame: BodyFrame,
    values: Float32Array | undefined,
    of: FieldInfo["of"],
    range: Range,
    map: Float32Array,
  ): void {
    this.last = [frame, values, of, range, map];
    if (this.isWire) this.draw(...this.last);
    else this.fill(...this.last);
  }

  /** Lines and points. */
  private draw(...[frame, values, of, range, map]: Painted): void {
    const { positions, linkStates } = frame;
    const ofLinks = of === "links";
    const [lines, shades] = arraysOf(this.wires);
    let vertex = 0;
    for (let link = 0; link < this.links.length / 2; link++) {
      const state = linkStates.length > 0 ? linkStates[link]! : 1;
      if (state === 0) continue;
      const plain = state > 1 ? this.states[(state - 2) % this.states.length]! : this.own;
      for (const point of [this.links[2 * link]!, this.links[2 * link + 1]!]) {
        put(lines, vertex, positions, 3 * point);
        if (values) put(shades, vertex, map, colourAt(values[ofLinks ? link : point]!, range));
        else put(shades, vertex, plain, 0);
        vertex++;
      }
    }
    this.wires.geometry.setDrawRange(0, vertex);
    const [places, colours] = arraysOf(this.dots);
    for (let point = 0; point < this.sizes.length; point++) {
      put(places, point, positions, 3 * point);
      if (values && !ofLinks) put(colours, point, map, colourAt(values[point]!, range));
      else put(colours, point, this.own, 0);
    }
    for (const { geometry } of [this.wires, this.dots]) {
      for (const name of ["position", "color"]) geometry.getAttribute(name).needsUpdate = true;
    }
  }

  /** Sticks and balls. */
  private fill(...[frame, values, of, range, map]: Painted): void {
    const { positions, linkStates } = frame;
    const count = this.links.length / 2;
    const ofLinks = of === "links";
    this.sticks.begin();
    for (let link = 0; link < count; link++) {
      const state = linkStates.length > 0 ? linkStates[link]! : 1;
      if (state === 0) continue;
      const a = this.links[2 * link]!;
      const b = this.links[2 * link + 1]!;
      this.sticks.span(positions, 3 * a, positions, 3 * b, this.radius);
      if (values) {
        const value = ofLinks ? values[link]! : 0.5 * (values[a]! + values[b]!);
        this.sticks.put(map, colourAt(value, range), a);
      } else {
        const colour = state > 1 ? this.states[(state - 2) % this.states.length]! : this.own;
        this.sticks.put(colour, 0, a);
      }
    }
    this.sticks.end();
    this.balls.begin();
    for (let point = 0; point < this.sizes.length; point++) {
      const radius = this.sizes[point]!;
      if (radius <= 0) continue;
      this.balls.ball(positions, 3 * point, Math.max(radius, this.least));
      if (values && !ofLinks) this.balls.put(map, colourAt(values[point]!, range), point);
      else this.balls.put(this.own, 0, point);
    }
    this.balls.end();
  }

  setCut(planes: Plane[]): void {
    this.sticks.setClipping(planes);
    this.balls.setClipping(planes);
    for (const material of [this.wires.material, this.dots.material] as Material[]) material.clippingPlanes = planes;
  }

  dispose(): void {
    this.sticks.dispose();
    this.balls.dispose();
    for (const thing of [this.wires, this.dots]) {
      thing.geometry.dispose();
      thing.material.dispose();
    }
  }

  /** Radii of all points: those that are given, small ones for loose masses, the sticks' own where these meet. */
  private sizesOf(shape: NetworkShape, points: number, size: number): Float32Array {
    const sizes = new Float32Array(points).fill(POINT * size);
    for (const end of shape.links) sizes[end] = this.radius;
    shape.radii.forEach((radius, point) => {
      if (radius > 0) sizes[point] = radius;
    });
    return sizes;
  }
}

/** Room for so many places and their colours. */
function coloured(count: number): BufferGeometry {
  const geometry = new BufferGeometry();
  for (const name of ["position", "color"]) {
    geometry.setAttribute(name, new BufferAttribute(new Float32Array(3 * Math.max(count, 1)), 3).setUsage(DynamicDrawUsage));
  }
  return geometry;
}

function arraysOf(thing: Wires | Dots): [Float32Array, Float32Array] {
  const of = (name: string): Float32Array => thing.geometry.getAttribute(name).array as Float32Array;
  return [of("position"), of("color")];
}

/** Three numbers. */
function put(to: Float32Array, index: number, from: ArrayLike<number>, at: number): void {
  for (let axis = 0; axis < 3; axis++) to[3 * index + axis] = from[at + axis]!;
}

function meanLength(links: Uint32Array, rest: Float32Array): number {
  let sum = 0;
  for (let link = 0; link < links.length; link += 2) {
    const a = 3 * links[link]!;
    const b = 3 * links[link + 1]!;
    sum += Math.hypot(rest[a]! - rest[b]!, rest[a + 1]! - rest[b + 1]!, rest[a + 2]! - rest[b + 2]!);
  }
  return links.length > 0 ? (2 * sum) / links.length : 0;
}
