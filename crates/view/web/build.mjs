// Bundles the page: `node build.mjs FOLDER`, in a folder with the packages of package-lock.json.

import { copyFile, mkdir } from "node:fs/promises";
import { createRequire } from "node:module";
import { dirname, join, resolve } from "node:path";
import { fileURLToPath } from "node:url";

const here = dirname(fileURLToPath(import.meta.url));
const packages = join(process.cwd(), "node_modules");
const { build } = createRequire(join(process.cwd(), "package.json"))("esbuild");
const out = resolve(process.argv[2] ?? "page");

await mkdir(out, { recursive: true });
await build({
  entryPoints: { page: join(here, "src/main.ts") },
  outdir: out,
  bundle: true,
  minify: true,
  format: "esm",
  target: "es2022",
  nodePaths: [packages],
  legalComments: "eof",
  logLevel: "warning",
});
await copyFile(join(here, "index.html"), join(out, "index.html"));
