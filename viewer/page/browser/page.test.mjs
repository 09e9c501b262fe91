// The page alone in a real browser, against a server of a few lines (fake_server.mjs): what it shows and what it says.
// PAGE names the folder of the built page, CHROMIUM the browser.
import assert from "node:assert/strict";
import { readFile } from "node:fs/promises";
import { test } from "node:test";
import { accessibilityFaults, contrastsOverPicture } from "./accessibility.mjs";
import { frames, newContext, onScreen, until, visit } from "./browser.mjs";
import { FakeServer, loadMessages } from "./fake_server.mjs";
import { different, LARGE, pixel, pixels, SMALL, stage } from "./page_stage.mjs";

const TOP = [0, 0.05, 0]; // of the cube, B

const said = (server, type) => server.received.filter((message) => message.type === type);
const asked = (server, what) => said(server, "command").filter((message) => message.what === what);

async function press(page, point = TOP) {
  const { x, y } = await onScreen(page, point);
  await page.mouse.move(x, y);
  await page.mouse.down();
  return { x, y };
}

test("a press on the object pushes it along the view, and goes on until it ends", async (context) => {
  const { page, server } = await stage(context);
  assert.equal(await page.locator("#hint").isVisible(), true);
  const camera = () => page.evaluate(() => window.irdm.world.camera.position.toArray());
  const before = await camera();
  const { x, y } = await press(page);
  await until(() => said(server, "stylus").length > 5, "the stylus is there");
  const messages = said(server, "stylus");
  assert.ok(messages[0].tip[1] > 0.05 + 0.0005, `it begins outside, at ${messages[0].tip[1]} m`); // 5 mm along the view
  assert.ok(messages.every(({ present, grab }) => present && !grab));
  await until(() => server.stylus.tip[1] < 0.05 - 0.001, "it goes in");
  const count = said(server, "stylus").length;
  await until(() => said(server, "stylus").length > count + 5, "it goes on while nothing moves");
  await until(async () => /N/.test(await page.locator("#felt").innerText()), "the force is shown");
  assert.match(await page.locator("#felt").innerText(), /^[0-9.]+ N\s+sticks$/);
  assert.equal(await page.locator("#hint").isVisible(), false);

  // Dragging slides it parallel to the screen; the wheel goes deeper.
  const held = server.stylus.tip;
  await page.mouse.move(x + 30, y);
  await until(() => server.stylus.tip[0] > held[0] + 0.003, "it slides");
  const slid = server.stylus.tip;
  await page.mouse.wheel(0, -300);
  await until(() => server.stylus.tip[1] < slid[1] - 0.0005, "it goes deeper");
  await page.mouse.up();
  await until(() => !server.stylus.present, "it is gone");
  assert.equal(await page.locator("#felt").isVisible(), false);
  assert.deepEqual(await camera(), before, "the camera has stayed where it was");

  // Beside the object the view is turned as ever.
  await page.mouse.move(20, 240);
  await page.mouse.down();
  await page.mouse.move(60, 250);
  await page.mouse.up();
  assert.equal(server.stylus.present, false);
  assert.notDeepEqual(await camera(), before);
  assert.deepEqual(page.faults, []);
});

/** The tools that are lit: with the accent as their ground. */
const lit = (page) =>
  page.evaluate(() => {
    const probe = document.body.appendChild(document.createElement("i"));
    probe.style.background = "var(--accent)";
    const { backgroundColor: accent } = getComputedStyle(probe);
    probe.remove();
    const inputs = [...document.querySelectorAll("input[name=tool]")];
    for (const span of document.querySelectorAll(".choice span")) span.style.transition = "none";
    return inputs.filter((input) => getComputedStyle(input.nextElementSibling).backgroundColor === accent).map(({ value }) => value);
  });

test("Shift, G and the tool take hold", async (context) => {
  const { page, server } = await stage(context);
  for (const key of ["Shift", "g"]) {
    assert.deepEqual(await lit(page), ["push"]);
    await page.keyboard.down(key);
    assert.deepEqual(await lit(page), ["grab"], `${key} lights Grab alone`);
    await press(page);
    await until(() => server.stylus.present && server.stylus.grab, `${key} takes hold`);
    await page.keyboard.up(key);
    await until(() => !server.stylus.grab, "it pushes");
    await page.mouse.up();
    await until(() => !server.stylus.present, "it is gone");
  }
  await page.locator("input[name=tool][value=grab]").check();
  await press(page);
  await until(() => server.stylus.grab, "the tool takes hold");
  await until(async () => /held/.test(await page.locator("#felt").innerText()), "it is said");
  await page.mouse.up();
});

test("a finger pushes, a second one takes hold", async (context) => {
  const { page, server } = await stage(context, { options: { ...SMALL, hasTouch: true } });
  const { x, y } = await onScreen(page, TOP);
  const session = await page.context().newCDPSession(page);
  const touch = (type, ...points) =>
    session.send("Input.dispatchTouchEvent", { type, touchPoints: points.map(([x, y], id) => ({ x, y, id })) });
  await touch("touchStart", [x, y]);
  await until(() => server.stylus.present && !server.stylus.grab, "it pushes");
  await touch("touchStart", [x, y], [x + 60, y + 60]);
  await until(() => server.stylus.grab, "it takes hold");
  await touch("touchEnd", [x, y]);
  await until(() => !server.stylus.grab, "it pushes again");
  await touch("touchEnd");
  await until(() => !server.stylus.present, "it is gone");
});

