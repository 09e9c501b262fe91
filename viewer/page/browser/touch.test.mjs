// The mouse as a stylus, in a real browser against real irdm-server: contact, grab, reset, onlookers, recordings.
// Programs, model and browser are named by the environment: tests/system/CMakeLists.txt.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { readdirSync } from "node:fs";
import path from "node:path";
import { test } from "node:test";
import { frames, onScreen, open, until } from "./browser.mjs";
import { Stage } from "./stage.mjs";

const TETHERED = "tether = { stiffness = 100, angular_stiffness = 0.1 }\ndamping = { linear = 5, angular = 5 }\n";
const SMALL = { viewport: { width: 780, height: 360 }, deviceScaleFactor: 0.5 }; // drawn by software, it has to be quick
const FRONT = [0, 0, 0.06]; // middle of a face, B

/** Every frame's last stylus and first object, as the page got them. */
function watch(page) {
  return page.evaluate(() => {
    window.seen = [];
    window.irdm.onFrame(({ step, time, styluses, objects }) => {
      const { present, contact, force, middle } = styluses.at(-1);
      window.seen.push({ step, time, present, contact, middle, force: Math.hypot(...force), position: objects[0].position });
    });
  });
}

/** Waits until the page has seen something; what it saw instead is in the error. */
async function sees(page, condition) {
  try {
    await page.waitForFunction(condition, null, { polling: 50 });
  } catch (error) {
    const last = await page.evaluate(() => JSON.stringify([window.irdm.state(), window.seen.slice(-40)]));
    throw new Error(`${error.message}\n${condition}\n${await page.locator("#notices").innerText()}\n${last}`);
  }
}
const says = (page, words) =>
  until(async () => words.test(await page.locator("#notices").innerText()), `it says ${words}`);
const mode = (page) => page.locator("#modes").innerText();

async function ready(context, stage, server, query = "") {
  const page = await open(context, server.url + query, SMALL);
  await frames(page);
  await page.waitForFunction(() => window.irdm.state() !== null);
  await watch(page);
  return page;
}

async function press(page, point = FRONT) {
  const { x, y } = await onScreen(page, point);
  await page.mouse.move(x, y);
  await page.mouse.down();
  return { x, y };
}

/** Steps of a trace in which stylus 1, the viewers', touched: row, step and size of the force. Read by Debian's h5py. */
function touched(trace) {
  const script = `
import h5py, json, sys
with h5py.File(sys.argv[1]) as f:
    s = f["/stylus/1"]
    size = (s["force"][:] ** 2).sum(axis=1) ** 0.5
    rows = zip(f["/step/force_step"][:], size, s["contact"][:])
    print(json.dumps([{"row": i, "step": int(k), "force": float(n)} for i, (k, n, c) in enumerate(rows) if c]))
`;
  return JSON.parse(execFileSync("/usr/bin/python3", ["-c", script, trace]).toString());
}

test("a press makes a contact, whose force is in the recorded trace", async (context) => {
  const stage = new Stage(context, "", TETHERED);
  const trace = stage.path("trace.h5");
  const server = await stage.server("--record", trace);
  const page = await ready(context, stage, server);
  await press(page);
  await sees(page, () => window.seen.filter(({ contact, force }) => contact === 1 && force > 0.02).length > 5);
  await until(async () => /[0-9.]+ N/.test(await page.locator("#felt").innerText()), "the force is shown");
  await page.mouse.up();
  await sees(page, () => !window.irdm.frame().styluses.at(-1).present);
  const seen = await page.evaluate(() => window.seen.filter(({ contact }) => contact !== 0));
  assert.deepEqual(page.faults, []); // later it misses the server
  server.kill("SIGTERM");
  assert.equal(await server.ended, 0);
  const recorded = new Map(touched(trace).map(({ step, force }) => [step, force]));
  assert.ok(recorded.size > 20, `${recorded.size} steps of contact are in the trace`);
  for (const { step, force, middle } of seen) {
    assert.ok(recorded.has(step), `step ${step} is a contact in the trace, too`);
    assert.ok(Math.abs(recorded.get(step) - force) < 1e-5, `step ${step}: ${recorded.get(step)} N, seen ${force} N`);
    assert.ok(Math.abs(Math.max(...middle.map(Math.abs)) - 0.06) < 1e-3, "it is on the surface at rest");
  }
  context.diagnostic(`${seen.length} frames of contact, up to ${Math.max(...seen.map(({ force }) => force)).toFixed(2)} N`);
});

