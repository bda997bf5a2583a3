// What comes over the wire and how it is read: see docs/protocol.md.

const VERSION = 5;
export const SUBPROTOCOL = `souple.v${VERSION}`;

export type Vector = [number, number, number];

export interface ColourMap {
  name: string;
  summary: string;
  /** 256 colours of six hexadecimal digits. */
  colours: string;
}

export interface CatalogueEntry {
  name: string;
  title: string;
  description: string;
}

export interface ToolInfo {
  name: string;
  summary: string;
  /** How far its front is from its origin, in its size. */
  front: number;
  /** How far about its middle a flat front reaches, in its size; null: it is held from the eye. */
  flat: number | null;
}

export interface Hello {
  kind: "hello";
  page: number;
  version: string;
  colour_maps: ColourMap[];
  tools: ToolInfo[];
  scenes: CatalogueEntry[];
}

export interface BodyInfo {
  name: string;
  points: number;
  cells: number;
  surface_points: number;
  surface_triangles: number;
  links: number;
  /** Masses, and links between them if any. */
  is_network: boolean;
  /** Both sides of its triangles are seen. */
  is_sheet: boolean;
  /** A skin hides it. */
  is_worn: boolean;
  has_inside: boolean;
}

export interface SkinInfo {
  name: string;
  worn_by: number | null;
}

export type ObstacleInfo =
  | { form: "plane"; point: Vector; normal: Vector }
  | { form: "surface"; is_around: boolean };

export interface ProbeInfo {
  name: string;
  unit: string;
  quantity: string;
  components: 1 | 3;
}

export interface FieldInfo {
  name: string;
  /** What it is of, where the name does not say it; null: the name does. */
  title: string | null;
  summary: string;
  unit: string;
  /** Of cells: a value for each triangle of the surface, then one for each cell while the inside comes as well. */
  of: "points" | "links" | "cells";
  /** What the numbers stand for; null: they are quantities. */
  classes: Class[] | null;
  /** The colours that its numbers stand for, which nobody chooses: how a surface looks; null: they are quantities, or classes. */
  scale: Scale | null;
  /** The number of the field that comes along, of the blood that lies over how bodies look; null: none. */
  over: number | null;
  /** Whether anything in the scene has it. */
  is_here: boolean;
}

export interface Class {
  name: string;
  /** Six hexadecimal digits. */
  colour: string;
}

export interface Scale {
  /** 256 of six hexadecimal digits, from that of the lowest number to that of the highest. */
  colours: string;
  low: number;
  high: number;
}

export interface ArrowInfo {
  name: string;
  summary: string;
  unit: string;
}

export interface SceneInfo {
  kind: "scene";
  scene: number;
  name: string;
  /** For files. */
  short_name: string;
  /** Whether a file of its name holds it. */
  is_file: boolean;
  title: string;
  description: string;
  period: number;
  up: Vector;
  direction: Vector;
  bodies: BodyInfo[];
  skins: SkinInfo[];
  obstacles: ObstacleInfo[];
  probes: ProbeInfo[];
  fields: FieldInfo[];
  arrows: ArrowInfo[];
  counts: Record<string, number>;
  warnings: string[];
}

export interface Adjustable {
  path: string;
  group: string;
  name: string;
  summary: string;
  unit: string;
  type: "number" | "integer" | "boolean" | "vector" | "choice" | "text";
  choices: string[];
  low: number | null;
  high: number | null;
  /** As a scene file would write it; null: left to the program. */
  value: string | null;
}

export interface Adjustables {
  kind: "adjustables";
  adjustables: Adjustable[];
  settings: string[];
}

export interface Pins {
  kind: "pins";
  /** For each body the points of its surface that are held. */
  pins: number[][];
}

/** Whose weights the field `influence` shows. */
export interface Influence {
  kind: "influence";
  /** Of each body; null: no frames carry it. */
  bodies: ({ frames: number; shown: number } | null)[];
  /** Of the legend. */
  title: string | null;
}

export interface Status {
  kind: "status";
  mode: "waiting" | "playing" | "paused" | "stepping" | "failed";
  speed: number;
  busy: "reset" | "load" | "set" | null;
  message: string | null;
}

export interface Refused {
  kind: "refused";
  about: string;
  message: string;
}

/** What a value that was set makes doubtful. */
export interface Warning {
  kind: "warning";
  message: string;
}

export type Document = Hello | SceneInfo | Adjustables | Pins | Influence | Status | Warning | Refused;

