// Display meshes on the page alone, in a real browser against a server of a few lines: what is seen of them.
// PAGE names the folder of the built page, CHROMIUM the browser.
import assert from "node:assert/strict";
import { test } from "node:test";
import { accessibilityFaults } from "./accessibility.mjs";
import { onScreen, until } from "./browser.mjs";
import { loadMessages } from "./fake_server.mjs";
import { different, LARGE, pixel, pixels, stage } from "./page_stage.mjs";

const { ball, cube, inclusion } = await loadMessages();
const R = 0.05;
const ROUND = [0, 45, 90, 135, 180].map((degrees) => (degrees * Math.PI) / 180).map((angle) => [Math.cos(angle), Math.sin(angle), 0]);
const times = (factor, places) => places.map((place) => place.map((part) => factor * part));

/** The ball over its octahedron, or something like it, from the front. */
async function show(context, object = ball(R, 12), changes = {}) {
  const staged = await stage(context, { options: LARGE, ...changes, scene: { objects: [object], ...changes.scene } });
  await staged.page.keyboard.press("1");
  return staged;
}

const plain = (object) => ({ ...object, display: { ...object.display, texture: [] } });

/** Nodes are moved, and the page has been told. */
async function move(page, server, displacement) {
  server.move = displacement;
  const step = await page.evaluate(() => window.irdm.frame().step);
  await page.waitForFunction((step) => window.irdm.frame().step > step + 32, step);
}

const opaque = async (page, places) => (await pixels(page, places)).map(([, , , alpha]) => alpha === 255);
const all = (list, value) => assert.ok(list.every((one) => one === value), `${list}`);
const isRed = ([red, , blue]) => red > blue + 100;
const isBlue = ([red, , blue]) => blue > red + 100;

test("the outline is that of the display mesh, and the texture is on it the right way up", async (context) => {
  const { page } = await show(context);
  all(await opaque(page, times(0.96 * R, ROUND)), true);
  all(await opaque(page, times(1.1 * R, ROUND)), false);
  await until(async () => isRed(await pixel(page, [0, 0.02, 0.045])), "the upper half of the picture is red");
  assert.ok(isBlue(await pixel(page, [0, -0.02, 0.045])));
  assert.deepEqual(page.faults, []);
});

test("a display mesh that is larger than what computes is in the picture as a whole", async (context) => {
  const object = ball(R, 12);
  object.display.positions = object.display.positions.map((part) => 4 * part);
  const { page } = await show(context, object);
  const height = await page.evaluate(() => window.irdm.world.canvas.clientHeight);
  for (const place of [[0, 4 * R, 0], [0, -4 * R, 0]]) {
    const { y } = await page.evaluate((place) => window.irdm.world.view.onCanvas(window.irdm.world.camera.position.clone().set(...place)), place);
    assert.ok(y > 0 && y < height, `${y} of ${height}`);
  }
});

test("the choice of the computed surface shows its triangles, and is there only where there is one", async (context) => {
  const { page } = await show(context);
  const diagonal = [times(0.96 * R, ROUND)[1], times(0.96 * R, ROUND)[3]];
  const box = page.getByLabel("Computed surface");
  assert.equal(await box.isChecked(), false);
  await box.check();
  all(await opaque(page, diagonal), false);
  all(await opaque(page, times(0.66 * R, ROUND)), true);
  const [red, , blue] = await pixel(page, [0, 0.02, 0.045]);
  assert.ok(Math.abs(red - blue) < 60, "it has no texture");
  await box.uncheck();
  all(await opaque(page, diagonal), true);
});

test("without a display mesh there is no choice", async (context) => {
  const { page } = await stage(context);
  assert.equal(await page.getByLabel("Computed surface").isVisible(), false);
});

test("it moves where the computed surface moves, more when exaggerated, and does not elsewhere", async (context) => {
  const { page, server } = await show(context);
  const [low, high, below] = [[0, 0.058, 0], [0, 0.066, 0], [0, -0.048, 0]];
  const side = [0.7071 * R, 0.7071 * R + 0.0035, 0]; // half way from the node that moves to one that does not
  assert.deepEqual(await opaque(page, [low, high, side, below]), [false, false, false, true]);
  await move(page, server, ([, y]) => [0, y > 0.04 ? 0.01 : 0, 0]);
  assert.deepEqual(await opaque(page, [low, high, side, below]), [true, false, true, true]);
  await page.locator("#exaggeration").fill("2");
  assert.deepEqual(await opaque(page, [low, high, side, below]), [true, true, true, true]);
  await page.locator("#exaggeration").fill("0");
  assert.deepEqual(await opaque(page, [low, high, side, below]), [false, false, false, true]);
});

