// Parts of the page that need no browser: numbers, lengths, creases.

import assert from "node:assert/strict";
import { test } from "node:test";
import { fileURLToPath } from "node:url";
import { build } from "esbuild";

/** The modules as one, bundled for this program. */
const sources = ["format", "ui/parameters", "view/eye", "view/furniture", "view/normals"].map((name) => fileURLToPath(new URL(`../src/${name}.ts`, import.meta.url)));
const { outputFiles } = await build({
  stdin: {
    contents: [...sources, "three"].map((path) => `export * from ${JSON.stringify(path)};`).join("\n"),
    resolveDir: fileURLToPath(new URL("..", import.meta.url)),
  },
  bundle: true,
  format: "esm",
  write: false,
});
const { Box3, Eye, Vector3, corners, divideAtCreases, number, quantity, roundLength, smoothNormals, written } = await import(
  `data:text/javascript;base64,${Buffer.from(outputFiles[0].contents).toString("base64")}`
);

test("numbers have three digits that count, and units their prefix", () => {
  const said = [0, 1, 12345, 123456, 0.00123, 1.2345e-7, -2e9].map(number);
  assert.deepEqual(said, ["0", "1", "12300", "1.23e5", "0.00123", "1.23e-7", "-2.00e9"]);
  assert.equal(quantity(12345, "Pa"), "12.3 kPa");
  assert.equal(quantity(999.96, "N"), "1 kN");
  assert.equal(quantity(3.2e12, "Pa"), "3.2 TPa");
  assert.equal(quantity(-4.5e-12, "N"), "-4.5 pN");
  assert.equal(quantity(0, "m"), "0 m");
});

test("lengths are the longest round ones that fit", () => {
  assert.deepEqual([1, 1.99, 2, 4.9, 5, 9.9, 0.034, 720].map(roundLength), [1, 1, 2, 2, 5, 5, 0.02, 500]);
});

/** Two squares that meet along z at an angle between their normals [degrees]. */
function folded(angle) {
  const [c, s] = [Math.cos((angle * Math.PI) / 180), Math.sin((angle * Math.PI) / 180)];
  const points = Float32Array.from([-1, 0, 0, -1, 0, 1, 0, 0, 0, 0, 0, 1, c, -s, 0, c, -s, 1]);
  return { points, triangles: Uint32Array.from([0, 1, 3, 0, 3, 2, 2, 3, 5, 2, 5, 4]) };
}

test("surfaces are smooth over bends and sharp at creases", () => {
  const bent = folded(39);
  const smooth = divideAtCreases(bent.points, bent.triangles);
  assert.equal(smooth.sources.length, 6);
  const sharp = folded(41);
  const { sources, triangles } = divideAtCreases(sharp.points, sharp.triangles);
  // the two points of the crease stand once for each side
  assert.deepEqual([...sources].sort(), [0, 1, 2, 2, 3, 3, 4, 5]);
  assert.deepEqual([...triangles].map((own) => sources[own]), [...sharp.triangles]);
  const positions = Float32Array.from([...sources].flatMap((point) => [...sharp.points.subarray(3 * point, 3 * point + 3)]));
  const normals = new Float32Array(positions.length);
  smoothNormals(positions, triangles, normals);
  // each side has the normal of its own square
  triangles.forEach((own, corner) => {
    const wanted = corner < 6 ? [0, 1, 0] : [Math.sin((41 * Math.PI) / 180), Math.cos((41 * Math.PI) / 180), 0];
    wanted.forEach((value, axis) => assert.ok(Math.abs(normals[3 * own + axis] - value) < 1e-6, `${corner}: ${normals.slice(3 * own, 3 * own + 3)}`));
  });
});

