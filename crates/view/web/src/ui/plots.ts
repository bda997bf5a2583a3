// What is measured, over time: probes, energies, and what a step costs.

import uPlot from "uplot";
import { inPrint, label, number } from "../format";
import type { Frame, HandShown, ProbeInfo, Samples } from "../protocol";
import { element, panel } from "./dom";
import { STAGES } from "./stages";

/** How much of the past may be seen [s]. */
const REACHES: [number, string][] = [
  [Infinity, "all"],
  [30, "30 s"],
  [10, "10 s"],
  [3, "3 s"],
  [1, "1 s"],
];
/** Rows kept; older ones leave. */
const ROWS = 4096;
const REDRAW_MS = 100;
const HEIGHT = 118;
const COLOURS = ["#d0604c", "#3f8f5a", "#3d6fd8"];
const ENERGIES = ["kinetic", "stored", "dissipated"];
const ITERATIONS = ["Newton", "linear"];

interface Plot {
  plot: uPlot;
  table: Table;
  /** Its first column. */
  first: number;
  count: number;
}

interface Line {
  name: string;
  colour: string;
}

export class Plots {
  readonly root: HTMLElement;
  private readonly place = element("div", { class: "plots" });
  /** From the world: time, energies, probes. */
  private samples = new Table(0);
  /** Of frames: time, stages, iterations. */
  private steps = new Table(0);
  /** Of frames, from when this page first held something: time, force. */
  private felt: Table | null = null;
  private plots: Plot[] = [];
  private isDrawn = true;
  /** How much of the past is seen [s]; all of it by default. */
  private readonly reach = element(
    "select",
    { id: "reach", "aria-label": "How much of the past" },
    ...REACHES.map(([seconds, text]) => element("option", { value: seconds }, text)),
  );

  constructor() {
    this.root = panel("Plots", true, element("label", { class: "row" }, element("span", {}, "Past"), this.reach), this.place);
    this.reach.addEventListener("change", () => {
      this.isDrawn = false;
      this.draw();
    });
    this.root.addEventListener("toggle", () => this.resize());
    new ResizeObserver(() => this.resize()).observe(this.root);
    setInterval(() => this.draw(), REDRAW_MS);
  }

  /** Another scene. */
  begin(probes: ProbeInfo[]): void {
    this.plots.forEach(({ plot }) => plot.destroy());
    this.plots = [];
    this.samples = new Table(1 + ENERGIES.length + probes.reduce((sum, probe) => sum + probe.components, 0));
    this.steps = new Table(1 + STAGES.length + ITERATIONS.length);
    this.felt = null;
    const lines = (names: string[]) => names.map((name, index) => ({ name, colour: COLOURS[index]! }));
    let first = 1 + ENERGIES.length;
    for (const { name, unit, components } of probes) {
      this.add(this.samples, first, label(name), unit, lines(components === 3 ? ["x", "y", "z"] : [label(name)]));
      first += components;
    }
    this.add(this.samples, 1, "energy", "J", lines(ENERGIES));
    this.add(this.steps, 1, "time of a step", "ms", STAGES.map(([name, colour]) => ({ name, colour })));
    this.add(this.steps, 1 + STAGES.length, "iterations of a step", "", lines(ITERATIONS));
  }

  push({ columns, numbers }: Samples): void {
    if (columns !== this.samples.columns.length) return;
    for (let row = 0; row < numbers.length; row += columns) this.samples.push(numbers.subarray(row, row + columns));
    this.isDrawn = false;
  }

  /** What the steps up to a frame have cost. */
  follow({ time, stages, iterations }: Frame): void {
    // a world that stands makes no steps
    if (time === this.steps.columns[0]?.at(-1)) return;
    this.steps.push([time, ...stages, ...iterations]);
    this.isDrawn = false;
  }

