// A soft body on the screen: its surface, its links and balls, its inside, the frames that carry it.

import {
  BufferAttribute,
  BufferGeometry,
  DoubleSide,
  DynamicDrawUsage,
  FrontSide,
  Group,
  InstancedMesh,
  LineBasicMaterial,
  LineSegments,
  Matrix4,
  Mesh,
  MeshPhysicalMaterial,
  MeshStandardMaterial,
  Plane,
  SphereGeometry,
  Vector3,
} from "three";
import type { Object3D } from "three";
import type { BodyFrame, BodyInfo, FieldInfo, InsideShape, NetworkShape, Surface, TextureShape } from "../protocol";
import { Axes } from "./axes";
import { Coat } from "./coat";
import { Facets } from "./facets";
import { Inside } from "./inside";
import type { Paint } from "./inside";
import { Network } from "./network";
import { divideAtCreases, smoothNormals } from "./normals";
import type { Creased } from "./normals";
import { BODY_COLOURS, paint } from "./palette";
import type { Range } from "./palette";

/** How surfaces are drawn. */
export type Style = "smooth" | "edges" | "wireframe";

const PIN_COLOUR = 0x3d6fd8;
/** Edges of elements: dark on surfaces, and bright where there is only the night behind them. */
const LINES_DARK = 0x101418;
const LINES_BRIGHT = 0xdfe6f0;
/** Of the outside beyond a section, in the size of all bodies. */
const OVERLAP = 4e-4;
/** Beyond so many sizes of all bodies numbers of four bytes draw nothing that could be seen. */
const FAR = 1e6;

/** How much of the lamp and of the room around is seen in a surface. */
interface Shine {
  roughness: number;
  clearcoat: number;
  clearcoatRoughness: number;
}
const OWN: Shine = { roughness: 0.5, clearcoat: 0.3, clearcoatRoughness: 0.4 };
/** Colours are read by the eye: less shine on them. */
const READ: Shine = { roughness: 0.7, clearcoat: 0.1, clearcoatRoughness: 0.4 };
/** The surface of an organ has a film of water on it. */
const WET: Shine = { roughness: 0.45, clearcoat: 1, clearcoatRoughness: 0.12 };

/** What values are coloured by. */
export interface Colouring {
  of: FieldInfo["of"];
  range: Range;
  map: Float32Array;
  /** Whether the colours are how a body looks, and not numbers to be read. */
  isLook: boolean;
}

export class Body {
  readonly group = new Group();
  readonly mesh: Mesh<BufferGeometry, MeshPhysicalMaterial>;
  /** Of the points that are always shown. */
  readonly positions: Float32Array;
  readonly normals: Float32Array;
  private readonly network: Network | null;
  private readonly axes: Axes;
  private readonly coat: Coat;
  private inside: Inside | null = null;
  /** Made when cells are first coloured. */
  private facets: Facets | null = null;
  private ofCells = false;
  private last: BodyFrame | null = null;
  private cut: Plane | null = null;
  /** What cuts the outside off. */
  private clipping: Plane[] = [];
  private explode = 0;
  private style: Style = "smooth";
  private dark = false;
  private hasValues = false;
  /** Attributes of the coat that are not zero everywhere. */
  private readonly numbered = new Set<string>();
  private shine = OWN;
  /** Seen itself, whatever skin it wears. */
  private isBare = false;
  /** The surface as it is drawn, and the numbers of its triangles among all that are ever there. */
  private creased: Creased;
  private drawn: Uint32Array;
  /** When it opens [s], and how often it has. */
  private readonly dates: number[];
  private opened = 0;
  private time = 0;
  private readonly edges: LineSegments<BufferGeometry, LineBasicMaterial>;
  private pins: InstancedMesh<SphereGeometry, MeshStandardMaterial> | null = null;
  private pinned: number[] = [];

