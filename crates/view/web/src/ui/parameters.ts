// Values of the scene, from its tables: set while the world runs.

import { inPrint, label, number } from "../format";
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

  constructor(
    private readonly send: (wish: Wish) => void,
    private readonly say: (text: string) => void,
  ) {
    this.copying = element("button", { title: "The command that reproduces these values", click: () => this.copy() }, "Copy command");
    this.root = panel("Parameters", true, this.place, element("div", { class: "buttons" }, this.copying), this.command);
  }

  setScene(name: string): void {
    this.scene = name;
  }

  set({ adjustables, settings }: Adjustables): void {
    const isFile = this.scene.endsWith(".toml");
    this.copying.disabled = !isFile;
    this.command.textContent = isFile
      ? `souple run ${quoted(this.scene)}${settings.map((s) => ` --set ${quoted(s)}`).join("")}`
      : "This scene is no file where the program runs: its recording, under Downloads, replays it.";
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

  /** What was set was refused: says so beside it, the value as it is comes after; whether there is such a place in sight. */
  refuse(message: string): boolean {
    const path = [...this.controls.keys()].find((path) => message.startsWith(`${path}:`)) ?? this.lastSet;
    const control = this.controls.get(path);
    control?.refuse(message.startsWith(`${path}:`) ? message.slice(path.length + 1).trim() : message);
    return control !== undefined && (this.root as HTMLDetailsElement).open;
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
    const title = `${summary}${unit ? ` [${unit}]` : ""}`;
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
    const forget = () => {
      text.removeAttribute("aria-invalid");
      refusal.hidden = true;
    };
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
    const refuse = (message: string) => {
      text.setAttribute("aria-invalid", "true");
      say(refusal, message);
    };
    this.controls.set(path, { show, refuse });
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
  const digits = Number(value);
  return Number.isFinite(digits) && type === "number" && Math.abs(digits) >= 1e-3 && Math.abs(digits) < 1e5
    ? String(Number(digits.toPrecision(6)))
    : Number.isFinite(digits) && type === "number"
      ? number(digits)
      : value;
}

/** What a person wrote, as a scene file would have it. */
function written(text: string, type: Adjustable["type"]): string {
  const trimmed = text.trim();
  if (type === "vector" && !trimmed.startsWith("[")) return `[${trimmed}]`;
  return trimmed;
}

function quoted(text: string): string {
  return /^[\w./:=-]*$/.test(text) ? text : `'${text.replaceAll("'", "'\\''")}'`;
}
