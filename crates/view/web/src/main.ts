// The page of `souple view`: what the world says goes to the picture and the panels, what a person does goes back.

import "uplot/dist/uPlot.min.css";
import "../style.css";
import { Connection, reload } from "./connection";
import type { Link, Message } from "./connection";
import type { ColourMap, Frame, NetworkShape, SceneInfo, Status, Surface, Wish } from "./protocol";
import { Display } from "./ui/display";
import { element, panel, remember, remembered } from "./ui/dom";
import { HandPanel } from "./ui/handling";
import { Legend } from "./ui/legend";
import { Notes } from "./ui/notes";
import type { Weight } from "./ui/notes";
import { Parameters } from "./ui/parameters";
import { photograph } from "./ui/photograph";
import { Plots } from "./ui/plots";
import { Scenes } from "./ui/scenes";
import { Stages } from "./ui/stages";
import { Transport } from "./ui/transport";
import { Grab } from "./view/grab";
import { Picture } from "./view/picture";

const DARK = "(prefers-color-scheme: dark)";
/** How often it is looked whether anything is in the picture [ms]: that costs a pass over all points. */
const LOOK_EVERY = 400;
/** Where the scene has its gravity. */
const GRAVITY = "world.gravity";
/** What a page says by itself, or says again when the connection is back. */
const UNTOLD = new Set<Wish["do"]>(["seen", "move", "release", "colour", "arrows", "inside"]);
/** What breaks a long step off. */
const AT_ONCE = new Set<Wish["do"]>(["pause", "reset", "load", "load_text"]);

/** What keys do, for who sees the page. */
const KEYS =
  "Keys: space plays and pauses, S makes one step, R begins anew, F shows everything, W draws surfaces another way. G pulls, O pushes, " +
  "T throws, P pins. H takes hold in the middle of the picture and lets go; arrows and page keys lead what is held, and turn the view or " +
  "come nearer where nothing is.";

class Page {
  private readonly notes = new Notes(place("notes"));
  private readonly title = element("h1", {}, "Souple");
  private readonly link = element("span", { class: "link" });
  private readonly failure = element("p", { class: "failure", role: "alert", hidden: true });
  private readonly transport = new Transport(
    (wish) => this.send(wish),
    (tool) => {
      if (this.grab) this.grab.tool = tool;
    },
  );
  private readonly display = new Display(() => this.applyLook(), {
    fit: () => this.picture.fit(),
    theme: () => this.chooseDark(!this.dark),
    influence: (body, frame) => this.send({ do: "influence", body, frame }),
  });
  private readonly hand = new HandPanel(
    (handling) => {
      if (this.grab) this.grab.handling = handling;
    },
    () => this.grab?.putAway(),
    (value) => this.parameters.change(GRAVITY, value),
  );
  private readonly parameters = new Parameters(
    (wish) => this.send(wish),
    (text) => this.notes.say("note", text),
  );
  private readonly plots = new Plots();
  private readonly scenes = new Scenes(
    (wish) => this.send(wish),
    (text) => this.notes.say("error", text),
  );
  private readonly stages = new Stages();
  private readonly legend = new Legend(place("legend"));
  private readonly description = element("p", { class: "description" });
  private grab: Grab | null = null;
  private readonly picture: Picture;
  private readonly connection: Connection;
  private maps: ColourMap[] = [];
  private info: SceneInfo | null = null;
  private surfaces: Surface[] = [];
  private networks: (NetworkShape | undefined)[] = [];
  private hasBegun = false;
  /** The last frame, while it is not drawn. */
  private frame: Frame | null = null;
  /** Frames that came since the last picture. */
  private unanswered = 0;
  /** What the world was asked to send along. */
  private asked: { field: string | null; arrows: string | null; inside: boolean } = { field: null, arrows: null, inside: false };
  private dark = false;
  /** Of the program. */
  private version: string | null = null;
  /** Frames drawn since the page was opened. */
  private pictures = 0;
  private lastLook = 0;
  private readonly sight = element(
    "p",
    { class: "sight", hidden: true },
    "Everything has moved out of the picture. ",
    element("button", { click: () => this.picture.fit() }, "Show it"),
  );

  private readonly reading = element("p", { class: "reading", hidden: true }, "The other scene is being read …");

