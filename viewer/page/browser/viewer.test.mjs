// The page in a real browser (Debian's chromium, without a screen), against real irdm-server and irdm-bridge.
// Programs, model and browser are named by the environment: tests/system/CMakeLists.txt.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { copyFileSync, mkdirSync, readFileSync } from "node:fs";
import path from "node:path";
import { test } from "node:test";
import { frames, newPage, open, until } from "./browser.mjs";
import { Stage } from "./stage.mjs";

const { IRDM_EXPECTED_SURFACE, IRDM_MODEL } = process.env;

/** Every fifth pixel of the canvas, as x, y, r, g, b, a, and where the object's nodes are on it, taken in one go. */
function picture(page) {
  return page.evaluate(() => {
    const { world } = window.irdm;
    world.drawNow();
    const { canvas } = world;
    const flat = document.createElement("canvas");
    flat.width = canvas.width;
    flat.height = canvas.height;
    const context = flat.getContext("2d");
    context.drawImage(canvas, 0, 0);
    const mesh = world.objects[0].group.children[0];
    mesh.updateWorldMatrix(true, false);
    const at = mesh.geometry.getAttribute("position");
    const points = [];
    for (let i = 0; i < at.count; ++i) {
      const point = world.camera.position.clone().fromBufferAttribute(at, i);
      point.applyMatrix4(mesh.matrixWorld).project(world.camera);
      points.push([((point.x + 1) / 2) * canvas.width, ((1 - point.y) / 2) * canvas.height]);
    }
    const { data } = context.getImageData(0, 0, flat.width, flat.height);
    const samples = [];
    for (let y = 2; y < flat.height; y += 5) {
      for (let x = 2; x < flat.width; x += 5) {
        const i = 4 * (y * flat.width + x);
        samples.push([x + 0.5, y + 0.5, ...data.slice(i, i + 4)]);
      }
    }
    return { samples, points };
  });
}

