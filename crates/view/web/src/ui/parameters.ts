// Values of the scene, from its tables: set while the world runs.

import { label, number } from "../format";
import type { Adjustable, Adjustables, Wish } from "../protocol";
import { element, panel } from "./dom";

/** Decades that a slider reaches to either side of the value. */
const DECADES = 1.5;
const SLIDER_STEPS = 300;

export class Parameters {
  readonly root: HTMLElement;
  private readonly place = element("div");
  private readonly command = element("code", { class: "command" });
  private shape = "";
  private readonly controls = new Map<string, (adjustable: Adjustable) => void>();
  private scene = "";

  constructor(
    private readonly send: (wish: Wish) => void,
    private readonly say: (text: string) => void,
  ) {
    const copy = element("button", { title: "The command that reproduces these values", click: () => this.copy() }, "Copy command");
    this.root = panel("Parameters", true, this.place, element("div", { class: "buttons" }, copy), this.command);
  }

  setScene(name: string): void {
    this.scene = name;
  }

  set({ adjustables, settings }: Adjustables): void {
    this.command.textContent = `souple run ${quoted(this.scene)}${settings.map((s) => ` --set ${quoted(s)}`).join("")}`;
    // fields keep the cursor while only their values change
    const shape = JSON.stringify(adjustables.map(({ path, type, group }) => [path, type, group]));
    if (shape !== this.shape) {
      this.shape = shape;
      this.build(adjustables);
    }
    adjustables.forEach((adjustable) => this.controls.get(adjustable.path)?.(adjustable));
  }

  private build(adjustables: Adjustable[]): void {
    this.controls.clear();
    const groups = new Map<string, HTMLElement>();
    for (const adjustable of adjustables) {
      let group = groups.get(adjustable.group);
      if (!group) {
        group = element("fieldset", {}, element("legend", {}, adjustable.group.replaceAll("_", " ")));
        groups.set(adjustable.group, group);
      }
      group.append(this.row(adjustable));
    }
    this.place.replaceChildren(...groups.values());
  }

  private row(adjustable: Adjustable): HTMLElement {
    const { path, name, unit, summary, type, choices } = adjustable;
    const title = `${summary}${unit ? ` [${unit}]` : ""}`;
    const set = (value: string) => this.send({ do: "set", path, value });
    const heading = element("span", { title }, label(name), unit ? element("small", {}, ` ${unit}`) : null);
    if (type === "choice" || type === "boolean") {
      const entries = type === "boolean" ? ["true", "false"] : choices;
      const select = element("select", { "data-path": path }, ...entries.map((value) => element("option", { value }, label(value))));
      select.addEventListener("change", () => set(type === "boolean" ? select.value : JSON.stringify(select.value)));
      this.controls.set(path, ({ value }) => (select.value = (value ?? "").replaceAll('"', "")));
      return element("label", { class: "row" }, heading, select);
    }
    const text = element("input", { type: "text", spellcheck: "false", autocomplete: "off", "data-path": path });
    text.addEventListener("change", () => set(written(text.value, type)));
    const slider = type === "number" ? element("input", { type: "range", min: 0, max: SLIDER_STEPS, "aria-label": label(name) }) : null;
    let scale: Scale | null = null;
    slider?.addEventListener("input", () => {
      if (scale) set(String(scale.value(Number(slider.value) / SLIDER_STEPS)));
    });
    this.controls.set(path, (now) => {
      if (document.activeElement !== text) text.value = shown(now);
      text.placeholder = now.value === null ? "automatic" : "";
      const value = Number(now.value);
      scale ??= scaleOf(now, value);
      if (slider) {
        slider.hidden = scale === null;
        if (scale && document.activeElement !== slider) slider.value = String(SLIDER_STEPS * scale.place(value));
      }
    });
    return element("label", { class: "row" }, heading, text, slider);
  }

  private copy(): void {
    navigator.clipboard.writeText(this.command.textContent ?? "").then(
      () => this.say("The command is in the clipboard."),
      () => this.say("The clipboard is closed to this page; the command is at the end of the panel."),
    );
  }
}

interface Scale {
  value(part: number): number;
  place(value: number): number;
}

/** Logarithmic about a positive value, even between two ends; none where neither makes sense. */
function scaleOf({ low, high, value: text }: Adjustable, value: number): Scale | null {
  if (text === null || !Number.isFinite(value)) return null;
  if (low !== null && high !== null) {
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
      value: (part) => Number((value * 10 ** (DECADES * (2 * part - 1))).toPrecision(3)),
      place: (now) => (Math.log10(now / value) / DECADES + 1) / 2,
    };
  }
  return null;
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