  constructor() {
    const say = (text: string, weight: Weight = "error") => this.notes.say(weight, text);
    this.picture = new Picture(place("stage"), say, (picture) => {
      this.grab = new Grab(picture, (wish) => this.send(wish), say);
      this.grab.handling = this.hand.handling;
    });
    place("top").append(element("div", { class: "name" }, this.title, this.link), this.transport.root);
    place("side").append(
      panel("About", false, this.description, element("p", { class: "keys" }, KEYS)),
      this.display.root,
      this.hand.root,
      this.parameters.root,
      this.plots.root,
      this.scenes.root,
      panel("Downloads", false, this.downloads()),
      panel("Messages", false, this.notes.list),
    );
    place("bottom").append(this.stages.root);
    place("messages").prepend(this.failure);
    place("stage").append(this.sight, this.reading);
    this.setDark(this.isDark());
    // with the gap below it
    const legend = place("legend");
    new ResizeObserver(() => this.picture.setLegend(legend.hidden ? 0 : legend.offsetHeight + 12)).observe(legend);
    matchMedia(DARK).addEventListener("change", () => this.setDark(this.isDark()));
    window.addEventListener("keydown", (event) => this.key(event));
    this.freeKeys();
    this.connection = new Connection(
      (message) => this.receive(message),
      (link, why) => this.setLink(link, why),
    );
    const draw = () => {
      requestAnimationFrame(draw);
      this.draw();
    };
    requestAnimationFrame(draw);
  }

  private send(wish: Wish): void {
    const isSent = this.connection.send(wish);
    if (UNTOLD.has(wish.do)) return;
    if (!isSent) this.notes.say("warning", "The connection is lost: nothing was done.");
    else if (this.transport.isLong && !AT_ONCE.has(wish.do)) this.notes.say("note", "This is done when the step ends that goes on now.");
  }

  /** What was pressed or set by a pointer does not keep the keys; what keys have come to does. */
  private freeKeys(): void {
    let isPointer = false;
    window.addEventListener("pointerdown", () => (isPointer = true), { capture: true });
    window.addEventListener("keydown", () => (isPointer = false), { capture: true });
    const free = (event: Event) => {
      const used = (event.target as HTMLElement).closest<HTMLElement>("button, summary, select, input[type=range], input[type=checkbox]");
      if (isPointer) used?.blur();
    };
    // a list is open after a click on it, and a slider led to where it stays when it has changed
    window.addEventListener("click", (event) => (event.target as HTMLElement).closest("select") ?? free(event));
    window.addEventListener("change", free);
  }

  private receive(message: Message): void {
    switch (message.kind) {
      case "hello":
        // the program has been built anew, and may have brought another page
        if (this.version !== null && this.version !== message.version) reload();
        this.version = message.version;
        this.maps = message.colour_maps;
        this.display.setMaps(this.maps);
        this.scenes.set(message.scenes);
        this.scenes.page = message.page;
        this.hand.setTools(message.tools);
        this.asked = { field: null, arrows: null, inside: false };
        this.grab?.forget();
        break;
      case "scene":
        // what was said of another world
        this.notes.clear();
        this.describe(message, this.info);
        this.info = message;
        this.surfaces = [];
        this.networks = [];
        this.picture.clearTools();
        this.grab?.forget();
        this.hasBegun = false;
        this.begin();
        break;
      case "surface":
        if (message.scene === this.info?.scene) this.surfaces[message.index] = message;
        this.begin();
        break;
      case "network":
        if (message.scene === this.info?.scene) this.networks[message.index] = message;
        break;
      case "texture":
        if (message.scene === this.info?.scene) this.picture.setTexture(message);
        break;
      case "inside":
        if (message.scene === this.info?.scene) this.picture.setInside(message);
        break;
      case "tool":
        if (message.scene === this.info?.scene) this.picture.addTool(message);
        break;
      case "adjustables":
        this.parameters.set(message);
        this.hand.setGravity(message.adjustables.find(({ path }) => path === GRAVITY));
        break;
      case "pins":
        message.pins.forEach((points, body) => this.picture.setPins(body, points));
        break;
      case "influence":
        this.display.setInfluence(message, this.info?.bodies ?? []);
        for (const field of this.info?.fields ?? []) if (field.title !== null) field.title = message.title;
        this.repaint();
        break;
      case "status":
        this.setStatus(message);
        break;
      case "refused":
        // what a panel shows beside the value is said once
        if (message.about === "set" && this.parameters.refuse(message.message)) this.notes.keep("error", message.message);
        else this.notes.say("error", message.message);
        break;
      case "warning":
        this.notes.say("warning", message.message);
        break;
      case "frame":
        this.frame = message;
        this.unanswered += 1;
        // a page that is hidden draws none, and is there all the same
        if (document.hidden) this.answer();
        break;
      case "samples":
        if (message.scene === this.info?.scene) this.plots.push(message);
        break;
    }
  }

