// The page in a real browser, before the released program: `cargo xtask test browser`.

import assert from "node:assert/strict";
import { after, before, describe, test } from "node:test";
import { Program, at, lag, launch, open, PATIENCE, passed, photograph, reads, seen, settled, shows, time, until } from "./world.mjs";

/** Coarse: it steps many times a second on any machine. */
const LIVER = ["scenes/liver", "--set", "parameters.size=30 mm"];

let browser;
before(async () => (browser = await launch()));
after(() => browser?.close());

describe("the liver", () => {
  let world;
  let page;
  before(async () => {
    world = await Program.open(...LIVER);
    page = await open(browser, world.url);
  });
  after(() => world?.close());

  test("is on screen, without errors", async () => {
    assert.match(await page.title(), /liver/i);
    const { colours } = await shows(page, 0.02);
    assert.ok(colours > 10, `${colours} colours`);
    await photograph(page, "liver");
    assert.deepEqual(page.errors, []);
  });

  test("is pulled by the mouse, which the plots show", async () => {
    await page.selectOption("#field", "displacement");
    await until(page, (now) => now > 0, "nothing is coloured");
    const resting = await settled(page);
    const plot = page.locator('[data-title="left tip"] canvas');
    const drawn = await plot.evaluate((canvas) => canvas.toDataURL());
    const [x, y] = await at(page);
    await page.mouse.move(x, y);
    await page.mouse.down();
    await page.mouse.move(x + 90, y - 20, { steps: 3 });
    await page.locator(".force").waitFor();
    await until(page, (now) => now > 1.1 * resting, "it does not follow the hand");
    await photograph(page, "liver-pulled");
    assert.match(await page.locator(".force").textContent(), /\d [mµ]?N$/);
    await page.mouse.up();
    await page.waitForFunction(
      (drawn) => document.querySelector('[data-title="left tip"] canvas').toDataURL() !== drawn,
      drawn,
    );
    await page.locator(".force").waitFor({ state: "detached" });
    assert.deepEqual(page.errors, []);
  });

  test("follows the mouse within a tenth of a second", async (t) => {
    const [x, y] = await at(page);
    await page.mouse.move(x, y);
    await page.mouse.down();
    await page.mouse.move(x + 10, y, { steps: 2 });
    await page.locator(".force").waitFor();
    // beside other work a machine may be late for a while
    let median = Infinity;
    const deadline = Date.now() + PATIENCE;
    while (median >= 100 && Date.now() < deadline) {
      const lags = [];
      for (let k = 0; k < 15; k++) lags.push(await lag(page, x + (k % 2 ? 30 : 10), y));
      median = lags.sort((a, b) => a - b)[7];
      t.diagnostic(`${median.toFixed(1)} ms, ${lags[0].toFixed(1)} to ${lags[14].toFixed(1)}`);
    }
    await page.mouse.up();
    await page.locator(".force").waitFor({ state: "detached" });
    assert.ok(median < 100, `${median} ms`);
  });

  test("is pushed by a tool, which is gone when it is let go of", async () => {
    await page.click('[data-tool="push"]');
    const [x, y] = await at(page);
    await page.mouse.move(x, y);
    await page.mouse.down();
    await page.mouse.move(x + 10, y + 5, { steps: 2 });
    // a tool begins before all that is about the place, however the surface bends there: as far in as its own size
    for (let notch = 0; notch < 8; notch++) await page.mouse.wheel(0, -100);
    await page.waitForFunction(() => /[1-9]/.test(document.querySelector(".force")?.textContent ?? ""));
    await photograph(page, "liver-pushed");
    await page.mouse.up();
    await page.locator(".force").waitFor({ state: "detached" });
    await page.click('[data-tool="pull"]');
    assert.deepEqual(page.errors, []);
  });

  test("is pulled by two fingers at once", async () => {
    const other = await open(browser, world.url, { hasTouch: true });
    const devtools = await other.context().newCDPSession(other);
    const [x, y] = await at(other);
    const touch = (type, ...places) =>
      devtools.send("Input.dispatchTouchEvent", { type, touchPoints: places.map(([x, y], id) => ({ x, y, id })) });
    await touch("touchStart", [x, y]);
    await touch("touchStart", [x, y], [x + 30, y]);
    await touch("touchMove", [x - 10, y - 20], [x + 40, y - 20]);
    await other.waitForFunction(() => document.querySelectorAll(".force").length === 2);
    await touch("touchEnd");
    await other.locator(".force").first().waitFor({ state: "detached" });
    assert.deepEqual(other.errors, []);
    await other.close();
  });

  test("is taken by keys", async () => {
    await page.locator("#stage canvas").focus();
    await page.keyboard.press("h");
    await page.locator(".force").waitFor();
    await page.keyboard.press("ArrowRight");
    await page.waitForFunction(() => /[1-9]/.test(document.querySelector(".force")?.textContent ?? ""));
    await page.keyboard.press("Escape");
    await page.locator(".force").waitFor({ state: "detached" });
  });

  test("pauses, steps, begins anew", async () => {
    await page.keyboard.press("Space");
    await reads(page, ".transport .main", "Play");
    await page.waitForFunction(() => document.querySelector(".factor").textContent === "paused");
    const paused = await time(page);
    await page.click('[data-do="step"]');
    await passed(page, paused);
    assert.ok(Math.abs((await time(page)) - paused - 0.02) < 1e-9);
    await page.click('[data-do="reset"]');
    await page.waitForFunction(() => Number(document.body.dataset.time) === 0);
    await page.click(".transport .main");
    await reads(page, ".transport .main", "Pause");
    await passed(page, 0);
  });

  test("hangs lower where it is softer; a wrong value is refused in words", async () => {
    const stiff = await settled(page);
    const input = page.locator('input[data-path="bodies.liver.material.youngs_modulus"]');
    await input.fill("2 kPa");
    await input.press("Enter");
    await page.waitForFunction(() => document.querySelector(".command").textContent.includes("youngs_modulus=2 kPa"));
    await until(page, (now) => now > 1.15 * stiff, "it does not sink");
    await input.fill("-1 kPa");
    await input.press("Enter");
    const note = page.locator(".note.error").first();
    await note.waitFor();
    assert.match(await note.textContent(), /out of range.*above 0/s);
    await photograph(page, "refused");
  });

  test("is cut open and taken apart", async () => {
    const whole = await seen(page);
    await page.selectOption("#cut", "0");
    await page.waitForFunction(() => Number(document.body.dataset.cells) > 0);
    const cut = await shows(page, 0.01);
    assert.notEqual(cut.print, whole.print);
    await photograph(page, "cut");
    await page.selectOption("#cut", "none");
    const slide = (value) =>
      page.locator("#explode").evaluate((slider, value) => {
        slider.value = value;
        slider.dispatchEvent(new Event("input"));
      }, value);
    await slide("0.6");
    await shows(page, 0.01);
    await photograph(page, "apart");
    await slide("0");
    await page.selectOption("#arrows", "velocity");
    await passed(page, (await time(page)) + 0.04);
    await page.selectOption("#arrows", "");
    assert.deepEqual(page.errors, []);
  });

  test("is the same on a second page", async () => {
    const other = await open(browser, world.url, { colorScheme: "dark" });
    await page.locator("#stage canvas").focus();
    await page.keyboard.press("Space");
    await reads(other, ".transport .main", "Play");
    await other.waitForFunction((time) => Number(document.body.dataset.time) === time, await paused(page));
    assert.equal(await other.evaluate(() => document.documentElement.dataset.theme), "dark");
    await photograph(other, "dark");
    await other.click(".transport .main");
    await reads(page, ".transport .main", "Pause");
    await other.close();
  });

  /** The time of a world that has stopped. */
  async function paused(page) {
    await page.waitForFunction(() => document.querySelector(".factor").textContent === "paused");
    return time(page);
  }
});

