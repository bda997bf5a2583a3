// Colours of bodies, and maps from values to colours.

import { Color } from "three";
import type { Class, ColourMap, Scale } from "../protocol";

/** Bodies in colours of their own, where no field colours them: the same as in pictures. */
export const BODY_COLOURS = [0xd67a68, 0x7096c4, 0xa0b260, 0xcea860, 0xa080b8];
/** Links in a state beyond that of the start: yielded ones are amber; the same as in pictures. */
export const STATE_COLOURS = [0xe6aa28, 0x58a478, 0xaa60b4, 0x3c82be, 0xbe5a3c];
/** Axes x, y, z of frames. */
export const AXIS_COLOURS = [0xd23c3c, 0x2f9e4f, 0x3d6fd8];
export const OBSTACLE_COLOUR = 0x969eaa;

/** A map as 256 colours of three numbers in linear light. */
export function linearColours(map: ColourMap | Scale): Float32Array {
  const colours = new Float32Array(3 * 256);
  const colour = new Color();
  for (let i = 0; i < 256; i++) {
    colour.setStyle(`#${map.colours.slice(6 * i, 6 * i + 6)}`).toArray(colours, 3 * i);
  }
  return colours;
}

/** A map in which the colour of a class stands at its number, see `CLASS_RANGE`. */
export function coloursOf(classes: Class[]): Float32Array {
  const colours = new Float32Array(3 * 256);
  const colour = new Color();
  classes.slice(0, 256).forEach(({ colour: digits }, index) => colour.setStyle(`#${digits}`).toArray(colours, 3 * index));
  return colours;
}

/** Values of the first and the last colour. */
export interface Range {
  low: number;
  high: number;
}

/** The range in which numbers of classes are places in a map. */
export const CLASS_RANGE: Range = { low: 0, high: 255 };

/** A colour as three numbers in linear light. */
export function linearOf(colour: number): Float32Array {
  return new Float32Array(new Color(colour).toArray());
}

/** Where the colour of a value stands in a map. */
export function colourAt(value: number, { low, high }: Range): number {
  const scale = 255 / Math.max(high - low, 1e-30);
  return 3 * Math.min(255, Math.max(0, Math.round((value - low) * scale) || 0));
}

/** Colours of values, three numbers each. */
export function paint(values: Float32Array, range: Range, map: Float32Array, colours: Float32Array): void {
  const count = Math.min(values.length, colours.length / 3);
  for (let i = 0; i < count; i++) {
    const step = colourAt(values[i]!, range);
    colours[3 * i] = map[step]!;
    colours[3 * i + 1] = map[step + 1]!;
    colours[3 * i + 2] = map[step + 2]!;
  }
}
