// Values of the scene, from its tables: set while the world runs.

import { inPrint, label } from "../format";
import type { Adjustable, Adjustables, Wish } from "../protocol";
import { element, panel } from "./dom";

/** Decades that a slider reaches to either side of the value. */
const DECADES = 1.5;
const SLIDER_STEPS = 300;

export class Parameters {
  readonly root: HTMLElement;
  private readonly place = element("div");
  private readonly command = element("code", { class: "command" });
  private readonly copying: HTMLButtonElement;
  private shape = "";
  private readonly controls = new Map<string, Control>();
  /** What was set last. */
  private lastSet = "";
  private scene = "";
  private isFile = false;

  constructor(
    private readonly send: (wish: Wish) => void,
    private readonly say: (text: string) => void,
  ) {
    this.copying = element("button", { title: "The command that reproduces these values", click: () => this.copy() }, "Copy command");
    this.root = panel("Parameters", true, this.place, element("div", { class: "buttons" }, this.copying), this.command);
  }

  setScene(name: string, isFile: boolean): void {
    this.scene = name;
    this.isFile = isFile;
  }

  set({ adjustables, settings }: Adjustables): void {
    this.copying.disabled = !this.isFile;
    this.command.textContent = this.isFile
      ? `souple run ${quoted(this.scene)}${settings.map((s) => ` --set ${quoted(s)}`).join("")}`
      : "No file of the program holds this scene. Its recording, under Downloads, repeats it by `souple replay`.";
    // fields keep the cursor while only their values change
    const shape = JSON.stringify([this.scene, adjustables.map((adjustable) => ({ ...adjustable, value: null }))]);
    if (shape !== this.shape) {
      this.shape = shape;
      this.build(adjustables);
    }
    adjustables.forEach((adjustable) => this.controls.get(adjustable.path)?.show(adjustable));
  }

  /** Wishes for a value. */
  change(path: string, value: string): void {
    this.lastSet = path;
    this.send({ do: "set", path, value });
  }

  /** What was set was refused: says so beside it, the value as it is comes after; whether a person who set it there sees it. */
  refuse(message: string): boolean {
    const path = [...this.controls.keys()].find((path) => message.startsWith(`${path}:`)) ?? this.lastSet;
    const control = this.controls.get(path);
    if (!control) return false;
    control.refuse(message.startsWith(`${path}:`) ? message.slice(path.length + 1).trim() : message);
    return control.holdsFocus();
  }

  private build(adjustables: Adjustable[]): void {
    this.controls.clear();
    const groups = new Map<string, HTMLElement>();
    for (const adjustable of adjustables) {
      let group = groups.get(adjustable.group);
      if (!group) {
        // how it is solved comes after what it is
        const open = !adjustable.path.startsWith("systems.");
        group = element("details", { class: "group", open }, element("summary", {}, adjustable.group.replaceAll("_", " ")));
        groups.set(adjustable.group, group);
      }
      group.append(this.row(adjustable));
    }
    this.place.replaceChildren(...groups.values());
  }

  private row(adjustable: Adjustable): HTMLElement {
    const { name, unit, summary, type } = adjustable;
    const title = `${summary}${unit ? ` [${inPrint(unit)}]` : ""}`;
    const heading = element("span", { title }, label(name), unit ? element("small", {}, ` ${inPrint(unit)}`) : null);
    const refusal = element("small", { class: "refusal", hidden: true });
    const isChosen = type === "choice" || type === "boolean";
    const inputs = isChosen ? this.choice(adjustable, refusal) : this.number(adjustable, refusal);
    return element("label", { class: "row" }, heading, ...inputs, refusal);
  }

  private choice({ path, type, choices }: Adjustable, refusal: HTMLElement): HTMLElement[] {
    const entries = type === "boolean" ? ["true", "false"] : choices;
    const select = element("select", { "data-path": path }, ...entries.map((value) => element("option", { value }, label(value))));
    select.addEventListener("change", () => {
      refusal.hidden = true;
      this.change(path, type === "boolean" ? select.value : JSON.stringify(select.value));
    });
    this.controls.set(path, {
      show: ({ value }) => (select.value = (value ?? "").replaceAll('"', "")),
      refuse: (message) => say(refusal, message),
      holdsFocus: () => document.activeElement === select,
    });
    return [select];
  }

