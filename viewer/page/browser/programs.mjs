// Programs and a browser for scripts that make pictures of the page.
import { spawn } from "node:child_process";
import { chromium } from "playwright-core";

export const DEADLINE_MS = 60_000;

/** A program; `output` is what it printed so far. */
export function start(program, ...words) {
  const child = spawn(program, words, { stdio: ["ignore", "pipe", "inherit"] });
  child.output = "";
  child.stdout.on("data", (data) => (child.output += data));
  return child;
}

export async function until(condition, what) {
  const deadline = Date.now() + DEADLINE_MS;
  while (!condition()) {
    if (Date.now() > deadline) throw new Error(`not in time: ${what}`);
    await new Promise((resolve) => setTimeout(resolve, 20));
  }
}

/** The addresses where a server listens: for bridges (a playback has none), and of its page. */
export async function listening(server) {
  await until(() => /on http\S+\n/.test(server.output), "the server listens");
  return { bridges: /listening on (\d\S+)/.exec(server.output)?.[1], page: /listening on (http\S+)/.exec(server.output)[1] };
}

/** Headless Chromium, which draws in software. */
export function launch(executablePath) {
  return chromium.launch({ executablePath, args: ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"] });
}
