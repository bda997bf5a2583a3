// How the hand takes hold and what it pushes with.

import { label, number } from "../format";
import type { Adjustable, ToolInfo } from "../protocol";
import { Gravity } from "./gravity";
import { element, panel } from "./dom";

export interface Handling {
  /** 1 swings a whole body in about half a second. */
  strength: number;
  tool: string;
  /** In the size of all bodies. */
  size: number;
  /** How far the front of the tool is from its origin, in its size. */
  front: number;
  /** How far about its middle a flat front reaches, in its size; null: it is held from the eye. */
  flat: number | null;
  /** Whether a tool stays where the hand leaves it. */
  stays: boolean;
}

/** Until the world has told which tools there are. */
export const BARE_HAND: Handling = { strength: 1, tool: "", size: 0.16, front: 0, flat: null, stays: false };

export class HandPanel {
  readonly root: HTMLElement;
  readonly handling: Handling = { ...BARE_HAND };
  private tools: ToolInfo[] = [];
  private readonly strength = element("input", { type: "range", id: "strength", min: -1.5, max: 1.5, step: 0.05, value: 0 });
  private readonly tool = element("select", { id: "tool" });
  private readonly size = element("input", { type: "range", id: "tool-size", min: -1.7, max: -0.3, step: 0.02, value: -0.8 });
  private readonly stays = element("input", { type: "checkbox", id: "tool-stays" });
  private readonly strengthSaid = element("small");
  private readonly sizeSaid = element("small");
  private readonly gravity: Gravity;

  constructor(
    private readonly changed: (handling: Handling) => void,
    putAway: () => void,
    setGravity: (value: string) => void,
  ) {
    const row = (text: string, control: HTMLElement, said: HTMLElement | null = null) =>
      element("label", { class: "row" }, element("span", {}, text, said), control);
    this.gravity = new Gravity(setGravity);
    for (const control of [this.strength, this.size]) control.addEventListener("input", () => this.read());
    for (const control of [this.tool, this.stays]) control.addEventListener("change", () => this.read());
    this.root = panel(
      "Hand",
      true,
      row("Strength", this.strength, this.strengthSaid),
      row("Pushes with", this.tool),
      row("Size of the tool", this.size, this.sizeSaid),
      row("Stays where it is left", this.stays),
      element("div", { class: "buttons" }, element("button", { id: "put-away", click: putAway }, "Put tools away")),
      this.gravity.root,
    );
    this.read();
  }

  /** Gravity as the scene has it; `undefined` where it has none that may be set. */
  setGravity(gravity: Adjustable | undefined): void {
    this.gravity.set(gravity);
  }

  setTools(tools: ToolInfo[]): void {
    this.tools = tools;
    const before = this.tool.value;
    this.tool.replaceChildren(
      ...tools.map(({ name, summary }) => element("option", { value: name, title: summary }, label(name))),
    );
    if (tools.some(({ name }) => name === before)) this.tool.value = before;
    this.read();
  }

  private read(): void {
    const { handling } = this;
    handling.strength = 10 ** Number(this.strength.value);
    handling.size = 10 ** Number(this.size.value);
    handling.tool = this.tool.value;
    handling.stays = this.stays.checked;
    this.strengthSaid.textContent = ` ${number(handling.strength)} ×`;
    this.sizeSaid.textContent = ` ${number(100 * handling.size)} % of all bodies`;
    const { front, flat } = this.tools.find(({ name }) => name === handling.tool) ?? BARE_HAND;
    Object.assign(handling, { front, flat });
    this.changed(handling);
  }
}
