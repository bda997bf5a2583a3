// The page in a real browser, before the released program: `cargo xtask browser`.
//
// SOUPLE_PROGRAM and SOUPLE_CHROMIUM name the program and the browser; SOUPLE_PICTURES a folder for pictures to look at.

import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { once } from "node:events";
import { mkdir } from "node:fs/promises";
import { join, resolve } from "node:path";
import { after, before, describe, test } from "node:test";
import { fileURLToPath } from "node:url";
import { chromium } from "playwright-core";

const root = resolve(fileURLToPath(import.meta.url), "../../../../..");
const program = process.env.SOUPLE_PROGRAM ?? "souple";
const pictures = process.env.SOUPLE_PICTURES;
/** Machines that draw by software, several at once, are slow. */
const PATIENCE = 120_000;

const LIVER = ["scenes/liver", "--set", "parameters.size=25 mm"];

/** The program showing a scene. */
class Program {
  static async open(scene, port = 0) {
    const opened = new Program();
    opened.child = spawn(program, ["view", ...scene, "--port", String(port)], { cwd: root, stdio: ["ignore", "pipe", "inherit"] });
    const [line] = await once(opened.child.stdout, "data");
    opened.url = String(line).trim().split("\n")[0];
    return opened;
  }

  async close() {
    this.child.kill("SIGINT");
    await once(this.child, "exit");
  }
}

let browser;
before(async () => {
  const args = ["--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader", "--no-sandbox"];
  browser = await chromium.launch({ executablePath: process.env.SOUPLE_CHROMIUM ?? "/usr/bin/chromium", args });
  if (pictures) await mkdir(pictures, { recursive: true });
});
after(() => browser?.close());

/** A page that shows frames; errors that it says are kept. */
async function open(url, options = {}) {
  const page = await browser.newPage({ viewport: { width: 1280, height: 800 }, ...options });
  page.setDefaultTimeout(PATIENCE);
  const errors = [];
  page.on("console", (message) => message.type() === "error" && errors.push(message.text()));
  page.on("pageerror", (error) => errors.push(error.message));
  await page.goto(url, { timeout: PATIENCE, waitUntil: "commit" });
  await page.waitForFunction(() => Number(document.body.dataset.frame) > 3);
  return Object.assign(page, { errors });
}

const time = (page) => page.evaluate(() => Number(document.body.dataset.time));
const mode = (page, text) => page.waitForFunction((text) => document.querySelector(".transport .main").textContent === text, text);

/** The share of the stage that is not background, and how many colours are on it. */
async function seen(page) {
  const png = (await page.locator("#stage canvas").screenshot()).toString("base64");
  return page.evaluate(async (png) => {
    const bytes = Uint8Array.from(atob(png), (c) => c.charCodeAt(0));
    const image = await createImageBitmap(new Blob([bytes], { type: "image/png" }));
    const canvas = new OffscreenCanvas(image.width, image.height);
    const context = canvas.getContext("2d");
    context.drawImage(image, 0, 0);
    const { data } = context.getImageData(0, 0, image.width, image.height);
    const colours = new Set();
    let strong = 0;
    for (let i = 0; i < data.length; i += 4) {
      const [r, g, b] = [data[i], data[i + 1], data[i + 2]];
      colours.add(((r >> 4) << 8) | ((g >> 4) << 4) | (b >> 4));
      if (Math.max(r, g, b) - Math.min(r, g, b) > 40) strong += 1;
    }
    return { share: strong / (data.length / 4), colours: colours.size };
  }, png);
}

/** The largest value of the legend [mm], once it is steady. */
async function largest(page) {
  let last = -1;
  for (let i = 0; i < 60; i++) {
    await page.waitForTimeout(400);
    const text = await page.locator("#legend .ends span").last().textContent();
    const [number, unit] = text.split(" ");
    const now = Number(number) * { m: 1000, mm: 1, "µm": 1e-3, nm: 1e-6 }[unit];
    if (Math.abs(now - last) < 0.03 * now) return now;
    last = now;
  }
  return last;
}

async function photograph(page, name) {
  if (pictures) await page.screenshot({ path: join(pictures, `${name}.png`) });
}

const middle = async (page) => {
  const box = await page.locator("#stage canvas").boundingBox();
  return [box.x + 0.48 * box.width, box.y + 0.52 * box.height];
};