test("a grab swings the object, and a reset puts it back", async (context) => {
  // So damped that it ends beside the mouse and does not tumble about it, however late the page looks.
  const stage = new Stage(context, "", "damping = { linear = 10, angular = 100 }\n");
  const server = await stage.server();
  const page = await ready(context, stage, server);
  await page.keyboard.down("Shift");
  const { x, y } = await press(page);
  await sees(page, () => window.irdm.frame().styluses.at(-1).contact === 2);
  await page.mouse.move(x + 60, y, { steps: 6 });
  await sees(page, () => window.irdm.frame().objects[0].position[0] > 0.02);
  await page.mouse.move(x - 60, y, { steps: 6 });
  await sees(page, () => window.irdm.frame().objects[0].position[0] < -0.01);
  await page.mouse.up();
  await page.keyboard.up("Shift");
  await sees(page, () => window.irdm.frame().styluses.at(-1).present === false);
  await page.locator("#reset").click();
  await sees(page, () => Math.hypot(...window.irdm.frame().objects[0].position) < 1e-6);
  assert.deepEqual(page.faults, []);
});

test("a press goes on after everything was reset", async (context) => {
  const stage = new Stage(context, "", TETHERED);
  const server = await stage.server();
  const page = await ready(context, stage, server);
  await press(page);
  await sees(page, () => window.irdm.frame().styluses.at(-1).contact === 1);
  await page.keyboard.press("r");
  await page.evaluate(() => (window.seen = []));
  await sees(page, () => window.seen.some(({ present, contact }) => present && contact === 0));
  await sees(page, () => window.irdm.frame().styluses.at(-1).contact === 1);
  await page.mouse.up();
});

test("the press of an onlooker does nothing; two viewers see the same", async (context) => {
  const stage = new Stage(context, "", TETHERED);
  const server = await stage.server();
  const page = await ready(context, stage, server);
  const onlooker = await ready(context, stage, server, "?watch=1");
  assert.match(await mode(onlooker), /view only/);
  await press(onlooker);
  await says(onlooker, /view only/);
  await onlooker.waitForTimeout(500);
  assert.equal(await onlooker.evaluate(() => window.seen.some(({ present }) => present)), false);
  await onlooker.mouse.up();
  await press(page);
  await sees(onlooker, () => window.irdm.frame().styluses.at(-1).contact === 1);
  await sees(onlooker, () => !window.irdm.state().stylusFree && !window.irdm.state().stylusMine);
  await page.mouse.up();
  await sees(onlooker, () => window.irdm.state().stylusFree);
});

test("after the server is killed and started again the mouse is a stylus again", async (context) => {
  const stage = new Stage(context, "[viewer]\nport = 0\n", TETHERED);
  const first = await stage.server();
  const page = await ready(context, stage, first);
  await press(page);
  await sees(page, () => window.irdm.frame().styluses.at(-1).contact === 1);
  first.kill("SIGKILL");
  await until(async () => /lost|Connecting/.test(await page.locator("#link").innerText()), "the page sees the loss");
  assert.equal(await page.locator("#felt").isVisible(), false);
  await page.mouse.up();
  stage.scene(`[viewer]\nport = ${new URL(first.url).port}\n`, TETHERED);
  await stage.server();
  await until(async () => (await page.locator("#link").innerText()) === "Live", "it is live again");
  await sees(page, () => window.irdm.state() !== null && window.irdm.frame() !== null);
  await press(page);
  await sees(page, () => window.irdm.frame().styluses.at(-1).contact === 1);
  await page.mouse.up();
});