  /** `before` is the scene that was there: the same one begun anew says nothing again. */
  private describe(info: SceneInfo, before: SceneInfo | null): void {
    this.title.textContent = info.title || info.name;
    document.title = `${info.title || info.name} – Souple`;
    // lines of a scene file end where its author's screen did; paragraphs are meant
    const paragraphs = info.description.trim().split(/\n\s*\n/);
    this.description.textContent = paragraphs.map((text) => text.replace(/\s*\n\s*/g, " ")).join("\n\n") || "The scene has no description.";
    this.parameters.setScene(info.name, info.is_file);
    this.scenes.setCurrent(info.name);
    this.plots.begin(info.probes);
    this.stages.begin(info);
    const said = before?.name === info.name ? before.warnings : [];
    info.warnings.filter((warning) => !said.includes(warning)).forEach((warning) => this.notes.say("warning", warning));
  }

  /** Begins to draw when all surfaces are there. */
  private begin(): void {
    const { info } = this;
    if (!info || this.hasBegun) return;
    const count = info.bodies.length + info.obstacles.filter(({ form }) => form === "surface").length;
    if (this.surfaces.filter(Boolean).length < count) return;
    this.hasBegun = true;
    this.transport.restart();
    this.picture.begin(info, this.surfaces, this.networks);
    this.display.setArrows(info.arrows, info.counts["rigid_frames"] !== undefined || info.counts["affine_frames"] !== undefined);
    this.display.setFields(info);
  }

  private applyLook(): void {
    const { look } = this.display;
    const map = this.maps.find(({ name }) => name === look.map) ?? this.maps[0];
    const fields = this.info?.fields ?? [];
    const index = fields.findIndex(({ name }) => name === look.field);
    const { asked } = this;
    const inside = look.cut !== null || look.explode > 0;
    if (look.field !== asked.field) this.send({ do: "colour", field: look.field });
    if (look.arrows !== asked.arrows) this.send({ do: "arrows", of: look.arrows });
    if (inside !== asked.inside) this.send({ do: "inside", is_shown: inside });
    this.asked = { field: look.field, arrows: look.arrows, inside };
    if (map) this.picture.setColours(index, fields[index], map);
    this.legend.set(fields[index] ?? null, map, this.info?.arrows.find(({ name }) => name === look.arrows) ?? null);
    this.picture.setStyle(look.style, this.dark);
    this.picture.setCut(look.cut);
    this.picture.follow(look.follow);
    const arrows = (this.info?.arrows ?? []).findIndex(({ name }) => name === look.arrows);
    const unit = this.info?.arrows[arrows]?.unit ?? "";
    this.picture.setExtras({ arrows, unit, explode: look.explode, axes: look.axes });
    // a world that is paused sends no frame that would bring it about
    this.repaint();
  }

  private repaint(): void {
    this.picture.repaint();
    this.legend.show(this.picture.meanings);
  }

  private setStatus(status: Status): void {
    this.transport.setStatus(status);
    this.failure.hidden = status.mode !== "failed";
    if (status.message && status.message !== this.failure.dataset.message) {
      this.failure.dataset.message = status.message;
      this.failure.replaceChildren(
        element("b", {}, "The world has stopped. "),
        `${status.message.charAt(0).toUpperCase()}${status.message.slice(1)}. `,
        element("button", { click: () => this.send({ do: "reset" }) }, "Reset"),
      );
      this.notes.keep("error", status.message);
    }
    document.body.classList.toggle("busy", status.busy !== null);
    this.reading.hidden = status.busy !== "load";
  }

  private setLink(link: Link, why: string): void {
    // while it is tried again the words stay
    if (link !== "connecting" || !this.link.textContent) this.link.textContent = link === "connecting" ? "connecting" : why;
    document.body.classList.toggle("lost", link !== "open");
    this.transport.restart();
    // what is pressed while nobody hears it would be lost
    for (const { root } of [this.transport, this.hand, this.parameters, this.scenes]) root.inert = link !== "open";
    // the connection that sent the last frames waits for no answer
    if (link !== "open") this.unanswered = 0;
  }

  /** Lets another frame come for each that came, also for those that a later one has replaced. */
  private answer(): void {
    for (; this.unanswered > 0; this.unanswered--) this.send({ do: "seen" });
  }

