// Scenes to choose from, and files dropped on the page.

import type { CatalogueEntry, Wish } from "../protocol";
import { element, panel } from "./dom";

/** Longest text that the server takes [bytes]. */
const TEXT_MAX = 1_000_000;

export class Scenes {
  readonly root: HTMLElement;
  /** The number that refusals come back to. */
  page = 0;
  private readonly list = element("ul", { class: "scenes" });

  constructor(
    private readonly send: (wish: Wish) => void,
    private readonly say: (text: string) => void,
  ) {
    this.root = panel("Scenes", false, this.list, element("p", { class: "quiet" }, "A scene file or a mesh can be dropped on the page."));
    window.addEventListener("dragover", (event) => event.preventDefault());
    window.addEventListener("drop", (event) => void this.drop(event));
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
          element("small", {}, description.replaceAll("\n", " ")),
        ),
      );
    this.list.replaceChildren(...scenes.map(entry));
  }

  setCurrent(name: string): void {
    this.list.querySelectorAll("button").forEach((button) => {
      const scene = button.dataset.scene ?? "";
      const current = name === scene || name.endsWith(`/${scene}/scene.toml`);
      button.setAttribute("aria-current", String(current));
    });
  }

  private async drop(event: DragEvent): Promise<void> {
    event.preventDefault();
    const file = event.dataTransfer?.files[0];
    if (!file) return;
    if (!file.name.endsWith(".toml")) {
      await this.sendMesh(file);
    } else if (file.size > TEXT_MAX) {
      this.say(`${file.name} is larger than the ${TEXT_MAX} bytes that a scene may have here`);
    } else {
      this.send({ do: "load_text", name: file.name, text: await file.text() });
    }
  }

  /** A mesh or a closed surface becomes a soft body; what is neither is refused in words. */
  private async sendMesh(file: File): Promise<void> {
    const url = new URL("mesh", location.href);
    url.search = location.search;
    url.searchParams.set("name", file.name.replace(/[^\w.-]/g, "_"));
    url.searchParams.set("page", String(this.page));
    try {
      const answer = await fetch(url, { method: "POST", body: file });
      if (!answer.ok) this.say(`${file.name}: ${(await answer.text()).trim()}`);
    } catch {
      this.say(`${file.name} could not be sent`);
    }
  }
}