test("everything can be touched by keys", async (context) => {
  const { page, server } = await stage(context);
  await page.keyboard.press("t");
  assert.equal(await page.locator("#cross").isVisible(), true);
  await page.keyboard.press("Space");
  await until(() => server.stylus.present, "it presses");
  const { tip } = server.stylus;
  await page.keyboard.down("ArrowRight");
  await until(() => server.stylus.tip[0] > tip[0] + 0.002, "it slides");
  await page.keyboard.up("ArrowRight");
  await page.keyboard.press("g");
  await until(() => server.stylus.grab, "it takes hold");
  await page.keyboard.press("Space");
  await until(() => !server.stylus.present, "it lets go");
  await page.keyboard.press("g");
  await page.keyboard.press("Space");
  await until(() => server.stylus.present && !server.stylus.grab, "it presses again");
  await page.keyboard.press("Escape");
  assert.equal(await page.locator("#cross").isVisible(), false, "one Esc ends it");
  await until(() => !server.stylus.present, "it has let go, too");
});

test("whoever cannot touch is told why, and sends nothing", async (context) => {
  const { page, server } = await stage(context, { query: "?watch=1" });
  assert.deepEqual(said(server, "hello"), [{ type: "hello", looksOn: 1 }]);
  assert.match(await page.locator("#modes").innerText(), /view only/);
  for (const button of ["#reset", "#pause", "#step", "#record"]) {
    assert.equal(await page.locator(button).isDisabled(), true, button);
  }
  await press(page);
  await until(async () => /view only/.test(await page.locator("#notices").innerText()), "it says so");
  await page.mouse.up();
  await page.keyboard.press("r");
  server.flag("looksOn", false);
  server.flag("free", false);
  await until(() => page.evaluate(() => !window.irdm.state().stylusFree), "another has the stylus");
  await press(page);
  await until(async () => /Another viewer/.test(await page.locator("#notices").innerText()), "it says so");
  await page.mouse.up();
  assert.equal(said(server, "stylus").length + said(server, "command").length, 0);
});

test("a stylus that is lost to another ends the press", async (context) => {
  const { page, server } = await stage(context);
  await press(page);
  await until(() => server.stylus.present, "it is there");
  const none = 0;
  server.tell({ flags: none });
  await until(async () => /Another viewer/.test(await page.locator("#notices").innerText()), "it says so");
  assert.equal(await page.locator("#felt").isVisible(), false);
});

test("the run is paused, stepped, reset and recorded by buttons and keys", async (context) => {
  const { page, server } = await stage(context);
  await page.keyboard.press("p");
  await until(async () => /paused/.test(await page.locator("#modes").innerText()), "it is paused");
  assert.match(await page.locator("#pause").innerText(), /^Resume/);
  await page.locator("#step").click();
  await page.keyboard.press(".");
  await until(() => asked(server, 4).length === 2, "two steps");
  assert.equal(asked(server, 4)[0].number, 1);
  await page.locator("#pause").click();
  await until(() => page.locator("#step").isDisabled(), "it goes on");
  await page.keyboard.press("r");
  await until(() => asked(server, 1).length === 1, "it is reset");
  await page.locator("#record").click();
  await until(async () => /recording/.test(await page.locator("#modes").innerText()), "it is recorded");
  await page.locator("#record").click();
  await until(async () => (await page.locator("#recordings li").count()) === 1, "the recording is listed");
  assert.deepEqual(page.faults, []);
});

test("a recorded run is shown, sought in, and left", async (context) => {
  const { page, server } = await stage(context, { state: { recordings: [{ number: 3, name: "a run" }] } });
  await page.getByLabel("Show the recording a run").click();
  await until(() => page.locator("#playback").isVisible(), "the bar is there");
  assert.equal(asked(server, 7)[0].number, 3);
  assert.equal(await page.locator("#tools").isVisible(), false);
  await page.locator("#play").click();
  await until(async () => (await page.locator("#play").innerText()) === "Pause", "it plays");
  await page.locator("#speed").selectOption("0.25");
  await until(() => asked(server, 12)[0]?.value === 0.25, "it is slower");
  await page.locator("#seek").fill("5");
  await until(() => asked(server, 11).at(-1)?.value === 5, "it is sought");
  await until(async () => /^5\.\d\d \/ 8\.00 s$/.test(await page.locator("#seek-value").innerText()), "it goes on from there");
  // What moves the slider between the hand and its message, as a frame does, does not change what is sought.
  await page.evaluate(() => {
    const slider = document.querySelector("#seek");
    for (const place of ["2", "3"]) {
      slider.value = place;
      slider.dispatchEvent(new Event("input"));
    }
    slider.value = "7";
  });
  await until(() => asked(server, 11).some(({ value }) => value === 3), "the last place is sought");
  assert.equal(asked(server, 11).some(({ value }) => value === 7), false);
  await page.locator("#back-to-live").click();
  await until(async () => !(await page.locator("#playback").isVisible()), "it is left");
  assert.deepEqual(page.faults, []);
});

const LISTED = { flags: 2 + 128 + 256 + 512, scenes: ["a scene with a name that is as long as names can be, or so.toml", "press.toml", "würfel.h5"], scene: 1 };

