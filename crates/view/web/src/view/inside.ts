// The inside of a body: the section where it is cut, and its cells taken apart.

import { BufferAttribute, BufferGeometry, DoubleSide, DynamicDrawUsage, Group, Mesh, MeshStandardMaterial } from "three";
import type { Plane } from "three";
import type { InsideShape } from "../protocol";
import { BODY_COLOURS, paint } from "./palette";
import type { Range } from "./palette";

/** Values of points or cells and how they are coloured; none where a body has its own colour. */
export interface Paint {
  values: Float32Array | undefined;
  ofCells: boolean;
  range: Range;
  map: Float32Array;
}

export class Inside {
  readonly group = new Group();
  private readonly section: Sheet;
  private readonly cells: Sheet;
  private heights = new Float32Array(0);
  private time = 0;

  constructor(
    private readonly shape: InsideShape,
    index: number,
  ) {
    this.section = new Sheet(index);
    this.cells = new Sheet(index);
    this.cells.mesh.castShadow = true;
    this.group.add(this.section.mesh, this.cells.mesh);
  }

  /** `positions` are those of all points, at a time: cells that have gone by then are not there. */
  update(positions: Float32Array, paint: Paint, cut: Plane | null, explode: number, time: number): void {
    this.time = time;
    const isWhole = explode === 0;
    this.section.mesh.visible = cut !== null && isWhole;
    this.cells.mesh.visible = !isWhole;
    if (cut && isWhole) this.cutThrough(positions, paint, cut);
    if (!isWhole) this.takeApart(positions, paint, explode);
  }

  setCut(planes: Plane[]): void {
    this.cells.mesh.material.clippingPlanes = planes;
  }

  dispose(): void {
    this.section.dispose();
    this.cells.dispose();
  }

  private isGone(cell: number): boolean {
    return this.shape.dates.length > 0 && this.shape.dates[cell]! <= this.time;
  }

  /** The section of each tetrahedron that the plane meets. */
  private cutThrough(positions: Float32Array, paint: Paint, plane: Plane): void {
    const values = valueBy(paint);
    const count = positions.length / 3;
    if (this.heights.length !== count) this.heights = new Float32Array(count);
    const { heights } = this;
    const { normal, constant } = plane;
    for (let i = 0; i < count; i++) {
      heights[i] = normal.x * positions[3 * i]! + normal.y * positions[3 * i + 1]! + normal.z * positions[3 * i + 2]! + constant;
    }
    const { tetrahedra } = this.shape;
    const sheet = this.section;
    sheet.begin();
    const left: number[] = [];
    const gone: number[] = [];
    for (let t = 0; t < tetrahedra.length; t += 5) {
      if (this.isGone(tetrahedra[t + 4]!)) continue;
      left.length = 0;
      gone.length = 0;
      for (let k = 0; k < 4; k++) {
        const point = tetrahedra[t + k]!;
        (heights[point]! >= 0 ? left : gone).push(point);
      }
      if (left.length === 0 || gone.length === 0) continue;
      // around: neighbours share a point of the tetrahedron
      const around =
        left.length === 2
          ? [left[0]!, gone[0]!, left[1]!, gone[0]!, left[1]!, gone[1]!, left[0]!, gone[1]!]
          : left.length === 1
            ? gone.flatMap((point) => [left[0]!, point])
            : left.flatMap((point) => [point, gone[0]!]);
      for (let k = 2; k < around.length / 2; k++) {
        for (const corner of [0, k - 1, k]) {
          const a = around[2 * corner]!;
          const b = around[2 * corner + 1]!;
          const share = heights[a]! / (heights[a]! - heights[b]!);
          sheet.between(positions, a, b, share, values(a, tetrahedra[t + 4]!), values(b, tetrahedra[t + 4]!));
        }
      }
    }
    // outward is towards what was cut away
    sheet.end(paint, [-normal.x, -normal.y, -normal.z]);
  }

  /** All cells, each away from the middle by a part of its distance. */
  private takeApart(positions: Float32Array, paint: Paint, explode: number): void {
    const values = valueBy(paint);
    const { triangles } = this.shape;
    const middle = [0, 0, 0];
    for (let i = 0; i < positions.length; i++) middle[i % 3]! += (3 * positions[i]!) / positions.length;
    const sheet = this.cells;
    sheet.begin();
    for (let first = 0; first < triangles.length; ) {
      const cell = triangles[first + 3]!;
      let end = first;
      const own = [0, 0, 0];
      for (; end < triangles.length && triangles[end + 3] === cell; end += 4) {
        for (let k = 0; k < 9; k++) own[k % 3]! += positions[3 * triangles[end + Math.floor(k / 3)]! + (k % 3)]!;
      }
      if (this.isGone(cell)) {
        first = end;
        continue;
      }
      const corners = (3 * (end - first)) / 4;
      const offset = own.map((sum, k) => (sum / corners - middle[k]!) * explode);
      for (let t = first; t < end; t += 4) {
        for (let k = 0; k < 3; k++) sheet.moved(positions, triangles[t + k]!, offset, values(triangles[t + k]!, cell));
      }
      first = end;
    }
    sheet.end(paint, null);
  }
}

