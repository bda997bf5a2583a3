// What comes over the wire and how it is read: version 1, see docs/protocol.md.

export const SUBPROTOCOL = "souple.v1";
const VERSION = 1;

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

export interface Hello {
  kind: "hello";
  page: number;
  version: string;
  colour_maps: ColourMap[];
  scenes: CatalogueEntry[];
}

export interface BodyInfo {
  name: string;
  points: number;
  cells: number;
  surface_points: number;
  surface_triangles: number;
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
  summary: string;
  unit: string;
}

export interface SceneInfo {
  kind: "scene";
  scene: number;
  name: string;
  title: string;
  description: string;
  period: number;
  up: Vector;
  direction: Vector;
  bodies: BodyInfo[];
  obstacles: ObstacleInfo[];
  probes: ProbeInfo[];
  fields: FieldInfo[];
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

export interface Status {
  kind: "status";
  mode: "waiting" | "playing" | "paused" | "failed";
  speed: number;
  busy: "reset" | "load" | "set" | null;
  message: string | null;
}

export interface Refused {
  kind: "refused";
  about: string;
  message: string;
}

export type Document = Hello | SceneInfo | Adjustables | Pins | Status | Refused;

export type Wish =
  | { do: "seen" | "play" | "pause" | "step" | "reset" }
  | { do: "speed"; factor: number }
  | { do: "load"; scene: string }
  | { do: "load_text"; name: string; text: string }
  | { do: "set"; path: string; value: string }
  | { do: "colour"; field: string | null }
  | { do: "grab"; hand: number; body: number; points: number[]; strength: number }
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
}

export interface HandShown {
  page: number;
  hand: number;
  held: Float32Array;
  place: Float32Array;
  force: Float32Array;
}

export interface BodyFrame {
  positions: Float32Array;
  fields: Map<number, Float32Array>;
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
}

export interface Samples {
  kind: "samples";
  scene: number;
  columns: number;
  /** Row after row. */
  numbers: Float64Array;
}

/** Reads a binary message; null for one of a version or kind that this page does not know. */
export function decode(buffer: ArrayBuffer): Surface | Frame | Samples | null {
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
    default:
      return null;
  }
}

function decodeSurface(buffer: ArrayBuffer, view: DataView, index: number, scene: number): Surface {
  const points = view.getUint32(8, true);
  const triangles = view.getUint32(12, true);
  return {
    kind: "surface",
    scene,
    index,
    points: new Float32Array(buffer, 16, 3 * points),
    triangles: new Uint32Array(buffer, 16 + 12 * points, 3 * triangles),
  };
}

function decodeFrame(buffer: ArrayBuffer, view: DataView, bodyCount: number, scene: number): Frame {
  let at = 68;
  const floats = (count: number): Float32Array => {
    const numbers = new Float32Array(buffer, at, count);
    at += 4 * count;
    return numbers;
  };
  const integer = (): number => {
    at += 4;
    return view.getUint32(at - 4, true);
  };
  const hands: HandShown[] = [];
  for (let i = view.getUint32(60, true); i > 0; i--) {
    hands.push({ page: integer(), hand: integer(), held: floats(3), place: floats(3), force: floats(3) });
  }
  const poses: Float32Array[] = [];
  for (let i = view.getUint32(64, true); i > 0; i--) poses.push(floats(12));
  const bodies: BodyFrame[] = [];
  for (let i = 0; i < bodyCount; i++) {
    const points = integer();
    const fieldCount = integer();
    const body: BodyFrame = { positions: floats(3 * points), fields: new Map() };
    for (let f = 0; f < fieldCount; f++) {
      const field = integer();
      body.fields.set(field, floats(points));
    }
    bodies.push(body);
  }
  return {
    kind: "frame",
    scene,
    number: view.getUint32(24, true),
    period: Number(view.getBigUint64(8, true)),
    time: view.getFloat64(16, true),
    realTimeFactor: view.getFloat32(28, true),
    stages: new Float32Array(buffer, 32, 5),
    iterations: new Float32Array(buffer, 52, 2),
    hands,
    poses,
    bodies,
  };
}
