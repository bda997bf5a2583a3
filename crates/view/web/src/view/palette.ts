// Colours of bodies, and maps from values to colours.

import { Color } from "three";
import type { ColourMap } from "../protocol";

/** Bodies in colours of their own, where no field colours them: the same as in pictures. */
export const BODY_COLOURS = [0xd67a68, 0x7096c4, 0xa0b260, 0xcea860, 0xa080b8];
export const OBSTACLE_COLOUR = 0x969eaa;

/** A map as 256 colours of three numbers in linear light. */
export function linearColours(map: ColourMap): Float32Array {
  const colours = new Float32Array(3 * 256);
  const colour = new Color();
  for (let i = 0; i < 256; i++) {
    colour.setStyle(`#${map.colours.slice(6 * i, 6 * i + 6)}`).toArray(colours, 3 * i);
  }
  return colours;
}

/** Values of the first and the last colour. */
export interface Range {
  low: number;
  high: number;
}

/** Colours of values, three numbers each. */
export function paint(values: Float32Array, range: Range, map: Float32Array, colours: Float32Array): void {
  const scale = 255 / Math.max(range.high - range.low, 1e-30);
  for (let i = 0; i < values.length; i++) {
    const step = 3 * Math.min(255, Math.max(0, Math.round((values[i]! - range.low) * scale) || 0));
    colours[3 * i] = map[step]!;
    colours[3 * i + 1] = map[step + 1]!;
    colours[3 * i + 2] = map[step + 2]!;
  }
}
