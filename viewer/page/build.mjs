// Builds the page: node build.mjs --out FOLDER. One script, one style sheet, both with a checksum in
// their names, and everything a second time packed by gzip.
import * as esbuild from "esbuild";
import { mkdir, readFile, rm, writeFile } from "node:fs/promises";
import path from "node:path";
import { fileURLToPath } from "node:url";
import { parseArgs } from "node:util";
import { gzipSync } from "node:zlib";

const here = path.dirname(fileURLToPath(import.meta.url));
const { values } = parseArgs({ options: { out: { type: "string" } } });
if (!values.out) {
  console.error("usage: node build.mjs --out FOLDER");
  process.exit(2);
}
const out = path.resolve(values.out);

const result = await esbuild.build({
  absWorkingDir: here,
  entryPoints: { app: "src/main.ts" },
  outdir: path.join(out, "assets"),
  entryNames: "[name]-[hash]",
  bundle: true,
  minify: true,
  format: "esm",
  target: "es2022",
  legalComments: "none", // LICENSES of what is bundled: docs/dependencies.md
  banner: { js: "/* irdm, three.js, uPlot: MIT licence */" },
  write: false,
});

const files = new Map(result.outputFiles.map((file) => [path.relative(out, file.path), Buffer.from(file.contents)]));
const named = (extension) => [...files.keys()].find((name) => name.endsWith(extension));
const html = await readFile(path.join(here, "index.html"), "utf8");
files.set("index.html", Buffer.from(html.replace("app.css", named(".css")).replace("app.js", named(".js"))));
files.set("favicon.svg", await readFile(path.join(here, "favicon.svg")));

await rm(out, { recursive: true, force: true });
let weight = 0;
for (const [name, content] of files) {
  const target = path.join(out, name);
  const packed = gzipSync(content, { level: 9 });
  weight += packed.length;
  await mkdir(path.dirname(target), { recursive: true });
  await writeFile(target, content);
  await writeFile(target + ".gz", packed);
}
console.log(`page: ${files.size} files, ${(weight / 1000).toFixed(1)} kB packed`);
const LIMIT = 300_000;
if (weight > LIMIT) {
  console.error(`page: heavier than ${LIMIT / 1000} kB`);
  process.exit(1);
}