export type Wish =
  | { do: "seen" | "play" | "pause" | "step" | "reset" }
  | { do: "speed"; factor: number }
  | { do: "load"; scene: string }
  | { do: "load_text"; name: string; text: string }
  | { do: "set"; path: string; value: string }
  | { do: "colour"; field: string | null }
  | { do: "arrows"; of: string | null }
  | { do: "influence"; body: number; frame: number }
  | { do: "inside"; is_shown: boolean }
  | { do: "grab"; hand: number; body: number; points: number[]; strength: number }
  | { do: "touch"; hand: number; tool: string; size: number; place: Vector; direction: Vector; strength: number }
  | { do: "move"; hand: number; offset: Vector }
  | { do: "release"; hand: number }
  | { do: "pin" | "unpin"; body: number; points: number[] }
  | { do: "throw"; body: number; velocity: Vector };

export interface Surface {
  kind: "surface";
  scene: number;
  index: number;
  points: Float32Array;
  triangles: Uint32Array;
  /** Of its elements: pairs of points. */
  edges: Uint32Array;
  /** From when until when each triangle is there [s]; empty where all stay. */
  spans: Float64Array;
  /** The same of edges. */
  edgeSpans: Float64Array;
}

/** What joins the points of a body, and how large they are. */
export interface NetworkShape {
  kind: "network";
  scene: number;
  index: number;
  /** Pairs of points. */
  links: Uint32Array;
  radii: Float32Array;
}

/** The cells of a body. */
export interface InsideShape {
  kind: "inside";
  scene: number;
  index: number;
  /** Four points and the cell, each. */
  tetrahedra: Uint32Array;
  /** Three points and the cell, each; those of a cell one after the other. */
  triangles: Uint32Array;
  /** When each cell goes [s]; empty where all stay. */
  dates: Float64Array;
}

/** The texture of a body. */
export interface TextureShape {
  kind: "texture";
  scene: number;
  index: number;
  /** 0: a picture; else the number of a pattern, from one. */
  figure: number;
  /** [m] */
  size: number;
  width: number;
  height: number;
  /** Two of three numbers in linear light, of a pattern. */
  colours: Float32Array;
  /** Four bytes each, from the upper row. */
  pixels: Uint8Array;
}

export interface ToolShape {
  kind: "tool";
  scene: number;
  page: number;
  hand: number;
  points: Float32Array;
  triangles: Uint32Array;
}

export interface HandShown {
  page: number;
  hand: number;
  holds: "body" | "tool";
  held: Float32Array;
  place: Float32Array;
  force: Float32Array;
}

export interface BodyFrame {
  positions: Float32Array;
  fields: Map<number, Float32Array>;
  arrows: Map<number, Float32Array>;
  /** Of each link: 0 where it does not hold, else its law's state and one; empty where none ever changes. */
  linkStates: Uint8Array;
  /** Origin and three axes of each frame that carries it. */
  frames: Float32Array;
}

export interface SkinFrame {
  positions: Float32Array;
  normals: Float32Array;
  triangles: Uint32Array;
}

export interface Frame {
  kind: "frame";
  scene: number;
  number: number;
  period: number;
  time: number;
  realTimeFactor: number;
  /** Milliseconds of a step: pairs, forces, assembly, solve, advance. */
  stages: Float32Array;
  /** Iterations of a step: Newton's, the linear solver's. */
  iterations: Float32Array;
  hands: HandShown[];
  /** Of each bounded obstacle: three axes and the origin. */
  poses: Float32Array[];
  bodies: BodyFrame[];
  skins: SkinFrame[];
  /** Ends of the straight pieces of all contours. */
  contours: Float32Array;
}

export interface Samples {
  kind: "samples";
  scene: number;
  columns: number;
  /** Row after row. */
  numbers: Float64Array;
}

export type Binary = Surface | Frame | Samples | NetworkShape | InsideShape | TextureShape | ToolShape;

/** Reads a binary message; null for one of a version or kind that this page does not know. */
export function decode(buffer: ArrayBuffer): Binary | null {
  const view = new DataView(buffer);
  if (buffer.byteLength < 16 || view.getUint8(1) !== VERSION) return null;
  const count = view.getUint16(2, true);
  const scene = view.getUint32(4, true);
  switch (view.getUint8(0)) {
    case 1:
      return decodeSurface(buffer, view, count, scene);
    case 2:
      return decodeFrame(buffer, view, count, scene);
    case 3: {
      const rows = view.getUint32(8, true);
      return { kind: "samples", scene, columns: count, numbers: new Float64Array(buffer, 16, rows * count) };
    }
    case 4: {
      const links = view.getUint32(8, true);
      const radii = view.getUint32(12, true);
      return {
        kind: "network",
        scene,
        index: count,
        links: new Uint32Array(buffer, 16, 2 * links),
        radii: new Float32Array(buffer, 16 + 8 * links, radii),
      };
    }
    case 5: {
      const tetrahedra = view.getUint32(8, true);
      const triangles = view.getUint32(12, true);
      return {
        kind: "inside",
        scene,
        index: count,
        tetrahedra: new Uint32Array(buffer, 16, 5 * tetrahedra),
        triangles: new Uint32Array(buffer, 16 + 20 * tetrahedra, 4 * triangles),
        dates: datesAt(view, 16 + 20 * tetrahedra + 16 * triangles, 1),
      };
    }
    case 7: {
      const width = view.getUint32(16, true);
      const height = view.getUint32(20, true);
      return {
        kind: "texture",
        scene,
        index: count,
        figure: view.getUint32(8, true),
        size: view.getFloat32(12, true),
        width,
        height,
        colours: new Float32Array(buffer, 24, 6),
        pixels: new Uint8Array(buffer, 48, 4 * width * height),
      };
    }
    case 6: {
      const points = view.getUint32(16, true);
      return {
        kind: "tool",
        scene,
        page: view.getUint32(8, true),
        hand: view.getUint32(12, true),
        points: new Float32Array(buffer, 24, 3 * points),
        triangles: new Uint32Array(buffer, 24 + 12 * points, 3 * view.getUint32(20, true)),
      };
    }
    default:
      return null;
  }
}

