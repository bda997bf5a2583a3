// What colours mean.

import { label, quantity } from "../format";
import type { Class, ColourMap, FieldInfo } from "../protocol";
import type { Range } from "../view/palette";
import { element } from "./dom";

export class Legend {
  private readonly title = element("div", { class: "title" });
  private readonly bar = element("div", { class: "bar" });
  private readonly low = element("span");
  private readonly middle = element("span");
  private readonly high = element("span");
  private readonly ends = element("div", { class: "ends" }, this.low, this.middle, this.high);
  private readonly list = element("ul", { class: "classes" });
  private unit = "";
  private classes: Class[] | null = null;
  private listed = "";

  constructor(private readonly place: HTMLElement) {
    place.append(this.title, this.bar, this.ends, this.list);
    place.hidden = true;
  }

  set(field: FieldInfo | null, map: ColourMap | undefined): void {
    this.place.hidden = !field || !map;
    if (!field || !map) return;
    this.title.textContent = label(field.name);
    this.unit = field.unit;
    this.classes = field.classes;
    this.list.hidden = field.classes === null;
    this.bar.hidden = this.ends.hidden = field.classes !== null;
    this.listed = "";
    this.list.replaceChildren();
    const stops = [0, 32, 64, 96, 128, 160, 192, 224, 255].map((i) => `#${map.colours.slice(6 * i, 6 * i + 6)}`);
    this.bar.style.background = `linear-gradient(to right, ${stops.join(", ")})`;
  }

  /** Ends of the range of quantities, or the classes that are seen. */
  show({ low, high }: Range, seen: number[]): void {
    if (this.place.hidden || !(low <= high)) return;
    if (this.classes) {
      this.name(this.classes, seen);
      return;
    }
    // what is nothing beside the range is nothing
    const least = 1e-3 * (high - low);
    const text = (value: number) => quantity(Math.abs(value) < least ? 0 : value, this.unit);
    this.low.textContent = text(low);
    this.middle.textContent = text(0.5 * (low + high));
    this.high.textContent = text(high);
  }

  private name(classes: Class[], seen: number[]): void {
    if (this.listed === seen.join()) return;
    this.listed = seen.join();
    const entry = ({ name, colour }: Class) =>
      element("li", {}, element("i", { style: `background: #${colour}` }), label(name));
    this.list.replaceChildren(...seen.flatMap((number) => classes[number] ?? []).map(entry));
  }
}
