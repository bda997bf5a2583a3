// A released program that shows a scene, and a page of it in a real browser.
//
// SOUPLE_PROGRAM and SOUPLE_CHROMIUM name the program and the browser; SOUPLE_PICTURES a folder for pictures to look at.

import { spawn } from "node:child_process";
import { once } from "node:events";
import { mkdir, readFile } from "node:fs/promises";
import { join, resolve } from "node:path";
import { fileURLToPath } from "node:url";
import { chromium } from "playwright-core";

const root = resolve(fileURLToPath(import.meta.url), "../../../../..");
const program = process.env.SOUPLE_PROGRAM ?? "souple";
const pictures = process.env.SOUPLE_PICTURES;
/** Machines that draw by software, several at once, are slow. */
export const PATIENCE = Number(process.env.SOUPLE_PATIENCE ?? 120_000);

/** The kind of binary messages that are frames. */
const FRAME = 2;

/** The program showing a scene. */
export class Program {
  static async open(...scene) {
    const opened = new Program();
    const stdio = ["ignore", "pipe", "ignore"];
    opened.child = spawn(program, ["view", ...scene, "--port", "0"], { cwd: root, stdio });
    const [line] = await Promise.race([
      once(opened.child.stdout, "data"),
      once(opened.child, "exit").then(() => Promise.reject(new Error(`souple view ${scene.join(" ")} has ended`))),
    ]);
    opened.url = String(line).trim().split("\n")[0];
    return opened;
  }

  /** Memory of the process that is in use [bytes]. */
  async memory() {
    const status = await readFile(`/proc/${this.child.pid}/status`, "utf8");
    return 1024 * Number(/VmRSS:\s+(\d+) kB/.exec(status)[1]);
  }

  async close() {
    if (this.child.exitCode !== null) return;
    this.child.kill("SIGINT");
    await once(this.child, "exit");
  }
}

export async function launch() {
  // without a graphics card the browser draws the world by software, and puts the page together without going through that
  const args = ["--no-sandbox", "--disable-dev-shm-usage"];
  if (pictures) await mkdir(pictures, { recursive: true });
  return chromium.launch({ executablePath: process.env.SOUPLE_CHROMIUM ?? "/usr/bin/chromium", args });
}

/**
 * A page that shows frames, drawn simply; errors that it says are kept, and frames and the answers to them are counted.
 */
export async function open(browser, url, options = {}) {
  const page = await browser.newPage({ viewport: { width: 800, height: 440 }, ...options });
  page.setDefaultTimeout(PATIENCE);
  const errors = [];
  page.on("console", (message) => message.type() === "error" && errors.push(message.text()));
  page.on("pageerror", (error) => errors.push(error.message));
  const traffic = { frames: 0, answers: 0 };
  page.on("websocket", (socket) => {
    socket.on("framereceived", ({ payload }) => (traffic.frames += typeof payload !== "string" && payload[0] === FRAME ? 1 : 0));
    socket.on("framesent", ({ payload }) => (traffic.answers += payload === '{"do":"seen"}' ? 1 : 0));
  });
  await options.before?.(page);
  await page.goto(`${url}?quality=3`, { timeout: PATIENCE, waitUntil: "commit" });
  await page.waitForFunction(() => Number(document.body.dataset.frame) > 0);
  return Object.assign(page, { errors, traffic });
}

export const time = (page) => page.evaluate(() => Number(document.body.dataset.time));

/** Waits until the simulated time is beyond one. */
export const passed = (page, moment) => page.waitForFunction((moment) => Number(document.body.dataset.time) > moment, moment);

export const reads = (page, selector, text) =>
  page.waitForFunction(([selector, text]) => document.querySelector(selector)?.textContent === text, [selector, text]);

/** What is seen of the stage. */
export async function seen(page) {
  return seenIn(page, await page.locator("#stage canvas").screenshot());
}

/**
 * The share of a picture that is in strong colours, the same of its lower left corner, the middle of the others in parts of its
 * width and height, how many colours are on it, and a number that tells pictures apart.
 */
export function seenIn(page, picture) {
  return page.evaluate(async (png) => {
    const bytes = Uint8Array.from(atob(png), (c) => c.charCodeAt(0));
    const image = await createImageBitmap(new Blob([bytes], { type: "image/png" }));
    const canvas = new OffscreenCanvas(image.width, image.height);
    const context = canvas.getContext("2d");
    context.drawImage(image, 0, 0);
    const { data } = context.getImageData(0, 0, image.width, image.height);
    const colours = new Set();
    let [corner, print] = [0, 0];
    const strong = [];
    for (let i = 0; i < data.length; i += 4) {
      const [r, g, b] = [data[i], data[i + 1], data[i + 2]];
      colours.add(((r >> 4) << 8) | ((g >> 4) << 4) | (b >> 4));
      if (Math.max(r, g, b) - Math.min(r, g, b) > 40) {
        const [x, y] = [(i / 4) % image.width, Math.floor(i / 4 / image.width)];
        if (x < image.width / 4 && y > 0.75 * image.height) corner += 1;
        else strong.push([x, y]);
      }
      print = (31 * print + r + 7 * g + 13 * b) % 1_000_000_007;
    }
    const all = data.length / 4;
    // the legend stands in the corner
    const middle = half(strong).map((place, axis) => place / [image.width, image.height][axis]);
    return { share: (strong.length + corner) / all, corner: corner / all, middle, colours: colours.size, print };

    /** Half of the places lie to the left; of those about that column half lie above. */
    function half(places) {
      const median = (numbers) => numbers.sort((a, b) => a - b)[numbers.length >> 1] ?? 0;
      const x = median(places.map(([x]) => x));
      return [x, median(places.filter((place) => Math.abs(place[0] - x) < 3).map(([, y]) => y))];
    }
  }, picture.toString("base64"));
}

