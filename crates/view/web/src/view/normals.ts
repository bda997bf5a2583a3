// Normals of a moving surface, made anew for each picture: smooth, but for creases that it has at rest.

/** Faces that meet at a larger angle than 40° have an edge between them. */
const CREASE_COSINE = Math.cos((40 / 180) * Math.PI);

/** A surface whose points stand once for each side of a crease. */
export interface Creased {
  /** The point that each of its own is. */
  sources: Uint32Array;
  triangles: Uint32Array;
}

/** Divides the points of a surface that lie on creases. */
export function divideAtCreases(points: Float32Array, triangles: Uint32Array): Creased {
  const corners = triangles.length;
  const faces = faceNormals(points, triangles);
  // corners that share a normal, as trees
  const parents = Uint32Array.from({ length: corners }, (_, corner) => corner);
  const rootOf = (corner: number): number => {
    while (parents[corner] !== corner) corner = parents[corner] = parents[parents[corner]!]!;
    return corner;
  };
  const join = (a: number, b: number): void => {
    const [low, high] = [rootOf(a), rootOf(b)].sort((x, y) => x - y);
    parents[high!] = low!;
  };
  /** The corner at the start of each side, by its ends; sides that are met leave it. */
  const open = new Map<number, number>();
  // two whole numbers in one: points are fewer than 2²⁶
  const side = (from: number, to: number) => from * 2 ** 26 + to;
  for (let corner = 0; corner < corners; corner++) {
    const next = nextCorner(corner);
    const other = open.get(side(triangles[next]!, triangles[corner]!));
    if (other === undefined) {
      open.set(side(triangles[corner]!, triangles[next]!), corner);
      continue;
    }
    open.delete(side(triangles[next]!, triangles[corner]!));
    const [f, g] = [3 * Math.floor(corner / 3), 3 * Math.floor(other / 3)];
    const cosine = faces[f]! * faces[g]! + faces[f + 1]! * faces[g + 1]! + faces[f + 2]! * faces[g + 2]!;
    if (cosine < CREASE_COSINE) continue;
    join(corner, nextCorner(other));
    join(next, other);
  }
  const numbers = new Map<number, number>();
  const sources: number[] = [];
  const divided = triangles.map((point, corner) => {
    const root = rootOf(corner);
    let number = numbers.get(root);
    if (number === undefined) {
      number = sources.length;
      numbers.set(root, number);
      sources.push(point);
    }
    return number;
  });
  return { sources: Uint32Array.from(sources), triangles: divided };
}

function nextCorner(corner: number): number {
  return corner % 3 === 2 ? corner - 2 : corner + 1;
}

/** Unit normals of triangles. */
function faceNormals(points: Float32Array, triangles: Uint32Array): Float32Array {
  const alone = Uint32Array.from({ length: triangles.length }, (_, corner) => corner);
  const spread = new Float32Array(3 * triangles.length);
  triangles.forEach((point, corner) => spread.set(points.subarray(3 * point, 3 * point + 3), 3 * corner));
  const normals = new Float32Array(spread.length);
  smoothNormals(spread, alone, normals);
  // the three corners of a triangle have the same
  return Float32Array.from({ length: triangles.length }, (_, at) => normals[9 * Math.floor(at / 3) + (at % 3)]!);
}

/** Normals at points: areas of the triangles about them, summed and made one long. */
export function smoothNormals(positions: Float32Array, triangles: Uint32Array, normals: Float32Array): void {
  normals.fill(0);
  for (let t = 0; t < triangles.length; t += 3) {
    const a = 3 * triangles[t]!;
    const b = 3 * triangles[t + 1]!;
    const c = 3 * triangles[t + 2]!;
    const ax = positions[a]!;
    const ay = positions[a + 1]!;
    const az = positions[a + 2]!;
    const ux = positions[b]! - ax;
    const uy = positions[b + 1]! - ay;
    const uz = positions[b + 2]! - az;
    const vx = positions[c]! - ax;
    const vy = positions[c + 1]! - ay;
    const vz = positions[c + 2]! - az;
    const nx = uy * vz - uz * vy;
    const ny = uz * vx - ux * vz;
    const nz = ux * vy - uy * vx;
    for (const corner of [a, b, c]) {
      normals[corner]! += nx;
      normals[corner + 1]! += ny;
      normals[corner + 2]! += nz;
    }
  }
  for (let i = 0; i < normals.length; i += 3) {
    const length = Math.hypot(normals[i]!, normals[i + 1]!, normals[i + 2]!) || 1;
    normals[i]! /= length;
    normals[i + 1]! /= length;
    normals[i + 2]! /= length;
  }
}