  constructor(
    readonly index: number,
    readonly info: BodyInfo,
    private readonly surface: Surface,
    network: NetworkShape | undefined,
    private readonly size: number,
  ) {
    this.dates = [...new Set(surface.spans)].filter(Number.isFinite).sort((a, b) => a - b);
    this.drawn = shownAt(surface.spans, surface.triangles.length / 3, -Infinity);
    this.creased = divideAtCreases(surface.points, chosen(surface.triangles, 3, this.drawn));
    this.positions = Float32Array.from(surface.points);
    this.normals = new Float32Array(this.positions.length);
    const made = (names: string[], points: number) => {
      const geometry = new BufferGeometry();
      for (const name of names) geometry.setAttribute(name, moving(new Float32Array(3 * points)));
      return geometry;
    };
    const geometry = made(["position", "normal", "color"], this.creased.sources.length);
    geometry.setIndex(new BufferAttribute(this.creased.triangles, 1));
    layRest(geometry, this.creased, surface.points);
    const material = new MeshPhysicalMaterial({
      color: BODY_COLOURS[index % BODY_COLOURS.length]!,
      ...OWN,
      polygonOffset: true,
      polygonOffsetFactor: 1,
      polygonOffsetUnits: 1,
    });
    this.coat = new Coat(material);
    this.mesh = new Mesh(geometry, material);
    this.mesh.castShadow = true;
    this.mesh.receiveShadow = true;
    // it moves out of any box that was drawn about it once
    this.mesh.frustumCulled = false;
    const lines = made(["color"], surface.points.length / 3);
    lines.setAttribute("position", moving(this.positions));
    lines.setIndex(new BufferAttribute(this.edgesAt(-Infinity), 1));
    this.edges = new LineSegments(lines, new LineBasicMaterial({ transparent: true }));
    this.edges.frustumCulled = false;
    this.edges.visible = false;
    this.group.add(this.mesh, this.edges);
    this.network = network ? new Network(network, surface.points, index, size) : null;
    if (this.network) this.group.add(this.network.group);
    this.axes = new Axes(this.group, size);
    if (info.is_sheet) material.side = DoubleSide;
    this.moved();
  }

  /** Goes where a frame says; points of the inside follow those of the outside there, if anybody looks at them. */
  update(frame: BodyFrame, time: number): void {
    this.open(time);
    if (frame.positions.length < this.positions.length) return;
    // of a world that blew up the last that can be drawn stays
    if (frame.positions.some((number) => !(Math.abs(number) < FAR * this.size))) return;
    this.last = frame;
    this.positions.set(frame.positions.subarray(0, this.positions.length));
    this.axes.update(frame.frames);
    this.moved();
  }

  /** Its cells have come. */
  setInside(shape: InsideShape): void {
    this.inside?.dispose();
    if (this.inside) this.group.remove(this.inside.group);
    this.inside = new Inside(shape, this.index);
    this.group.add(this.inside.group);
    this.setVisible();
  }

  /** Places of what is drawn as loose balls and links, and how far these reach about them [m]; null of a surface. */
  get loose(): { places: Float32Array; reach: number } | null {
    return this.network ? { places: this.positions, reach: this.network.largest } : null;
  }

  /** Balls are drawn as large at least [m]. */
  setLeast(radius: number): void {
    if (this.network) this.network.least = radius;
  }

  /** Cells whose shapes have come. */
  get cellCount(): number {
    return this.inside ? this.info.cells : 0;
  }

  /** What a ray may meet. */
  get targets(): Object3D[] {
    return this.network ? this.network.targets : [this.mesh];
  }

  setExplode(amount: number): void {
    this.explode = amount;
    this.setVisible();
  }

  setBare(isBare: boolean): void {
    if (isBare === this.isBare) return;
    this.isBare = isBare;
    this.setVisible();
  }

  setAxes(shown: boolean): void {
    this.axes.setShown(shown);
  }

  setTexture(shape: TextureShape): void {
    this.coat.setTexture(shape);
  }

