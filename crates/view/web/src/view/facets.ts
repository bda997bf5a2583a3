// A surface whose triangles have a colour each, for what differs from cell to cell and has nothing between.

import { BufferAttribute, BufferGeometry, DynamicDrawUsage, Mesh } from "three";
import type { MeshPhysicalMaterial } from "three";

export class Facets {
  readonly mesh: Mesh<BufferGeometry, MeshPhysicalMaterial>;
  private readonly positions: Float32Array;
  private readonly normals: Float32Array;
  private readonly colours: Float32Array;

  /** `numbers` are those by which triangles have values; `material` is that of the surface: what is set there holds here. */
  constructor(
    private readonly triangles: Uint32Array,
    private readonly numbers: Uint32Array,
    material: MeshPhysicalMaterial,
  ) {
    const geometry = new BufferGeometry();
    const attribute = (name: string) => {
      const numbers = new Float32Array(3 * triangles.length);
      geometry.setAttribute(name, new BufferAttribute(numbers, 3).setUsage(DynamicDrawUsage));
      return numbers;
    };
    this.positions = attribute("position");
    this.normals = attribute("normal");
    this.colours = attribute("color");
    this.mesh = new Mesh(geometry, material);
    this.mesh.castShadow = true;
    this.mesh.receiveShadow = true;
    this.mesh.frustumCulled = false;
  }

  /** `values` are those of triangles by their numbers. */
  update(positions: Float32Array, normals: Float32Array, values: Float32Array, map: Float32Array): void {
    const { triangles, numbers } = this;
    for (let corner = 0; corner < triangles.length; corner++) {
      const from = 3 * triangles[corner]!;
      const colour = 3 * values[numbers[Math.floor(corner / 3)]!]!;
      for (let k = 0; k < 3; k++) {
        this.positions[3 * corner + k] = positions[from + k]!;
        this.normals[3 * corner + k] = normals[from + k]!;
        this.colours[3 * corner + k] = map[colour + k]!;
      }
    }
    for (const attribute of Object.values(this.mesh.geometry.attributes)) attribute.needsUpdate = true;
  }

  dispose(): void {
    this.mesh.geometry.dispose();
  }
}
