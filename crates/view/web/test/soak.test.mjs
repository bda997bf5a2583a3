// A long look at a world: neither the program nor the page may grow. `cargo xtask test soak`.
//
// SOUPLE_SOAK_MINUTES says how long, an hour where it is not there.

import assert from "node:assert/strict";
import { test } from "node:test";
import { setTimeout as sleep } from "node:timers/promises";
import { Program, at, launch, open, time } from "./world.mjs";

const MINUTES = Number(process.env.SOUPLE_SOAK_MINUTES ?? 60);
/** Measurements, a tenth of which warm up. */
const SAMPLES = 40;
/** What an allocator may keep back or give away between two looks [bytes]. */
const SLACK = 2 ** 20;
/** A leak of a number of eight bytes in each picture is to be seen in an hour of 60 a second: 1.7 MB. */
const PER_PICTURE = 8;

test(`a world is looked at for ${MINUTES} minutes`, async (t) => {
  const browser = await launch();
  const world = await Program.open("scenes/soft_block");
  try {
    const page = await open(browser, world.url, { viewport: { width: 480, height: 320 } });
    const devtools = await page.context().newCDPSession(page);
    const looks = [];
    for (let k = 0; k < SAMPLES; k++) {
      await sleep((60_000 * MINUTES) / SAMPLES);
      // the block falls anew, and is pulled at: what is done by hand is part of the hour
      await page.keyboard.press("r");
      const [x, y] = await at(page);
      await page.mouse.move(x, y);
      await page.mouse.down();
      await page.mouse.move(x + 20, y - 10, { steps: 3 });
      await page.mouse.up();
      await devtools.send("HeapProfiler.collectGarbage");
      const { usedSize } = await devtools.send("Runtime.getHeapUsage");
      const pictures = await page.evaluate(() => Number(document.body.dataset.frame));
      looks.push({ program: await world.memory(), page: usedSize, pictures });
      t.diagnostic(`${JSON.stringify(looks.at(-1))} at ${await time(page)} s of the world`);
    }
    assert.deepEqual(page.errors, []);
    const steady = looks.slice(SAMPLES / 10);
    const half = steady.length / 2;
    const pictures = steady.at(-1).pictures - steady[0].pictures;
    for (const side of ["program", "page"]) {
      const median = (part) => part.map((look) => look[side]).sort((a, b) => a - b)[Math.floor(part.length / 2)];
      const growth = median(steady.slice(half)) - median(steady.slice(0, half));
      t.diagnostic(`${side}: ${growth} bytes in ${pictures / 2} pictures`);
      assert.ok(growth < SLACK + (PER_PICTURE * pictures) / 2, `the ${side} has grown by ${growth} bytes`);
    }
  } finally {
    await world.close();
    await browser.close();
  }
});
