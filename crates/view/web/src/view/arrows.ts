// Vectors at points, as arrows in one scale.

import { Group } from "three";
import type { Plane } from "three";
import type { BodyFrame } from "../protocol";
import { Instances } from "./instances";
import { linearOf } from "./palette";

/** Most arrows of a body: more hide it. */
const MOST = 500;
/** Length of the longest, and radius, in the size of all bodies. */
const LONGEST = 0.16;
const RADIUS = 0.0018;
const COLOURS = { light: linearOf(0x20303f), dark: linearOf(0xf2d27a) };

export class Arrows {
  readonly group = new Group();
  private readonly sticks = new Instances("stick", MOST);
  private readonly tips = new Instances("tip", MOST);
  /** Metres for each unit. */
  private scale = 0;
  private kind = -1;
  /** Of the vectors shown last, in their unit. */
  longest = 0;
  private readonly neck = new Float32Array(3);
  private readonly end = new Float32Array(3);

  constructor(private readonly size: number) {
    this.group.add(this.sticks.mesh, this.tips.mesh);
    for (const { mesh } of [this.sticks, this.tips]) mesh.castShadow = false;
  }

  /** The arrows of all bodies, of a kind; of none for -1. What is shorter than `rest`, in its unit, is nothing. */
  update(bodies: BodyFrame[], kind: number, dark: boolean, rest: number): void {
    // lengths of one kind say nothing of another's
    if (kind !== this.kind) this.scale = 0;
    this.kind = kind;
    const all = bodies.map((body) => [body.positions, body.arrows.get(kind)] as const);
    const count = all.reduce((sum, [, vectors]) => sum + (vectors?.length ?? 0) / 3, 0);
    const every = Math.max(1, Math.ceil(count / MOST));
    const colour = dark ? COLOURS.dark : COLOURS.light;
    this.fit(
      all.map(([, vectors]) => vectors),
      rest,
    );
    this.sticks.begin();
    this.tips.begin();
    for (const [positions, vectors] of all) {
      if (!vectors) continue;
      for (let at = 0; at < vectors.length && !this.tips.isFull; at += 3 * every) this.put(positions, vectors, at, colour);
    }
    this.sticks.end();
    this.tips.end();
    this.group.visible = count > 0;
  }

  setCut(planes: Plane[]): void {
    this.sticks.setClipping(planes);
    this.tips.setClipping(planes);
  }

  dispose(): void {
    this.sticks.dispose();
    this.tips.dispose();
  }

  private put(positions: Float32Array, vectors: Float32Array, at: number, colour: Float32Array): void {
    const { neck, end, scale } = this;
    const length = scale * Math.hypot(vectors[at]!, vectors[at + 1]!, vectors[at + 2]!);
    // shorter ones are dots that tell nothing
    if (!(length > 0.004 * this.size)) return;
    const head = Math.min(0.45 * length, 0.022 * this.size) / length;
    for (let k = 0; k < 3; k++) {
      const along = scale * vectors[at + k]!;
      end[k] = positions[at + k]! + along;
      neck[k] = end[k]! - head * along;
    }
    this.sticks.span(positions, at, neck, 0, RADIUS * this.size);
    this.sticks.put(colour, 0, at / 3);
    this.tips.span(neck, 0, end, 0, 0.3 * head * length);
    this.tips.put(colour, 0, at / 3);
  }

  /** Shrinks at once for longer vectors, and grows slowly: arrows that jump cannot be compared. */
  private fit(all: (Float32Array | undefined)[], rest: number): void {
    let longest = 0;
    for (const vectors of all) {
      for (let at = 0; at < (vectors?.length ?? 0); at += 3) {
        longest = Math.max(longest, Math.hypot(vectors![at]!, vectors![at + 1]!, vectors![at + 2]!));
      }
    }
    this.longest = longest > rest ? longest : 0;
    if (this.longest === 0) {
      this.scale = 0;
      return;
    }
    const fitting = (LONGEST * this.size) / longest;
    this.scale = this.scale === 0 || fitting < this.scale ? fitting : this.scale + 0.03 * (fitting - this.scale);
  }
}
