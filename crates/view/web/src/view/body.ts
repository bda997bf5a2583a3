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
  SphereGeometry,
  Vector3,
} from "three";
import type { Object3D, Plane } from "three";
import type { BodyFrame, BodyInfo, FieldInfo, InsideShape, NetworkShape, Surface } from "../protocol";
import { Axes } from "./axes";
import { Facets } from "./facets";
import { Inside } from "./inside";
import type { Paint } from "./inside";
import { Network } from "./network";
import { smoothNormals } from "./normals";
import { BODY_COLOURS, paint } from "./palette";
import type { Range } from "./palette";

/** How surfaces are drawn. */
export type Style = "smooth" | "edges" | "wireframe";

const PIN_COLOUR = 0x3d6fd8;
/** Beyond so many sizes of all bodies numbers of four bytes draw nothing that could be seen. */
const FAR = 1e6;

export class Body {
  readonly group = new Group();
  readonly mesh: Mesh<BufferGeometry, MeshPhysicalMaterial>;
  /** Of the points that are always shown. */
  readonly positions: Float32Array;
  readonly normals: Float32Array;
  private readonly network: Network | null;
  private readonly axes: Axes;
  private inside: Inside | null = null;
  /** Made when cells are first coloured. */
  private facets: Facets | null = null;
  private ofCells = false;
  private last: BodyFrame | null = null;
  private cut: Plane | null = null;
  private explode = 0;
  private style: Style = "smooth";
  private readonly colours: BufferAttribute;
  private readonly edges: LineSegments<BufferGeometry, LineBasicMaterial>;
  private readonly triangles: Uint32Array;
  private pins: InstancedMesh<SphereGeometry, MeshStandardMaterial> | null = null;
  private pinned: number[] = [];

