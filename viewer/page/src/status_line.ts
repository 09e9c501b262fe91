import { RateMeter, type LinkState } from "./connection";
import { element, make } from "./elements";
import type { Frame, Scene, State } from "./protocol";

const LINKS: Record<LinkState, string> = {
  connecting: "Connecting",
  live: "Live",
  lost: "Connection lost, trying again",
  refused: "Refused",
};

/** In what way the run is shown, in a word each. Pure. */
export function modesOf(scene: Scene, state: State): string[] {
  const modes: string[] = [];
  if (state.playback !== null) modes.push(state.playback.playing ? "recorded run" : "recorded run, paused");
  else if (state.paused) modes.push("paused");
  if (state.recording) modes.push("recording");
  if (scene.lockstep) modes.push("lockstep");
  if (state.onlyLooksOn) modes.push("view only");
  return modes;
}

/** Above the picture: how the connection is; below it: time, pictures drawn, surfaces received, bandwidth. */
export class StatusLine {
  private readonly bytes = new RateMeter();
  private readonly surfaces = new RateMeter();
  private readonly drawings = new RateMeter();

  link(state: LinkState, detail: string): void {
    const link = element("link");
    link.dataset["state"] = state;
    link.querySelector("span")!.textContent = LINKS[state] + (detail === "" ? "" : ": " + detail);
    if (state !== "live") element("modes").replaceChildren();
  }

  showState(scene: Scene, state: State): void {
    const modes = modesOf(scene, state);
    element("link").querySelector("span")!.textContent = state.playback === null ? LINKS.live : "Connected";
    const host = element("modes");
    if (host.textContent === modes.join("")) return;
    host.replaceChildren(...modes.map((mode) => make("span", mode, mode === "recording" ? "bad" : "")));
  }

  received(size: number, isFrame: boolean): void {
    const now = performance.now();
    this.bytes.add(size, now);
    if (isFrame) this.surfaces.add(1, now);
  }

  /** The picture has been drawn. */
  drawn(): void {
    this.drawings.add(1, performance.now());
  }

  /** Now and then. */
  show(newest: Frame | null): void {
    const now = performance.now();
    element("rate").textContent = `${this.drawings.perSecond(now)} drawn/s, ${this.surfaces.perSecond(now)} surfaces/s`;
    element("bandwidth").textContent = `${(this.bytes.perSecond(now) / 1000).toFixed(0)} kB/s`;
    element("clock").textContent = newest === null ? "" : `t = ${newest.time.toFixed(2)} s`;
  }
}