test("a scene is chosen, loaded and saved by keys; whoever cannot is told why", async (context) => {
  const { page, server } = await stage(context, { state: LISTED });
  const choice = page.getByLabel("Scene", { exact: true }).and(page.locator("select"));
  const [load, save] = ["Load", "Save as scene"].map((name) => page.getByRole("button", { name, exact: true }));
  assert.deepEqual(await choice.locator("option").allInnerTexts(), [LISTED.scenes[0], "press.toml (shown)", "würfel.h5"]);
  assert.equal(await choice.inputValue(), "press.toml");
  await choice.focus();
  await page.keyboard.press("ArrowDown");
  server.tell({ scenes: ["another.toml", ...LISTED.scenes], scene: 2 }); // meanwhile
  await until(async () => (await choice.locator("option").count()) === 4, "the new one is listed");
  assert.equal(await choice.inputValue(), "würfel.h5", "what is chosen stays so");
  await page.keyboard.press("Tab");
  await page.keyboard.press("Enter");
  await until(() => load.isDisabled(), "a scene is being loaded");
  assert.deepEqual(said(server, "load"), [{ type: "load", name: "würfel.h5" }]);
  assert.equal(await save.isDisabled(), true);
  assert.match(await page.locator("#scenes-reason").innerText(), /being loaded or saved/);
  server.flag("preparing", false);
  await until(() => save.isEnabled(), "it is done");
  await save.focus();
  await page.keyboard.press("Space");
  await until(() => asked(server, 13).length === 1, "it is saved");

  server.flag("canLoad", false);
  await until(() => choice.isDisabled(), "this run keeps its scene");
  assert.match(await page.locator("#scenes-reason").innerText(), /records this run as a whole/);
  assert.equal(await save.isEnabled(), true);
  server.flag("canLoad", true);
  server.flag("recording", true);
  await until(() => load.isDisabled(), "a recording comes first");
  assert.match(await page.locator("#scenes-reason").innerText(), /End the recording/);
  server.flag("recording", false);
  server.tell({ scenes: [], scene: 65535 });
  await until(async () => /no scenes yet/.test(await page.locator("#scenes-reason").innerText()), "the folder is empty");
  server.flag("hasScenes", false);
  await until(async () => !(await page.locator("#scenes-section").isVisible()), "it is hidden without a folder");
  assert.deepEqual(page.faults, []);
});

test("an onlooker sees which scenes there are, and can neither load nor save", async (context) => {
  const { page } = await stage(context, { state: LISTED, query: "?watch=1" });
  await until(async () => /view only/.test(await page.locator("#scenes-reason").innerText()), "it says why");
  for (const id of ["#scene-choice", "#scene-load", "#scene-save"]) assert.equal(await page.locator(id).isDisabled(), true, id);
});

test("settings go out whole, and come back without a fight", async (context) => {
  const { page, server } = await stage(context);
  await page.locator("#settings-section summary").click();
  const slider = (name) => page.getByLabel(name, { exact: true });
  await slider("Friction").fill("100"); // 0.2 of 2, below what it is while slipping
  await until(() => said(server, "settings").length > 0, "they are sent");
  await until(() => said(server, "settings").at(-1).kineticFriction === 0.2, "friction takes the other along");
  assert.equal(said(server, "settings").at(-1).staticFriction, 0.2);
  assert.equal(await slider("Friction while slipping").inputValue(), "100");
  // What the server says meanwhile does not move what is under the hand.
  await slider("Friction").fill("700");
  server.state.objects[0].staticFriction = 0.1;
  server.tell({});
  assert.equal(await slider("Friction").inputValue(), "700");
  // A change by somebody else is shown.
  await until(async () => (await slider("Gravity").inputValue()) === "0", "there is no gravity");
  await page.waitForTimeout(1200);
  server.tell({ gravity: [0, -10, 0] });
  await until(async () => (await slider("Gravity").inputValue()) === "500", "there is gravity");
  server.state.objects[0].changeable = 1;
  server.tell({});
  await until(() => slider("Centrifugal loading").isDisabled(), "its spin cannot be chosen");
  assert.match(await page.locator("#settings").innerText(), /no data for centrifugal loading/);
  assert.deepEqual(page.faults, []);
});

test("notices go when they are sent away, and by themselves", async (context) => {
  const { page, server } = await stage(context);
  server.tell({ notice: "The disk is full." });
  await until(async () => /disk is full/.test(await page.locator("#notices").innerText()), "it is shown");
  assert.equal(await page.locator("#notices").getAttribute("aria-live"), "polite");
  await page.getByLabel("Dismiss").click();
  assert.equal(await page.locator("#notices").innerText(), "");
  await page.mouse.move(10, 10);
  server.tell({ notice: "The disk is still full." });
  await until(async () => /still full/.test(await page.locator("#notices").innerText()), "it is shown");
  await until(async () => (await page.locator("#notices").innerText()) === "", "it has gone");
});

test("what is drawn is counted beside what is received, and rest is not drawn again", async (context) => {
  const { page } = await stage(context);
  const rates = async () => {
    const text = await page.locator("#rate").innerText();
    return /^(\d+) drawn\/s, (\d+) surfaces\/s$/.exec(text).slice(1).map(Number);
  };
  await until(async () => (await rates())[0] === 0 && (await rates())[1] > 3, "surfaces come in, nothing is drawn");
  // three.js counts for itself.
  const drawn = () => page.evaluate(() => window.irdm.world.renderer.info.render.frame);
  const before = await drawn();
  await press(page);
  await page.evaluate(() => window.irdm.world.move(0.01, 0, 1));
  let shown = 0;
  await until(async () => {
    await page.keyboard.press("ArrowLeft");
    shown = (await rates())[0];
    return shown > 0;
  }, "what is drawn is counted");
  const all = (await drawn()) - before;
  assert.ok(shown <= all, `${shown} shown in the last second, ${all} drawn in all`);
  await page.mouse.up();
});

test("help is open on the first visit, and not on the next; the wheel's direction is said", async (context) => {
  const { page } = await stage(context);
  assert.match(await page.locator("#help").innerText(), /deeper when turned up/);
  assert.match(await page.locator("#hint").innerText(), /wheel up goes deeper, down comes back/);
  await page.reload();
  await frames(page);
  assert.equal(await page.getByText("What you see.").isVisible(), false);
});