describe("small worlds", () => {
  let world;
  let page;
  let cut = null;
  before(async () => {
    world = await Program.open("scenes/soft_block");
    // the connection goes by way of the test, which may cut it
    const before = (page) =>
      page.routeWebSocket(/\/socket/, (socket) => {
        socket.connectToServer();
        cut = () => socket.close();
      });
    page = await open(browser, world.url, { before });
  });
  after(() => world?.close());

  test("go on when the connection was cut", async () => {
    const now = await time(page);
    await cut();
    await page.locator("body.lost").waitFor();
    await page.locator("body:not(.lost)").waitFor();
    await passed(page, now + 0.05);
  });

  test("are drawn whatever they are made of", async () => {
    const scenes = { tearing_sheet: 0.02, clay_sticks_again: 0.02, fascia: 0.02, skin_two_way: 0.01 };
    for (const [scene, share] of Object.entries(scenes)) {
      await page.locator(`[data-scene="${scene}"]`).evaluate((button) => button.click());
      await page.waitForFunction(
        (scene) => document.querySelector(`[data-scene="${scene}"]`)?.getAttribute("aria-current") === "true",
        scene,
      );
      await passed(page, 0);
      await shows(page, share);
      await photograph(page, scene);
    }
    assert.deepEqual(page.errors, []);
  });

  test("are made of a mesh that is dropped on the page", async () => {
    await page.evaluate(() => {
      const corners = [0, 1, 2, 3, 4, 5, 6, 7].map((i) => `v ${i & 1} ${(i >> 1) & 1} ${i >> 2}`);
      const faces = ["1 3 4 2", "5 6 8 7", "1 2 6 5", "3 7 8 4", "1 5 7 3", "2 4 8 6"].map((face) => `f ${face}`);
      const dropped = new DataTransfer();
      dropped.items.add(new File([[...corners, ...faces].join("\n")], "cube.obj"));
      window.dispatchEvent(new DragEvent("drop", { dataTransfer: dropped, cancelable: true }));
    });
    await reads(page, "h1", "cube.obj");
    await passed(page, 0);
    await shows(page, 0.02);
  });

  test("are legible in windows of every size", async () => {
    for (const [width, height] of [[1600, 900], [1024, 700], [420, 860]]) {
      await page.setViewportSize({ width, height });
      await page.waitForFunction((width) => innerWidth === width, width);
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
    }
  });
});

test("a world that explodes names its body and can be begun anew", async () => {
  const world = await Program.open("scenes/soft_block", "--set", "systems.main.stepper=symplectic_euler");
  try {
    const page = await open(browser, world.url);
    const failure = page.locator(".failure");
    await failure.waitFor();
    assert.match(await failure.textContent(), /has stopped.*refused.*`block`/s);
    await photograph(page, "failed");
    await failure.locator("button").click();
    await failure.waitFor({ state: "hidden" });
  } finally {
    await world.close();
  }
});