function decodeSurface(buffer: ArrayBuffer, view: DataView, index: number, scene: number): Surface {
  const points = view.getUint32(8, true);
  const triangles = view.getUint32(12, true);
  const afterTriangles = 16 + 12 * (points + triangles);
  const edges = view.getUint32(afterTriangles, true);
  const afterEdges = afterTriangles + 4 + 8 * edges;
  const spans = datesAt(view, afterEdges, 2);
  return {
    kind: "surface",
    scene,
    index,
    points: new Float32Array(buffer, 16, 3 * points),
    triangles: new Uint32Array(buffer, 16 + 12 * points, 3 * triangles),
    edges: new Uint32Array(buffer, afterTriangles + 4, 2 * edges),
    spans,
    edgeSpans: datesAt(view, afterEdges + 4 + 8 * spans.length, 2),
  };
}

/** Dates behind their count, so many of each thing that is counted; they may begin at any multiple of four. */
function datesAt(view: DataView, at: number, each: number): Float64Array {
  const count = each * view.getUint32(at, true);
  return Float64Array.from({ length: count }, (_, number) => view.getFloat64(at + 4 + 8 * number, true));
}

/** Reads numbers one after the other. */
class Reader {
  constructor(
    private readonly buffer: ArrayBuffer,
    private at: number,
  ) {}

  integer(): number {
    return this.integers(1)[0]!;
  }

  integers(count: number): Uint32Array {
    return new Uint32Array(this.buffer, this.pass(4 * count), count);
  }

  floats(count: number): Float32Array {
    return new Float32Array(this.buffer, this.pass(4 * count), count);
  }

  /** Followed by as many bytes as lead to a multiple of four. */
  bytes(count: number): Uint8Array {
    return new Uint8Array(this.buffer, this.pass(4 * Math.ceil(count / 4)), count);
  }

  list<T>(count: number, read: () => T): T[] {
    return Array.from({ length: count }, read);
  }

  private pass(length: number): number {
    this.at += length;
    return this.at - length;
  }
}

function decodeFrame(buffer: ArrayBuffer, view: DataView, bodyCount: number, scene: number): Frame {
  const read = new Reader(buffer, 60);
  const [handCount = 0, poseCount = 0, skinCount = 0] = read.integers(3);
  const hand = (): HandShown => {
    const [page = 0, number = 0, holds] = read.integers(3);
    return {
      page,
      hand: number,
      holds: holds === 1 ? "tool" : "body",
      held: read.floats(3),
      place: read.floats(3),
      force: read.floats(3),
    };
  };
  const body = (): BodyFrame => {
    const [points = 0, fields = 0, arrows = 0, links = 0, frames = 0] = read.integers(5);
    return {
      positions: read.floats(3 * points),
      fields: new Map(read.list(fields, () => [read.integer(), read.floats(read.integer())])),
      arrows: new Map(read.list(arrows, () => [read.integer(), read.floats(3 * points)])),
      linkStates: read.bytes(links),
      frames: read.floats(12 * frames),
    };
  };
  const skin = (): SkinFrame => {
    const [points = 0, triangles = 0] = read.integers(2);
    return { positions: read.floats(3 * points), normals: read.floats(3 * points), triangles: read.integers(3 * triangles) };
  };
  return {
    kind: "frame",
    scene,
    number: view.getUint32(24, true),
    period: Number(view.getBigUint64(8, true)),
    time: view.getFloat64(16, true),
    realTimeFactor: view.getFloat32(28, true),
    stages: new Float32Array(buffer, 32, 5),
    iterations: new Float32Array(buffer, 52, 2),
    hands: read.list(handCount, hand),
    poses: read.list(poseCount, () => read.floats(12)),
    bodies: read.list(bodyCount, body),
    skins: read.list(skinCount, skin),
    contours: read.floats(6 * read.integer()),
  };
}
