// What is measured, over time: probes and energies.

import uPlot from "uplot";
import { label, number } from "../format";
import type { ProbeInfo, Samples } from "../protocol";
import { element, panel } from "./dom";

/** Rows kept; older ones leave. */
const ROWS = 4096;
const REDRAW_MS = 100;
const COLOURS = ["#d0604c", "#3f8f5a", "#3d6fd8"];

interface Plot {
  plot: uPlot;
  first: number;
  count: number;
}

export class Plots {
  readonly root: HTMLElement;
  private readonly place = element("div", { class: "plots" });
  private readonly empty = element("p", { class: "quiet" }, "The scene measures nothing.");
  private columns: number[][] = [];
  private plots: Plot[] = [];
  private isDrawn = true;

  constructor() {
    this.root = panel("Plots", true, this.empty, this.place);
    this.root.addEventListener("toggle", () => this.resize());
    new ResizeObserver(() => this.resize()).observe(this.root);
    setInterval(() => this.draw(), REDRAW_MS);
  }

  /** Another scene. */
  begin(probes: ProbeInfo[]): void {
    this.plots.forEach(({ plot }) => plot.destroy());
    this.place.replaceChildren();
    const width = 4 + probes.reduce((sum, probe) => sum + probe.components, 0);
    this.columns = Array.from({ length: width }, () => []);
    this.plots = [];
    let first = 4;
    for (const { name, unit, components } of probes) {
      const names = components === 3 ? ["x", "y", "z"] : [label(name)];
      this.add(label(name), unit, names, first);
      first += components;
    }
    this.add("energy", "J", ["kinetic", "stored", "dissipated"], 1);
    this.empty.hidden = this.plots.length > 0;
  }

  push({ columns, numbers }: Samples): void {
    if (columns !== this.columns.length) return;
    for (let row = 0; row < numbers.length; row += columns) {
      for (let c = 0; c < columns; c++) this.columns[c]!.push(numbers[row + c]!);
    }
    const surplus = (this.columns[0]?.length ?? 0) - ROWS;
    // cut in large pieces: each moves all that is behind it
    if (surplus > ROWS / 4) this.columns.forEach((column) => column.splice(0, surplus));
    this.isDrawn = false;
  }

  private add(title: string, unit: string, names: string[], first: number): void {
    const axis = { stroke: () => style("--quiet"), grid: { stroke: () => style("--line"), width: 1 }, ticks: { show: false } };
    const plot = new uPlot(
      {
        width: this.width(),
        height: 118,
        title: unit ? `${title} [${unit}]` : title,
        scales: { x: { time: false } },
        legend: { show: names.length > 1, live: false },
        cursor: { drag: { x: false, y: false }, points: { show: false } },
        axes: [
          { ...axis, size: 22, values: (_, values) => values.map((value) => `${number(value)} s`) },
          { ...axis, size: 58, values: (_, values) => values.map(number) },
        ],
        series: [{}, ...names.map((name, index) => ({ label: name, stroke: COLOURS[index]!, width: 1.5, points: { show: false } }))],
      },
      [[], ...names.map(() => [])],
      this.place,
    );
    plot.root.dataset.title = title;
    this.plots.push({ plot, first, count: names.length });
  }

  private draw(): void {
    if (this.isDrawn || !(this.root as HTMLDetailsElement).open || document.hidden) return;
    this.isDrawn = true;
    const [time] = this.columns;
    for (const { plot, first, count } of this.plots) {
      plot.setData([time!, ...this.columns.slice(first, first + count)] as uPlot.AlignedData);
    }
  }

  private width(): number {
    return Math.max(180, this.place.clientWidth || 288);
  }

  private resize(): void {
    const width = this.width();
    for (const { plot } of this.plots) if (plot.width !== width) plot.setSize({ width, height: 118 });
  }
}

function style(name: string): string {
  return getComputedStyle(document.documentElement).getPropertyValue(name);
}
