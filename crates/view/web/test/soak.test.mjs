// A long look at a world: neither the program nor the page may grow. `cargo xtask test soak`.
//
// SOUPLE_SOAK_MINUTES says how long, an hour where it is not there; SOUPLE_SOAK_PICTURES how many pictures are drawn in a second, for
// machines that draw by software and have other work: as many as the browser can where it is not there.

import assert from "node:assert/strict";
import { test } from "node:test";
import { setTimeout as sleep } from "node:timers/promises";
import { Program, launch, open, time } from "./world.mjs";

const MINUTES = Number(process.env.SOUPLE_SOAK_MINUTES ?? 60);
const PICTURES = Number(process.env.SOUPLE_SOAK_PICTURES ?? Infinity);
/** Few cells: what may grow does so with steps, messages and pictures, and an hour of these costs the machine little. */
const LIGHT = ["--set", "bodies.block.mesh.cells=[3, 2, 2]"];
/** Measurements, a tenth of which warm up. */
const SAMPLES = 40;
/**
 * What an allocator may keep back or give away between two looks, and all that may grow [bytes]. Of the looks after the warm-up the
 * middle one of the first half is compared with that of the second, which in an hour of 60 pictures a second lie 97,200 pictures
 * apart: a leak of 11 bytes in each picture is seen.
 */
const SLACK = 2 ** 20;
/** The hand is led elsewhere as often: what is done by hand is part of the time [ms]. */
const LEAD_EVERY = 500;

test(`a world is looked at, and held in a hand, for ${MINUTES} minutes`, async (t) => {
  const browser = await launch();
  const world = await Program.open("scenes/soft_block", ...LIGHT);
  try {
    const before = (page) => page.addInitScript(slowly, 1000 / PICTURES);
    const page = await open(browser, world.url, { viewport: { width: 480, height: 320 }, before });
    const devtools = await page.context().newCDPSession(page);
    // by keys: a small window may have no body under its middle
    await page.locator("#stage canvas").focus();
    await page.keyboard.press("h");
    await page.locator(".force").waitFor();
    const looks = [];
    for (let k = 0; k < SAMPLES; k++) {
      const until = Date.now() + (60_000 * MINUTES) / SAMPLES;
      for (let step = 0; Date.now() < until; step++) {
        await page.keyboard.press(["ArrowRight", "ArrowUp", "ArrowLeft", "ArrowDown"][step % 4]);
        await sleep(LEAD_EVERY);
      }
      await devtools.send("HeapProfiler.collectGarbage");
      const { usedSize } = await devtools.send("Runtime.getHeapUsage");
      const pictures = await page.evaluate(() => Number(document.body.dataset.pictures));
      looks.push({ program: await world.memory(), page: usedSize, pictures });
      t.diagnostic(`${JSON.stringify(looks.at(-1))} at ${await time(page)} s of the world`);
      assert.equal(await page.locator(".force").count(), 1, "the hand has let go");
    }
    await page.keyboard.press("Escape");
    assert.deepEqual(page.errors, []);
    const steady = looks.slice(SAMPLES / 10);
    const halves = [steady.slice(0, steady.length / 2), steady.slice(steady.length / 2)];
    const median = (half, side) => half.map((look) => look[side]).sort((a, b) => a - b)[Math.floor(half.length / 2)];
    const growth = (side) => median(halves[1], side) - median(halves[0], side);
    t.diagnostic(`a leak of ${(SLACK / growth("pictures")).toFixed(1)} bytes in each picture is seen`);
    for (const side of ["program", "page"]) {
      t.diagnostic(`${side}: ${growth(side)} bytes in ${growth("pictures")} pictures`);
      assert.ok(growth(side) < SLACK, `the ${side} has grown by ${growth(side)} bytes`);
    }
  } finally {
    await world.close();
    await browser.close();
  }
});

/** In a page: so much time passes before each picture [ms]. */
function slowly(pause) {
  if (pause === 0) return;
  const request = window.requestAnimationFrame.bind(window);
  window.requestAnimationFrame = (draw) => setTimeout(() => request(draw), pause);
}