describe("the liver", () => {
  let world;
  before(async () => (world = await Program.open(LIVER)));
  after(() => world.close());

  test("is on screen, without errors", async () => {
    const page = await open(world.url);
    assert.match(await page.title(), /liver/i);
    const { share, colours } = await seen(page);
    assert.ok(share > 0.03 && colours > 30, `${share} of the picture, ${colours} colours`);
    await photograph(page, "liver");
    assert.deepEqual(page.errors, []);
    await page.close();
  });

  test("is pulled by the mouse, which the plots show", async () => {
    const page = await open(world.url);
    await page.selectOption("#field", "displacement");
    await page.waitForTimeout(1500);
    const [before, plot] = [await largest(page), page.locator('[data-title="left tip"] canvas')];
    const drawn = await plot.evaluate((canvas) => canvas.toDataURL());
    const [x, y] = await middle(page);
    await page.mouse.move(x, y);
    await page.mouse.down();
    await page.mouse.move(x + 160, y - 40, { steps: 8 });
    await page.locator(".force").waitFor();
    const pulled = await largest(page);
    await photograph(page, "liver-pulled");
    const force = await page.locator(".force").textContent();
    await page.mouse.up();
    assert.ok(pulled > 1.1 * before, `${before} mm before, ${pulled} mm pulled`);
    assert.match(force, /\d m?N$/);
    assert.notEqual(await plot.evaluate((canvas) => canvas.toDataURL()), drawn);
    await page.locator(".force").waitFor({ state: "detached" });
    assert.deepEqual(page.errors, []);
    await page.close();
  });

  test("pauses, steps, begins anew", async () => {
    const page = await open(world.url);
    await page.keyboard.press("Space");
    await mode(page, "Play");
    await page.waitForTimeout(500);
    const paused = await time(page);
    await page.waitForTimeout(500);
    assert.equal(await time(page), paused);
    await page.click('[data-do="step"]');
    await page.waitForFunction((paused) => Number(document.body.dataset.time) > paused, paused);
    assert.ok(Math.abs((await time(page)) - paused - 0.02) < 1e-9);
    await page.click('[data-do="reset"]');
    await page.waitForFunction(() => Number(document.body.dataset.time) === 0);
    await page.click(".transport .main");
    await mode(page, "Pause");
    await page.close();
  });

  test("hangs lower where it is softer; a wrong value is refused in words", async () => {
    const page = await open(world.url);
    await page.selectOption("#field", "displacement");
    await page.waitForTimeout(2500);
    const stiff = await largest(page);
    const input = page.locator('input[data-path="bodies.liver.material.youngs_modulus"]');
    await input.fill("2 kPa");
    await input.press("Enter");
    await page.waitForFunction(() => document.querySelector(".command").textContent.includes("youngs_modulus=2 kPa"));
    await page.waitForTimeout(4000);
    const soft = await largest(page);
    assert.ok(soft > 1.15 * stiff, `${stiff} mm at 6 kPa, ${soft} mm at 2 kPa`);
    await input.fill("-1 kPa");
    await input.press("Enter");
    const note = page.locator(".note.error").first();
    await note.waitFor();
    assert.match(await note.textContent(), /out of range.*above 0/s);
    await photograph(page, "refused");
    await page.close();
  });

  test("is the same on a second page", async () => {
    const [one, two] = [await open(world.url), await open(world.url, { colorScheme: "dark" })];
    await one.keyboard.press("Space");
    await mode(two, "Play");
    await two.waitForTimeout(1500);
    assert.equal(await time(one), await time(two));
    await photograph(two, "dark");
    await two.keyboard.press("Space");
    await mode(one, "Pause");
    await one.close();
    await two.close();
  });
});

test("a page comes back when the connection was lost", async () => {
  const first = await Program.open(["scenes/soft_block"]);
  const page = await open(first.url);
  await first.close();
  await page.locator("body.lost").waitFor();
  const second = await Program.open(["scenes/soft_block"], new URL(first.url).port);
  await page.locator("body:not(.lost)").waitFor();
  const now = await time(page);
  await page.waitForFunction((now) => Number(document.body.dataset.time) !== now, now);
  await page.close();
  await second.close();
});

test("a world that explodes says so and can be begun anew", async () => {
  const wild = ["scenes/soft_block", "--set", "systems.main.stepper=symplectic_euler"];
  const world = await Program.open(wild);
  const page = await open(world.url).catch(() => null);
  assert.ok(page);
  await page.locator(".failure").waitFor();
  const text = await page.locator(".failure").textContent();
  assert.match(text, /has stopped.*refused/s);
  await photograph(page, "failed");
  await page.close();
  await world.close();
});

test("every size of window is legible", async () => {
  const world = await Program.open(["scenes/soft_block"]);
  for (const [width, height, colorScheme] of [[1600, 1000, "light"], [1024, 700, "dark"], [420, 860, "light"]]) {
    const page = await open(world.url, { viewport: { width, height }, colorScheme });
    const wide = await page.evaluate(() => document.documentElement.scrollWidth - innerWidth);
    assert.equal(wide, 0, `${width}: wider than the window by ${wide}`);
    const overlaps = await page.evaluate(() => {
      const boxes = [...document.querySelectorAll("#top button, #top select, #top .time, #top .factor, #top h1")]
        .map((thing) => [thing.textContent, thing.getBoundingClientRect()])
        .filter(([, box]) => box.width > 0);
      const meet = (a, b) => a.left < b.right - 1 && b.left < a.right - 1 && a.top < b.bottom - 1 && b.top < a.bottom - 1;
      return boxes.flatMap(([text, box], i) => boxes.slice(i + 1).filter(([, other]) => meet(box, other)).map(([other]) => `${text} / ${other}`));
    });
    assert.deepEqual(overlaps, []);
    await photograph(page, `size-${width}`);
    await page.close();
  }
  await world.close();
});
