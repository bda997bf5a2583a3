// What is said to a person where it happens: notes that fade, and a list that stays.

import { element } from "./dom";

export type Weight = "note" | "warning" | "error";

const SECONDS: Record<Weight, number> = { note: 4, warning: 8, error: 12 };
const KEPT = 50;

export class Notes {
  readonly list = element("ol", { class: "log" }, element("li", { class: "quiet" }, "Nothing to tell."));

  constructor(private readonly place: HTMLElement) {}

  say(weight: Weight, text: string): void {
    this.list.querySelector(".quiet")?.remove();
    const time = new Date().toLocaleTimeString();
    this.list.prepend(element("li", { class: weight }, element("time", {}, time), ` ${text}`));
    while (this.list.childElementCount > KEPT) this.list.lastElementChild?.remove();
    const note = element("p", { class: `note ${weight}`, click: () => note.remove() }, text);
    this.place.append(note);
    setTimeout(() => note.remove(), 1000 * SECONDS[weight]);
    while (this.place.childElementCount > 4) this.place.firstElementChild?.remove();
  }
}