  private number({ path, name, type }: Adjustable, refusal: HTMLElement): HTMLElement[] {
    const text = element("input", { type: "text", spellcheck: "false", autocomplete: "off", "data-path": path });
    const slider = element("input", { type: "range", min: 0, max: SLIDER_STEPS, "aria-label": label(name), hidden: true });
    /** As it was shown or set: what is typed since then is left alone. */
    let known = "";
    let scale: Scale | null = null;
    let isAutomatic = false;
    const forget = () => (refusal.hidden = true);
    text.addEventListener("input", forget);
    slider.addEventListener("input", forget);
    text.addEventListener("change", () => {
      if (isAutomatic && text.value.trim() === "") {
        refuse("it is automatic again when the scene is loaded anew");
        text.value = known;
        return;
      }
      known = text.value;
      this.change(path, written(text.value, type));
    });
    slider.addEventListener("input", () => {
      if (scale) this.change(path, String(scale.value(Number(slider.value) / SLIDER_STEPS)));
    });
    const show = (now: Adjustable) => {
      if (document.activeElement !== text || text.value === known) known = text.value = shown(now);
      isAutomatic ||= now.value === null;
      text.placeholder = now.value === null ? "automatic" : "";
      const value = Number(now.value);
      const isMoved = document.activeElement === slider;
      // a value beyond the ends came from elsewhere, and the slider reaches about it from now on
      if (type === "number" && !isMoved && !(scale && isPart(scale.place(value)))) scale = scaleOf(now, value);
      slider.hidden = scale === null;
      if (scale && !isMoved) slider.value = String(SLIDER_STEPS * scale.place(value));
    };
    // the value that holds comes back, and is none that is wrong
    const refuse = (message: string) => say(refusal, message);
    this.controls.set(path, { show, refuse, holdsFocus: () => [text, slider].some((input) => input === document.activeElement) });
    return [text, slider];
  }

  private copy(): void {
    navigator.clipboard.writeText(this.command.textContent ?? "").then(
      () => this.say("The command is in the clipboard."),
      () => this.say("The clipboard is closed to this page; the command is at the end of the panel."),
    );
  }
}

/** What shows a value. */
interface Control {
  show(adjustable: Adjustable): void;
  refuse(message: string): void;
  /** Whether it is what a person is at, and so is seen. */
  holdsFocus(): boolean;
}

interface Scale {
  value(part: number): number;
  place(value: number): number;
}

/** Logarithmic about a positive value, even between two ends; none where neither makes sense. */
function scaleOf({ low, high, value: text }: Adjustable, value: number): Scale | null {
  if (text === null || !Number.isFinite(value)) return null;
  // small beside its range: a tolerance, of which factors count
  if (low !== null && high !== null && !(value > 0 && value < 1e-2 * (high - low))) {
    // ends themselves may be excluded
    const inset = 0.002 * (high - low);
    const [from, to] = [low + inset, high - inset];
    return {
      value: (part) => Number((from + (to - from) * part).toPrecision(4)),
      place: (now) => (now - from) / (to - from),
    };
  }
  if (value > 0) {
    return {
      value: (part) => Number(Math.min(value * 10 ** (DECADES * (2 * part - 1)), high ?? Infinity).toPrecision(3)),
      place: (now) => (Math.log10(now / value) / DECADES + 1) / 2,
    };
  }
  return null;
}

function isPart(part: number): boolean {
  return part >= 0 && part <= 1;
}

function say(refusal: HTMLElement, message: string): void {
  refusal.textContent = message;
  refusal.hidden = false;
}

/** A value as it is read: `12000` as `12000`, `[0, -9.81, 0]` as `0, -9.81, 0`. */
function shown({ value, type }: Adjustable): string {
  if (value === null) return "";
  if (type === "vector") return value.replaceAll(/[[\]]/g, "");
  const number = Number(value);
  // what it is set from has more digits than anybody reads
  return type === "number" && Number.isFinite(number) ? String(Number(number.toPrecision(6))) : value;
}

/** What a person wrote, as a scene file would have it. */
export function written(text: string, type: Adjustable["type"]): string {
  const trimmed = text.trim();
  if (type !== "vector") return trimmed;
  // with its unit a part is a text
  const part = (text: string) => (Number.isFinite(Number(text)) || text.startsWith('"') ? text : JSON.stringify(text));
  const parts = trimmed.replace(/^\[|\]$/g, "").split(",");
  return `[${parts.map((text) => part(text.trim())).join(", ")}]`;
}

function quoted(text: string): string {
  return /^[\w./:=-]*$/.test(text) ? text : `'${text.replaceAll("'", "'\\''")}'`;
}