test("what is touched is the computed surface, at its true place", async (context) => {
  const { page } = await show(context);
  const pick = async (place) => {
    const { x, y } = await onScreen(page, place);
    return page.evaluate(([x, y]) => window.irdm.world.pick(window.irdm.world.view.rayThrough(x, y))?.toArray() ?? null, [x, y]);
  };
  const middle = [R / 4, R / 4, R / 2]; // of a triangle
  const [x, y, z] = await pick(middle);
  assert.ok(Math.abs(x + y + z - R) < 1e-6 && Math.hypot(x - middle[0], y - middle[1]) < 0.001, `${[x, y, z]}`);
  assert.equal(await pick(times(0.9 * R, ROUND)[1]), null, "there is only the display mesh");
});

test("its shading turns with the computed surface", async (context) => {
  // As an octahedron with the normals of a ball: turned by a right angle it looks as before, unless its normals stay.
  const radius = 0.02;
  const object = plain(ball(radius, 10));
  const { nodes, weights } = object.display;
  object.display.positions = nodes.flatMap((_, i) => {
    const corner = i - (i % 3);
    return [0, 1, 2].reduce((sum, c) => sum + weights[corner + c] * object.rest[3 * nodes[corner + c] + (i % 3)], 0);
  });
  const { page, server } = await show(context, object);
  const places = times(radius / 2, [[0.4, 0.4, 1], [-0.4, 0.4, 1], [-0.4, -0.4, 1], [0.4, -0.4, 1], [0.9, 0.2, 0.6], [-0.9, 0.2, 0.6]]);
  const before = await pixels(page, places);
  assert.ok(different(before[0], before[3]), "above it is lighter");
  await move(page, server, ([x, y]) => [-y - x, x - y, 0]);
  const after = await pixels(page, places);
  const steps = after.map((colour, i) => Math.max(...colour.map((part, c) => Math.abs(part - before[i][c]))));
  assert.ok(Math.max(...steps) < 8, `differences ${steps}`);
});

test("its gap to the computed surface turns with that", async (context) => {
  const radius = 0.02;
  const { page, server } = await show(context, ball(radius, 12));
  await move(page, server, ([x, y]) => [-y - x, x - y, 0]); // by a right angle
  all(await opaque(page, times(0.96 * radius, ROUND)), true);
  all(await opaque(page, times(1.1 * radius, ROUND)), false);
});

test("its shadow moves with it", async (context) => {
  const radius = 0.02;
  const { page, server } = await show(context, ball(radius, 10));
  await page.keyboard.press("f");
  const height = -1.35 * Math.sqrt(3) * radius; // of the ground
  const shadow = [(0.5 / 1.5) * height, height, (0.65 / 1.5) * height];
  const beside = [shadow[0] + 0.03, shadow[1], shadow[2]];
  const dark = async () => (await pixels(page, [shadow, beside])).map(([, , , alpha]) => alpha > 10 && alpha < 200);
  assert.deepEqual(await dark(), [true, false]);
  await move(page, server, () => [0.03, 0, 0]);
  assert.deepEqual(await dark(), [false, true]);
});

test("colours of the nodes go over the display mesh, and the texture comes back after them", async (context) => {
  const { page, server } = await show(context);
  await until(async () => isRed(await pixel(page, [0, 0.02, 0.045])), "it has its texture");
  await move(page, server, ([, y]) => [0, y > 0.04 ? 0.01 : 0, 0]);
  await page.locator("#colour").selectOption("displacement");
  const yellow = ([red, green, blue]) => red > blue + 60 && green > blue + 60;
  const [top, middle, low] = await pixels(page, [[0, 0.0585, 0.002], [0, 0.05, 0.022], [0, -0.02, 0.045]]);
  assert.ok(yellow(top), `the most is yellow, not ${top}`);
  assert.ok(middle[1] > middle[0] + 60 && middle[1] > middle[2] + 10, `part of it is green, not ${middle}`);
  assert.ok(low[1] < low[2] - 20 && low[1] < 60, `none is violet, not ${low}`);
  all(await opaque(page, times(0.96 * R, [ROUND[0], ROUND[4]])), true);
  await page.locator("#colour").selectOption("none");
  assert.ok(isRed(await pixel(page, [0, 0.02, 0.045])));
});

test("Young's moduli are shown on the triangles that compute", async (context) => {
  const object = ball(R, 12);
  const { page } = await show(context, { ...object, regions: inclusion(object, 0.02, 3250, 42500) });
  const diagonal = times(0.96 * R, ROUND)[1];
  assert.equal((await pixel(page, diagonal))[3], 255);
  await page.locator("#colour").selectOption("modulus");
  assert.equal((await pixel(page, diagonal))[3], 0);
  await page.locator("#colour").selectOption("displacement");
  assert.equal((await pixel(page, diagonal))[3], 255);
});