test("the cursor says what can be touched, and how", async (context) => {
  const { page, server } = await stage(context);
  const cursor = () => page.evaluate(() => getComputedStyle(window.irdm.world.canvas).cursor);
  const { x, y } = await onScreen(page, TOP);
  await page.mouse.move(x, y);
  await until(async () => (await cursor()) === "crosshair", "it is over the object");
  await page.keyboard.down("Shift");
  assert.equal(await cursor(), "grab");
  await page.keyboard.up("Shift");
  await page.mouse.move(20, 240);
  await until(async () => (await cursor()) === "auto", "it is beside it");
  server.flag("paused", true);
  await until(() => page.evaluate(() => window.irdm.state().paused), "it is paused");
  await page.mouse.move(x, y);
  await page.waitForTimeout(300);
  assert.equal(await cursor(), "auto", "paused, nothing can be touched");
});

test("health shows the bridges' times, the view its compliance", async (context) => {
  const { page } = await stage(context, { scene: { radii: [0, 0, 0.006] } });
  const rows = await page.locator("#health").innerText();
  assert.match(rows, /Round trip 1\s+310 µs\s+496 µs\s+930 µs/);
  assert.match(rows, /Age of force 2\s+1\.9 ms/);
  await page.locator("#colour").selectOption("compliance");
  assert.match(await page.locator("#legend").innerText(), /mm\/N/);
});

test("bodies of one material have no colours of the material, and the page says why", async (context) => {
  const { page } = await stage(context);
  const option = page.locator("#colour option[value=modulus]");
  assert.equal(await option.isDisabled(), true);
  assert.equal(await option.innerText(), "Young’s modulus (no body has regions)");
  for (let i = 0; i < 4; ++i) await page.keyboard.press("c");
  assert.equal(await page.locator("#colour").inputValue(), "none", "its key passes it over");
  assert.equal(await page.locator("#materials li").count(), 1);
  assert.equal(await page.locator("#materials").isVisible(), false);
});

const saturated = ([red, green, blue]) => Math.max(red, green, blue) - Math.min(red, green, blue) > 60;
const MIDDLE = [0.13, 0, 0]; // of the second object
const FRONT = [0.12, 0.03, 0.05]; // on its surface, before nothing

test("an inclusion is seen in the colour of its modulus through the body, with a legend", async (context) => {
  const options = { viewport: { width: 1000, height: 700 }, deviceScaleFactor: 1 };
  const { page } = await stage(context, { options, inclusions: {} });
  const colour = page.locator("#colour");
  const plain = await pixel(page, MIDDLE);
  assert.equal(saturated(plain), false);
  await colour.selectOption("modulus");
  const [red, green, blue, alpha] = await pixel(page, MIDDLE);
  assert.ok(alpha > 240, "the inclusion is solid");
  assert.ok(red > blue + 60 && green > blue + 60, `stiff is yellow, not ${red} ${green} ${blue}`);
  const before = await pixel(page, FRONT);
  assert.ok(before[3] < 230, `the surface is seen through, alpha ${before[3]}`);
  assert.equal((await pixel(page, [0, 0, 0]))[3], 255, "the other body stays opaque");

  const legend = await page.locator("#legend").innerText();
  assert.match(legend, /Young’s modulus, logarithmic\s+3\.25\skPa\s*42\.5\skPa/);
  const rows = await page.locator("#materials li").allInnerTexts();
  assert.deepEqual(rows.map((row) => row.replaceAll("\u00a0", " ")), [
    "plain\n20 kPa",
    "tissue, outside the regions\n3.25 kPa, ν 0.45, 1000 kg/m³",
    "tissue, region 1\n42.5 kPa, ν 0.3, 1100 kg/m³",
  ]);
  assert.match(await page.locator("#materials-note").innerText(), /drawn undeformed/);
  const swatches = await page.locator("#materials i").evaluateAll((list) => list.map((one) => getComputedStyle(one).backgroundImage));
  assert.equal(new Set(swatches).size, 3);

  await colour.selectOption("compliance");
  assert.equal(await page.locator("#materials").isVisible(), false);
  assert.equal((await pixel(page, FRONT))[3], 255);
  await colour.selectOption("none");
  assert.deepEqual(await pixel(page, MIDDLE), plain, "it is as before");
  assert.deepEqual(page.faults, []);
});

test("regions at the surface have sharp bounds, and what is left out is said", async (context) => {
  const options = { viewport: { width: 1000, height: 700 }, deviceScaleFactor: 1 };
  const triangles = 6 * 12 * 12 * 2;
  const surfaceModulus = Array.from({ length: triangles }, (_, t) => (t < triangles - 144 ? 3250 : 42500)); // half of the front
  const inclusions = { flags: 3, surfaceModulus, nodes: [], faces: [], faceModulus: [] };
  const { page } = await stage(context, { options, inclusions });
  await page.locator("#colour").selectOption("modulus");
  const row = await pixels(page, Array.from({ length: 24 }, (_, i) => [0.13 - 0.046 + 0.004 * i, 0, 0.05]));
  const yellow = row.map(([red, , blue]) => red > blue + 60);
  assert.deepEqual(yellow, [...yellow].sort(), "one side is stiff");
  assert.ok(yellow.includes(true) && yellow.includes(false));
  const between = row.filter(([red, green, blue]) => green > red + 30 && green > blue + 10);
  assert.equal(between.length, 0, "no colour of a modulus that is nowhere");
  assert.ok(row.every(([, , , alpha]) => alpha === 255), "with nothing to see inside the body is opaque");
  const note = await page.locator("#materials-note").innerText();
  assert.match(note, /tissue: too many faces inside to be drawn\. tissue: further regions are not listed\./);
  assert.doesNotMatch(note, /undeformed/);
});

