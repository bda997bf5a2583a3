// The page of `souple view`: what the world says goes to the picture and the panels, what a person does goes back.

import "uplot/dist/uPlot.min.css";
import "../style.css";
import { Connection } from "./connection";
import type { Link, Message } from "./connection";
import type { ColourMap, Frame, NetworkShape, SceneInfo, Status, Surface, Wish } from "./protocol";
import { Display } from "./ui/display";
import { element, panel, remember, remembered } from "./ui/dom";
import { HandPanel } from "./ui/handling";
import { Legend } from "./ui/legend";
import { Notes } from "./ui/notes";
import { Parameters } from "./ui/parameters";
import { Plots } from "./ui/plots";
import { Scenes } from "./ui/scenes";
import { Stages } from "./ui/stages";
import { Transport } from "./ui/transport";
import { Grab } from "./view/grab";
import { Picture } from "./view/picture";

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
    theme: () => this.setDark(!this.dark),
  });
  private readonly hand = new HandPanel(
    (handling) => {
      if (this.grab) this.grab.handling = handling;
    },
    () => this.grab?.putAway(),
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
  private frame: Frame | null = null;
  /** What the world was asked to send along. */
  private asked: { field: string | null; arrows: string | null; inside: boolean } = { field: null, arrows: null, inside: false };
  private dark = remembered("theme") === null ? matchMedia("(prefers-color-scheme: dark)").matches : remembered("theme") === "dark";

  constructor() {
    this.picture = new Picture(place("stage"), (picture) => {
      this.grab = new Grab(picture, (wish) => this.send(wish));
      this.grab.handling = this.hand.handling;
    });
    place("top").append(element("div", { class: "name" }, this.title, this.link), this.transport.root);
    place("side").append(
      panel("About", false, this.description),
      this.display.root,
      this.hand.root,
      this.parameters.root,
      this.plots.root,
      this.scenes.root,
      panel("Downloads", false, this.downloads()),
      panel("Messages", false, this.notes.list),
    );
    place("bottom").append(this.stages.root);
    document.body.append(this.failure);
    this.setDark(this.dark);
    window.addEventListener("keydown", (event) => this.key(event));
    this.connection = new Connection(
      (message) => this.receive(message),
      (link) => this.setLink(link),
    );
    const draw = () => {
      requestAnimationFrame(draw);
      this.draw();
    };
    requestAnimationFrame(draw);
  }

  private send(wish: Wish): void {
    this.connection.send(wish);
  }

  private receive(message: Message): void {
    switch (message.kind) {
      case "hello":
        this.maps = message.colour_maps;
        this.display.setMaps(this.maps);
        this.scenes.set(message.scenes);
        this.scenes.page = message.page;
        this.hand.setTools(message.tools);
        this.asked = { field: null, arrows: null, inside: false };
        this.grab?.forget();
        break;
      case "scene":
        this.info = message;
        this.surfaces = [];
        this.networks = [];
        this.picture.tools.clear();
        this.grab?.forget();
        this.hasBegun = false;
        this.describe(message);
        this.begin();
        break;
      case "surface":
        if (message.scene === this.info?.scene) this.surfaces[message.index] = message;
        this.begin();
        break;
      case "network":
        if (message.scene === this.info?.scene) this.networks[message.index] = message;
        break;
      case "inside":
        if (message.scene === this.info?.scene) this.picture.setInside(message);
        break;
      case "tool":
        if (message.scene === this.info?.scene) this.picture.addTool(message);
        break;
      case "adjustables":
        this.parameters.set(message);
        break;
      case "pins":
        message.pins.forEach((points, body) => this.picture.bodies[body]?.setPins(points));
        break;
      case "status":
        this.setStatus(message);
        break;
      case "refused":
        this.notes.say("error", message.message);
        break;
      case "frame":
        this.frame = message;
        break;
      case "samples":
        if (message.scene === this.info?.scene) this.plots.push(message);
        break;
    }
  }

  private describe(info: SceneInfo): void {
    this.title.textContent = info.title || info.name;
    document.title = `${info.title || info.name} – Souple`;
    this.description.textContent = info.description || "The scene has no description.";
    this.parameters.setScene(info.name);
    this.scenes.setCurrent(info.name);
    this.plots.begin(info.probes);
    this.stages.begin(info);
    info.warnings.forEach((warning) => this.notes.say("warning", warning));
  }

  /** Begins to draw when all surfaces are there. */
  private begin(): void {
    const { info } = this;
    if (!info || this.hasBegun) return;
    const count = info.bodies.length + info.obstacles.filter(({ form }) => form === "surface").length;
    if (this.surfaces.filter(Boolean).length < count) return;
    this.hasBegun = true;
    this.picture.begin(info, this.surfaces, this.networks);
    this.picture.fit();
    this.display.setArrows(info.arrows, info.counts["rigid_frames"] !== undefined || info.counts["affine_frames"] !== undefined);
    this.display.setFields(info.fields);
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
    this.legend.set(fields[index] ?? null, map);
    this.picture.setStyle(look.style, this.dark);
    this.picture.setCut(look.cut);
    const arrows = (this.info?.arrows ?? []).findIndex(({ name }) => name === look.arrows);
    this.picture.setExtras({ arrows, explode: look.explode, axes: look.axes });
  }

  private setStatus(status: Status): void {
    this.transport.setStatus(status);
    this.failure.hidden = status.mode !== "failed";
    if (status.message && status.message !== this.failure.dataset.message) {
      this.failure.dataset.message = status.message;
      this.failure.replaceChildren(
        element("b", {}, "The world has stopped. "),
        status.message,
        element("button", { click: () => this.send({ do: "reset" }) }, "Reset"),
      );
      this.notes.say("error", status.message);
    }
    document.body.classList.toggle("busy", status.busy !== null);
  }

  private setLink(link: Link): void {
    this.link.textContent = link === "open" ? "" : link === "lost" ? "connection lost, trying again" : "connecting";
    document.body.classList.toggle("lost", link !== "open");
  }

  private draw(): void {
    const { frame } = this;
    this.frame = null;
    if (frame) {
      // a frame of the scene before, or of one whose surfaces are still to come, counts as seen as well
      this.send({ do: "seen" });
      if (this.hasBegun && frame.scene === this.info?.scene) {
        this.picture.show(frame);
        this.transport.show(frame);
        this.stages.show(frame);
        this.legend.show(this.picture.range, this.picture.classes);
        document.body.dataset.frame = String(frame.number);
        document.body.dataset.time = String(frame.time);
        document.body.dataset.cells = String(this.picture.cellCount);
      }
    }
    this.picture.draw();
  }

  private setDark(dark: boolean): void {
    this.dark = dark;
    document.documentElement.dataset.theme = dark ? "dark" : "light";
    remember("theme", dark ? "dark" : "light");
    this.picture.setStyle(this.display.look.style, dark);
  }

  private key(event: KeyboardEvent): void {
    const target = event.target as HTMLElement;
    if (event.ctrlKey || event.metaKey || event.altKey || /^(INPUT|SELECT|TEXTAREA)$/.test(target.tagName)) return;
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
    if (this.grab?.key(name)) {
      event.preventDefault();
      return;
    }
    const action = actions[name];
    if (!action || (event.key === " " && target.tagName === "BUTTON")) return;
    event.preventDefault();
    action();
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
    const blob = await this.picture.save();
    if (!blob) return;
    const url = URL.createObjectURL(blob);
    element("a", { href: url, download: "souple.png" }).click();
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
  document.body.append(element("p", { class: "failure", role: "alert" }, text));
  throw error;
}