test("paused, it stands still; a step is a step; settings are taken", async (context) => {
  const stage = new Stage(context, "[world]\ngravity = [0, -0.2, 0]\n", "");
  const server = await stage.server();
  const page = await ready(context, stage, server);
  await page.keyboard.press("p");
  await sees(page, () => window.irdm.state().paused);
  // Frames from before the pause may still be under way where the machine is busy.
  const step = () => page.evaluate(() => window.irdm.frame().step);
  let before = await step();
  for (let seen = -1; seen !== before; before = await step()) {
    seen = before;
    await page.waitForTimeout(500);
  }
  await page.keyboard.press(".");
  await page.waitForFunction((step) => window.irdm.frame().step === step, before + 1);
  await page.waitForTimeout(200);
  assert.equal(await page.evaluate(() => window.irdm.frame().step), before + 1);
  await page.locator("#settings-section summary").click();
  await page.getByLabel("Gravity", { exact: true }).fill("250");
  await sees(page, () => window.irdm.state().changes > 0 && window.irdm.state().settings.gravity[1] === -5);
  await page.keyboard.press("p");
  await page.waitForFunction((step) => window.irdm.frame().step > step + 10, before);
  assert.deepEqual(page.faults, []);
});

test("what was recorded is played, sought in, and left", async (context) => {
  const stage = new Stage(context, "", TETHERED);
  const recordings = stage.path("recordings");
  const server = await stage.server("--recordings", recordings);
  const page = await ready(context, stage, server);
  await page.locator("#record").click();
  await sees(page, () => window.irdm.state().recording);
  await page.waitForTimeout(200); // everything is reset first
  await press(page);
  await sees(page, () => window.seen.filter(({ contact, force }) => contact === 1 && force > 0.02).length > 5);
  await page.waitForTimeout(700);
  await page.mouse.up();
  await sees(page, () => !window.irdm.frame().styluses.at(-1).present);
  await page.locator("#record").click();
  await until(async () => (await page.locator("#recordings li").count()) === 1, "it is listed");
  await says(page, /recorded: /);
  const [file] = readdirSync(recordings);
  const recorded = new Map(touched(path.join(recordings, file)).map(({ row, force }) => [row, force]));
  assert.ok(recorded.size > 10);

  await page.locator("#recordings button").click();
  await sees(page, () => window.irdm.state().playback?.length > 0);
  assert.equal(await page.locator("#playback").isVisible(), true);
  await press(page);
  await page.mouse.up();
  await says(page, /recorded run is shown/);
  await sees(page, () => !window.irdm.state().playback.playing); // at its end; from there a click would play it again
  const { length } = await page.evaluate(() => window.irdm.state().playback);
  const middle = Number((length / 2).toFixed(2));
  await page.locator("#seek").fill(String(middle));
  await page.waitForFunction((middle) => Math.abs(window.irdm.frame().time - middle) < 0.05, middle);
  await page.locator("#seek").fill("0");
  await page.waitForFunction(() => window.irdm.frame().time < 0.05);
  await page.locator("#speed").selectOption("0.1");
  await page.evaluate(() => (window.seen = []));
  await page.locator("#play").click();
  await sees(page, () => window.seen.some(({ contact, force }) => contact === 1 && force > 0.02));
  await page.locator("#play").click();
  await sees(page, () => !window.irdm.state().playback.playing);
  const played = await page.evaluate(() => window.seen.filter(({ contact }) => contact === 1));
  for (const { step, force } of played) {
    assert.ok(Math.abs(recorded.get(step) - force) < 1e-5, `step ${step}: ${recorded.get(step)} N, played ${force} N`);
  }
  context.diagnostic(`${length.toFixed(2)} s, ${played.length} frames of contact played`);
  await page.locator("#back-to-live").click();
  await sees(page, () => window.irdm.state().playback === null && !window.irdm.state().paused);
  await until(async () => !(await page.locator("#playback").isVisible()), "the bar is gone");
  assert.deepEqual(page.faults, []);
});
