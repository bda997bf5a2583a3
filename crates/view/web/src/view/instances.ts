// Many round things drawn at once: sticks between two places, balls, tips of arrows.

import {
  Color,
  ConeGeometry,
  CylinderGeometry,
  DynamicDrawUsage,
  IcosahedronGeometry,
  InstancedMesh,
  MeshStandardMaterial,
} from "three";
import type { BufferGeometry, Material, Plane } from "three";

/** Things of one form; those of a picture are put one after the other. */
export class Instances {
  readonly mesh: InstancedMesh<BufferGeometry, MeshStandardMaterial>;
  /** What each that was put stands for, given back where a ray meets it. */
  readonly meanings: Uint32Array;
  private count = 0;
  private readonly colour = new Color();

  constructor(
    form: "stick" | "ball" | "tip",
    private readonly capacity: number,
  ) {
    const material = new MeshStandardMaterial({ roughness: 0.5 });
    this.mesh = new InstancedMesh(geometry(form, capacity), material, Math.max(capacity, 1));
    this.mesh.instanceMatrix.setUsage(DynamicDrawUsage);
    // makes room for colours
    this.mesh.setColorAt(0, this.colour);
    this.mesh.frustumCulled = false;
    this.mesh.castShadow = true;
    this.mesh.receiveShadow = true;
    this.meanings = new Uint32Array(capacity);
    this.mesh.count = 0;
  }

  begin(): void {
    this.count = 0;
  }

  /** A stick or a tip from one place to another. */
  span(from: ArrayLike<number>, a: number, to: ArrayLike<number>, b: number, radius: number): void {
    const x = to[b]! - from[a]!;
    const y = to[b + 1]! - from[a + 1]!;
    const z = to[b + 2]! - from[a + 2]!;
    const length = Math.hypot(x, y, z) || 1e-30;
    const [dx, dy, dz] = [x / length, y / length, z / length];
    // any direction across
    let [sx, sy, sz] = Math.abs(dy) < 0.9 ? [-dz, 0, dx] : [0, dz, -dy];
    const across = Math.hypot(sx, sy, sz);
    [sx, sy, sz] = [sx / across, sy / across, sz / across];
    const m = this.mesh.instanceMatrix.array;
    const at = 16 * this.count;
    m[at] = sx * radius;
    m[at + 1] = sy * radius;
    m[at + 2] = sz * radius;
    m[at + 3] = 0;
    m[at + 4] = x;
    m[at + 5] = y;
    m[at + 6] = z;
    m[at + 7] = 0;
    m[at + 8] = (sy * dz - sz * dy) * radius;
    m[at + 9] = (sz * dx - sx * dz) * radius;
    m[at + 10] = (sx * dy - sy * dx) * radius;
    m[at + 11] = 0;
    m[at + 12] = from[a]!;
    m[at + 13] = from[a + 1]!;
    m[at + 14] = from[a + 2]!;
    m[at + 15] = 1;
  }

  ball(places: ArrayLike<number>, a: number, radius: number): void {
    const m = this.mesh.instanceMatrix.array;
    const at = 16 * this.count;
    m.fill(0, at, at + 16);
    m[at] = radius;
    m[at + 5] = radius;
    m[at + 10] = radius;
    m[at + 12] = places[a]!;
    m[at + 13] = places[a + 1]!;
    m[at + 14] = places[a + 2]!;
    m[at + 15] = 1;
  }

  /** Ends the thing that was placed. */
  put(colour: ArrayLike<number>, at: number, meaning: number): void {
    const colours = this.mesh.instanceColor!.array;
    for (let k = 0; k < 3; k++) colours[3 * this.count + k] = colour[at + k]!;
    this.meanings[this.count] = meaning;
    this.count += 1;
  }

  get isFull(): boolean {
    return this.count >= this.capacity;
  }

  end(): void {
    this.mesh.count = this.count;
    this.mesh.instanceMatrix.needsUpdate = true;
    this.mesh.instanceColor!.needsUpdate = true;
  }

  prepareForRay(): void {
    this.mesh.computeBoundingSphere();
  }

  setClipping(planes: Plane[]): void {
    this.mesh.material.clippingPlanes = planes;
  }

  /** Is seen through whatever stands before it. */
  shineThrough(): void {
    Object.assign(this.mesh.material as Material, { depthTest: false, transparent: true });
    this.mesh.renderOrder = 9;
    this.mesh.castShadow = false;
  }

  dispose(): void {
    this.mesh.geometry.dispose();
    this.mesh.material.dispose();
    this.mesh.dispose();
  }
}

/** Of length and radius one, from the origin along y; fewer corners where there are many. */
function geometry(form: "stick" | "ball" | "tip", count: number): BufferGeometry {
  const isMany = count > 3000;
  switch (form) {
    case "ball":
      return new IcosahedronGeometry(1, isMany ? 1 : 3);
    case "stick":
      return new CylinderGeometry(1, 1, 1, isMany ? 5 : 10, 1, true).translate(0, 0.5, 0);
    case "tip":
      return new ConeGeometry(1, 1, 12).translate(0, 0.5, 0);
  }
}
