// Where the time of a step goes.

import { number } from "../format";
import type { BodyInfo, Frame, SceneInfo } from "../protocol";
import { element } from "./dom";

/** What a step is made of, and the colours of its parts. */
export const STAGES: readonly [string, string][] = [
  ["contacts", "#8d6bb8"],
  ["forces", "#3d6fd8"],
  ["matrix", "#3f8f8f"],
  ["solve", "#d0863f"],
  ["rest", "#8a93a0"],
];
/** Weight of a new picture in what is shown: digits that flicker are not read. */
const NEW = 0.06;

export class Stages {
  readonly root: HTMLElement;
  private readonly counts = element("span", { class: "counts" });
  private readonly total = element("span", { class: "total" });
  private readonly bar = element("span", { class: "stagebar" });
  private readonly parts: HTMLElement[];
  private readonly iterations = element("span", { title: "Iterations of a step, in the mean: of Newton's method, and of the linear solver" });
  private readonly rate = element("span", { title: "Frames of the world that are drawn each second" });
  private mean: number[] | null = null;
  private lastText = 0;
  private pictures = 0;
  private since = performance.now();

  constructor() {
    const swatch = ([name, colour]: readonly [string, string]) => element("i", { title: name, style: `background:${colour}` });
    this.parts = STAGES.map(swatch);
    this.bar.append(...this.parts);
    const names = STAGES.map((stage) => element("span", {}, swatch(stage), stage[0]));
    const key = element("span", { class: "stagenames" }, ...names);
    this.root = element("div", { class: "stages" }, this.counts, this.total, this.bar, key, this.iterations, this.rate);
  }

  begin(info: SceneInfo): void {
    this.mean = null;
    const sum = (count: (body: BodyInfo) => number) => info.bodies.reduce((all, body) => all + count(body), 0);
    const counts: [number, string][] = [
      [sum(({ points }) => points), "points"],
      [sum(({ cells, is_network }) => (is_network ? 0 : cells)), "cells"],
      [sum(({ links }) => links), "links"],
    ];
    const there = counts.filter(([count]) => count > 0).map(([count, name]) => `${count.toLocaleString()} ${name}`);
    this.counts.textContent = there.join(", ");
  }

  show(frame: Frame): void {
    this.pictures += 1;
    const now = [...frame.stages, ...frame.iterations];
    const { mean } = this;
    if (!mean) this.mean = now;
    else now.forEach((value, index) => (mean[index]! += NEW * (value - mean[index]!)));
    const clock = performance.now();
    if (clock - this.lastText < 250) return;
    this.lastText = clock;
    const [contacts = 0, forces = 0, matrix = 0, solve = 0, rest = 0, newton = 0, linear = 0] = this.mean ?? now;
    const stages = [contacts, forces, matrix, solve, rest];
    const total = stages.reduce((sum, stage) => sum + stage, 0);
    this.total.textContent = `${number(total)} ms a step`;
    stages.forEach((stage, index) => {
      const part = this.parts[index]!;
      // less than one in all would leave a part of the bar empty
      part.style.flexGrow = String(stage / (total || 1));
      part.title = `${STAGES[index]![0]}: ${number(stage)} ms`;
    });
    this.iterations.textContent = linear > 0 ? `Newton ${newton.toFixed(1)}, linear ${linear.toFixed(1)}` : "";
    if (clock - this.since > 1000) {
      this.rate.textContent = `${Math.round((1000 * this.pictures) / (clock - this.since))} fps`;
      this.since = clock;
      this.pictures = 0;
    }
  }
}