  /** How hard the hands of this page pull or press together, of which there is a plot once there are any [N]. */
  feel(time: number, hands: HandShown[]): void {
    if (!this.felt) {
      if (hands.length === 0) return;
      this.felt = new Table(2);
      const force = { name: "force", colour: COLOURS[0]! };
      // what a person does now comes first
      this.place.prepend(this.add(this.felt, 1, "your hand", "N", [force]));
    }
    if (time === this.felt.columns[0]?.at(-1)) return;
    this.felt.push([time, hands.reduce((sum, { force }) => sum + Math.hypot(...force), 0)]);
    this.isDrawn = false;
  }

  /** Axes take the colours of the page. */
  restyle(): void {
    this.plots.forEach(({ plot }) => plot.redraw());
  }

  private add(table: Table, first: number, title: string, unit: string, lines: Line[]): HTMLElement {
    const axis = { stroke: () => style("--quiet"), grid: { stroke: () => style("--line"), width: 1 }, ticks: { show: false } };
    // what is under the mouse, or else what came last
    const said = (unit: string) => (plot: uPlot, value: number | null, line: number) => {
      const shown = value ?? plot.data[line]?.at(-1) ?? null;
      return shown === null ? "" : `${number(shown)}${unit}`;
    };
    const line = ({ name, colour }: Line) => ({ label: name, stroke: colour, width: 1.5, points: { show: false }, value: said("") });
    const time = { label: "time", value: said(" s") };
    const plot = new uPlot(
      {
        width: this.width(),
        height: HEIGHT,
        title: unit ? `${title} [${inPrint(unit)}]` : title,
        scales: { x: { time: false } },
        legend: { live: true, isolate: true },
        cursor: { drag: { x: false, y: false } },
        axes: [
          { ...axis, size: 22, values: (_, values) => values.map((value) => `${number(value)} s`) },
          { ...axis, size: 58, values: (_, values) => values.map(number) },
        ],
        series: [time, ...lines.map(line)],
      },
      [[], ...lines.map(() => [])],
      this.place,
    );
    plot.root.dataset.title = title;
    this.plots.push({ plot, table, first, count: lines.length });
    return plot.root;
  }

  private draw(): void {
    if (this.isDrawn || !(this.root as HTMLDetailsElement).open || document.hidden) return;
    this.isDrawn = true;
    for (const { plot, table, first, count } of this.plots) {
      const from = table.since(Number(this.reach.value));
      const times = table.columns[0]!.slice(from);
      const lines = table.columns.slice(first, first + count).map((line) => line.slice(from));
      plot.setData([times, ...lines] as uPlot.AlignedData);
      plot.root.dataset.last = JSON.stringify(lines.map((line) => line.at(-1) ?? null));
    }
  }

  private width(): number {
    return Math.max(180, this.place.clientWidth || 288);
  }

  private resize(): void {
    const width = this.width();
    for (const { plot } of this.plots) if (plot.width !== width) plot.setSize({ width, height: HEIGHT });
  }
}

/** The last rows of numbers, column by column; time is the first. */
class Table {
  readonly columns: number[][];

  constructor(width: number) {
    this.columns = Array.from({ length: width }, () => []);
  }

  /** The first row of the last seconds. */
  since(seconds: number): number {
    const times = this.columns[0]!;
    const start = (times.at(-1) ?? 0) - seconds;
    let [low, high] = [0, times.length];
    while (low < high) {
      const middle = (low + high) >> 1;
      if (times[middle]! < start) low = middle + 1;
      else high = middle;
    }
    return low;
  }

  push(row: ArrayLike<number>): void {
    this.columns.forEach((column, index) => column.push(row[index]!));
    const surplus = (this.columns[0]?.length ?? 0) - ROWS;
    // cut in large pieces: each moves all that is behind it
    if (surplus > ROWS / 4) this.columns.forEach((column) => column.splice(0, surplus));
  }
}

function style(name: string): string {
  return getComputedStyle(document.documentElement).getPropertyValue(name);
}