/** Convex hull, counter-clockwise. */
function hull(points) {
  const sorted = [...points].sort((a, b) => a[0] - b[0] || a[1] - b[1]);
  const turn = (a, b, c) => (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
  const half = (list) => {
    const chain = [];
    for (const point of list) {
      while (chain.length > 1 && turn(chain.at(-2), chain.at(-1), point) <= 0) chain.pop();
      chain.push(point);
    }
    return chain.slice(0, -1);
  };
  return [...half(sorted), ...half([...sorted].reverse())];
}

/** Distance to the hull's nearest side; more than 0 inside. */
function depth(corners, x, y) {
  return Math.min(
    ...corners.map(([ax, ay], i) => {
      const [bx, by] = corners[(i + 1) % corners.length];
      return ((bx - ax) * (y - ay) - (by - ay) * (x - ax)) / Math.hypot(bx - ax, by - ay);
    }),
  );
}

test("the canvas shows the cube where it is, and nothing elsewhere", async (context) => {
  const stage = new Stage(context);
  const server = await stage.server();
  const page = await open(context, server.url);
  await frames(page);
  await page.waitForTimeout(300);
  const { samples, points } = await picture(page);
  const corners = hull(points);
  let inside = 0;
  for (const [x, y, red, green, blue, alpha] of samples) {
    const deep = depth(corners, x, y);
    if (deep > 2) {
      assert.equal(alpha, 255, `the cube covers ${x}, ${y}`);
      ++inside;
    }
    // Outside there is only its shadow, which is black and thin.
    if (deep < -2) assert.ok(alpha < 128 && red + green + blue === 0, `nothing is at ${x}, ${y}`);
  }
  assert.ok(inside > 1000, `${inside} pixels looked at inside`);
  assert.equal(await page.title(), "cube – irdm");
  assert.equal(await page.locator("#link").innerText(), "Live");
  assert.deepEqual(page.faults, []);
});

test("a pressed cube is deformed on the page as at the server", async (context) => {
  const stage = new Stage(context, "[[stylus]]\nradius = 0\n"); // a point, which deforms it most
  const trace = stage.path("trace.h5");
  // Takes hold of the top and swings the cube round, 2 cm, once a second, for longer than the page needs to see it.
  const rows = ["time,x,y,z,button", "0,0,0.07,0,0", "0.05,0,0.07,0,0", "0.25,0,0.055,0,1"];
  for (let k = 1; k <= 60_000; ++k) {
    const phase = 2 * Math.PI * 0.01 * k;
    rows.push(`${0.25 + 0.01 * k},${0.02 * (1 - Math.cos(phase))},0.055,${0.02 * Math.sin(phase)},1`);
  }
  stage.write("script.csv", rows.join("\n"));
  const server = await stage.server("--lockstep", "--record", trace);
  const page = await open(context, server.url);
  await frames(page);
  await page.evaluate(() => {
    window.best = { size: 0, seen: 0 };
    window.irdm.onFrame((frame) => {
      const u = window.irdm.world.objects[0].displacement;
      const size = Math.max(...u.map(Math.abs));
      window.best.seen += 1;
      if (size <= window.best.size) return;
      const { unit } = frame.objects[0];
      window.best = { ...window.best, size, unit, step: frame.step, u: Array.from(u), stylus: frame.styluses[0] };
    });
  });
  const bridge = stage.bridge(server);
  await until(() => page.evaluate(() => window.best.size > 1e-3), "it is deformed");
  bridge.kill("SIGTERM");
  assert.equal(await bridge.ended, 0);
  server.kill("SIGTERM");
  assert.equal(await server.ended, 0);
  await until(async () => /lost/.test(await page.locator("#link").innerText()), "the page sees the end");
  const best = await page.evaluate(() => window.best);
  const expected = JSON.parse(
    execFileSync(IRDM_EXPECTED_SURFACE, [stage.path("scene.toml"), trace, String(best.step)]).toString(),
  );
  context.diagnostic(`${best.seen} frames; step ${best.step}: ${(1000 * best.size).toFixed(2)} mm, unit ${best.unit} m`);
  assert.ok(best.unit <= 1e-5);
  assert.equal(best.u.length, expected.length);
  const error = Math.max(...best.u.map((value, i) => Math.abs(value - expected[i])));
  assert.ok(error <= 0.501 * best.unit + 1e-9, `displacements are ${error} m off`);
  // What is drawn is rest shape and displacement; where a stylus holds, that of the patch.
  const drawn = await page.evaluate(() => {
    const object = window.irdm.world.objects[0];
    const at = object.group.children[0].geometry.getAttribute("position").array;
    window.irdm.world.drawNow();
    const { nodeOf } = object.surface.computed.creased;
    const { rest } = window.irdm.scene().objects[0];
    const shown = object.drawn.displacement;
    const same = shown.filter((value, i) => value === object.displacement[i]).length / shown.length;
    const error = Math.max(
      ...[...at].map((value, i) => {
        const node = 3 * nodeOf[Math.floor(i / 3)] + (i % 3);
        return Math.abs(value - rest[node] - shown[node]);
      }),
    );
    return { error, same };
  });
  assert.ok(drawn.error < 1e-7);
  assert.ok(drawn.same > 0.4, `the displacement of ${(100 * drawn.same).toFixed(0)} % of the surface is drawn as it is`);
});

test("a reset puts the falling cube back, by button and by key", async (context) => {
  const stage = new Stage(context, "[world]\ngravity = [0, -0.1, 0]");
  const server = await stage.server();
  const page = await open(context, server.url);
  await frames(page);
  await page.evaluate(() => {
    window.rises = 0;
    let height = 0;
    window.irdm.onFrame((frame) => {
      const [, y] = frame.objects[0].position;
      if (y > height + 0.05) window.rises += 1;
      height = y;
    });
  });
  const ways = [() => page.locator("#reset").click(), () => page.keyboard.press("r")];
  for (let i = 0; i < ways.length; ++i) {
    await until(() => page.evaluate(() => window.irdm.frame().objects[0].position[1] < -0.1), "it falls");
    await ways[i]();
    await until(() => page.evaluate((count) => window.rises === count, i + 1), "it is reset");
  }
  assert.deepEqual(page.faults, []);
});

test("the page comes back when the server does, and two pages see the same", async (context) => {
  const stage = new Stage(context, "[viewer]\nport = 0");
  const first = await stage.server();
  const page = await open(context, first.url);
  const other = await open(context, first.url);
  await frames(page);
  await frames(other);
  const port = new URL(first.url).port;
  first.kill("SIGKILL");
  await first.ended;
  await until(async () => /lost|Connecting/.test(await page.locator("#link").innerText()), "the page sees the loss");
  assert.equal(await page.locator("#reset").isDisabled(), true);
  stage.write(
    "scene.toml",
    `[viewer]\nport = ${port}\n[world]\ngravity = [0, -0.01, 0]\n[[object]]\nname = "another"\nmodel = "${IRDM_MODEL}"\n`,
  );
  await stage.server();
  for (const one of [page, other]) {
    await until(async () => (await one.locator("#link").innerText()) === "Live", "it is live again");
    await one.waitForFunction(() => window.irdm.scene().objects[0].name === "another");
    await one.waitForFunction(() => window.irdm.frame()?.step > 50);
  }
});

test("keys and controls do what they say, in dark and on a phone", async (context) => {
  const stage = new Stage(context);
  const server = await stage.server();
  const page = await open(context, server.url, { colorScheme: "dark", viewport: { width: 375, height: 740 } });
  await frames(page);
  const look = () => page.evaluate(() => window.irdm.world.look);
  await page.keyboard.press("w");
  await page.keyboard.press("c");
  await page.keyboard.press("]");
  const { exaggeration, colouring, rigid, follow } = await look();
  assert.deepEqual({ exaggeration, colouring, rigid, follow }, { exaggeration: 1.5, colouring: "displacement", rigid: true, follow: true });
  assert.equal(await page.locator("#legend").isVisible(), true);
  const wide = await page.evaluate(() => document.documentElement.scrollWidth);
  assert.ok(wide <= 375, `the page is ${wide} pixels wide`);
  const before = await page.evaluate(() => window.irdm.world.camera.position.toArray());
  await page.locator("#scene").focus();
  await page.keyboard.press("ArrowLeft");
  assert.notDeepEqual(await page.evaluate(() => window.irdm.world.camera.position.toArray()), before);
  for (const [button, name] of [["#csv", "irdm-force.csv"], ["#png", "irdm-force.png"]]) {
    const [file] = await Promise.all([page.waitForEvent("download"), page.locator(button).click()]);
    assert.equal(file.suggestedFilename(), name);
  }
  assert.deepEqual(page.faults, []);
});

test("without WebGL the page says so and shows forces and health", async (context) => {
  const stage = new Stage(context);
  const server = await stage.server();
  const page = await newPage(context);
  await page.addInitScript(() => {
    HTMLCanvasElement.prototype.getContext = new Proxy(HTMLCanvasElement.prototype.getContext, {
      apply: (target, canvas, words) => (/webgl/.test(words[0]) ? null : Reflect.apply(target, canvas, words)),
    });
  });
  await page.goto(server.url);
  await frames(page);
  assert.equal(await page.locator("#no-webgl").isVisible(), true);
  assert.match(await page.locator("#counts").innerText(), /Missed deadlines/);
});

test("a page of another origin sees nothing", async (context) => {
  const stage = new Stage(context);
  const server = await stage.server();
  const page = await newPage(context);
  await page.goto("data:text/html,<p>elsewhere");
  const outcome = await page.evaluate(
    (url) =>
      new Promise((resolve) => {
        const socket = new WebSocket(url.replace("http", "ws") + "/live");
        socket.onopen = () => resolve("open");
        socket.onclose = () => resolve("closed");
      }),
    server.url,
  );
  assert.equal(outcome, "closed");
});

const TWO = (model) => `[viewer]
token = "another-token-unused"
[[object]]
name = "lower"
model = "${model}"
[[object]]
name = "upper"
model = "${model}"
position = [0, 0.3, 0]
`;

/** A stage with a folder of scenes, which a bridge holds its stylus in. */
async function folderStage(context, scenes, tables = "") {
  const stage = new Stage(context, tables);
  mkdirSync(stage.path("scenes"));
  for (const [name, text] of Object.entries(scenes)) stage.write(path.join("scenes", name), text);
  stage.write("script.csv", "time,x,y,z,button\n0,0,0.2,0,0\n600,0,0.2,0,0\n");
  const server = await stage.server("--scenes", stage.path("scenes"));
  const bridge = stage.bridge(server);
  return { stage, server, bridge };
}

const notice = (page, text) => until(async () => (await page.locator("#notices").innerText()).includes(text), `the notice "${text}"`);
const bridged = (page) => page.waitForFunction(() => window.irdm.frame()?.styluses[0].present === true);
const choose = async (page, name) => {
  await page.locator("#scene-choice").selectOption(name);
  await page.locator("#scene-load").click();
};

/** Is something drawn at a place of the world? */
const drawnAt = (page, place) =>
  page.evaluate((place) => {
    const { world } = window.irdm;
    world.drawNow();
    const flat = document.createElement("canvas");
    [flat.width, flat.height] = [world.canvas.width, world.canvas.height];
    const context = flat.getContext("2d");
    context.drawImage(world.canvas, 0, 0);
    const { x, y } = world.view.onCanvas(world.camera.position.clone().set(...place));
    const ratio = world.canvas.width / world.canvas.clientWidth;
    return context.getImageData(Math.floor(x * ratio), Math.floor(y * ratio), 1, 1).data[3] === 255;
  }, place);

test("another scene is loaded from the page: the picture changes, page and bridge come back", async (context) => {
  const token = "0123456789abcdef";
  const { server, bridge } = await folderStage(context, { "two.toml": TWO(IRDM_MODEL) }, `[viewer]\ntoken = "${token}"`);
  const page = await open(context, `${server.url}#token=${token}`);
  await frames(page);
  await bridged(page);
  assert.equal(await page.title(), "cube – irdm");
  assert.equal(await page.locator("#scene-choice option").first().innerText(), "Choose a scene");
  await choose(page, "two.toml");
  await until(async () => (await page.title()) === "lower, upper – irdm", "the other scene is shown");
  await notice(page, "loaded: two.toml");
  await frames(page);
  await bridged(page);
  await page.waitForTimeout(300);
  assert.equal(await drawnAt(page, [0, 0, 0]), true);
  assert.equal(await drawnAt(page, [0, 0.3, 0]), true);
  assert.equal(await drawnAt(page, [0, 0.15, 0]), false);
  assert.equal(await page.locator("#scene-choice option").first().innerText(), "two.toml (shown)");
  assert.equal(await page.locator("#link").innerText(), "Live");
  assert.equal(bridge.exitCode, null, "the bridge has gone on");
  const lines = server.output.match(/listening on \S+/g);
  assert.deepEqual(lines.slice(2), lines.slice(0, 2), "it listens where it did");
  assert.match(server.output, /steps: [1-9]/, "the ended run was reported");
  server.kill("SIGTERM");
  assert.equal(await server.ended, 0);
});

test("a scene that is broken leaves the run as it is, and says what is wrong", async (context) => {
  const broken = '[[object]]\nname = "broken"\nmodel = "missing.h5"\n';
  const { server } = await folderStage(context, { "broken.toml": broken, "typo.toml": "[[object]]\nmodel = \n" });
  const page = await open(context, server.url);
  await frames(page);
  await bridged(page);
  for (const [name, text] of [["broken.toml", "missing.h5"], ["typo.toml", "typo.toml:2"]]) {
    await choose(page, name);
    await notice(page, text);
    const step = await page.evaluate(() => window.irdm.frame().step);
    await page.waitForFunction((step) => window.irdm.frame().step > step + 100, step);
  }
  assert.equal(await page.title(), "cube – irdm");
  await bridged(page);
  assert.equal(server.output.match(/listening on/g).length, 2);
  assert.doesNotMatch(server.output, /steps:/);
  assert.deepEqual(page.faults, []);
});

test("settings are saved as a scene, which is listed and loads with them", async (context) => {
  const { stage, server } = await folderStage(context, {});
  const page = await open(context, server.url);
  await frames(page);
  await page.locator("#settings-section summary").click();
  const tether = page.locator("#set-tether");
  const told = () => tether.getAttribute("aria-valuetext");
  await tether.focus();
  for (let i = 0; i < 40; ++i) await page.keyboard.press("ArrowRight");
  await until(async () => page.evaluate(() => window.irdm.state().settings.objects[0].tether > 0), "the server has it");
  const set = await told();
  await page.locator("#scene-save").click();
  await notice(page, "saved: scene-1.toml");
  assert.match(readFileSync(stage.path("scenes/scene-1.toml"), "utf8"), /tether = \{/);
  await until(async () => (await page.locator("#scene-choice").innerText()).includes("scene-1.toml"), "it is listed");
  await choose(page, "scene-1.toml");
  await notice(page, "loaded: scene-1.toml");
  assert.equal(await page.title(), "cube – irdm");
  await until(async () => (await told()) === set, "the tether is as it was set");
});

test("a model alone is loaded; an onlooker cannot", async (context) => {
  const { stage, server } = await folderStage(context, {});
  copyFileSync(IRDM_MODEL, stage.path("scenes/soft thing.h5"));
  const onlooker = await open(context, `${server.url}?watch=1`);
  await frames(onlooker);
  assert.equal(await onlooker.locator("#scene-load").isDisabled(), true);
  const page = await open(context, server.url);
  await frames(page);
  await until(async () => (await page.locator("#scene-choice").innerText()).includes("soft thing.h5"), "it is listed");
  await choose(page, "soft thing.h5");
  for (const one of [page, onlooker]) await until(async () => (await one.title()) === "soft thing – irdm", "it is shown");
});
