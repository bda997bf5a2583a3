// Contours of networks on the screen: straight pieces, as many others in every picture.

import { BufferAttribute, BufferGeometry, DynamicDrawUsage, LineBasicMaterial, LineSegments } from "three";
import { BODY_COLOURS } from "./palette";

export class Contours {
  readonly lines = new LineSegments(new BufferGeometry(), new LineBasicMaterial({ color: BODY_COLOURS[1]! }));

  constructor() {
    this.lines.frustumCulled = false;
  }

  /** Ends of pieces, one after the other. */
  update(ends: Float32Array): void {
    const { geometry } = this.lines;
    const attribute = geometry.getAttribute("position") as BufferAttribute | undefined;
    if (attribute && attribute.array.length >= ends.length) {
      (attribute.array as Float32Array).set(ends);
      attribute.needsUpdate = true;
    } else {
      // what the graphics card has of the old ones would stay there
      geometry.dispose();
      geometry.setAttribute("position", new BufferAttribute(new Float32Array(ends), 3).setUsage(DynamicDrawUsage));
    }
    geometry.setDrawRange(0, ends.length / 3);
  }
}
