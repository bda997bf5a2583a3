// Tools in hands: each with the shape that the world told of.

import { BufferAttribute, BufferGeometry, Group, Mesh, MeshStandardMaterial } from "three";
import type { HandShown, ToolShape } from "../protocol";

const COLOUR = 0x8fa3b8;

export class Tools {
  readonly group = new Group();
  private readonly shapes = new Map<string, Mesh>();

  /** A tool whose shape has come. */
  add({ page, hand, points, triangles }: ToolShape): void {
    this.remove(key(page, hand));
    const geometry = new BufferGeometry();
    geometry.setAttribute("position", new BufferAttribute(points, 3));
    geometry.setIndex(new BufferAttribute(triangles, 1));
    // edges stay sharp: few tools are round without many triangles
    const flat = geometry.toNonIndexed();
    flat.computeVertexNormals();
    geometry.computeVertexNormals();
    const isRound = triangles.length > 100;
    const mesh = new Mesh(
      isRound ? geometry : flat,
      new MeshStandardMaterial({ color: COLOUR, roughness: 0.25, metalness: 0.6, transparent: true, opacity: 0.85 }),
    );
    mesh.castShadow = true;
    mesh.frustumCulled = false;
    // until a frame tells where it is
    mesh.visible = false;
    this.shapes.set(key(page, hand), mesh);
    this.group.add(mesh);
  }

  update(hands: HandShown[]): void {
    const present = new Set<string>();
    for (const { page, hand, holds, place } of hands) {
      const mesh = this.shapes.get(key(page, hand));
      if (!mesh || holds !== "tool") continue;
      present.add(key(page, hand));
      mesh.position.fromArray(place);
      mesh.visible = true;
    }
    for (const [name, mesh] of this.shapes) {
      // one that was seen and is no longer held is gone; a new one may still wait for its first frame
      if (mesh.visible && !present.has(name)) this.remove(name);
    }
  }

  clear(): void {
    [...this.shapes.keys()].forEach((name) => this.remove(name));
  }

  private remove(name: string): void {
    const mesh = this.shapes.get(name);
    if (!mesh) return;
    this.group.remove(mesh);
    mesh.geometry.dispose();
    (mesh.material as MeshStandardMaterial).dispose();
    this.shapes.delete(name);
  }
}

function key(page: number, hand: number): string {
  return `${page}/${hand}`;
}
