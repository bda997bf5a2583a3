// The mouse, pen, fingers and keys on bodies: pull, push, pin, throw.

import { Vector3 } from "three";
import type { Vector, Wish } from "../protocol";
import { BARE_HAND } from "../ui/handling";
import type { Handling } from "../ui/handling";
import type { Hit, Picture } from "./picture";

export type Tool = "pull" | "push" | "pin" | "throw";

interface Held {
  hand: number;
  body: number;
  /** Where the hand took hold; of a tool, where it was put. */
  start: Vector3;
  /** The place under the pointer then. */
  grip: Vector3;
  tool: Tool;
  last: Vector3;
  /** Where on the screen its pointer was when it was last led [px]; nowhere before. */
  pointer: [number, number];
  /** When it was last led before its picture [ms]. */
  moved: number;
}

/** What a hand takes hold of: a part of the bodies' diagonal, about a palm of an organ. On less of it a pull tears at few cells. */
const PATCH = 0.09;
/** A throw is as fast as if the way pulled were gone in this time [s]. */
const THROW_SECONDS = 0.25;
/** Hands that a page has. */
const HANDS = 10;
/** The key's hand among what is held; pointers have numbers from 0. */
const KEYS = -1;
/** The way of a key: to the right, up, and towards the eye. */
const DIRECTIONS: Record<string, [number, number, number]> = {
  arrowleft: [-1, 0, 0],
  arrowright: [1, 0, 0],
  arrowup: [0, 1, 0],
  arrowdown: [0, -1, 0],
  pageup: [0, 0, -1],
  pagedown: [0, 0, 1],
};
/** How far a press of an arrow key, and a notch of the wheel, lead a hand: parts of the bodies' diagonal. */
const KEY_STEP = 0.02;
const WHEEL_STEP = 0.012;
/** What a notch of a wheel says [px]; trackpads say less, and more often. */
const NOTCH = 100;
/** Movements between pictures are told this long after each other [ms]: a mouse says up to eight in a millisecond. */
const MOVES_MS = 4;
/** A tool stands as much farther off than it would touch, of the way to its front. */
const CLEARANCE = 1.02;

export class Grab {
  tool: Tool = "pull";
  handling: Handling = BARE_HAND;
  private readonly held = new Map<number, Held>();
  /** Fingers beside bodies that lead what another holds, as the wheel does: where they were last on the screen [px]. */
  private readonly leading = new Map<number, number>();
  /** Tools that were left where they are. */
  private readonly left: Held[] = [];
  private lastHover = 0;

  constructor(
    private readonly picture: Picture,
    private readonly send: (wish: Wish) => void,
    private readonly say: (text: string) => void,
  ) {
    const { canvas } = picture;
    canvas.tabIndex = 0;
    const what = [
      "The simulated world: drag bodies, or use the tool in the middle with H,",
      "lead it with the arrow and page keys, let go with H; with empty hands these keys turn the view",
    ];
    canvas.setAttribute("aria-label", what.join(" "));
    canvas.addEventListener("pointerdown", (event) => this.down(event));
    canvas.addEventListener("pointermove", (event) => this.move(event));
    // browsers keep movements back until they draw the next picture, and tell of them at once here, where they know it
    canvas.addEventListener("pointerrawupdate", (event) => this.moveAtOnce(event as PointerEvent));
    canvas.addEventListener("pointerup", (event) => this.up(event));
    canvas.addEventListener("pointercancel", (event) => this.up(event));
    // before the camera's own wheel
    canvas.addEventListener("wheel", (event) => this.wheel(event), { capture: true });
  }

  /** The connection was lost or the scene is another: nothing is held any more. */
  forget(): void {
    this.held.clear();
    this.leading.clear();
    this.left.length = 0;
    this.rest();
  }

  /** Lets go of every tool that was left. */
  putAway(): void {
    this.left.splice(0).forEach(({ hand }) => this.send({ do: "release", hand }));
  }

