// What colours and arrows mean.

import { label, quantity } from "../format";
import type { ArrowInfo, Class, ColourMap, FieldInfo } from "../protocol";
import { STATE_COLOURS } from "../view/palette";
import type { Meanings } from "../view/meanings";
import { element } from "./dom";
import type { Caption } from "./photograph";

export class Legend {
  private readonly title = element("div", { class: "title" });
  private readonly bar = element("div", { class: "bar" });
  private readonly low = element("span");
  private readonly middle = element("span");
  private readonly high = element("span");
  private readonly ends = element("div", { class: "ends" }, this.low, this.middle, this.high);
  private readonly list = element("ul", { class: "classes" });
  private readonly none = element("div", { class: "none" }, "No body here has it.");
  private readonly arrow = element("div", { class: "arrow" });
  private field: FieldInfo | null = null;
  private arrows: ArrowInfo | null = null;
  /** What is in the list: it is not made anew in each picture. */
  private listed = "";
  private entries: Class[] = [];
  private stops: string[] = [];

  constructor(private readonly place: HTMLElement) {
    place.append(this.title, this.bar, this.ends, this.list, this.none, this.arrow);
    place.hidden = true;
  }

  /** What is asked for. */
  set(field: FieldInfo | null, map: ColourMap | undefined, arrows: ArrowInfo | null): void {
    this.field = field;
    this.arrows = arrows;
    const colours = field?.scale?.colours ?? map?.colours;
    if (!colours) return;
    this.stops = [0, 32, 64, 96, 128, 160, 192, 224, 255].map((i) => `#${colours.slice(6 * i, 6 * i + 6)}`);
    this.bar.style.background = `linear-gradient(to right, ${this.stops.join(", ")})`;
  }

  /** What it says, for a picture that leaves the page. */
  get caption(): Caption["legend"] {
    const said = (thing: HTMLElement) => (this.place.hidden || thing.hidden ? [] : [thing.textContent ?? ""]);
    const ends = [this.low, this.middle, this.high].map(({ textContent }) => textContent ?? "");
    return {
      // what arrows mean stands above, as there is room below for one scale only
      lines: [...said(this.arrow), ...said(this.none), ...said(this.title)],
      bar: this.place.hidden || this.bar.hidden ? null : { colours: this.stops, ends },
      classes: this.place.hidden ? [] : this.entries.map(({ name, colour }) => ({ name: label(name), colour: `#${colour}` })),
    };
  }

  /** What is seen. */
  show({ hasValues, range, classes, linkStates, longest }: Meanings): void {
    const { field, arrows } = this;
    const isScale = field !== null && field.classes === null && hasValues && range.low <= range.high;
    const entries = field ? classes.flatMap((number) => field.classes?.[number] ?? []) : linkStates.map(stateOf);
    const hasArrows = arrows !== null && longest > 0;
    this.title.textContent = field ? (field.title ?? label(field.name)) : entries.length > 0 ? "Links" : "";
    this.title.hidden = !this.title.textContent;
    this.bar.hidden = this.ends.hidden = !isScale;
    this.none.hidden = field === null || hasValues;
    this.arrow.hidden = arrows === null;
    this.place.hidden = this.title.hidden && arrows === null;
    this.name(entries);
    if (isScale) this.scale(range.low, range.high, field.unit);
    if (hasArrows) this.arrow.textContent = `Longest arrow, ${label(arrows.name)}: ${quantity(longest, arrows.unit)}`;
    else if (arrows) this.arrow.textContent = `No arrows: nothing has any ${label(arrows.name)} now.`;
    this.arrow.classList.toggle("none", !hasArrows);
  }

  private scale(low: number, high: number, unit: string): void {
    // what is nothing beside the range is nothing
    const least = 1e-3 * (high - low);
    const text = (value: number) => quantity(Math.abs(value) < least ? 0 : value, unit);
    this.low.textContent = text(low);
    this.middle.textContent = text(0.5 * (low + high));
    this.high.textContent = text(high);
  }

  private name(entries: Class[]): void {
    this.list.hidden = entries.length === 0;
    const listed = JSON.stringify(entries);
    if (this.listed === listed) return;
    this.listed = listed;
    this.entries = entries;
    const entry = ({ name, colour }: Class) =>
      element("li", {}, element("i", { style: `background: #${colour}` }), label(name));
    this.list.replaceChildren(...entries.map(entry));
  }
}

/** A state of links, by its number in frames; the first, in which they have the colour of their body, is 1. */
function stateOf(number: number): Class {
  const colour = STATE_COLOURS[(number - 2) % STATE_COLOURS.length]!;
  return { name: `in state ${number} of their law`, colour: colour.toString(16).padStart(6, "0") };
}
