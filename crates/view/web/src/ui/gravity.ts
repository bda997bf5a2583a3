// Where gravity pulls: three sliders, of which a person may turn the world over.

import { number } from "../format";
import type { Adjustable } from "../protocol";
import { element } from "./dom";

/** Gravity on Earth [m/s²]: sliders reach as far, or as far as the scene's own. */
const EARTH = 9.81;
const AXES = ["x", "y", "z"];

export class Gravity {
  readonly root: HTMLElement;
  private readonly sliders: HTMLInputElement[];
  private readonly said = element("small");
  /** [m/s²] */
  private vector = AXES.map(() => 0);

  constructor(private readonly send: (value: string) => void) {
    this.sliders = AXES.map((axis) =>
      element("input", { type: "range", id: `gravity-${axis}`, step: "any", "aria-label": `Gravity along ${axis}`, title: axis }),
    );
    this.sliders.forEach((slider, axis) => slider.addEventListener("input", () => this.read(axis)));
    this.root = element(
      "fieldset",
      { class: "gravity", hidden: true },
      element("legend", {}, "Gravity", this.said),
      ...this.sliders.map((slider, axis) => element("label", { class: "row" }, element("span", {}, `along ${AXES[axis]}`), slider)),
    );
  }

  set(gravity: Adjustable | undefined): void {
    const vector = (gravity?.value ?? "").replaceAll(/[[\]\s]/g, "").split(",").map(Number);
    this.root.hidden = gravity === undefined || vector.length !== AXES.length || !vector.every(Number.isFinite);
    // a slider that is being moved is ahead of what the world says
    if (this.root.hidden || this.sliders.some((slider) => slider === document.activeElement)) return;
    this.vector = vector;
    const reach = Math.max(EARTH, Math.hypot(...vector));
    this.sliders.forEach((slider, axis) => {
      [slider.min, slider.max] = [String(-reach), String(reach)];
      slider.value = String(vector[axis]);
    });
    this.say();
  }

  private read(axis: number): void {
    // the others stay as exact as the scene has them
    this.vector[axis] = Number(Number(this.sliders[axis]!.value).toFixed(2));
    this.say();
    this.send(`[${this.vector.join(", ")}]`);
  }

  private say(): void {
    this.said.textContent = ` ${this.vector.map(number).join(", ")} m/s²`;
  }
}
