// Makes the pictures of the README: real irdm-server and irdm-bridge, the page in headless Chromium, light and dark; and
// the frames of its moving picture, film-NNN.png, from a run that is recorded in lockstep and played.
//   node screenshots.mjs CONFIGS MODELS OUT      folders; MODELS has SCENE.h5; programs: IRDM_SERVER, IRDM_BRIDGE, CHROMIUM
import { spawn } from "node:child_process";
import { copyFileSync, mkdtempSync, rmSync, symlinkSync } from "node:fs";
import { tmpdir } from "node:os";
import path from "node:path";
import { chromium } from "playwright-core";

const { IRDM_SERVER, IRDM_BRIDGE, CHROMIUM } = process.env;
const [configs, models, out] = process.argv.slice(2).map((name) => path.resolve(name));
const DEADLINE_MS = 60_000;
const SIZE = { width: 1200, height: 750 };

// `when` says in the page whether what it shows is worth a picture.
const PICTURES = [
  {
    name: "cube",
    scene: "paper-cube",
    bridge: "demo",
    when: () => {
      const { time, styluses } = window.irdm.frame();
      if (styluses[0].contact !== 2) return false;
      window.heldSince ??= time;
      return time > window.heldSince + 1.5 && Math.hypot(...styluses[0].force) > 0.3;
    },
    prepare: async (page) => {
      await page.locator("#rigid").check();
      await page.locator("#exaggeration").fill("3");
    },
  },
  {
    name: "liver",
    scene: "liver",
    bridge: "palpate",
    when: () => {
      const [stylus] = window.irdm.frame().styluses;
      return stylus.contact !== 0 && stylus.tip[0] > 0.04 && Math.hypot(...stylus.force) > 0.3;
    },
    prepare: (page) => page.locator("#colour").selectOption("displacement"),
  },
];

const FILM = { width: 960, height: 600 };
const MOVING = {
  scene: "paper-cube",
  bridge: "demo",
  seconds: 14,
  step: 0.1,
  prepare: async (page) => {
    await page.locator("#exaggeration").fill("3");
  },
};

function start(program, ...words) {
  const child = spawn(program, words, { stdio: ["ignore", "pipe", "inherit"] });
  child.output = "";
  child.stdout.on("data", (data) => (child.output += data));
  return child;
}

async function until(condition, what) {
  const deadline = Date.now() + DEADLINE_MS;
  while (!condition()) {
    if (Date.now() > deadline) throw new Error(`not in time: ${what}`);
    await new Promise((resolve) => setTimeout(resolve, 20));
  }
}

async function take(browser, { name, scene, bridge, when, prepare }) {
  const folder = mkdtempSync(path.join(tmpdir(), "irdm-screenshots-"));
  const children = [];
  try {
    copyFileSync(path.join(configs, "scenes", `${scene}.toml`), path.join(folder, "scene.toml"));
    symlinkSync(path.join(models, `${scene}.h5`), path.join(folder, `${scene}.h5`));
    const server = start(IRDM_SERVER, path.join(folder, "scene.toml"));
    children.push(server);
    await until(() => /on http\S+\n/.test(server.output), "the server listens");
    const page = await browser.newPage({ viewport: SIZE });
    await page.goto(/listening on (http\S+)/.exec(server.output)[1]);
    await page.waitForFunction(() => window.irdm?.frame() != null, null, { timeout: DEADLINE_MS });
    await prepare(page);
    const address = /listening on (\d\S+)/.exec(server.output)[1];
    children.push(start(IRDM_BRIDGE, path.join(configs, "bridges", `${bridge}.toml`), "--server", address));
    // The server stands still while the picture is taken, so that light and dark show the same.
    await page.waitForFunction(when, null, { timeout: DEADLINE_MS, polling: 20 });
    server.kill("SIGSTOP");
    await page.evaluate(() => {
      document.activeElement?.blur();
      window.irdm.world.fit();
    });
    for (const colorScheme of ["light", "dark"]) {
      await page.emulateMedia({ colorScheme });
      await page.waitForTimeout(300);
      await page.screenshot({ path: path.join(out, `${name}-${colorScheme}.png`) });
    }
    await page.close();
  } finally {
    for (const child of children) child.kill("SIGKILL");
    rmSync(folder, { recursive: true, force: true });
  }
}

function ended(child) {
  return new Promise((resolve, reject) =>
    child.on("exit", (status) => (status === 0 ? resolve() : reject(new Error(`${child.spawnfile}: status ${status}`)))),
  );
}

async function film(browser, { scene, bridge, seconds, step, prepare }) {
  const folder = mkdtempSync(path.join(tmpdir(), "irdm-film-"));
  const children = [];
  const inFolder = (name) => path.join(folder, name);
  try {
    copyFileSync(path.join(configs, "scenes", `${scene}.toml`), inFolder("scene.toml"));
    symlinkSync(path.join(models, `${scene}.h5`), inFolder(`${scene}.h5`));
    const run = ["--lockstep", "--duration", String(seconds), "--record", inFolder("trace.h5"), "--no-viewer"];
    const recorder = start(IRDM_SERVER, inFolder("scene.toml"), "--port", "0", ...run);
    children.push(recorder);
    const over = ended(recorder);
    await until(() => /listening on \d\S+/.test(recorder.output), "the server listens");
    const address = /listening on (\d\S+)/.exec(recorder.output)[1];
    const words = ["--server", address, "--duration", String(seconds)];
    children.push(start(IRDM_BRIDGE, path.join(configs, "bridges", `${bridge}.toml`), ...words));
    await over;
    const player = start(IRDM_SERVER, inFolder("scene.toml"), "--port", "0", "--play", inFolder("trace.h5"));
    children.push(player);
    await until(() => /on http\S+\n/.test(player.output), "the recording is shown");
    const page = await browser.newPage({ viewport: FILM, colorScheme: "light" });
    await page.goto(/(http\S+)/.exec(player.output)[1]);
    await page.waitForFunction(() => window.irdm?.frame() != null, null, { timeout: DEADLINE_MS });
    await page.locator("#playback").evaluate((bar) => bar.style.setProperty("display", "none"));
    await prepare(page);
    await page.evaluate(() => window.irdm.world.fit());
    await page.locator("#speed").evaluate((speed) => {
      speed.selectedIndex = 0;
      speed.dispatchEvent(new Event("change"));
    });
    const toggle = () => page.evaluate(() => document.getElementById("play").click());
    for (let k = 0; k < seconds / step; ++k) {
      await toggle();
      await page.waitForFunction((time) => window.irdm.frame().time >= time, k * step, { timeout: DEADLINE_MS, polling: 5 });
      await toggle();
      await page.waitForTimeout(60);
      await page.screenshot({ path: path.join(out, `film-${String(k).padStart(3, "0")}.png`) });
    }
    await page.close();
  } finally {
    for (const child of children) child.kill("SIGKILL");
    rmSync(folder, { recursive: true, force: true });
  }
}

const browser = await chromium.launch({
  executablePath: CHROMIUM,
  args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
});
try {
  for (const picture of PICTURES) {
    console.log(`screenshots: ${picture.name}`);
    await take(browser, picture);
  }
  console.log("screenshots: film");
  await film(browser, MOVING);
} finally {
  await browser.close();
}
