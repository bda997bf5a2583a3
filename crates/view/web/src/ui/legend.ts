// What colours mean.

import { label, quantity } from "../format";
import type { ColourMap, FieldInfo } from "../protocol";
import type { Range } from "../view/palette";
import { element } from "./dom";

export class Legend {
  private readonly title = element("div", { class: "title" });
  private readonly bar = element("div", { class: "bar" });
  private readonly low = element("span");
  private readonly middle = element("span");
  private readonly high = element("span");
  private unit = "";

  constructor(private readonly place: HTMLElement) {
    place.append(this.title, this.bar, element("div", { class: "ends" }, this.low, this.middle, this.high));
    place.hidden = true;
  }

  set(field: FieldInfo | null, map: ColourMap | undefined): void {
    this.place.hidden = !field || !map;
    if (!field || !map) return;
    this.title.textContent = label(field.name);
    this.unit = field.unit;
    const stops = [0, 32, 64, 96, 128, 160, 192, 224, 255].map((i) => `#${map.colours.slice(6 * i, 6 * i + 6)}`);
    this.bar.style.background = `linear-gradient(to right, ${stops.join(", ")})`;
  }

  show({ low, high }: Range): void {
    if (this.place.hidden || !(low <= high)) return;
    // what is nothing beside the range is nothing
    const least = 1e-3 * (high - low);
    const text = (value: number) => quantity(Math.abs(value) < least ? 0 : value, this.unit);
    this.low.textContent = text(low);
    this.middle.textContent = text(0.5 * (low + high));
    this.high.textContent = text(high);
  }
}
