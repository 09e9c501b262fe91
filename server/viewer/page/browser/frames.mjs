// Pictures of a recorded run as the page shows it: irdm-server --play and the page in headless Chromium, moved from
// frame to frame. scripts/frames.sh starts it.
//   node frames.mjs OPTIONS.. SCENE.toml TRACE.h5 FOLDER     programs: IRDM_SERVER, CHROMIUM
import { spawn } from "node:child_process";
import { existsSync, mkdirSync, readdirSync } from "node:fs";
import path from "node:path";
import { parseArgs } from "node:util";
import { chromium } from "playwright-core";

const DEADLINE_MS = 60_000;
const DISPLAY = 60; // frames a second
const { IRDM_SERVER, CHROMIUM } = process.env;
const { values, positionals } = parseArgs({
  allowPositionals: true,
  options: {
    rate: { type: "string", default: "25" },
    from: { type: "string", default: "0" },
    to: { type: "string" },
    size: { type: "string", default: "1280x720" },
    camera: { type: "string" },
    exaggeration: { type: "string", default: "1" },
    colour: { type: "string", default: "none" },
    rigid: { type: "boolean", default: false },
    still: { type: "boolean", default: false },
    dark: { type: "boolean", default: false },
    page: { type: "boolean", default: false },
  },
});
const [scene, trace, folder] = positionals;

function fail(message) {
  console.error(`frames: ${message}`);
  process.exit(1);
}

function numbers(name, text, pattern, low, high) {
  const parts = pattern.exec(text)?.slice(1).map(Number) ?? [];
  if (parts.length === 0 || parts.some((part) => !(part >= low && part <= high))) fail(`--${name} ${text} cannot be used; see --help`);
  return parts;
}
const POSITIVE = /^([0-9.]+(?:e[-+]?\d+)?)$/;
const [rate] = numbers("rate", values.rate, POSITIVE, 1e-3, 1e4);
const [from] = numbers("from", values.from, POSITIVE, 0, 1e9);
const [to] = values.to === undefined ? [Infinity] : numbers("to", values.to, POSITIVE, 0, 1e9);
const [width, height] = numbers("size", values.size, /^(\d+)x(\d+)$/, 64, 8192);
const [exaggeration] = numbers("exaggeration", values.exaggeration, POSITIVE, 0, 20);
const camera = values.camera === undefined ? null : numbers("camera", values.camera, /^(-?[0-9.]+),(-?[0-9.]+)$/, -360, 360);
if (!["none", "displacement", "velocity", "compliance"].includes(values.colour)) fail(`--colour ${values.colour} cannot be used; see --help`);
if (existsSync(folder) && readdirSync(folder).length > 0) fail(`${folder} is not empty; give a new folder`);

/** Where the server shows the page. What keeps it from that it says itself. */
function listening(server) {
  return new Promise((resolve, reject) => {
    let output = "";
    server.stdout.on("data", (data) => {
      output += data;
      const found = /listening on (http\S+)/.exec(output);
      if (found) resolve(found[1]);
    });
    server.on("error", reject);
    server.on("exit", () => reject(new Error("irdm-server did not play the trace")));
  });
}

/** As a person would set it, by the page's own controls. */
async function setLook(page) {
  await page.locator("#exaggeration").fill(String(exaggeration));
  await page.locator("#rigid").setChecked(values.rigid);
  await page.locator("#follow").setChecked(!values.still);
  await page.locator("#colour").selectOption(values.colour);
  await page.evaluate(() => {
    document.activeElement?.blur();
    for (const part of document.querySelectorAll("*")) part.scrollTop = 0;
  });
  if (values.page) return;
  await page.addStyleTag({
    content: "body { display: block !important } .panel { display: none !important } .stage { position: fixed !important; inset: 0; height: auto !important }" +
      ".bar, #playback, #notices, #tools, #hint { display: none !important }",
  });
}

/** Round about the objects: azimuth from the z axis towards x, elevation above the horizon [degrees]. */
function turn(page) {
  return page.evaluate((camera) => {
    const { world } = window.irdm;
    world.fit();
    if (camera === null) return;
    const [azimuth, elevation] = camera.map((angle) => (angle * Math.PI) / 180);
    const { x, y, z } = world.camera.position.clone().sub(world.controls.target);
    world.move(azimuth - Math.atan2(x, z), Math.PI / 2 - elevation - Math.acos(y / Math.hypot(x, y, z)), 1);
  }, camera);
}

/** Shows the step that a time falls into. */
async function goTo(page, time) {
  await page.evaluate((time) => window.irdm.seek(time), time);
  await page.waitForFunction(
    (time) => {
      const { dt } = window.irdm.scene();
      return Math.abs(window.irdm.frame().time - Math.max(1, Math.ceil(time / dt - 1e-6)) * dt) < dt / 2;
    },
    time,
    { timeout: DEADLINE_MS, polling: 5 },
  );
}

/** From one time to a later one as a display would: so the camera goes along as it does in a live view. */
async function moveOn(page, before, time) {
  for (let k = Math.floor(before * DISPLAY) + 1; k < time * DISPLAY; ++k) await goTo(page, k / DISPLAY);
  await goTo(page, time);
  // The picture is taken of what the browser has put on the screen: one frame after it was drawn.
  await page.evaluate(
    () =>
      new Promise((resolve) =>
        requestAnimationFrame(() => {
          window.irdm.world.drawNow();
          requestAnimationFrame(() => requestAnimationFrame(resolve));
        }),
      ),
  );
}

async function takeAll(page) {
  await page.waitForFunction(() => window.irdm?.frame() && window.irdm.state()?.playback, null, { timeout: DEADLINE_MS });
  if (await page.evaluate(() => window.irdm.world === null)) fail("this Chromium has no WebGL, with which the page draws");
  if (await page.evaluate(() => window.irdm.state().playback.playing)) await page.locator("#play").click();
  await page.waitForFunction(() => !window.irdm.state().playback.playing, null, { timeout: DEADLINE_MS });
  await setLook(page);
  const length = await page.evaluate(() => window.irdm.state().playback.length);
  const end = Math.min(to, length);
  if (from > end) fail(`--from ${from} is after the end, ${end} s`);
  await goTo(page, from);
  await turn(page);
  mkdirSync(folder, { recursive: true });
  const count = Math.floor((end - from) * rate * (1 + 1e-9)) + 1;
  for (let k = 0; k < count; ++k) {
    const time = from + k / rate;
    await moveOn(page, Math.max(from, time - 1 / rate), Math.min(time, length));
    await page.screenshot({ path: path.join(folder, `frame_${String(k).padStart(5, "0")}.png`) });
  }
  console.log(`frames: ${count} of ${width} x ${height} in ${folder}`);
}

const server = spawn(IRDM_SERVER, [path.resolve(scene), "--play", path.resolve(trace), "--port", "0"], {
  stdio: ["ignore", "pipe", "inherit"],
});
let browser;
try {
  const url = await listening(server);
  browser = await chromium.launch({
    executablePath: CHROMIUM,
    args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
  });
  const page = await browser.newPage({
    viewport: { width, height },
    colorScheme: values.dark ? "dark" : "light",
    bypassCSP: true, // for a style of our own that leaves out the controls
  });
  await page.goto(url);
  await takeAll(page);
} catch (error) {
  console.error(`frames: ${error.message.split("\n")[0]}`);
  process.exitCode = 1;
} finally {
  await browser?.close();
  server.kill("SIGTERM");
}
