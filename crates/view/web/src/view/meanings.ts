// What colours and arrows of the last picture stand for: the legend tells it.

import type { BodyFrame, FieldInfo } from "../protocol";
import { CLASS_RANGE } from "./palette";
import type { Range } from "./palette";

/**
 * What moves less than this part of the size of all bodies, or by as much in a second, rests: what is left is rounding, and what
 * solvers leave over.
 */
const REST = 1e-7;
/** Units in which the size of all bodies tells what is nothing. */
const OF_MOTION = new Set(["m", "m/s"]);

type Values = (Float32Array | undefined)[];

export class Meanings {
  /** Whether any body has values of the field. */
  hasValues = false;
  /** Of the values seen lately. */
  range: Range = { low: 0, high: 1 };
  /** Numbers of the classes that are seen, in order; none where colours stand for quantities. */
  classes: number[] = [];
  /** States of links that are seen, as frames number them, beyond the first; none where a field colours them. */
  linkStates: number[] = [];
  /** Length of the longest arrow, in its unit. */
  longest = 0;
  /** Diagonal of all bodies [m]. */
  size = 1;
  private hasClasses = false;
  /** It is not of the values seen. */
  private isFixed = false;
  private unit = "";

  /** Another field, or another world: values seen before tell nothing. */
  begin(field: FieldInfo | null): void {
    this.hasClasses = field !== null && field.classes !== null;
    const fixed = this.hasClasses ? CLASS_RANGE : field?.scale;
    this.isFixed = Boolean(fixed);
    this.unit = field?.unit ?? "";
    this.range = fixed ? { low: fixed.low, high: fixed.high } : { low: Infinity, high: -Infinity };
  }

  /** What counts as nothing in a unit. */
  rest(unit: string): number {
    return OF_MOTION.has(unit) ? REST * this.size : 0;
  }

  /**
   * Looks through the values of all bodies. Widens the range of colours at once, and lets it shrink by a part of what is too much:
   * a legend that jumps cannot be read.
   */
  follow(values: Values, bodies: BodyFrame[], shrinking: number): void {
    this.hasValues = values.some((list) => list !== undefined && list.length > 0);
    this.classes = this.hasClasses ? numbersIn(values) : [];
    this.linkStates = this.hasValues ? [] : numbersIn(bodies.map(({ linkStates }) => linkStates)).filter((state) => state > 1);
    if (!this.isFixed) this.fit(values, shrinking);
  }

  private fit(values: Values, shrinking: number): void {
    let low = Infinity;
    let high = -Infinity;
    for (const list of values) {
      for (const value of list ?? []) {
        // a world that blew up may have numbers that no scale has
        if (Math.abs(value) === Infinity) continue;
        if (value < low) low = value;
        if (value > high) high = value;
      }
    }
    if (low > high) return;
    const rest = this.rest(this.unit);
    // colours of what rests would show a motion that is none
    if (Math.max(high, -low) < rest) [low, high] = [0, rest];
    const { range } = this;
    const ease = (old: number, now: number, widens: boolean) =>
      widens || !Number.isFinite(old) ? now : old + shrinking * (now - old);
    range.low = ease(range.low, low, low < range.low);
    range.high = ease(range.high, high, high > range.high);
  }
}

/** The numbers that occur, in order. */
function numbersIn(lists: (ArrayLike<number> | undefined)[]): number[] {
  const seen = new Set<number>();
  for (const list of lists) for (let i = 0; i < (list?.length ?? 0); i++) seen.add(list![i]!);
  return [...seen].sort((a, b) => a - b);
}