  /** Colours by values, with blood over them where any lies; by its own colour for none. */
  colourBy(values: Float32Array | undefined, film: Float32Array | undefined, { of, range, map, isLook }: Colouring): void {
    const { material } = this.mesh;
    const shine = !values ? OWN : isLook ? WET : READ;
    if (material.vertexColors !== Boolean(values) || this.shine !== shine) {
      this.shine = shine;
      material.vertexColors = Boolean(values);
      material.color.set(values ? 0xffffff : BODY_COLOURS[this.index % BODY_COLOURS.length]!);
      Object.assign(material, shine);
      material.needsUpdate = true;
    }
    this.setNumbers("film", film);
    const isTextured = this.coat.isTextured && (!values || isLook);
    this.coat.setShown(isTextured);
    this.setNumbers("look", isTextured ? values : undefined);
    this.setOfCells(of === "cells" && values !== undefined);
    const { sources } = this.creased;
    const count = this.surface.triangles.length / 3;
    if (values && this.ofCells) {
      this.facets?.update(numbersOf(this.mesh, "position"), numbersOf(this.mesh, "normal"), values, map);
    } else if (values) {
      const colours = numbersOf(this.edges, "color");
      paint(values, range, map, colours);
      spread(colours, sources, numbersOf(this.mesh, "color"));
      for (const { geometry } of [this.mesh, this.edges]) geometry.getAttribute("color").needsUpdate = true;
    }
    this.hasValues = values !== undefined;
    this.setLines();
    if (!this.last) return;
    this.network?.update(this.last, values, of, range, map);
    // a frame that left before the page looked inside has no points there
    const hasInside = this.last.positions.length > this.positions.length || this.info.points === this.info.surface_points;
    if (!hasInside) return;
    const inner: Paint = { values: this.ofCells ? values?.subarray(count) : values, ofCells: this.ofCells, range, map };
    this.inside?.update(this.last.positions, inner, this.cut, this.explode, this.time);
  }

  setStyle(style: Style, dark: boolean): void {
    this.style = style;
    this.dark = dark;
    this.mesh.castShadow = style !== "wireframe";
    this.network?.setWire(style === "wireframe");
    this.setVisible();
    this.setLines();
  }

  /** Lines are coloured where nothing else is; classes, which have nothing between them, by their triangles' sides. */
  private setLines(): void {
    const isWire = this.style === "wireframe";
    const { material } = this.mesh;
    material.wireframe = isWire && this.ofCells;
    material.colorWrite = material.depthWrite = !isWire || this.ofCells;
    const lines = this.edges.material;
    const isColoured = isWire && this.hasValues && !this.ofCells;
    if (lines.vertexColors !== isColoured) lines.needsUpdate = true;
    lines.vertexColors = isColoured;
    const plain = isWire && this.dark ? LINES_BRIGHT : LINES_DARK;
    lines.color.set(isColoured ? 0xffffff : plain);
    lines.opacity = isColoured ? 1 : isWire ? 0.6 : 0.3;
  }

  setCut(cut: Plane | null): void {
    this.cut = cut;
    // the outside ends a little beyond the section: nothing is seen between them
    const planes = cut ? [new Plane(cut.normal, cut.constant + OVERLAP * this.size)] : [];
    this.mesh.material.clippingPlanes = planes;
    // what has no section is looked into
    this.mesh.material.side = this.info.is_sheet || (cut && !this.info.has_inside) ? DoubleSide : FrontSide;
    this.mesh.material.needsUpdate = true;
    this.edges.material.clippingPlanes = planes;
    this.clipping = planes;
    if (this.pins) this.pins.material.clippingPlanes = planes;
    this.network?.setCut(planes);
    this.inside?.setCut(planes);
  }

  setPins(points: number[]): void {
    this.pinned = points;
    if (this.pins && this.pins.count !== points.length) this.dropPins();
    if (!this.pins && points.length > 0) {
      const sphere = new SphereGeometry(this.size * 0.009, 10, 8);
      this.pins = new InstancedMesh(sphere, new MeshStandardMaterial({ color: PIN_COLOUR, roughness: 0.5 }), points.length);
      this.pins.frustumCulled = false;
      this.pins.material.clippingPlanes = this.clipping;
      this.group.add(this.pins);
    }
    this.placePins();
  }

  isPinned(point: number): boolean {
    return this.pinned.includes(point);
  }