  constructor(
    readonly index: number,
    readonly info: BodyInfo,
    surface: Surface,
    network: NetworkShape | undefined,
    private readonly size: number,
  ) {
    this.triangles = surface.triangles;
    this.positions = Float32Array.from(surface.points);
    this.normals = new Float32Array(this.positions.length);
    const geometry = new BufferGeometry();
    const moving = (numbers: Float32Array) => new BufferAttribute(numbers, 3).setUsage(DynamicDrawUsage);
    geometry.setAttribute("position", moving(this.positions));
    geometry.setAttribute("normal", moving(this.normals));
    this.colours = moving(new Float32Array(this.positions.length));
    geometry.setAttribute("color", this.colours);
    geometry.setIndex(new BufferAttribute(this.triangles, 1));
    const material = new MeshPhysicalMaterial({
      color: BODY_COLOURS[index % BODY_COLOURS.length]!,
      roughness: 0.5,
      clearcoat: 0.3,
      clearcoatRoughness: 0.4,
      polygonOffset: true,
      polygonOffsetFactor: 1,
      polygonOffsetUnits: 1,
    });
    this.mesh = new Mesh(geometry, material);
    this.mesh.castShadow = true;
    this.mesh.receiveShadow = true;
    // it moves out of any box that was drawn about it once
    this.mesh.frustumCulled = false;
    const lines = new BufferGeometry();
    lines.setAttribute("position", geometry.getAttribute("position"));
    lines.setIndex(new BufferAttribute(edgesOf(this.triangles), 1));
    this.edges = new LineSegments(lines, new LineBasicMaterial({ transparent: true, opacity: 0.35, color: 0x101418 }));
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
  update(frame: BodyFrame): void {
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

  setAxes(shown: boolean): void {
    this.axes.setShown(shown);
  }

  /** Colours by values; by its own colour for none. */
  colourBy(values: Float32Array | undefined, of: FieldInfo["of"], range: Range, map: Float32Array): void {
    const { material } = this.mesh;
    if (material.vertexColors !== Boolean(values)) {
      material.vertexColors = Boolean(values);
      material.color.set(values ? 0xffffff : BODY_COLOURS[this.index % BODY_COLOURS.length]!);
      // colours are read by the eye: less shine on them
      material.clearcoat = values ? 0.1 : 0.3;
      material.roughness = values ? 0.7 : 0.5;
      material.needsUpdate = true;
    }
    this.setOfCells(of === "cells" && values !== undefined);
    const count = this.triangles.length / 3;
    if (values && this.ofCells) {
      this.facets?.update(this.positions, this.normals, values, map);
    } else if (values) {
      paint(values, range, map, this.colours.array as Float32Array);
      this.colours.needsUpdate = true;
    }
    if (!this.last) return;
    this.network?.update(this.last, values, of, range, map);
    // a frame that left before the page looked inside has no points there
    const hasInside = this.last.positions.length > this.positions.length || this.info.points === this.info.surface_points;
    if (!hasInside) return;
    const inner: Paint = { values: this.ofCells ? values?.subarray(count) : values, ofCells: this.ofCells, range, map };
    this.inside?.update(this.last.positions, inner, this.cut, this.explode);
  }

  setStyle(style: Style, dark: boolean): void {
    this.style = style;
    this.mesh.material.colorWrite = style !== "wireframe";
    this.mesh.material.depthWrite = style !== "wireframe";
    this.mesh.castShadow = style !== "wireframe";
    this.setVisible();
    this.edges.material.color.set(style === "wireframe" && dark ? 0xdfe6f0 : 0x101418);
    this.edges.material.opacity = style === "wireframe" ? 0.6 : 0.3;
  }

  setCut(cut: Plane | null): void {
    this.cut = cut;
    const planes = cut ? [cut] : [];
    this.mesh.material.clippingPlanes = planes;
    // what has no section is looked into
    this.mesh.material.side = this.info.is_sheet || (cut && !this.info.has_inside) ? DoubleSide : FrontSide;
    this.mesh.material.needsUpdate = true;
    this.edges.material.clippingPlanes = planes;
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

  /** Makes the mesh ready to be met by a ray. */
  prepareForRay(): void {
    this.mesh.geometry.computeBoundingSphere();
    this.network?.prepareForRay();
  }

  dispose(): void {
    this.mesh.geometry.dispose();
    this.mesh.material.dispose();
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
    const isSurface = !isApart && !this.info.is_worn;
    this.mesh.visible = isSurface && !this.ofCells;
    if (this.facets) {
      this.facets.mesh.visible = isSurface && this.ofCells;
      this.facets.mesh.castShadow = this.mesh.castShadow;
    }
    this.edges.visible = isSurface && this.style !== "smooth";
    if (this.inside) this.inside.group.visible = !this.info.is_worn;
  }

  private setOfCells(ofCells: boolean): void {
    if (ofCells === this.ofCells) return;
    this.ofCells = ofCells;
    if (ofCells && !this.facets) {
      this.facets = new Facets(this.triangles, this.mesh.material);
      this.group.add(this.facets.mesh);
    }
    this.setVisible();
  }

  private moved(): void {
    smoothNormals(this.positions, this.triangles, this.normals);
    const { geometry } = this.mesh;
    geometry.getAttribute("position").needsUpdate = true;
    geometry.getAttribute("normal").needsUpdate = true;
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

/** Each edge of triangles once, also those at the border, which have one triangle. */
function edgesOf(triangles: Uint32Array): Uint32Array {
  const edges: number[] = [];
  const seen = new Set<number>();
  for (let t = 0; t < triangles.length; t += 3) {
    for (let k = 0; k < 3; k++) {
      const a = triangles[t + k]!;
      const b = triangles[t + ((k + 1) % 3)]!;
      // two whole numbers in one: points are fewer than 2²⁶
      const edge = Math.min(a, b) * 2 ** 26 + Math.max(a, b);
      if (!seen.has(edge)) edges.push(a, b);
      seen.add(edge);
    }
  }
  return Uint32Array.from(edges);
}
