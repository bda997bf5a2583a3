// Where x, y and z are, and how large things are, in a corner of the picture.

import { Vector3 } from "three";
import { quantity } from "../format";
import type { Eye } from "./eye";
import { AXIS_COLOURS } from "./palette";

const SVG = "http://www.w3.org/2000/svg";
/** Half the side of the corner of the axes, and length of an axis [px]. */
const HALF = 32;
const LENGTH = 21;
/** The scale is at most as long [px]. */
const SCALE_MAX = 120;

export class Furniture {
  private readonly axes: { line: SVGLineElement; name: SVGTextElement }[];
  private readonly bar = document.createElement("i");
  private readonly length = document.createElement("span");
  /** What is drawn: a page whose eye rests changes nothing. */
  private drawn = "";

  constructor(place: HTMLElement) {
    const corner = document.createElementNS(SVG, "svg");
    corner.setAttribute("viewBox", `${-HALF} ${-HALF} ${2 * HALF} ${2 * HALF}`);
    this.axes = ["x", "y", "z"].map((text, axis) => {
      const colour = `#${AXIS_COLOURS[axis]!.toString(16).padStart(6, "0")}`;
      const line = document.createElementNS(SVG, "line");
      line.setAttribute("stroke", colour);
      const name = document.createElementNS(SVG, "text");
      name.setAttribute("fill", colour);
      name.textContent = text;
      corner.append(line, name);
      return { line, name };
    });
    const scale = document.createElement("div");
    scale.className = "scale";
    scale.append(this.bar, this.length);
    const all = document.createElement("div");
    all.className = "furniture";
    all.setAttribute("aria-hidden", "true");
    all.append(corner, scale);
    place.append(all);
  }

  /** As an eye sees it in a picture of a height [px]. */
  update(eye: Eye, height: number): void {
    const { camera } = eye;
    const right = new Vector3().setFromMatrixColumn(camera.matrixWorld, 0);
    const up = new Vector3().setFromMatrixColumn(camera.matrixWorld, 1);
    const metresPerPixel = eye.metresPerPixel(height);
    const drawn = [right, up].flatMap((axis) => axis.toArray().map((number) => number.toFixed(3))).join() + metresPerPixel.toPrecision(4);
    if (drawn === this.drawn) return;
    this.drawn = drawn;
    this.axes.forEach(({ line, name }, axis) => {
      const [x, y] = [right.getComponent(axis), -up.getComponent(axis)];
      line.setAttribute("x2", (LENGTH * x).toFixed(1));
      line.setAttribute("y2", (LENGTH * y).toFixed(1));
      name.setAttribute("x", ((LENGTH + 7) * x).toFixed(1));
      name.setAttribute("y", ((LENGTH + 7) * y).toFixed(1));
      // an axis towards the eye or away from it has no room for its name
      name.setAttribute("opacity", Math.hypot(x, y) < 0.25 ? "0" : "1");
    });
    const metres = roundLength(SCALE_MAX * metresPerPixel);
    this.bar.style.width = `${(metres / metresPerPixel).toFixed(1)}px`;
    this.length.textContent = quantity(metres, "m");
  }
}

/** The longest of 1, 2, 5, 10, … that is no longer. */
export function roundLength(most: number): number {
  const power = 10 ** Math.floor(Math.log10(most));
  const step = [5, 2, 1].find((step) => step * power <= most) ?? 1;
  return Number((step * power).toPrecision(1));
}