test("regions of which a face has no such node are refused, and the page says so", async (context) => {
  const browserContext = await newContext(context, SMALL);
  const server = await FakeServer.start(browserContext, process.env.PAGE, { inclusions: { faces: [0, 1, 8], faceModulus: [42500] } });
  context.after(() => server.stop());
  const page = await browserContext.newPage();
  await visit(page, server.address);
  await until(async () => /has a node that is not there/.test(await page.locator("#link").innerText()), "it says so");
  assert.equal(await page.evaluate(() => window.irdm.scene()), null);
});

test("axe-core finds nothing, in light and in dark, live and recorded", async (context) => {
  const changes = { scene: { radii: [0, 0.006, 0.006], scenery: SCENERY }, inclusions: {}, state: { ...LISTED, recordings: [{ number: 0, name: "a run" }] } };
  const { page, server } = await stage(context, changes);
  await page.evaluate(() => document.querySelectorAll("details").forEach((details) => (details.open = true)));
  await page.locator("#colour").selectOption("modulus");
  await page.getByRole("button", { name: "Beside: plot Stylus 2" }).click();
  server.contacts = [PUSHED];
  const overPicture = ["h1", "#link span", "#hint .fine", "#touch-keys", ".choice span", "#legend figcaption", "#legend-max", "#materials span", "#scale span"];
  for (const colorScheme of ["light", "dark"]) {
    await page.emulateMedia({ colorScheme, reducedMotion: "reduce" });
    server.tell({ notice: `A notice in ${colorScheme}.` });
    assert.deepEqual(await accessibilityFaults(page), [], colorScheme);
    for (const [selector, contrast] of await contrastsOverPicture(page, overPicture)) {
      assert.ok(contrast >= 4.5, `${selector} in ${colorScheme}: ${contrast.toFixed(2)}`);
    }
  }
  await page.getByLabel("Show the recording").click();
  server.flag("playing", true);
  await until(() => page.locator("#playback").isVisible(), "the bar is there");
  assert.deepEqual(await accessibilityFaults(page), []);
});

test("at 360 pixels nothing sticks out", async (context) => {
  const options = { viewport: { width: 360, height: 740 }, hasTouch: true };
  const recordings = [{ number: 0, name: "a recording with a name that is as long as names can be, or so" }];
  const { page, server } = await stage(context, { options, state: { ...LISTED, recordings } });
  const width = () => page.evaluate(() => document.documentElement.scrollWidth);
  await page.evaluate(() => document.querySelectorAll("details").forEach((details) => (details.open = true)));
  assert.ok((await width()) <= 360);
  await page.getByLabel("Show the recording").click();
  server.tell({ notice: "Something_long_without_a_blank_".repeat(8) });
  await until(() => page.locator("#playback").isVisible(), "the bar is there");
  assert.ok((await width()) <= 360);
});

const UPRIGHT = [1, 0, 0, 0];
const SCENERY = [
  { name: "table", shape: 0, size: [0, 0, 0], position: [0, -0.05, 0], orientation: UPRIGHT },
  { name: "box", shape: 1, size: [0.06, 0.04, 0.06], position: [-0.1, -0.03, 0], orientation: UPRIGHT },
  { name: "ball", shape: 2, size: [0.03, 0, 0], position: [0.1, -0.02, 0], orientation: UPRIGHT },
  { name: "capsule", shape: 3, size: [0.01, 0.05, 0], position: [0, 0.1, 0], orientation: UPRIGHT },
];
const PUSHED = { object: 0, other: -1, normal: [0, 1, 0], position: [0, -0.05, 0.03], force: [0, 1, 0], area: 4e-4 };

test("scenery is drawn, in light and in dark", async (context) => {
  const options = { ...SMALL, deviceScaleFactor: 1 };
  const { page } = await stage(context, { options, scene: { scenery: SCENERY } });
  await page.waitForTimeout(300);
  for (const colorScheme of ["light", "dark"]) {
    await page.emulateMedia({ colorScheme });
    for (const { name, position } of SCENERY.slice(1)) {
      const [red, green, blue, alpha] = await pixel(page, position);
      assert.equal(alpha, 255, `${name} is there`);
      assert.ok(Math.max(red, green, blue) - Math.min(red, green, blue) < 40, `${name} is neutral`);
    }
    assert.equal((await pixel(page, [0.2, 0.12, 0]))[3], 0, "elsewhere is nothing");
  }
  const cells = await page.evaluate(() => window.irdm.world.scenery[0].group.children[0].children.length);
  assert.equal(cells, 2, "the plane has its lines and its shadows");
  assert.deepEqual(page.faults, []);
});

