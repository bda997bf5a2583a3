// Scenes to choose from, and files dropped on the page.

import type { CatalogueEntry, Wish } from "../protocol";
import { element, panel } from "./dom";

/** Longest text that the server takes [bytes]. */
const TEXT_MAX = 1_000_000;
/** Largest mesh that it takes [bytes]. */
const MESH_MAX = 64 * 2 ** 20;

export class Scenes {
  readonly root: HTMLElement;
  /** The number that refusals come back to. */
  page = 0;
  private readonly list = element("ul", { class: "scenes" });
  private readonly none = element("p", { class: "quiet", hidden: true }, "No scene has all these words.");
  private readonly wanted = element("input", {
    type: "text",
    id: "find-scene",
    placeholder: "Find a scene",
    "aria-label": "Find a scene by its name, title or description",
    spellcheck: "false",
  });

  constructor(
    private readonly send: (wish: Wish) => void,
    private readonly say: (text: string) => void,
  ) {
    const file = element("input", { type: "file", id: "file", hidden: true });
    file.addEventListener("change", () => {
      void this.open(file.files?.[0]);
      // the same file may be chosen again
      file.value = "";
    });
    this.root = panel(
      "Scenes",
      false,
      element("div", { class: "buttons" }, element("button", { click: () => file.click() }, "Open a file"), file),
      element("p", { class: "quiet" }, "A scene file or a mesh; it can be dropped on the page as well."),
      this.wanted,
      this.none,
      this.list,
    );
    this.wanted.addEventListener("input", () => this.find());
    window.addEventListener("dragover", (event) => event.preventDefault());
    window.addEventListener("drop", (event) => {
      event.preventDefault();
      void this.open(event.dataTransfer?.files[0]);
    });
  }

  set(scenes: CatalogueEntry[]): void {
    const entry = ({ name, title, description }: CatalogueEntry) =>
      element(
        "li",
        {},
        element(
          "button",
          { "data-scene": name, title: description, click: () => this.send({ do: "load", scene: name }) },
          element("b", {}, title),
          element("code", {}, name),
          element("small", {}, description.replaceAll("\n", " ")),
        ),
      );
    this.list.replaceChildren(...scenes.map(entry));
    this.find();
  }

  /** Leaves on the list what has all words that are wanted; says so where nothing has. */
  private find(): void {
    const words = this.wanted.value.toLowerCase().split(/\s+/);
    for (const entry of this.list.children) {
      const text = (entry.textContent ?? "").toLowerCase();
      (entry as HTMLElement).hidden = !words.every((word) => text.includes(word));
    }
    this.none.hidden = [...this.list.children].some((entry) => !(entry as HTMLElement).hidden);
  }

  setCurrent(name: string): void {
    this.list.querySelectorAll("button").forEach((button) => {
      const scene = button.dataset.scene ?? "";
      const current = name === scene || name.endsWith(`/${scene}/scene.toml`);
      button.setAttribute("aria-current", String(current));
    });
  }

  private async open(file: File | undefined): Promise<void> {
    if (!file) return;
    const isScene = file.name.endsWith(".toml");
    const most = isScene ? TEXT_MAX : MESH_MAX;
    if (file.size > most) {
      // the server would close the connection before it has read as much, and its reason would be lost
      this.say(`${file.name} has ${file.size} bytes; a ${isScene ? "scene" : "mesh"} may have ${most} here`);
    } else if (isScene) {
      this.send({ do: "load_text", name: file.name, text: await file.text() });
    } else {
      await this.sendMesh(file);
    }
  }

  /** A mesh or a closed surface becomes a soft body; what is neither is refused in words. */
  private async sendMesh(file: File): Promise<void> {
    const url = new URL("mesh", location.href);
    url.search = location.search;
    url.searchParams.set("name", file.name);
    url.searchParams.set("page", String(this.page));
    try {
      const answer = await fetch(url, { method: "POST", body: file });
      const said = answer.ok ? "" : (await answer.text()).trim();
      // what is wrong in a file is told with its name; that it is too large, or not let in, is not
      if (!answer.ok) this.say(said.startsWith(file.name) ? said : `${file.name}: ${said}`);
    } catch {
      this.say(`${file.name} could not be sent`);
    }
  }
}
