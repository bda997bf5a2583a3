// Hands on the world: an arrow from what is held to where it is pulled, with the force in numbers.

import { ArrowHelper, Group, Mesh, MeshBasicMaterial, SphereGeometry, Vector3 } from "three";
import type { Camera } from "three";
import { quantity } from "../format";
import type { HandShown } from "../protocol";

/** Where something will be thrown, and how fast [m/s]. */
export interface Aim {
  from: Vector3;
  to: Vector3;
  speed: number;
}

const COLOUR = 0xf2a33a;
/** Of numbers from the edge of the picture [px]. */
const MARGIN = 6;
/** Length of the arrow of a tool, in the size of all bodies. */
const TOOL_ARROW = 0.12;

interface Shown {
  arrow: ArrowHelper;
  grip: Mesh<SphereGeometry, MeshBasicMaterial>;
  label: HTMLElement;
  place: Vector3;
}

export class Hands {
  readonly group = new Group();
  private shown: Shown[] = [];
  private last: HandShown[] = [];
  private aimed: Aim | null = null;

  constructor(
    private readonly labels: HTMLElement,
    private readonly size: () => number,
  ) {}

  /** Shows where something will be thrown; null: nothing will. */
  aim(aimed: Aim | null): void {
    if (aimed === this.aimed) return;
    this.aimed = aimed;
    this.update(this.last);
  }

  update(hands: HandShown[]): void {
    this.last = hands;
    const count = hands.length + (this.aimed ? 1 : 0);
    while (this.shown.length > count) this.drop();
    while (this.shown.length < count) this.add();
    hands.forEach((hand, index) => {
      const shown = this.shown[index]!;
      const { grip, label, place } = shown;
      const held = new Vector3().fromArray(hand.held);
      const force = new Vector3().fromArray(hand.force);
      place.fromArray(hand.place);
      // of a tool the arrow tells the way it pushes, not where it is led to
      if (hand.holds === "tool") place.copy(held);
      if (hand.holds === "tool" && force.length() > 0) place.addScaledVector(force, (TOOL_ARROW * this.size()) / force.length());
      this.point(shown, held);
      grip.visible = hand.holds === "body";
      label.textContent = quantity(force.length(), "N");
    });
    const shown = this.shown[hands.length];
    if (!this.aimed || !shown) return;
    shown.place.copy(this.aimed.to);
    this.point(shown, this.aimed.from);
    shown.grip.visible = true;
    shown.label.textContent = quantity(this.aimed.speed, "m/s");
  }

  /** Points the arrow from a place to where its number stands. */
  private point({ arrow, grip, place }: Shown, from: Vector3): void {
    const pull = place.clone().sub(from);
    const length = Math.max(pull.length(), 1e-9);
    arrow.visible = length > 1e-6 * this.size();
    const head = Math.min(0.035 * this.size(), 0.6 * length);
    arrow.position.copy(from);
    arrow.setDirection(pull.divideScalar(length));
    arrow.setLength(length, head, 0.55 * head);
    grip.position.copy(from);
    grip.scale.setScalar(this.size());
  }

  /** Puts the numbers where the arrows end on the screen. */
  placeLabels(camera: Camera, width: number, height: number): void {
    for (const { label, place } of this.shown) {
      const at = place.clone().project(camera);
      // a hand may lead far out of the picture: its number stays at the edge
      const within = (wanted: number, most: number) => Math.min(Math.max(wanted, MARGIN), Math.max(most - MARGIN, MARGIN));
      const left = within(((at.x + 1) / 2) * width + 12, width - label.offsetWidth);
      const top = within(((1 - at.y) / 2) * height - 10, height - label.offsetHeight);
      label.style.transform = `translate(${left}px, ${top}px)`;
    }
  }

  private add(): void {
    const arrow = new ArrowHelper(new Vector3(1, 0, 0), new Vector3(), 1, COLOUR);
    const grip = new Mesh(new SphereGeometry(0.012, 16, 12), new MeshBasicMaterial({ color: COLOUR }));
    for (const thing of [arrow.line.material, arrow.cone.material, grip.material]) {
      // a hand inside a body is seen through it
      Object.assign(thing, { depthTest: false, transparent: true, toneMapped: false });
    }
    [arrow.line, arrow.cone, grip].forEach((thing) => (thing.renderOrder = 10));
    const label = document.createElement("span");
    label.className = "force";
    this.labels.append(label);
    this.group.add(arrow, grip);
    this.shown.push({ arrow, grip, label, place: new Vector3() });
  }

  private drop(): void {
    const last = this.shown.pop();
    if (!last) return;
    this.group.remove(last.arrow, last.grip);
    last.arrow.dispose();
    last.grip.geometry.dispose();
    last.grip.material.dispose();
    last.label.remove();
  }
}
