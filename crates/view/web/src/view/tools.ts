// Tools in hands: each with the shape that the world told of.

import { BufferAttribute, BufferGeometry, Group, Mesh, MeshStandardMaterial } from "three";
import type { HandShown, ToolShape } from "../protocol";

const COLOUR = 0x8fa3b8;

/** Frames that may have left before the shape did: those that no page has answered, and the one that waits. */
const ON_THE_WAY = 3;

interface Shape {
  mesh: Mesh<BufferGeometry, MeshStandardMaterial>;
  /** Frames in which no hand held it. */
  missed: number;
}

export class Tools {
  readonly group = new Group();
  private readonly shapes = new Map<string, Shape>();

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
    (isRound ? flat : geometry).dispose();
    const mesh = new Mesh(
      isRound ? geometry : flat,
      new MeshStandardMaterial({ color: COLOUR, roughness: 0.25, metalness: 0.6, transparent: true, opacity: 0.85 }),
    );
    mesh.castShadow = true;
    mesh.frustumCulled = false;
    // until a frame tells where it is
    mesh.visible = false;
    this.shapes.set(key(page, hand), { mesh, missed: 0 });
    this.group.add(mesh);
  }

  update(hands: HandShown[]): void {
    const present = new Set<string>();
    for (const { page, hand, holds, held } of hands) {
      const shape = this.shapes.get(key(page, hand));
      if (!shape || holds !== "tool") continue;
      present.add(key(page, hand));
      shape.mesh.position.fromArray(held);
      shape.mesh.visible = true;
    }
    for (const [name, shape] of this.shapes) {
      if (present.has(name)) continue;
      shape.missed += 1;
      // one that was seen and is no longer held is gone; so is a new one that was let go of before its first frame
      if (shape.mesh.visible || shape.missed > ON_THE_WAY) this.remove(name);
    }
  }

  clear(): void {
    [...this.shapes.keys()].forEach((name) => this.remove(name));
  }

  private remove(name: string): void {
    const mesh = this.shapes.get(name)?.mesh;
    if (!mesh) return;
    this.group.remove(mesh);
    mesh.geometry.dispose();
    mesh.material.dispose();
    this.shapes.delete(name);
  }
}

function key(page: number, hand: number): string {
  return `${page}/${hand}`;
}