  /** Points within a distance of a place, of a surface those on the side that a normal points to. */
  pointsNear(place: Vector3, normal: Vector3 | null, distance: number): number[] {
    const near: [number, number][] = [];
    const { positions, normals } = this;
    const side = this.network ? null : normal;
    for (let point = 0; point < positions.length / 3; point++) {
      const at = 3 * point;
      const dx = positions[at]! - place.x;
      const dy = positions[at + 1]! - place.y;
      const dz = positions[at + 2]! - place.z;
      const distanceSq = dx * dx + dy * dy + dz * dz;
      const facing = side ? normals[at]! * side.x + normals[at + 1]! * side.y + normals[at + 2]! * side.z : 1;
      if (distanceSq < distance * distance && facing > 0) near.push([distanceSq, point]);
    }
    near.sort((a, b) => a[0] - b[0]);
    return near.slice(0, 400).map(([, point]) => point);
  }

  /** The mean normal at some points, on the side of another, which stands for it where they have none. */
  normalAbout(points: number[], other: Vector3): Vector3 {
    const normal = new Vector3();
    const one = new Vector3();
    for (const point of points) normal.add(one.fromArray(this.normals, 3 * point));
    if (normal.length() === 0 || this.network) return other.clone();
    // a sheet is met from behind as well
    return normal.normalize().multiplyScalar(normal.dot(other) < 0 ? -1 : 1);
  }

  /** Makes the mesh ready to be met by a ray. */
  prepareForRay(): void {
    this.mesh.geometry.computeBoundingSphere();
    this.network?.prepareForRay();
  }

  dispose(): void {
    this.mesh.geometry.dispose();
    this.mesh.material.dispose();
    this.coat.dispose();
    this.edges.geometry.dispose();
    this.edges.material.dispose();
    this.dropPins();
    this.network?.dispose();
    this.inside?.dispose();
    this.facets?.dispose();
    this.axes.dispose();
  }

  /** What stands for the body: its cells, its surface, or the skin that it wears. */
  private setVisible(): void {
    const isApart = this.explode > 0 && this.inside !== null;
    const isHidden = this.info.is_worn && !this.isBare;
    const isSurface = !isApart && !isHidden;
    this.mesh.visible = isSurface && !this.ofCells;
    if (this.facets) {
      this.facets.mesh.visible = isSurface && this.ofCells;
      this.facets.mesh.castShadow = this.mesh.castShadow;
    }
    this.edges.visible = isSurface && (this.style === "edges" || (this.style === "wireframe" && !this.ofCells));
    if (this.inside) this.inside.group.visible = !isHidden;
    if (this.network) this.network.group.visible = !isHidden;
  }

  private setOfCells(ofCells: boolean): void {
    if (ofCells === this.ofCells && !(ofCells && !this.facets)) return;
    this.ofCells = ofCells;
    if (ofCells && !this.facets) {
      this.facets = new Facets(this.creased.triangles, this.drawn, this.mesh.material);
      this.group.add(this.facets.mesh);
    }
    this.setVisible();
  }

  /** A number of each point, for its coat; zeros for none. */
  private setNumbers(name: "film" | "look", values: Float32Array | undefined): void {
    const had = this.numbered.has(name);
    if (!values && !had) return;
    const attribute = this.mesh.geometry.getAttribute(name);
    const numbers = attribute.array as Float32Array;
    if (values) this.creased.sources.forEach((point, own) => (numbers[own] = values[point] ?? 0));
    else numbers.fill(0);
    attribute.needsUpdate = true;
    if (values) this.numbered.add(name);
    else this.numbered.delete(name);
  }

  /** Draws what is on the surface at a time; a world begun anew is closed again. */
  private open(time: number): void {
    this.time = time;
    const opened = this.dates.filter((date) => date <= time).length;
    if (opened === this.opened) return;
    this.opened = opened;
    const { spans, triangles, points } = this.surface;
    this.drawn = shownAt(spans, triangles.length / 3, time);
    this.creased = divideAtCreases(points, chosen(triangles, 3, this.drawn));
    const { geometry } = this.mesh;
    // buffers of another length are others
    geometry.dispose();
    for (const name of ["position", "normal", "color"]) geometry.setAttribute(name, moving(new Float32Array(3 * this.creased.sources.length)));
    layRest(geometry, this.creased, points);
    this.numbered.clear();
    geometry.setIndex(new BufferAttribute(this.creased.triangles, 1));
    this.edges.geometry.setIndex(new BufferAttribute(this.edgesAt(time), 1));
    if (this.facets) {
      this.group.remove(this.facets.mesh);
      this.facets.dispose();
      this.facets = null;
    }
    this.moved();
  }

