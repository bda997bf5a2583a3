// What is said to a person where it happens: notes that fade, and a list that stays.

import { element } from "./dom";

export type Weight = "note" | "warning" | "error";

const SECONDS: Record<Weight, number> = { note: 4, warning: 8, error: 12 };
const KEPT = 50;
/** Notes on the screen at once: more would cover what they are about, and the list has them all. */
const SHOWN = 2;

export class Notes {
  readonly list = element("ol", { class: "log" }, element("li", { class: "quiet" }, "Nothing to tell."));

  constructor(private readonly place: HTMLElement) {}

  /** Puts a text on the list alone. */
  keep(weight: Weight, text: string): void {
    this.list.querySelector(".quiet")?.remove();
    const time = new Date().toLocaleTimeString();
    // a note on the screen is of the class `note`
    this.list.prepend(element("li", { class: weight === "note" ? "" : weight }, element("time", {}, time), ` ${text}`));
    while (this.list.childElementCount > KEPT) this.list.lastElementChild?.remove();
  }

  /** Takes all notes off the screen: they were of another world. */
  clear(): void {
    this.place.replaceChildren();
  }

  say(weight: Weight, text: string): void {
    this.keep(weight, text);
    // what is said again stands once
    [...this.place.children].filter((note) => note.querySelector("p")?.textContent === text).forEach((note) => note.remove());
    const close = element("button", { class: "close", "aria-label": "Close this message", click: () => note.remove() }, "×");
    const note = element("div", { class: `note ${weight}` }, element("p", {}, text), close);
    this.place.append(note);
    // what a person is about to close stays
    const fade = () => (note.matches(":hover, :focus-within") ? wait() : note.remove());
    const wait = () => setTimeout(fade, 1000 * SECONDS[weight]);
    wait();
    while (this.place.childElementCount > SHOWN) this.place.firstElementChild?.remove();
  }
}