test("what is looked at stands above the foot of the picture, from everywhere", () => {
  const bounds = new Box3(new Vector3(-1, 2, 0), new Vector3(3, 2.5, 1));
  for (const [width, height] of [[1400, 800], [470, 318], [420, 330], [300, 900]]) {
    for (const direction of [[-0.5, -0.45, -1], [0, 0, -1], [1, 0.2, 0], [-1, -2, -1]]) {
      const eye = new Eye(silent());
      eye.resize(width, height, 0);
      eye.direction.fromArray(direction).normalize();
      eye.fit(bounds, bounds);
      eye.camera.updateMatrixWorld();
      const low = -1 + (2 * Math.min(84, 0.4 * height)) / height;
      const seen = corners(bounds).map((corner) => corner.project(eye.camera));
      for (const { x, y } of seen) assert.ok(Math.abs(x) < 1 && y < 1 && y > low, `${width} x ${height}, ${direction}: ${x}, ${y}`);
      // so it does however it turns about its middle
      const centre = bounds.getCenter(new Vector3());
      const radius = 0.5 * bounds.getSize(new Vector3()).length();
      for (let k = 0; k < 100; k++) {
        const [sin, angle] = [Math.sin(k), 2.4 * k];
        const turned = new Vector3(Math.cos(angle) * sin, Math.sin(angle) * sin, Math.cos(k)).multiplyScalar(radius).add(centre);
        const { x, y } = turned.project(eye.camera);
        assert.ok(Math.abs(x) < 1 && y < 1 && y > low, `${width} x ${height}, ${direction}, ${k}: ${x}, ${y}`);
      }
    }
  }
});

/** A page's element that says nothing. */
function silent() {
  const element = { addEventListener() {}, removeEventListener() {}, getRootNode: () => element, style: {} };
  element.ownerDocument = element;
  return element;
}

test("what is up in the scene is what the mouse turns about", () => {
  const eye = new Eye(silent());
  const bounds = new Box3(new Vector3(-1, -1, -1), new Vector3(1, 1, 1));
  eye.resize(800, 600, 0);
  for (const [up, direction] of [[[0, 0, 1], [0, 1, 0]], [[0, 1, 0], [1, -0.5, 0]], [[1, 0, 0], [0, 1, 1]]]) {
    eye.up.fromArray(up);
    eye.direction.fromArray(direction).normalize();
    eye.fit(bounds, bounds);
    // as far from the pole as the view is from what is up
    const polar = eye.direction.clone().negate().angleTo(eye.up);
    assert.ok(Math.abs(eye.controls.getPolarAngle() - polar) < 1e-9, `${up}: ${eye.controls.getPolarAngle()}, not ${polar}`);
  }
});

test("a view that nobody has moved is fitted to a window of another shape, another shows what it has shown", () => {
  const eye = new Eye(silent());
  const bounds = new Box3(new Vector3(-5, -0.2, -0.2), new Vector3(5, 0.2, 0.2));
  eye.direction.set(0, 0, -1);
  const isAllSeen = () => {
    eye.camera.updateMatrixWorld();
    return corners(bounds).every((corner) => Math.abs(corner.project(eye.camera).x) < 1);
  };
  eye.resize(1400, 500, 0);
  eye.fit(bounds, bounds);
  assert.ok(isAllSeen());
  eye.resize(780, 900, 0);
  assert.ok(isAllSeen());
  eye.resize(1400, 500, 0);
  const before = eye.camera.position.z;
  eye.shift(new Vector3(0.1, 0, 0));
  eye.resize(300, 500, 0);
  // the height was the narrower side, of which the foot is free, and now the width is
  const wanted = (before * (500 - 84)) / 300;
  assert.ok(Math.abs(eye.camera.position.z / wanted - 1) < 1e-9, `${eye.camera.position.z}, not ${wanted}`);
});

test("values are written as scene files have them", () => {
  assert.equal(written(" 12 kPa ", "number"), "12 kPa");
  assert.equal(written("0, -9.81, 0", "vector"), "[0, -9.81, 0]");
  assert.equal(written("0, -9.81 m/s^2, 0", "vector"), '[0, "-9.81 m/s^2", 0]');
  assert.equal(written("[0, 1, 0]", "vector"), "[0, 1, 0]");
  assert.equal(written("[0, 5 cm, 0]", "vector"), '[0, "5 cm", 0]');
  assert.equal(written('[0, "5 cm", 0]', "vector"), '[0, "5 cm", 0]');
});