  /** Uses the tool in the middle of the picture, leads where that `mayLead`, lets go; whether the key was one of these. */
  key(name: string, isRepeat: boolean, mayLead: boolean): boolean {
    const held = this.held.get(KEYS);
    if (name === "escape" && this.held.size > 0) {
      // who escapes does not throw
      for (const [pointer, { tool }] of [...this.held]) {
        if (tool === "throw") this.drop(pointer);
        else this.end(pointer);
      }
      return true;
    }
    if (name === "h") {
      // a key that is held is pressed once
      if (isRepeat) return true;
      if (held) this.end(KEYS);
      else this.takeInTheMiddle();
      return true;
    }
    const direction = DIRECTIONS[name];
    if (!direction || !mayLead) return false;
    if (!held) {
      this.picture.eye.turn(direction);
      return true;
    }
    const step = KEY_STEP * this.picture.size;
    const place = held.last.clone();
    const axis = new Vector3();
    for (const [k, share] of direction.entries()) {
      place.addScaledVector(axis.setFromMatrixColumn(this.picture.eye.camera.matrixWorld, k), share * step);
    }
    this.lead(held, place);
    return true;
  }

  private takeInTheMiddle(): void {
    const { left, top, width, height } = this.picture.canvas.getBoundingClientRect();
    // what is nearest to the middle, along a spiral
    for (let k = 0; k < 200; k++) {
      const [angle, reach] = [2.4 * k, 0.03 * Math.sqrt(k) * Math.min(width, height)];
      const place = { clientX: left + width / 2 + reach * Math.cos(angle), clientY: top + height / 2 + reach * Math.sin(angle) };
      const hit = this.picture.hit(place);
      if (hit && this.tool === "pin") this.pin(hit);
      else if (hit) this.begin(KEYS, hit, this.tool);
      if (hit) return;
    }
    this.say("No body is about the middle of the picture: F shows all of them.");
  }

  private down(event: PointerEvent): void {
    if (event.button !== 0 || event.shiftKey || event.ctrlKey || event.metaKey) return;
    const hit = this.picture.hit(event);
    if (!hit) {
      if (event.pointerType === "touch" && this.held.size > 0) this.leading.set(event.pointerId, event.clientY);
      return;
    }
    if (this.tool === "pin") this.pin(hit);
    else {
      this.begin(event.pointerId, hit, this.tool);
      this.picture.canvas.setPointerCapture(event.pointerId);
    }
    // the camera is not to turn with it
    this.picture.eye.controls.enabled = false;
    this.picture.canvas.style.cursor = "grabbing";
  }

  private begin(pointer: number, hit: Hit, tool: Tool): void {
    const used = new Set([...this.held.values(), ...this.left].map(({ hand }) => hand));
    const hand = Array.from({ length: HANDS }, (_, n) => n).find((n) => !used.has(n));
    if (hand === undefined) {
      this.say(`All ${HANDS} hands hold something: put tools away in the panel “Hand” first.`);
      return;
    }
    const { body, point } = hit;
    const start = tool === "push" ? this.put(hand, hit) : point.clone();
    this.held.set(pointer, { hand, body: body.index, start, grip: point, tool, last: point.clone(), pointer: [NaN, NaN], moved: 0 });
    if (tool === "pull") {
      this.send({ do: "grab", hand, body: body.index, points: this.patch(hit), strength: this.handling.strength });
    }
  }

  /** Puts a tool before the nearest point of a body, which is what meets it; where that is. */
  private put(hand: number, hit: Hit): Vector3 {
    const { tool, strength, front, flat } = this.handling;
    const size = this.handling.size * this.picture.size;
    const patch = this.patch(hit);
    const nearest = patch[0];
    const point = nearest === undefined ? hit.point : new Vector3().fromArray(hit.body.positions, 3 * nearest);
    // a flat tool lies on the surface, before all that its front would meet there
    const normal = flat === null ? hit.normal : hit.body.normalAbout(patch, hit.normal);
    const ahead = flat === null ? 0 : this.freeAbove(point, normal, flat * size, 2 * CLEARANCE * front * size);
    const place = point.clone().addScaledVector(normal, CLEARANCE * front * size + ahead);
    const direction = (flat === null ? this.picture.eye.towards : normal).toArray() as Vector;
    this.send({ do: "touch", hand, tool, size, place: place.toArray() as Vector, direction, strength });
    return place;
  }

  /** How far above a plane through a point there is room for what is `thick`, within a radius. */
  private freeAbove(point: Vector3, normal: Vector3, radius: number, thick: number): number {
    let free = 0;
    // what stands in it lifts it, and then something else may
    for (;;) {
      const height = this.picture.heightAbove(point, normal, radius, free + thick);
      if (height <= free) return free;
      free = height;
    }
  }

  private move(event: PointerEvent): void {
    const before = this.leading.get(event.pointerId);
    if (before !== undefined) {
      this.leading.set(event.pointerId, event.clientY);
      this.leadAway((before - event.clientY) / this.picture.canvas.clientHeight);
      return;
    }
    const held = this.held.get(event.pointerId);
    if (held) this.follow(held, event);
    else if (event.buttons === 0) this.hover(event);
  }