test("contacts between bodies are drawn with a legend, and can be left out", async (context) => {
  const options = { ...SMALL, deviceScaleFactor: 1 };
  const { page, server } = await stage(context, { options, scene: { scenery: SCENERY.slice(0, 1) } });
  assert.equal(await page.locator("#pressure").isVisible(), false);
  const shaft = [0, -0.03, 0.03]; // within the arrow
  const before = await pixel(page, shaft);
  server.contacts = [PUSHED, { ...PUSHED, position: [0.03, -0.05, 0], force: [0, 0.5, 0] }];
  await until(() => page.evaluate(() => window.irdm.world.contacts.shafts.count === 2), "there are two arrows");
  const inked = ([red, green, blue]) => red + green + blue < 200;
  assert.equal(inked(before), false);
  assert.equal(inked(await pixel(page, shaft)), true, "the arrow is seen through the object");
  await until(() => page.locator("#pressure").isVisible(), "there is a legend");
  assert.match(await page.locator("#pressure").innerText(), /Contact pressure\s+0\s*2\.50 kPa/);

  const box = page.getByLabel("Forces", { exact: true });
  assert.equal(await box.isChecked(), true);
  await box.focus();
  await page.keyboard.press("Space");
  assert.equal(await box.isChecked(), false);
  assert.equal(await page.locator("#force-scale").isVisible(), false);
  assert.deepEqual(await pixel(page, shaft), before);
  await box.check();
  assert.equal(inked(await pixel(page, shaft)), true);

  // The patch: in the colour of its pressure, in another one when the range is set, plain, not at all.
  const patch = [0.008, -0.05, 0.035];
  const coloured = await pixel(page, patch);
  await page.getByLabel("Pressure max").fill("25");
  await until(async () => /25\.0 kPa/.test(await page.locator("#pressure").innerText()), "the legend has the range");
  const lower = await pixel(page, patch);
  assert.notDeepEqual(lower, coloured, "a tenth of the range has another colour");
  await page.getByLabel("Pressure", { exact: true }).uncheck();
  assert.equal(await page.locator("#pressure").isVisible(), false);
  const plain = await pixel(page, patch);
  assert.ok(plain[0] < plain[2] && plain[1] > 60, `the patch is plain: ${plain}`);
  await page.getByLabel("Contacts", { exact: true }).uncheck();
  assert.ok(different(await pixel(page, patch), plain), "it is not drawn");

  // Longer arrows, with their scale.
  const above = [0, 0.02, 0.03];
  const short = await page.locator("#force-scale i").evaluate((bar) => bar.clientWidth);
  const newtons = Number.parseFloat(await page.locator("#force-scale").innerText());
  assert.equal(inked(await pixel(page, above)), false);
  await page.getByLabel("Arrow length").fill("1");
  assert.equal(inked(await pixel(page, above)), true, "twice as long it comes here");
  await until(async () => {
    const width = await page.locator("#force-scale i").evaluate((bar) => bar.clientWidth);
    const now = Number.parseFloat(await page.locator("#force-scale").innerText());
    return Math.abs(width / now / (short / newtons) - 2) < 0.2;
  }, "the scale says so");
  server.contacts = [];
  await until(() => page.evaluate(() => window.irdm.world.contacts.shafts.count === 0), "they end");
  assert.deepEqual(page.faults, []);
});

/** In the colour of a mark, not of the object. */
const marked = ([red, green, blue, alpha]) => alpha === 255 && Math.max(red, green, blue) - Math.min(red, green, blue) > 36;

test("arrows adapt to the forces, and their scale says how long they are", async (context) => {
  const { page, server } = await stage(context, { options: LARGE, scene: { largestForce: 0 } });
  const scale = async () => {
    const width = await page.locator("#force-scale i").evaluate((bar) => bar.getBoundingClientRect().width);
    return width / Number.parseFloat(await page.locator("#force-scale").innerText());
  };
  assert.match(await page.locator("#force-scale").innerText(), /^[0-9.]+ N$/);
  const before = await scale();
  server.stiffness = 5000; // some 40 N
  await press(page);
  await until(async () => (await scale()) < before / 5, "the arrows are shorter, and the scale says so");
  const force = await page.evaluate(() => Math.hypot(...window.irdm.frame().styluses.at(-1).force));
  const [low, high] = [await onScreen(page, [0, -0.05, 0]), await onScreen(page, [0, 0.05, 0])];
  const pixels = force * (await scale());
  assert.ok(pixels < 1.2 * (low.y - high.y), `${force.toFixed(1)} N have an arrow of ${pixels.toFixed(0)} pixels`);
  assert.ok(pixels > 20);
  await page.mouse.up();
});

test("with exaggeration the stylus stays on the surface as it is drawn", async (context) => {
  const { page, server } = await stage(context, { options: LARGE });
  await page.getByLabel("Forces", { exact: true }).uncheck(); // the arrow would cross the places that are looked at
  await press(page);
  await page.mouse.wheel(0, -1200);
  await until(() => page.evaluate(() => window.irdm.frame().styluses.at(-1).force[1] > 1.5), "it presses");
  await page.waitForTimeout(500);
  const proxy = server.stylus.tip.map((part, i) => (i === 1 ? 0.05 - 0.5 * (0.05 - part) : part));
  const down = 0.05 - proxy[1]; // of the surface there
  assert.ok(down > 0.002);
  assert.equal(marked(await pixel(page, proxy)), true, "the proxy is on the surface");
  await page.locator("#exaggeration").fill("4");
  const drawn = [proxy[0], 0.05 - 4 * down, proxy[2]];
  assert.equal(marked(await pixel(page, drawn)), true, "it has moved with the surface");
  assert.equal(marked(await pixel(page, proxy)), false, "it is not where the surface would be");
  await page.mouse.up();
});