  private draw(): void {
    const { frame } = this;
    this.frame = null;
    // a frame of the scene before, or of one whose surfaces are still to come, counts as seen as well
    this.answer();
    if (frame) {
      if (this.hasBegun && frame.scene === this.info?.scene) {
        this.picture.show(frame);
        this.transport.show(frame);
        this.stages.show(frame);
        this.plots.follow(frame);
        this.plots.feel(frame.time, frame.hands.filter(({ page }) => page === this.scenes.page));
        this.legend.show(this.picture.meanings);
        document.body.dataset.frame = String(frame.number);
        document.body.dataset.pictures = String(++this.pictures);
        document.body.dataset.time = String(frame.time);
        document.body.dataset.factor = String(frame.realTimeFactor);
        document.body.dataset.cells = String(this.picture.cellCount);
      }
    } else if (this.hasBegun && !document.body.classList.contains("lost")) {
      this.transport.wait();
    }
    this.picture.draw();
    if (performance.now() - this.lastLook < LOOK_EVERY) return;
    this.lastLook = performance.now();
    this.sight.hidden = !this.reading.hidden || !this.picture.isOutOfSight;
  }

  /** As was chosen by hand; as the system has it where nothing was. */
  private isDark(): boolean {
    const chosen = remembered("theme");
    return chosen === null ? matchMedia(DARK).matches : chosen === "dark";
  }

  private chooseDark(dark: boolean): void {
    remember("theme", dark ? "dark" : "light");
    this.setDark(dark);
  }

  private setDark(dark: boolean): void {
    this.dark = dark;
    document.documentElement.dataset.theme = dark ? "dark" : "light";
    this.picture.setStyle(this.display.look.style, dark);
    this.plots.restyle();
    this.repaint();
  }

  private key(event: KeyboardEvent): void {
    const target = event.target as HTMLElement;
    if (event.ctrlKey || event.metaKey || event.altKey || /^(INPUT|SELECT|TEXTAREA)$/.test(target.tagName)) return;
    // panels are scrolled by the keys that lead a hand
    const mayLead = target === document.body || target === this.picture.canvas;
    const actions: Record<string, () => void> = {
      " ": () => this.transport.toggle(),
      s: () => this.send({ do: "step" }),
      r: () => this.send({ do: "reset" }),
      g: () => this.transport.take("pull"),
      p: () => this.transport.take("pin"),
      t: () => this.transport.take("throw"),
      o: () => this.transport.take("push"),
      w: () => this.display.nextStyle(),
      f: () => this.picture.fit(),
    };
    const name = event.key.toLowerCase();
    if (this.grab?.key(name, event.repeat, mayLead)) {
      event.preventDefault();
      return;
    }
    const action = actions[name];
    // what has the focus may be pressed by the space bar itself
    if (!action || (event.key === " " && target.closest("button, summary, a"))) return;
    event.preventDefault();
    // a key that is held is pressed once
    if (!event.repeat) action();
  }

  private downloads(): HTMLElement {
    const link = (path: string, text: string, title: string) =>
      element("a", { href: `${path}${location.search}`, title, download: "" }, text);
    const picture = element("button", { click: () => void this.savePicture() }, "Picture");
    return element(
      "div",
      { class: "buttons" },
      picture,
      link("recording", "Recording", "`souple replay` repeats it bit for bit"),
      link("snapshot", "State", "`souple run --resume` goes on from it"),
      link("report", "Report", "Counts, times, energies"),
    );
  }

  private async savePicture(): Promise<void> {
    const { info } = this;
    const time = Number(document.body.dataset.time ?? 0);
    const caption = {
      title: info?.title || info?.name || "",
      time: `${time.toFixed(3)} s`,
      legend: this.legend.caption,
    };
    const blob = await this.picture.atItsBest((drawing) => photograph(drawing, caption));
    if (!blob) return;
    const url = URL.createObjectURL(blob);
    element("a", { href: url, download: `${info?.short_name ?? "souple"}_${time.toFixed(3)}s.png` }).click();
    setTimeout(() => URL.revokeObjectURL(url), 1000);
  }
}

function place(id: string): HTMLElement {
  const found = document.getElementById(id);
  if (!found) throw new Error(`the page has no #${id}`);
  return found;
}

try {
  new Page();
} catch (error) {
  const text = `This page needs WebGL 2: ${error instanceof Error ? error.message : String(error)}`;
  place("messages").prepend(element("p", { class: "failure", role: "alert" }, text));
  throw error;
}
