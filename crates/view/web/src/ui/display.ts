// How the world is drawn: what colours it, edges, a cut, light or dark.

import type { ArrowInfo, BodyInfo, ColourMap, FieldInfo, Influence, SceneInfo } from "../protocol";
import { label } from "../format";
import type { Cut } from "../view/picture";
import type { Style } from "../view/body";
import { element, panel, remember, remembered } from "./dom";

export interface Look {
  field: string | null;
  map: string;
  style: Style;
  cut: Cut | null;
  arrows: string | null;
  /** How far cells are apart, in their distance from the middle. */
  explode: number;
  axes: boolean;
  /** Whether the view goes along with the bodies. */
  follow: boolean;
}

const STYLES: [Style, string][] = [
  ["smooth", "Smooth"],
  ["edges", "With edges"],
  ["wireframe", "Wireframe"],
];
const AXES: [string, string][] = [
  ["none", "No cut"],
  ["0", "Across x"],
  ["1", "Across y"],
  ["2", "Across z"],
];

const row = (text: string, control: HTMLElement): HTMLElement =>
  element("label", { class: "row" }, element("span", {}, text), control);

export class Display {
  readonly root: HTMLElement;
  readonly look: Look = {
    field: null,
    map: "sequential",
    style: "smooth",
    cut: null,
    arrows: null,
    explode: 0,
    axes: true,
    follow: false,
  };
  private readonly field = element("select", { id: "field" });
  private readonly map = element("select", { id: "map" });
  /** The frame whose weights colour each body. */
  private readonly influence = element("div", { id: "influence" });
  private readonly style = element("select", { id: "style" });
  private readonly axis = element("select", { id: "cut" });
  private readonly otherHalf = element("input", { type: "checkbox", id: "other-half" });
  private readonly otherHalfRow: HTMLElement;
  private readonly styleRow: HTMLElement;
  private readonly explodeRow: HTMLElement;
  private readonly place = element("input", { type: "range", min: 0, max: 1, step: 0.005, value: 0.5, "aria-label": "Place of the cut" });
  private readonly explode = element("input", { type: "range", id: "explode", min: 0, max: 1, step: 0.01, value: 0 });
  private readonly arrows = element("select", { id: "arrows" });
  private readonly axes = element("input", { type: "checkbox", id: "axes", checked: true });
  private readonly axesRow: HTMLElement;
  private readonly follow = element("input", { type: "checkbox", id: "follow" });

  constructor(
    private readonly changed: () => void,
    private readonly actions: { fit: () => void; theme: () => void; influence: (body: number, frame: number) => void },
  ) {
    const options = (select: HTMLSelectElement, entries: [string, string][]) =>
      select.append(...entries.map(([value, text]) => element("option", { value }, text)));
    options(this.style, STYLES);
    options(this.axis, AXES);
    // chosen by a person: a scene that lacks it does not make it forgotten
    this.field.addEventListener("change", () => remember("field", this.field.value));
    for (const control of [this.field, this.map, this.style, this.axis, this.otherHalf, this.arrows, this.axes, this.follow]) {
      control.addEventListener("change", () => this.read());
    }
    for (const control of [this.place, this.explode]) control.addEventListener("input", () => this.read());
    this.styleRow = row("Style", this.style);
    this.explodeRow = row("Cells apart", this.explode);
    this.otherHalfRow = row("Other half", this.otherHalf);
    this.axesRow = row("Frames' axes", this.axes);
    this.root = panel(
      "Display",
      true,
      row("Colour", this.field),
      this.influence,
      row("Colour map", this.map),
      this.styleRow,
      row("Cut", this.axis),
      element("div", { class: "row" }, this.place),
      this.otherHalfRow,
      this.explodeRow,
      row("Arrows", this.arrows),
      this.axesRow,
      row("Follow the bodies", this.follow),
      element(
        "div",
        { class: "buttons" },
        element("button", { click: actions.fit, title: "Shows all bodies (F)" }, "Fit view"),
        element("button", { click: actions.theme, title: "Light or dark" }, "Light / dark"),
      ),
    );
    this.place.hidden = this.otherHalfRow.hidden = this.influence.hidden = true;
  }