  private edgesAt(time: number): Uint32Array {
    const { edges, edgeSpans } = this.surface;
    return chosen(edges, 2, shownAt(edgeSpans, edges.length / 2, time));
  }

  private moved(): void {
    const { sources, triangles } = this.creased;
    const normals = numbersOf(this.mesh, "normal");
    spread(this.positions, sources, numbersOf(this.mesh, "position"));
    smoothNormals(numbersOf(this.mesh, "position"), triangles, normals);
    this.normals.fill(0);
    sources.forEach((point, own) => {
      for (let k = 0; k < 3; k++) this.normals[3 * point + k]! += normals[3 * own + k]!;
    });
    const { geometry } = this.mesh;
    const moved = [geometry, this.edges.geometry].map((moving) => moving.getAttribute("position"));
    for (const attribute of [...moved, geometry.getAttribute("normal")]) attribute.needsUpdate = true;
    this.placePins();
  }

  private dropPins(): void {
    if (!this.pins) return;
    this.group.remove(this.pins);
    this.pins.geometry.dispose();
    this.pins.material.dispose();
    this.pins.dispose();
    this.pins = null;
  }

  private placePins(): void {
    if (!this.pins) return;
    const place = new Matrix4();
    this.pinned.forEach((point, index) => {
      const at = 3 * point;
      place.makeTranslation(this.positions[at]!, this.positions[at + 1]!, this.positions[at + 2]!);
      this.pins?.setMatrixAt(index, place);
    });
    this.pins.instanceMatrix.needsUpdate = true;
  }
}

function numbersOf({ geometry }: { geometry: BufferGeometry }, name: string): Float32Array {
  return geometry.getAttribute(name).array as Float32Array;
}

function moving(numbers: Float32Array): BufferAttribute {
  return new BufferAttribute(numbers, 3).setUsage(DynamicDrawUsage);
}

/** What a coat needs of the points drawn: where they are at rest, with normals there, and the numbers it is told, none yet. */
function layRest(geometry: BufferGeometry, { sources, triangles }: Creased, points: Float32Array): void {
  for (const name of ["film", "look"]) {
    const numbers = new BufferAttribute(new Float32Array(sources.length), 1);
    geometry.setAttribute(name, numbers.setUsage(DynamicDrawUsage));
  }
  const rest = new Float32Array(3 * sources.length);
  spread(points, sources, rest);
  const normals = new Float32Array(rest.length);
  smoothNormals(rest, triangles, normals);
  geometry.setAttribute("rest", new BufferAttribute(rest, 3));
  geometry.setAttribute("restNormal", new BufferAttribute(normals, 3));
}

/** The numbers of the things, of so many, that are there at a time; all where they have no spans. */
function shownAt(spans: Float64Array, count: number, time: number): Uint32Array {
  const all = Array.from({ length: count }, (_, number) => number);
  const isThere = (number: number) => spans[2 * number]! <= time && time < spans[2 * number + 1]!;
  return Uint32Array.from(spans.length > 0 ? all.filter(isThere) : all);
}

/** The numbers of some things that have so many each. */
function chosen(numbers: Uint32Array, each: number, which: Uint32Array): Uint32Array {
  const some = new Uint32Array(each * which.length);
  which.forEach((thing, place) => some.set(numbers.subarray(each * thing, each * (thing + 1)), each * place));
  return some;
}

/** Three numbers of each source. */
function spread(numbers: Float32Array, sources: Uint32Array, to: Float32Array): void {
  for (let own = 0; own < sources.length; own++) {
    const from = 3 * sources[own]!;
    to[3 * own] = numbers[from]!;
    to[3 * own + 1] = numbers[from + 1]!;
    to[3 * own + 2] = numbers[from + 2]!;
  }
}
