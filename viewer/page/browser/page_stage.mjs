// A page with its server (fake_server.mjs), and the colours of its picture. PAGE names the folder of the built page.
import { frames, newContext, visit } from "./browser.mjs";
import { FakeServer } from "./fake_server.mjs";

export const SMALL = { viewport: { width: 720, height: 420 }, deviceScaleFactor: 0.5 };
export const LARGE = { viewport: { width: 1000, height: 700 }, deviceScaleFactor: 1 };

/** The page at a server of its own, when it shows the first frame. */
export async function stage(test, { options = SMALL, query = "", ...changes } = {}) {
  const context = await newContext(test, options);
  const server = await FakeServer.start(context, process.env.PAGE, changes);
  test.after(() => server.stop());
  const page = await context.newPage();
  await visit(page, server.address + query);
  await frames(page);
  await page.waitForFunction(() => window.irdm.state() !== null);
  return { page, server };
}

/** Of the picture at places of the world, drawn once: red, green, blue, alpha. */
export function pixels(page, places) {
  return page.evaluate((places) => {
    const { world } = window.irdm;
    world.drawNow();
    const flat = document.createElement("canvas");
    [flat.width, flat.height] = [world.canvas.width, world.canvas.height];
    const context = flat.getContext("2d");
    context.drawImage(world.canvas, 0, 0);
    const ratio = world.canvas.width / world.canvas.clientWidth;
    return places.map((place) => {
      const { x, y } = world.view.onCanvas(world.camera.position.clone().set(...place));
      return [...context.getImageData(Math.floor(x * ratio), Math.floor(y * ratio), 1, 1).data];
    });
  }, places);
}

export const pixel = async (page, place) => (await pixels(page, [place]))[0];

/** Two pixels that nobody would take for the same. */
export const different = (a, b) => Math.max(...a.map((part, i) => Math.abs(part - b[i]))) > 30;
