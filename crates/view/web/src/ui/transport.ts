// Play, pause, step, reset, speed; the time and how it compares with real time.

import type { Tool } from "../view/grab";
import { element } from "./dom";
import type { Frame, Status, Wish } from "../protocol";
import { number } from "../format";

const SPEEDS = [0.05, 0.1, 0.25, 0.5, 1, 2, 4];
const TOOLS: [Tool, string, string][] = [
  ["pull", "Pull", "Drag a body; the wheel leads it nearer or away (G)"],
  ["push", "Push", "Press a tool on a body; the wheel leads it nearer or away (O)"],
  ["pin", "Pin", "Click to hold a place, click again to let go (P)"],
  ["throw", "Throw", "Drag and let go: the body flies that way (T)"],
];

/** A step that takes longer is told [ms]. */
const LONG_MS = 1500;

export class Transport {
  readonly root: HTMLElement;
  private readonly play = element("button", { class: "main", title: "Play or pause (space)" }, "Pause");
  private readonly speed = element("select", { title: "Simulated seconds per second", "aria-label": "Speed" });
  private readonly time = element("span", { class: "time", title: "Simulated time" }, "0.00 s");
  private readonly factor = element("span", { class: "factor", title: "Simulated seconds per second, as measured" });
  private readonly tools = new Map<Tool, HTMLButtonElement>();
  private mode: Status["mode"] = "waiting";
  /** When the last frame was shown, and how long after the one before [ms]. */
  private shown = 0;
  private between = 0;

  constructor(
    private readonly send: (wish: Wish) => void,
    private readonly choose: (tool: Tool) => void,
  ) {
    this.play.addEventListener("click", () => this.toggle());
    for (const speed of SPEEDS) {
      this.speed.append(element("option", { value: speed, selected: speed === 1 }, `${speed} ×`));
    }
    this.speed.addEventListener("change", () => send({ do: "speed", factor: Number(this.speed.value) }));
    const button = (text: string, title: string, wish: Wish) =>
      element("button", { title, "data-do": wish.do, click: () => send(wish) }, text);
    const tools = element("div", { class: "tools", role: "group", "aria-label": "What the mouse does" });
    for (const [tool, text, title] of TOOLS) {
      const made = element("button", { title, "data-tool": tool, click: () => this.take(tool) }, text);
      this.tools.set(tool, made);
      tools.append(made);
    }
    this.root = element(
      "div",
      { class: "transport" },
      this.play,
      button("Step", "One step of a paused world (S)", { do: "step" }),
      button("Reset", "Back to the start, with the values that were set (R)", { do: "reset" }),
      this.speed,
      tools,
      element("span", { class: "clock" }, this.time, this.factor),
    );
    this.take("pull");
  }

  toggle(): void {
    this.send({ do: this.isGoing ? "pause" : "play" });
  }

  /** Playing, or in the step of a paused world. */
  private get isGoing(): boolean {
    return this.mode === "playing" || this.mode === "stepping";
  }

  take(tool: Tool): void {
    this.tools.forEach((button, known) => button.setAttribute("aria-pressed", String(known === tool)));
    this.choose(tool);
  }

  setStatus(status: Status): void {
    // what has passed while nothing was to be shown is no step
    if (status.mode !== this.mode) this.restart();
    this.mode = status.mode;
    this.play.textContent = status.mode === "playing" ? "Pause" : "Play";
    this.play.disabled = status.mode === "failed";
    this.showSpeed(status.speed);
  }

  /** Another client may have wished for one that is not in the list. */
  private showSpeed(speed: number): void {
    if (![...this.speed.options].some(({ value }) => Number(value) === speed)) {
      this.speed.append(element("option", { value: speed }, `${number(speed)} ×`));
    }
    this.speed.value = String(speed);
  }

  /** From now on a frame is waited for. */
  restart(): void {
    this.shown = performance.now();
  }

  /** Whether a step goes on for long: what is wished for is done when it ends. */
  get isLong(): boolean {
    return this.isGoing && performance.now() - this.shown > Math.max(LONG_MS, 3 * this.between);
  }

  /** No frame has come: a step that goes on for long is told. */
  wait(): void {
    if (!this.isLong) return;
    const since = performance.now() - this.shown;
    this.factor.textContent = `${number(since / 1000)} s in one step`;
    // a step that does not last is over before anybody could
    this.play.textContent = "Pause";
    this.factor.classList.add("slow");
  }

  show(frame: Frame): void {
    const now = performance.now();
    this.between = now - this.shown;
    this.shown = now;
    this.time.textContent = `${frame.time.toFixed(2)} s`;
    const text = this.mode === "playing" ? `${number(frame.realTimeFactor)} × real time` : this.mode;
    this.factor.textContent = text;
    this.factor.classList.toggle("slow", this.mode === "playing" && frame.realTimeFactor < 0.9 * Number(this.speed.value));
  }
}