test("a grab pulls out a patch and no spike", async (context) => {
  const { page, server } = await stage(context, { options: LARGE });
  server.dent = { width: 0.008, out: 0.032 };
  for (const label of ["Contacts", "Forces"]) await page.getByLabel(label, { exact: true }).uncheck();
  await page.keyboard.down("Shift");
  await press(page);
  await until(() => page.evaluate(() => window.irdm.frame().styluses.at(-1).contact === 2), "it holds");
  await until(() => page.evaluate(() => Math.max(...window.irdm.world.objects[0].displacement) > 0.02), "a node is far out");
  await page.keyboard.press("1"); // from the front
  await page.waitForTimeout(300);
  assert.equal((await pixel(page, [0, 0.075, 0]))[3], 0, "there is no spike");
  assert.equal((await pixel(page, [0, 0.0575, 0]))[3], 255, "the patch is raised");
  assert.equal((await pixel(page, [0.04, 0.0575, 0]))[3], 0, "and nothing else");
  await page.mouse.up();
  await page.keyboard.up("Shift");
});

test("an edge that ends in the middle of a surface is not seen", async (context) => {
  const { cube } = await loadMessages();
  const tent = cube(0.1, 12);
  const apex = tent.rest.findIndex((part, i) => i % 3 === 0 && part === 0 && tent.rest[i + 1] === 0 && tent.rest[i + 2] === 0.05);
  tent.rest[apex + 2] += 0.0045;
  const { page } = await stage(context, { options: LARGE, scene: { objects: [tent] } });
  await page.keyboard.press("1");
  // Across a ridge of a low tent on the front, which runs from its top to a corner of its foot.
  const cell = 0.1 / 12;
  const across = Array.from({ length: 11 }, (_, i) => [0.35 * cell + 0.0003 * (i - 5), 0.35 * cell - 0.0003 * (i - 5), 0.05 + 0.65 * 0.0045]);
  const row = (await pixels(page, across)).map(([red]) => red);
  const steps = row.slice(1).map((value, i) => Math.abs(value - row[i]));
  assert.ok(Math.max(...steps) < 12, `no step from one side to the other: ${row}`);
  // The cube's own edges stay.
  await page.keyboard.press("f");
  const [front, right] = [await pixel(page, [0.0485, 0.01, 0.05]), await pixel(page, [0.05, 0.01, 0.0485])];
  assert.ok(Math.abs(front[0] - right[0]) > 15, `${front} before the edge, ${right} behind`);
  assert.deepEqual(page.faults, []);
});

test("colours of the compliance have a range that can be set", async (context) => {
  const { page } = await stage(context, { options: LARGE });
  assert.equal(await page.locator("#range").isVisible(), false);
  await page.locator("#colour").selectOption("compliance");
  const high = page.getByLabel("Upper end of the colours’ range");
  const place = [0.045, 0.05, 0.045];
  const before = await pixel(page, place);
  await high.fill("50");
  await until(async () => /50\.0 mm\/N/.test(await page.locator("#legend").innerText()), "the legend has it");
  assert.ok(different(await pixel(page, place), before), "the colours, too");
  await page.locator("#colour").selectOption("displacement");
  assert.equal(await high.inputValue(), "", "another quantity has another range");
  await page.locator("#colour").selectOption("compliance");
  assert.equal(await high.inputValue(), "50");
  await page.getByLabel("Lower end of the colours’ range").fill("60");
  assert.equal(await high.getAttribute("aria-invalid"), "true");
  await high.fill("");
  await page.getByLabel("Lower end of the colours’ range").fill("");
  assert.deepEqual(await pixel(page, place), before, "automatic again");
});

test("the camera has presets, and is where it was at the next visit", async (context) => {
  const { page } = await stage(context, { options: LARGE });
  const at = (point) => onScreen(page, point);
  await page.getByRole("button", { name: "Top" }).click();
  const [top, left, right, front] = [await at([0, 0.05, 0]), await at([-0.05, 0.05, 0]), await at([0.05, 0.05, 0]), await at([0, 0.05, 0.05])];
  assert.ok(Math.abs(left.y - right.y) < 2 && Math.abs(top.x - front.x) < 2 && front.y > top.y + 20, "from above");
  await page.keyboard.press("2");
  const [near, far] = [await at([0, 0, 0.05]), await at([0, 0, -0.05])];
  assert.ok(near.x < far.x - 20 && Math.abs(near.y - far.y) < 2, "from the side");
  await page.keyboard.press("1");
  await page.locator("#scene").focus();
  for (let i = 0; i < 3; ++i) await page.keyboard.press("ArrowRight");
  await page.keyboard.press("+");
  const corner = await at([0.05, 0.05, 0.05]);
  await page.reload();
  await frames(page);
  await page.waitForTimeout(300);
  const again = await at([0.05, 0.05, 0.05]);
  assert.ok(Math.hypot(again.x - corner.x, again.y - corner.y) < 1, `${JSON.stringify(corner)}, then ${JSON.stringify(again)}`);
});

test("what does nothing for a fixed body is disabled, with the reason", async (context) => {
  const { page, server } = await stage(context);
  await page.locator("#settings-section summary").click();
  const idle = ["Damping of motion", "Damping of turning", "Tether", "Tether of turning", "Centrifugal loading"];
  for (const name of idle) assert.equal(await page.getByLabel(name, { exact: true }).isDisabled(), false, name);
  server.state.objects[0].changeable = 1 | 4; // fixed
  server.tell({});
  await until(() => page.getByLabel("Tether", { exact: true }).isDisabled(), "it is fixed");
  for (const name of idle) assert.equal(await page.getByLabel(name, { exact: true }).isDisabled(), true, name);
  assert.equal(await page.getByLabel("Friction", { exact: true }).isDisabled(), false);
  assert.match(await page.locator("#settings").innerText(), /This body is fixed/);
  assert.equal(await page.getByLabel("Follow object").isDisabled(), true);
  assert.match(await page.locator("#follow-reason").innerText(), /Every body is fixed/);
});

