// The mouse, pen and fingers on bodies: pull, pin, throw.

import { Vector3 } from "three";
import type { Vector, Wish } from "../protocol";
import type { Hit, Picture } from "./picture";

export type Tool = "pull" | "pin" | "throw";

interface Held {
  hand: number;
  body: number;
  start: Vector3;
  tool: Tool;
  last: Vector3;
}

/** What a hand takes hold of: a part of the bodies' diagonal. */
const PATCH = 0.045;
/** A throw is as fast as if the way pulled were gone in this time [s]. */
const THROW_SECONDS = 0.25;

export class Grab {
  tool: Tool = "pull";
  strength = 1;
  private readonly held = new Map<number, Held>();
  private lastHover = 0;

  constructor(
    private readonly picture: Picture,
    private readonly send: (wish: Wish) => void,
  ) {
    const { canvas } = picture;
    canvas.addEventListener("pointerdown", (event) => this.down(event));
    canvas.addEventListener("pointermove", (event) => this.move(event));
    canvas.addEventListener("pointerup", (event) => this.up(event));
    canvas.addEventListener("pointercancel", (event) => this.up(event));
  }

  private down(event: PointerEvent): void {
    if (event.button !== 0 || event.shiftKey || event.ctrlKey || event.metaKey) return;
    const hit = this.picture.hit(event);
    if (!hit) return;
    if (this.tool === "pin") {
      this.pin(hit);
    } else {
      const hand = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9].find((n) => ![...this.held.values()].some((h) => h.hand === n)) ?? 0;
      const held: Held = { hand, body: hit.body.index, start: hit.point, tool: this.tool, last: hit.point.clone() };
      this.held.set(event.pointerId, held);
      if (this.tool === "pull") {
        this.send({ do: "grab", hand, body: held.body, points: this.patch(hit), strength: this.strength });
      }
      this.picture.canvas.setPointerCapture(event.pointerId);
    }
    // the camera is not to turn with it
    this.picture.controls.enabled = false;
    this.picture.canvas.style.cursor = "grabbing";
  }

  private move(event: PointerEvent): void {
    const held = this.held.get(event.pointerId);
    if (!held) {
      if (event.buttons === 0) this.hover(event);
      return;
    }
    const place = this.picture.onPlane(event, held.start);
    if (!place) return;
    held.last = place;
    if (held.tool === "pull") {
      this.send({ do: "move", hand: held.hand, offset: place.clone().sub(held.start).toArray() as Vector });
    }
  }

  private up(event: PointerEvent): void {
    const held = this.held.get(event.pointerId);
    this.held.delete(event.pointerId);
    if (held?.tool === "pull") this.send({ do: "release", hand: held.hand });
    if (held?.tool === "throw") {
      const velocity = held.last.clone().sub(held.start).divideScalar(THROW_SECONDS);
      if (velocity.length() > 0) this.send({ do: "throw", body: held.body, velocity: velocity.toArray() as Vector });
    }
    if (this.held.size === 0) {
      this.picture.controls.enabled = true;
      this.picture.canvas.style.cursor = "";
    }
  }

  private pin(hit: Hit): void {
    const points = this.patch(hit);
    const nearest = points[0];
    const pinned = nearest !== undefined && hit.body.isPinned(nearest);
    this.send({ do: pinned ? "unpin" : "pin", body: hit.body.index, points });
    // without a hand on anything the camera is free again at once
    requestAnimationFrame(() => (this.picture.controls.enabled = this.held.size === 0));
  }

  private patch(hit: Hit): number[] {
    const { body, point, normal } = hit;
    for (let reach = PATCH; reach < 1; reach *= 1.5) {
      const points = body.pointsNear(point, normal, reach * this.picture.size);
      if (points.length >= 3) return points;
    }
    return body.pointsNear(point, normal, this.picture.size);
  }

  /** Shows that what is under the mouse can be taken; now and then, since it costs a search. */
  private hover(event: PointerEvent): void {
    if (event.timeStamp - this.lastHover < 80) return;
    this.lastHover = event.timeStamp;
    this.picture.canvas.style.cursor = this.picture.hit(event) ? "grab" : "";
  }
}