/** Waits until as much of the stage is in strong colours. */
export const shows = (page, share) => looks(page, (now) => now.share > share, `not ${share} of the picture is in strong colours`);

/** What is seen when a condition of it holds. */
export async function looks(page, holds, what) {
  const deadline = Date.now() + PATIENCE;
  for (;;) {
    const now = await seen(page);
    if (holds(now)) return now;
    if (Date.now() > deadline) throw new Error(`${what}: ${JSON.stringify(now)}`);
  }
}

/** The last numbers that a plot shows. */
export const plotted = (page, title) =>
  page.evaluate((title) => JSON.parse(document.querySelector(`[data-title="${title}"]`).dataset.last ?? "[]"), title);

/** How long the page takes from picture to picture, in the middle of some [ms]. */
export const pictureTime = (page) =>
  page.evaluate(async () => {
    const times = [];
    for (let k = 0; k < 12; k++) times.push(await new Promise(requestAnimationFrame));
    return times.slice(1).map((time, k) => time - times[k]).sort((a, b) => a - b)[5];
  });

/**
 * What covers or leaves what: controls of the head, messages, the legend, the panels and the line at the bottom.
 */
export const overlaps = (page) =>
  page.evaluate(() => {
    const parts = "#top button, #top select, #top .time, #top .factor, #top h1, #messages, #legend, .furniture svg, .scale, #side, #bottom";
    const boxes = [...document.querySelectorAll(parts)]
      .map((thing) => [thing.id || thing.textContent, thing.getBoundingClientRect()])
      .filter(([, box]) => box.width > 0 && box.height > 0);
    const meet = (a, b) => a.left < b.right - 1 && b.left < a.right - 1 && a.top < b.bottom - 1 && b.top < a.bottom - 1;
    const outside = (box) => box.left < -1 || box.top < -1 || box.right > innerWidth + 1 || box.bottom > innerHeight + 1;
    return [
      ...boxes.flatMap(([name, box], i) => boxes.slice(i + 1).filter(([, other]) => meet(box, other)).map(([other]) => `${name} / ${other}`)),
      ...boxes.filter(([, box]) => outside(box)).map(([name]) => `${name} is outside`),
    ];
  });

/** The largest value of the legend [mm]. */
export const largest = (page) =>
  page.evaluate(() => {
    const [number, unit] = document.querySelector("#legend .ends span:last-child").textContent.split(" ");
    return Number(number) * ({ m: 1000, mm: 1, "µm": 1e-3, nm: 1e-6 }[unit] ?? NaN);
  });

/** Waits until a condition of the legend's largest value [mm] holds; that value. */
export async function until(page, holds, what) {
  const deadline = Date.now() + PATIENCE;
  for (;;) {
    const now = await largest(page);
    if (holds(now)) return now;
    if (Date.now() > deadline) throw new Error(`${what}: still ${now} mm`);
    await page.evaluate(() => new Promise(requestAnimationFrame));
  }
}

/** The largest value of the legend when it has not changed for a simulated second [mm]: what swings stands still for less. */
export async function settled(page) {
  const values = [];
  for (;;) {
    values.push(await largest(page));
    const lately = values.slice(-10);
    const [least, most] = [Math.min(...lately), Math.max(...lately)];
    if (lately.length === 10 && most - least < 0.02 * most) return values.at(-1);
    await passed(page, (await time(page)) + 0.1);
  }
}

/**
 * Moves the mouse, which holds something, and waits for the picture that shows it: from the event to the moment it was drawn
 * [ms]. The number beside the hand stands where the hand is led to.
 */
export async function lag(page, x, y) {
  await page.evaluate(() => {
    window.lag = new Promise((resolve) => {
      const place = () => document.querySelector(".force").style.transform;
      const moved = ({ timeStamp }) => {
        const before = place();
        const look = () => (place() === before ? requestAnimationFrame(look) : resolve(performance.now() - timeStamp));
        requestAnimationFrame(look);
      };
      document.querySelector("#stage canvas").addEventListener("pointermove", moved, { once: true, capture: true });
    });
  });
  await page.mouse.move(x, y);
  return page.evaluate(() => window.lag);
}

export async function photograph(page, name) {
  if (pictures) await page.screenshot({ path: join(pictures, `${name}.png`) });
}

/** A place of the stage, in parts of its width and height. */
export async function at(page, x, y) {
  const box = await page.locator("#stage canvas").boundingBox();
  return [box.x + x * box.width, box.y + y * box.height];
}

/** A place in the middle of what is in strong colours on the stage. */
export async function onBody(page) {
  const { middle } = await seen(page);
  return at(page, ...middle);
}
