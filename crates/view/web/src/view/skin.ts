// A skin on the screen: a surface whose triangles are others in every picture.

import { BufferAttribute, BufferGeometry, DynamicDrawUsage, Mesh, MeshPhysicalMaterial } from "three";
import type { Plane } from "three";
import type { SkinFrame, SkinInfo } from "../protocol";
import { BODY_COLOURS } from "./palette";
import type { Style } from "./body";

export class Skin {
  readonly mesh: Mesh<BufferGeometry, MeshPhysicalMaterial>;

  constructor(
    readonly info: SkinInfo,
    index: number,
  ) {
    const material = new MeshPhysicalMaterial({
      color: BODY_COLOURS[index % BODY_COLOURS.length]!,
      roughness: 0.45,
      clearcoat: 0.4,
      clearcoatRoughness: 0.35,
    });
    this.mesh = new Mesh(new BufferGeometry(), material);
    this.mesh.castShadow = true;
    this.mesh.receiveShadow = true;
    this.mesh.frustumCulled = false;
  }

  update({ positions, normals, triangles }: SkinFrame): void {
    this.write("position", positions);
    this.write("normal", normals);
    const { geometry } = this.mesh;
    const index = geometry.getIndex();
    if (index && index.array.length >= triangles.length) {
      (index.array as Uint32Array).set(triangles);
      index.needsUpdate = true;
    } else {
      // what the graphics card has of the old ones would stay there
      geometry.dispose();
      geometry.setIndex(new BufferAttribute(roomFor(triangles, Uint32Array), 1).setUsage(DynamicDrawUsage));
    }
    geometry.setDrawRange(0, triangles.length);
  }

  setStyle(style: Style): void {
    this.mesh.material.wireframe = style === "wireframe";
  }

  setCut(planes: Plane[]): void {
    this.mesh.material.clippingPlanes = planes;
    this.mesh.material.side = planes.length > 0 ? 2 : 0;
    this.mesh.material.needsUpdate = true;
  }

  prepareForRay(): void {
    this.mesh.geometry.computeBoundingSphere();
  }

  dispose(): void {
    this.mesh.geometry.dispose();
    this.mesh.material.dispose();
  }

  private write(name: string, numbers: Float32Array): void {
    const { geometry } = this.mesh;
    const attribute = geometry.getAttribute(name) as BufferAttribute | undefined;
    if (attribute && attribute.array.length >= numbers.length) {
      (attribute.array as Float32Array).set(numbers);
      attribute.needsUpdate = true;
    } else {
      geometry.dispose();
      geometry.setAttribute(name, new BufferAttribute(roomFor(numbers, Float32Array), 3).setUsage(DynamicDrawUsage));
    }
  }
}

/** A copy with room to grow: half as much again, in threes. */
function roomFor<T extends Float32Array | Uint32Array>(numbers: T, Kind: new (length: number) => T): T {
  const made = new Kind(3 * Math.ceil(numbers.length / 2));
  made.set(numbers);
  return made;
}
