// How much a picture may cost: less where the machine is slow to draw.

/** What is left out, step by step. */
export const LEVELS = [
  { pixels: 2, shadows: true, reflections: true },
  { pixels: 1, shadows: true, reflections: true },
  { pixels: 1, shadows: false, reflections: true },
  { pixels: 0.75, shadows: false, reflections: false },
] as const;

export type Level = (typeof LEVELS)[number];

/** A picture takes too long beyond this [ms]; the machine is slow when more than half of some of them do. */
const SLOW_MS = 70;
const PICTURES = 8;

export class Quality {
  private level: number;
  private last = 0;
  private slow = 0;
  private count = 0;
  /** Whether what was drawn last may not be on the screen yet. */
  private isDrawing = false;

  /** `?quality=3` in the address begins with the simplest. */
  constructor(private readonly changed: (level: Level) => void) {
    const asked = Number(new URLSearchParams(location.search).get("quality") ?? 0);
    this.level = Number.isInteger(asked) && asked in LEVELS ? asked : 0;
    // time spent hidden is not spent on drawing
    document.addEventListener("visibilitychange", () => (this.last = performance.now()));
  }

  get now(): Level {
    return LEVELS[this.level]!;
  }

  /** Does something at the best level there is; how long that takes tells nothing of the machine. */
  atBest<T>(work: () => T): T {
    const { level } = this;
    const to = (next: number) => {
      this.level = next;
      this.changed(this.now);
      this.last = performance.now();
    };
    to(0);
    try {
      return work();
    } finally {
      to(level);
    }
  }

  /** There was nothing to draw at a time [ms]: the picture before is there, and took until now at most. */
  rested(time: number): void {
    if (this.isDrawing) this.took(time - this.last);
    this.isDrawing = false;
    this.last = time;
  }

  /** A picture has been drawn at a time [ms]. */
  drawn(time: number): void {
    if (this.isDrawing) this.took(time - this.last);
    this.isDrawing = true;
    this.last = time;
  }

  /** A picture took so long [ms]. */
  private took(time: number): void {
    if (time > SLOW_MS) this.slow += 1;
    this.count += 1;
    if (this.count < PICTURES) return;
    const isSlow = 2 * this.slow > PICTURES;
    this.slow = 0;
    this.count = 0;
    if (isSlow && this.level < LEVELS.length - 1) {
      this.level += 1;
      this.changed(this.now);
    }
  }
}
