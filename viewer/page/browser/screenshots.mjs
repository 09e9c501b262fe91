// Makes the pictures of README and tutorial: real irdm-server and irdm-bridge, the page in headless Chromium, light and dark.
//   node screenshots.mjs CONFIGS MODELS OUT      folders; MODELS has SCENE.h5; programs: IRDM_SERVER, IRDM_BRIDGE, CHROMIUM
import { copyFileSync, mkdtempSync, rmSync, symlinkSync } from "node:fs";
import { tmpdir } from "node:os";
import path from "node:path";
import { DEADLINE_MS, launch, listening, start } from "./programs.mjs";

const { IRDM_SERVER, IRDM_BRIDGE, CHROMIUM } = process.env;
const [configs, models, out] = process.argv.slice(2).map((name) => path.resolve(name));
const DESKTOP = { viewport: { width: 1200, height: 750 } };
const PHONE = { viewport: { width: 390, height: 844 }, deviceScaleFactor: 2, isMobile: true, hasTouch: true };

/** Something presses the liver's front so hard that it is seen. */
const pressed = () => {
  const [stylus] = window.irdm.frame().styluses;
  return stylus.contact !== 0 && stylus.tip[0] > 0.04 && Math.hypot(...stylus.force) > 0.3;
};

// `when` says in the page whether what it shows is worth a picture.
const PICTURES = [
  {
    name: "liver",
    shape: DESKTOP,
    scene: "liver",
    bridge: "palpate",
    when: pressed,
    prepare: async (page) => {
      await page.locator("#help summary").click(); // open on a first visit
      await page.locator("#colour").selectOption("displacement");
    },
  },
  {
    name: "phone",
    shape: PHONE,
    scene: "liver",
    bridge: "palpate",
    when: pressed,
    prepare: async (page) => {
      await page.locator("#colour").selectOption("displacement");
      await page.evaluate(() => window.scrollTo(0, 0));
    },
  },
];

async function take(browser, { name, shape, scene, bridge, when, prepare }) {
  const folder = mkdtempSync(path.join(tmpdir(), "irdm-screenshots-"));
  const children = [];
  try {
    copyFileSync(path.join(configs, "scenes", `${scene}.toml`), path.join(folder, "scene.toml"));
    symlinkSync(path.join(models, `${scene}.h5`), path.join(folder, `${scene}.h5`));
    const server = start(IRDM_SERVER, path.join(folder, "scene.toml"));
    children.push(server);
    const addresses = await listening(server);
    const page = await browser.newPage(shape);
    await page.goto(addresses.page);
    await page.waitForFunction(() => window.irdm?.frame() != null, null, { timeout: DEADLINE_MS });
    await prepare(page);
    children.push(start(IRDM_BRIDGE, path.join(configs, "bridges", `${bridge}.toml`), "--server", addresses.bridges));
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

const browser = await launch(CHROMIUM);
try {
  for (const picture of PICTURES) {
    console.log(`screenshots: ${picture.name}`);
    await take(browser, picture);
  }
} finally {
  await browser.close();
}