test("two styluses are side by side in the plot, with the same axes", async (context) => {
  const options = { viewport: { width: 1200, height: 800 }, deviceScaleFactor: 1 };
  const { page, server } = await stage(context, { options, scene: { radii: [0, 0.006, 0.006] } });
  server.others = [{ present: true, force: [1.5, 0, 0] }, { present: true, force: [0, 4, 0] }];
  assert.deepEqual(await page.locator("#styluses .line > button:first-child > span:first-child").allInnerTexts(), ["Stylus 1", "Stylus 2", "Mouse stylus"]);
  assert.equal(await page.locator("#plot-beside").isVisible(), false);
  await page.getByRole("button", { name: "Beside: plot Stylus 2" }).click();
  await until(async () => {
    const [one, other] = await Promise.all(["#plot canvas", "#plot-beside canvas"].map((id) => page.locator(id).boundingBox()));
    return Math.abs(one.y - other.y) < 2 && other.x >= one.x + one.width;
  }, "they are side by side");
  assert.deepEqual(await Promise.all(["#plot-title", "#plot-beside-title"].map((id) => page.locator(id).innerText())), ["Stylus 1", "Stylus 2"]);
  await until(async () => /1\.500/.test(await page.locator("#plot .u-legend").innerText()), "one has its force");
  await until(async () => /4\.000/.test(await page.locator("#plot-beside .u-legend").innerText()), "the other one has its own");
  // The magnitude of 1.5 N is drawn as far below the top as 4 N make it in the other.
  const highest = (id) =>
    page.evaluate((id) => {
      const canvas = document.querySelector(id);
      const { data } = canvas.getContext("2d").getImageData(60, 0, canvas.width - 60, canvas.height);
      const dark = (i) => data[i + 3] > 120 && data[i] + data[i + 1] + data[i + 2] < 420;
      for (let i = 0; i < data.length; i += 4) if (dark(i)) return Math.floor(i / 4 / (canvas.width - 60));
      return null;
    }, id);
  await page.waitForTimeout(500);
  const [low, high] = [await highest("#plot canvas"), await highest("#plot-beside canvas")];
  assert.ok(low !== null && high !== null && low > high + 40, `1.5 N at ${low}, 4 N at ${high} pixels from the top`);
  const [file] = await Promise.all([page.waitForEvent("download"), page.locator("#png").click()]);
  assert.equal(file.suggestedFilename(), "irdm-force.png");
  await page.getByRole("button", { name: "Beside: plot Stylus 2" }).click();
  assert.equal(await page.locator("#plot-beside").isVisible(), false);
  assert.deepEqual(page.faults, []);
});

test("the plot is frozen by button and by Space", async (context) => {
  const { page } = await stage(context);
  const time = () => page.locator("#plot .u-legend").innerText();
  const button = page.getByRole("button", { name: "Freeze plot" });
  await button.click();
  await page.waitForTimeout(200);
  const frozen = await time();
  await page.waitForTimeout(400);
  assert.equal(await time(), frozen);
  await page.locator("#scene").focus();
  await page.keyboard.press("Space");
  assert.equal(await button.getAttribute("aria-pressed"), "false");
  await until(async () => (await time()) !== frozen, "it goes on");
});

test("the picture is filmed, on a ground of its own", async (context) => {
  const { page } = await stage(context, { options: { ...LARGE, viewport: { width: 800, height: 500 } } });
  const button = page.getByRole("button", { name: /video/i });
  await button.click();
  assert.equal(await button.innerText(), "End video");
  await page.waitForTimeout(600);
  for (let i = 0; i < 5; ++i) {
    await page.keyboard.press("]");
    await page.waitForTimeout(150);
  }
  const [file] = await Promise.all([page.waitForEvent("download"), button.click()]);
  assert.equal(file.suggestedFilename(), "irdm.webm");
  assert.equal(await button.innerText(), "Video");
  const bytes = await readFile(await file.path());
  const seen = await page.evaluate(async (base64) => {
    const video = document.createElement("video");
    video.muted = true;
    video.src = "data:video/webm;base64," + base64;
    await new Promise((resolve, reject) => {
      video.onloadeddata = resolve;
      video.onerror = () => reject(new Error(video.error.message));
    });
    await video.play();
    await new Promise((resolve) => video.requestVideoFrameCallback(resolve));
    const flat = document.createElement("canvas").getContext("2d");
    [flat.canvas.width, flat.canvas.height] = [video.videoWidth, video.videoHeight];
    flat.drawImage(video, 0, 0);
    const at = (x, y) => [...flat.getImageData(x * video.videoWidth, y * video.videoHeight, 1, 1).data];
    return { corner: at(0.02, 0.3), middle: at(0.5, 0.5), width: video.videoWidth, canvas: window.irdm.world.canvas.width };
  }, bytes.toString("base64"));
  assert.equal(seen.width, seen.canvas);
  assert.ok(Math.min(...seen.corner) > 200, `the ground is light, not ${seen.corner}`);
  assert.ok(different(seen.corner, seen.middle), "the object is in the middle");
  assert.equal((await pixel(page, [0.2, 0.12, 0]))[3], 0, "the page's own ground is back");
  assert.deepEqual(page.faults, []);
});

test("without MediaRecorder there is no video, and the page says why", async (context) => {
  const browserContext = await newContext(context, SMALL);
  const server = await FakeServer.start(browserContext, process.env.PAGE);
  context.after(() => server.stop());
  const page = await browserContext.newPage();
  await page.addInitScript(() => delete window.MediaRecorder);
  await visit(page, server.address);
  assert.equal(await page.locator("#video").isDisabled(), true);
  assert.match(await page.locator("#video-reason").innerText(), /cannot record/);
});
