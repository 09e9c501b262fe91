// Makes the frames of the README's moving picture: a recorded run on irdm-server's page in headless Chromium, slowed
// down, light and dark.
//   node moving_picture.mjs SCENE TRACE OUT      OUT/light-NNN.png, OUT/dark-NNN.png; programs: IRDM_SERVER, CHROMIUM
import { mkdirSync } from "node:fs";
import path from "node:path";
import { DEADLINE_MS, launch, listening, start } from "./programs.mjs";

const { IRDM_SERVER, CHROMIUM } = process.env;
const [scene, trace, out] = process.argv.slice(2);
const INTERVAL = 1 / 15; // of the run [s]
const SIZE = { width: 960, height: 480 };
// The objects and the force. What is left out tells of the playback, which is held for each frame.
const LOOK =
  "#playback, #notices, #modes, .status, .panel > section, .panel > details:not(:has(#plot)), .panel .actions, " +
  "#plot-hint { display: none !important }";

const set = (page, id, key, value, event = "input") =>
  page.evaluate(
    ([id, key, value, event]) => {
      const input = document.getElementById(id);
      input[key] = value;
      input.dispatchEvent(new Event(event));
    },
    [id, key, value, event],
  );

async function open(browser, address, colorScheme) {
  const page = await browser.newPage({ viewport: SIZE, colorScheme, bypassCSP: true });
  await page.goto(address);
  await page.waitForFunction(() => window.irdm?.frame() != null, null, { timeout: DEADLINE_MS });
  await page.addStyleTag({ content: LOOK });
  await set(page, "rigid", "checked", true);
  await set(page, "exaggeration", "value", "3");
  return page;
}

/** Both pages show the same run; the first one has its controls. */
async function play(pages, wanted) {
  const isPlaying = () => window.irdm.state().playback.playing;
  if ((await pages[0].evaluate(isPlaying)) === wanted) return;
  await pages[0].evaluate(() => document.getElementById("play").click());
  await pages[0].waitForFunction((wanted) => window.irdm.state().playback.playing === wanted, wanted, { timeout: DEADLINE_MS });
}

async function begin(pages) {
  await play(pages, false);
  await set(pages[0], "speed", "value", "0.1", "change");
  await set(pages[0], "seek", "value", "0");
  for (const page of pages) {
    await page.waitForFunction(() => window.irdm.frame().time < 0.05, null, { timeout: DEADLINE_MS });
    await page.evaluate(() => window.irdm.world.fit());
  }
}

/** Held while both are drawn, so that they show the same. */
async function take(pages, number) {
  await play(pages, true);
  await pages[0].waitForFunction((time) => window.irdm.frame().time >= time, number * INTERVAL, {
    timeout: DEADLINE_MS,
    polling: 5,
  });
  await play(pages, false);
  for (const [k, name] of ["light", "dark"].entries()) {
    await pages[k].screenshot({ path: path.join(out, `${name}-${String(number).padStart(3, "0")}.png`) });
  }
}

mkdirSync(out, { recursive: true });
const server = start(IRDM_SERVER, scene, "--play", trace);
const browser = await launch(CHROMIUM);
try {
  const { page: address } = await listening(server);
  const pages = [await open(browser, address, "light"), await open(browser, address, "dark")];
  await begin(pages);
  const { length } = await pages[0].evaluate(() => window.irdm.state().playback);
  for (let number = 1; number * INTERVAL < length; ++number) await take(pages, number);
} finally {
  await browser.close();
  server.kill();
}