/** The value at a point of a cell. */
function valueBy({ values, ofCells }: Paint): (point: number, cell: number) => number {
  if (!values) return () => 0;
  return ofCells ? (_, cell) => values[cell]! : (point) => values[point]!;
}

/** Triangles that are made anew for each picture, three corners each. */
class Sheet {
  readonly mesh: Mesh<BufferGeometry, MeshStandardMaterial>;
  private places = new Float32Array(9 * 256);
  private numbers = new Float32Array(3 * 256);
  private count = 0;
  private readonly colour: number;

  constructor(index: number) {
    this.colour = BODY_COLOURS[index % BODY_COLOURS.length]!;
    const material = new MeshStandardMaterial({ roughness: 0.75, side: DoubleSide, color: this.colour });
    this.mesh = new Mesh(new BufferGeometry(), material);
    this.mesh.frustumCulled = false;
    this.mesh.receiveShadow = true;
    this.mesh.visible = false;
  }

  begin(): void {
    this.count = 0;
  }

  /** A corner between two points. */
  between(positions: Float32Array, a: number, b: number, share: number, valueA: number, valueB: number): void {
    const at = this.room();
    for (let k = 0; k < 3; k++) {
      const from = positions[3 * a + k]!;
      this.places[at + k] = from + share * (positions[3 * b + k]! - from);
    }
    this.numbers[this.count] = valueA + share * (valueB - valueA);
    this.count += 1;
  }

  /** A corner at a point, moved. */
  moved(positions: Float32Array, point: number, offset: number[], value: number): void {
    const at = this.room();
    for (let k = 0; k < 3; k++) this.places[at + k] = positions[3 * point + k]! + offset[k]!;
    this.numbers[this.count] = value;
    this.count += 1;
  }

  /** All look the way of `normal`, or each its own. */
  end({ values, range, map }: Paint, normal: [number, number, number] | null): void {
    const { geometry, material } = this.mesh;
    const room = this.places.length;
    if (geometry.getAttribute("position")?.array !== this.places) {
      geometry.dispose();
      const moving = (numbers: Float32Array) => new BufferAttribute(numbers, 3).setUsage(DynamicDrawUsage);
      geometry.setAttribute("position", moving(this.places));
      geometry.setAttribute("normal", moving(new Float32Array(room)));
      geometry.setAttribute("color", moving(new Float32Array(room)));
    }
    const normals = geometry.getAttribute("normal").array as Float32Array;
    for (let at = 0; at < 9 * Math.floor(this.count / 3); at += 9) this.look(normals, at, normal);
    if (material.vertexColors !== Boolean(values)) {
      material.vertexColors = Boolean(values);
      material.color.set(values ? 0xffffff : this.colour);
      material.needsUpdate = true;
    }
    if (values) paint(this.numbers.subarray(0, this.count), range, map, geometry.getAttribute("color").array as Float32Array);
    for (const name of ["position", "normal", "color"]) geometry.getAttribute(name).needsUpdate = true;
    geometry.setDrawRange(0, this.count);
  }

  dispose(): void {
    this.mesh.geometry.dispose();
    this.mesh.material.dispose();
  }

  /** Normals of the triangle at `at`; where all look one way, its corners turn so that it does as well. */
  private look(normals: Float32Array, at: number, normal: [number, number, number] | null): void {
    const p = this.places;
    const [ux, uy, uz] = [p[at + 3]! - p[at]!, p[at + 4]! - p[at + 1]!, p[at + 5]! - p[at + 2]!];
    const [vx, vy, vz] = [p[at + 6]! - p[at]!, p[at + 7]! - p[at + 1]!, p[at + 8]! - p[at + 2]!];
    let [x, y, z] = [uy * vz - uz * vy, uz * vx - ux * vz, ux * vy - uy * vx];
    const length = Math.hypot(x, y, z) || 1;
    [x, y, z] = [x / length, y / length, z / length];
    if (normal && x * normal[0] + y * normal[1] + z * normal[2] < 0) {
      for (let k = 0; k < 3; k++) [p[at + 3 + k], p[at + 6 + k]] = [p[at + 6 + k]!, p[at + 3 + k]!];
      const n = this.numbers;
      [n[at / 3 + 1], n[at / 3 + 2]] = [n[at / 3 + 2]!, n[at / 3 + 1]!];
      [x, y, z] = [-x, -y, -z];
    }
    for (let k = 0; k < 3; k++) {
      normals[at + 3 * k] = x;
      normals[at + 3 * k + 1] = y;
      normals[at + 3 * k + 2] = z;
    }
  }

  /** Where the next corner goes; there is twice the room when it runs out. */
  private room(): number {
    const at = 3 * this.count;
    if (at + 3 > this.places.length) {
      const grown = new Float32Array(2 * this.places.length);
      grown.set(this.places);
      const numbers = new Float32Array(2 * this.numbers.length);
      numbers.set(this.numbers);
      [this.places, this.numbers] = [grown, numbers];
    }
    return at;
  }
}