test("a mark is on the display mesh where it is bound to the place that is touched", async (context) => {
  const { page, server } = await show(context, plain(ball(R, 12)), { scene: { radii: [0.01, 0.006] } });
  await page.keyboard.press("f");
  const middle = [R / 3, R / 3, R / 3];
  const above = times(Math.sqrt(3), [middle])[0];
  const places = [above, times(R / Math.sqrt(3), [[-1, 1, 1]])[0]];
  const before = await pixels(page, places);
  server.others = [{ present: true, contact: 1, object: 0, tip: [0.3, 0.3, 0], proxy: [0.3, 0.3, 0], middle }];
  await until(() => page.evaluate(() => window.irdm.frame().styluses[0].present), "it touches");
  const after = await pixels(page, places);
  assert.ok(different(after[0], before[0]), `${before[0]} there, then ${after[0]}`);
  assert.ok(!different(after[1], before[1]), `${before[1]} elsewhere, then ${after[1]}`);
  await page.getByLabel("Contacts", { exact: true }).uncheck();
  assert.ok(!different((await pixels(page, places))[0], before[0]));
});

test("it is looked through for the wires of the rigid body, in light and in dark", async (context) => {
  const { page } = await show(context, plain(ball(R, 12)));
  const place = [0.02, 0.0205, 0.04];
  const light = await pixel(page, place);
  assert.equal(light[3], 255);
  await page.keyboard.press("w");
  assert.ok((await pixel(page, place))[3] < 230);
  await page.keyboard.press("w");
  await page.emulateMedia({ colorScheme: "dark" });
  await until(async () => (await pixel(page, place)).join() !== light.join(), "it has the colour of the theme");
  assert.equal((await pixel(page, place))[3], 255);
});

test("a surface of more nodes than a row of a texture has moves all of them", async (context) => {
  const object = cube(0.04, 30); // nodes within the front are the last ones
  const nodes = object.rest.length / 3;
  assert.ok(nodes > 5000);
  const normals = Array.from({ length: nodes }, (_, i) => object.rest.slice(3 * i, 3 * i + 3)).flatMap((point) => times(1 / Math.hypot(...point), [point])[0]);
  const own = (parts) => Array.from({ length: nodes }, (_, i) => parts(i)).flat();
  const display = { positions: object.rest, normals, triangles: object.triangles, nodes: own((i) => [i, 0, 0]), weights: own(() => [1, 0, 0]) };
  const { page, server } = await show(context, { ...object, display });
  await page.keyboard.press("2"); // from the side
  const places = [[0, 0, 0.034], [0, 0, -0.028], [0, 0.028, 0]];
  assert.deepEqual(await opaque(page, places), [false, false, false]);
  await move(page, server, ([x, y, z]) => [0, 0, z > 0.0199 && Math.max(Math.abs(x), Math.abs(y)) < 0.019 ? 0.025 : 0]);
  assert.deepEqual(await opaque(page, places), [true, false, false]);
});

test("a texture that cannot be read is said, and the mesh is plain", async (context) => {
  const { page } = await show(context, ball(R, 12, [1, 2, 3]));
  await until(async () => /texture of ball cannot be read/.test(await page.locator("#notices").innerText()), "it says so");
  const [red, , blue, alpha] = await pixel(page, [0, 0.02, 0.045]);
  assert.equal(alpha, 255);
  assert.ok(Math.abs(red - blue) < 60);
  assert.deepEqual(page.faults, []);
});

test("what another scene takes the place of leaves nothing behind", async (context) => {
  const { page } = await show(context);
  const textured = () => until(async () => isRed(await pixel(page, [0, 0.02, 0.045])), "the texture is there");
  const counted = () => page.evaluate(() => ({ ...window.irdm.world.renderer.info.memory }));
  await textured();
  const before = await counted();
  for (let i = 0; i < 3; ++i) {
    await page.evaluate(() => {
      const { world, scene, frame } = window.irdm;
      world.show(scene());
      world.follow(frame());
    });
    await textured();
  }
  assert.deepEqual(await counted(), before);
  assert.deepEqual(page.faults, []);
});

test("axe-core finds nothing", async (context) => {
  const { page } = await show(context);
  await page.evaluate(() => document.querySelectorAll("details").forEach((details) => (details.open = true)));
  assert.equal(await page.getByLabel("Computed surface").isVisible(), true);
  assert.deepEqual(await accessibilityFaults(page), []);
});