  /** What is held follows, as often as makes a difference. */
  private moveAtOnce(event: PointerEvent): void {
    const held = this.held.get(event.pointerId);
    if (!held || event.timeStamp - held.moved < MOVES_MS) return;
    held.moved = event.timeStamp;
    this.follow(held, event);
  }

  private follow(held: Held, { clientX, clientY }: PointerEvent): void {
    const [x, y] = held.pointer;
    if (clientX === x && clientY === y) return;
    held.pointer = [clientX, clientY];
    const place = this.picture.eye.onPlane({ clientX, clientY }, held.last);
    if (place) this.lead(held, place);
  }

  /** Leads what is held to where its grip is at a place. */
  private lead(held: Held, place: Vector3): void {
    held.last = place;
    if (held.tool === "throw") {
      this.picture.aim({ from: held.start, to: place, speed: velocityOf(held).length() });
      return;
    }
    this.send({ do: "move", hand: held.hand, offset: place.clone().sub(held.grip).toArray() as Vector });
  }

  /** The wheel leads what is held away from the eye, or nearer. */
  private wheel(event: WheelEvent): void {
    const held = [...this.held.values()][0];
    if (!held || held.tool === "throw") return;
    event.preventDefault();
    event.stopImmediatePropagation();
    const notches = event.deltaMode === WheelEvent.DOM_DELTA_PIXEL ? event.deltaY / NOTCH : event.deltaY;
    this.leadAway(-WHEEL_STEP * Math.min(Math.max(notches, -1), 1));
  }

  /** Leads what was taken first away from the eye, by a part of the bodies' diagonal. */
  private leadAway(share: number): void {
    const held = [...this.held.values()][0];
    if (!held || held.tool === "throw") return;
    this.lead(held, held.last.clone().addScaledVector(this.picture.eye.towards, -share * this.picture.size));
  }

  private up(event: PointerEvent): void {
    this.leading.delete(event.pointerId);
    this.end(event.pointerId);
  }

  private end(pointer: number): void {
    const held = this.held.get(pointer);
    this.held.delete(pointer);
    if (held) this.letGo(held);
    this.rest();
  }

  /** Lets go as if nothing had been led. */
  private drop(pointer: number): void {
    this.held.delete(pointer);
    this.rest();
  }

  private letGo(held: Held): void {
    if (held.tool === "push" && this.handling.stays) this.left.push(held);
    else if (held.tool === "pull" || held.tool === "push") this.send({ do: "release", hand: held.hand });
    if (held.tool === "throw") {
      const velocity = velocityOf(held);
      if (velocity.length() > 0) this.send({ do: "throw", body: held.body, velocity: velocity.toArray() as Vector });
    }
  }

  /** Without a hand on anything the camera is free. */
  private rest(): void {
    if ([...this.held.values()].every(({ tool }) => tool !== "throw")) this.picture.aim(null);
    if (this.held.size > 0) return;
    this.leading.clear();
    this.picture.eye.controls.enabled = true;
    this.picture.canvas.style.cursor = "";
  }

  private pin(hit: Hit): void {
    const points = this.patch(hit);
    const nearest = points[0];
    const pinned = nearest !== undefined && hit.body.isPinned(nearest);
    this.send({ do: pinned ? "unpin" : "pin", body: hit.body.index, points });
    requestAnimationFrame(() => this.rest());
  }

  private patch(hit: Hit): number[] {
    const { body, point, normal } = hit;
    // of few masses one is enough
    const enough = Math.min(3, body.positions.length / 3);
    for (let reach = PATCH; reach < 1; reach *= 1.5) {
      const points = body.pointsNear(point, normal, reach * this.picture.size);
      if (points.length >= enough) return points;
    }
    return body.pointsNear(point, null, Infinity).slice(0, enough);
  }

  /** Shows that what is under the mouse can be taken; now and then, since it costs a search. */
  private hover(event: PointerEvent): void {
    if (event.timeStamp - this.lastHover < 80) return;
    this.lastHover = event.timeStamp;
    this.picture.canvas.style.cursor = this.picture.hit(event) ? "grab" : "";
  }
}

/** Of what would be thrown now. */
function velocityOf({ start, last }: Held): Vector3 {
  return last.clone().sub(start).divideScalar(THROW_SECONDS);
}
