// A real browser without a screen (Debian's chromium), and what tests do with a page in it.
import assert from "node:assert/strict";
import { after, before } from "node:test";
import { chromium } from "playwright-core";

/** Generous: it only says when a test that hangs gives up. */
export const DEADLINE_MS = 120_000;

let browser;
before(async () => {
  browser = await chromium.launch({
    executablePath: process.env.CHROMIUM,
    args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"],
  });
});
after(() => browser?.close());

export async function until(condition, what) {
  const deadline = Date.now() + DEADLINE_MS;
  while (!(await condition())) {
    assert.ok(Date.now() < deadline, `in time: ${what}`);
    await new Promise((resolve) => setTimeout(resolve, 20));
  }
}

/** A context of its own, which ends with the test. */
export async function newContext(test, options = {}) {
  const context = await browser.newContext({ viewport: { width: 1000, height: 700 }, ...options });
  context.setDefaultTimeout(DEADLINE_MS);
  test.after(() => context.close());
  return context;
}

export async function newPage(test, options = {}) {
  return (await newContext(test, options)).newPage();
}

/** The page at an address; what goes wrong in it is in its `faults`. */
export async function open(test, url, options = {}) {
  const page = await newPage(test, options);
  await visit(page, url);
  return page;
}

export async function visit(page, url) {
  page.faults = [];
  page.on("pageerror", (error) => page.faults.push(error.message));
  page.on("console", (message) => {
    if (message.type() === "error") page.faults.push(message.text());
  });
  await page.goto(url);
}

export const frames = (page) => page.waitForFunction(() => window.irdm?.frame() != null);

/** Where a point of an object's frame B is on the screen [CSS px]. */
export function onScreen(page, point, object = 0) {
  return page.evaluate(
    ([point, object]) => {
      const { world } = window.irdm;
      const { group } = world.objects[object];
      group.updateMatrixWorld();
      const place = group.position.clone().set(...point).applyMatrix4(group.matrixWorld);
      const { x, y } = world.view.onCanvas(place);
      const { left, top } = world.canvas.getBoundingClientRect();
      return { x: x + left, y: y + top };
    },
    [point, object],
  );
}
