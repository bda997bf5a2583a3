// How much a picture may cost: less where the machine is slow to draw.

/** What is left out, step by step. */
export const LEVELS = [
  { pixels: 2, shadows: true, reflections: true },
  { pixels: 1, shadows: true, reflections: true },
  { pixels: 1, shadows: false, reflections: true },
  { pixels: 0.75, shadows: false, reflections: false },
] as const;

export type Level = (typeof LEVELS)[number];

/** A picture takes too long beyond this [ms], in the mean over some of them. */
const SLOW_MS = 70;
const PICTURES = 8;

export class Quality {
  private level: number;
  private last = 0;
  private sum = 0;
  private count = 0;

  /** `?quality=3` in the address begins with the simplest. */
  constructor(private readonly changed: (level: Level) => void) {
    const asked = Number(new URLSearchParams(location.search).get("quality") ?? 0);
    this.level = Number.isInteger(asked) && asked in LEVELS ? asked : 0;
  }

  get now(): Level {
    return LEVELS[this.level]!;
  }

  /** A picture has been drawn at a time [ms]. */
  drawn(time: number): void {
    const took = time - this.last;
    this.last = time;
    // a page that was hidden is not slow
    if (took > 2000 || document.hidden) return;
    this.sum += took;
    this.count += 1;
    if (this.count < PICTURES) return;
    const mean = this.sum / this.count;
    this.sum = 0;
    this.count = 0;
    if (mean > SLOW_MS && this.level < LEVELS.length - 1) {
      this.level += 1;
      this.changed(this.now);
    }
  }
}
