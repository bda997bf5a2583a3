// The frames that carry a body, as three axes each, seen through it.

import { Group } from "three";
import type { Object3D } from "three";
import { Instances } from "./instances";
import { AXIS_COLOURS, linearOf } from "./palette";

/** Length and radius of an axis, in the size of all bodies. */
const LENGTH = 0.045;
const RADIUS = 0.0022;

export class Axes {
  private sticks: Instances | null = null;
  private readonly colours = AXIS_COLOURS.map(linearOf);
  private readonly tip = new Float32Array(3);
  private readonly group = new Group();

  constructor(
    parent: Object3D,
    private readonly size: number,
  ) {
    parent.add(this.group);
  }

  update(frames: Float32Array): void {
    const count = frames.length / 12;
    if (!this.sticks) {
      if (count === 0) return;
      this.sticks = new Instances("stick", 3 * count);
      this.sticks.shineThrough();
      this.group.add(this.sticks.mesh);
    }
    const { sticks, tip } = this;
    sticks.begin();
    for (let frame = 0; frame < count && !sticks.isFull; frame++) {
      const origin = 12 * frame;
      for (let axis = 0; axis < 3; axis++) {
        for (let k = 0; k < 3; k++) tip[k] = frames[origin + k]! + frames[origin + 3 * (axis + 1) + k]! * LENGTH * this.size;
        sticks.span(frames, origin, tip, 0, RADIUS * this.size);
        sticks.put(this.colours[axis]!, 0, frame);
      }
    }
    sticks.end();
  }

  setShown(shown: boolean): void {
    this.group.visible = shown;
  }

  dispose(): void {
    this.sticks?.dispose();
  }
}
