// The picture as a file: with its ground, what its colours mean, the scene and the time.

/** What stands beside the drawing. */
export interface Caption {
  title: string;
  time: string;
  /** Its lines, and the colours of its bar from low to high, with the numbers under it; none where nothing is coloured. */
  legend: { lines: string[]; bar: { colours: string[]; ends: string[] } | null; classes: { name: string; colour: string }[] };
}

/** Pixels of a line of text in a picture as high as `FULL`. */
const LINE = 20;
const FULL = 720;

/** A drawing on its ground, captioned. */
export function photograph(drawing: HTMLCanvasElement, caption: Caption): Promise<Blob | null> {
  const canvas = document.createElement("canvas");
  const { width, height } = drawing;
  Object.assign(canvas, { width, height });
  const context = canvas.getContext("2d");
  if (!context) return Promise.resolve(null);
  const style = getComputedStyle(document.documentElement);
  const ground = context.createLinearGradient(0, 0, 0, height);
  ground.addColorStop(0, style.getPropertyValue("--back-top"));
  ground.addColorStop(1, style.getPropertyValue("--back-bottom"));
  context.fillStyle = ground;
  context.fillRect(0, 0, width, height);
  context.drawImage(drawing, 0, 0);
  const scale = Math.max(height / FULL, 0.5);
  context.scale(scale, scale);
  context.fillStyle = style.getPropertyValue("--text");
  context.font = "600 16px system-ui, sans-serif";
  context.textBaseline = "top";
  const [right, bottom] = [width / scale - LINE, height / scale - LINE];
  context.fillText(caption.title, LINE, LINE, right - 8 * LINE);
  context.font = "14px system-ui, sans-serif";
  context.textAlign = "right";
  context.fillText(caption.time, right, LINE);
  context.textAlign = "left";
  putLegend(context, caption.legend, bottom);
  return new Promise((resolve) => canvas.toBlob(resolve, "image/png"));
}

/** From the bottom up: lines last to first. */
function putLegend(context: CanvasRenderingContext2D, { lines, bar, classes }: Caption["legend"], bottom: number): void {
  let y = bottom - LINE;
  const text = context.fillStyle;
  const put = (words: string, x: number) => context.fillText(words, x, y);
  for (const { name, colour } of [...classes].reverse()) {
    context.fillStyle = colour;
    context.fillRect(LINE, y + 1, 13, 13);
    context.fillStyle = text;
    put(name, LINE + 20);
    y -= LINE;
  }
  if (bar) {
    const width = 240;
    bar.ends.forEach((words, index) => {
      const share = index / Math.max(bar.ends.length - 1, 1);
      context.textAlign = share === 0 ? "left" : share === 1 ? "right" : "center";
      put(words, LINE + width * share);
    });
    context.textAlign = "left";
    const colours = context.createLinearGradient(LINE, 0, LINE + width, 0);
    bar.colours.forEach((colour, index) => colours.addColorStop(index / (bar.colours.length - 1), colour));
    context.fillStyle = colours;
    context.fillRect(LINE, y - 14, width, 12);
    context.fillStyle = text;
    y -= 14 + LINE;
  }
  for (const line of [...lines].reverse()) {
    put(line, LINE);
    y -= LINE;
  }
}