  /** Whose weights are shown: a row for each body that frames carry. */
  setInfluence({ bodies }: Influence, infos: BodyInfo[]): void {
    const carried = bodies.flatMap((body, index) => (body ? [{ ...body, index }] : []));
    const rows = carried.map(({ frames, shown, index }) => {
      const input = element("input", { type: "number", min: 0, max: frames - 1, step: 1, value: shown });
      input.addEventListener("change", () => {
        const frame = Math.min(Math.max(Math.round(Number(input.value) || 0), 0), frames - 1);
        input.value = String(frame);
        this.actions.influence(index, frame);
      });
      return row(carried.length > 1 ? `Frame of ${infos[index]?.name ?? index}` : "Frame", input);
    });
    // a field that somebody types into is not taken away by its own answer
    const before = [...this.influence.querySelectorAll("input")];
    const isSame = before.length === carried.length && before.every((input, i) => input.max === String(carried[i]!.frames - 1));
    if (isSame) before.forEach((input, i) => (input.value = String(carried[i]!.shown)));
    else this.influence.replaceChildren(...rows);
  }

  setMaps(maps: ColourMap[]): void {
    this.map.replaceChildren(...maps.map((map) => element("option", { value: map.name, title: map.summary }, label(map.name))));
    this.map.value = this.look.map;
  }

  setFields({ fields, bodies, skins }: SceneInfo): void {
    const entry = ({ name, summary, unit, classes }: FieldInfo) =>
      element("option", { value: name, title: classes ? summary : `${summary} [${unit || "1"}]` }, label(name));
    this.styleRow.hidden = skins.length === 0 && bodies.every((body) => body.surface_triangles === 0 && !body.is_network);
    this.explodeRow.hidden = !bodies.some(({ has_inside }) => has_inside);
    const here = fields.filter(({ is_here }) => is_here);
    this.field.replaceChildren(element("option", { value: "" }, "Material"), ...here.map(entry));
    // bodies are shown as they look
    const wanted = remembered("field") ?? here.find(({ scale }) => scale !== null)?.name ?? "";
    this.field.value = here.some((field) => field.name === wanted) ? wanted : "";
    this.read();
  }

  setArrows(kinds: ArrowInfo[], hasFrames: boolean): void {
    const entry = ({ name, summary, unit }: ArrowInfo) =>
      element("option", { value: name, title: `${summary} [${unit}]` }, label(name));
    this.arrows.replaceChildren(element("option", { value: "" }, "None"), ...kinds.map(entry));
    this.arrows.value = this.look.arrows ?? "";
    this.axesRow.hidden = !hasFrames;
  }

  /** The next style of surfaces and networks. */
  nextStyle(): void {
    const at = STYLES.findIndex(([style]) => style === this.look.style);
    this.style.value = STYLES[(at + 1) % STYLES.length]![0];
    this.read();
  }

  private read(): void {
    const { look } = this;
    look.field = this.field.value || null;
    this.influence.hidden = look.field !== "influence";
    look.map = this.map.value || "sequential";
    look.style = this.style.value as Style;
    // what is chosen for other scenes is kept, and does nothing where it cannot be seen
    look.explode = this.explodeRow.hidden ? 0 : Number(this.explode.value);
    look.arrows = this.arrows.value || null;
    look.axes = this.axes.checked;
    look.follow = this.follow.checked;
    const axis = this.axis.value;
    this.place.hidden = this.otherHalfRow.hidden = axis === "none";
    look.cut =
      axis === "none"
        ? null
        : { axis: Number(axis) as 0 | 1 | 2, isFarHalf: !this.otherHalf.checked, place: Number(this.place.value) };
    this.changed();
  }
}
