import "uplot/dist/uPlot.min.css";
import "./style.css";
import { cssRamp } from "./colour_map";
import { Connection, RateMeter, type LinkState } from "./connection";
import { download } from "./download";
import { ForceLog } from "./force_log";
import { ForcePlot } from "./force_plot";
import { element, HealthPanel, StylusList } from "./panel";
import { Command, encodeCommand, type Frame, type Scene, type ServerMessage } from "./protocol";
import { scaleBar } from "./scale_bar";
import type { Colouring } from "./soft_object";
import { currentTheme, onThemeChange } from "./theme";
import { World } from "./world";

const STATES: Record<LinkState, string> = {
  connecting: "Connecting",
  live: "Live",
  lost: "Connection lost, trying again",
  refused: "Refused",
};

function tryWorld(): World | null {
  try {
    return new World(element<HTMLCanvasElement>("scene"), currentTheme());
  } catch {
    element("no-webgl").hidden = false;
    element("scene").hidden = true;
    element("scale").hidden = true;
    return null;
  }
}

const world = tryWorld();
const plot = new ForcePlot(element("plot"), currentTheme());
const styluses = new StylusList(element("styluses"));
const health = new HealthPanel(element("health"), element("counts"));
const bytes = new RateMeter();
const pictures = new RateMeter();
let scene: Scene | null = null;
let newest: Frame | null = null;
let log = new ForceLog(1, 0.002);
let plotAsked = false;

// What comes in

function showScene(next: Scene): void {
  scene = next;
  newest = null;
  log = new ForceLog(next.styluses.length, next.dt);
  styluses.show(next);
  world?.show(next);
  document.title = `${next.objects.map((object) => object.name).join(", ")} – irdm`;
}

function showFrame(frame: Frame): void {
  newest = frame;
  pictures.add(1, performance.now());
  log.follow(frame);
  styluses.follow(frame);
  world?.follow(frame);
  askPlot();
  for (const listener of listeners) listener(frame);
}

function askPlot(): void {
  if (plotAsked) return;
  plotAsked = true;
  requestAnimationFrame(() => {
    plotAsked = false;
    if (newest !== null) plot.show(log, styluses.chosen, newest.time);
  });
}

function take(message: ServerMessage, size: number): void {
  bytes.add(size, performance.now());
  if (message.kind === "scene") showScene(message);
  else if (message.kind === "frame") showFrame(message);
  else if (message.kind === "health") health.show(message, performance.now());
}

function showState(state: LinkState, detail: string): void {
  const link = element("link");
  link.dataset["state"] = state;
  link.querySelector("span")!.textContent = STATES[state] + (detail === "" ? "" : ": " + detail);
  element<HTMLButtonElement>("put-back").disabled = state !== "live";
}

const token = new URLSearchParams(location.hash.slice(1)).get("token") ?? "";
const live = new URL("live", location.href);
live.protocol = live.protocol.replace("http", "ws");
live.hash = "";
const connection = new Connection(live.href, token, false, { message: take, state: showState });

// Controls

const exaggeration = element<HTMLInputElement>("exaggeration");
const rigid = element<HTMLInputElement>("rigid");
const follow = element<HTMLInputElement>("follow");
const colours = [...document.querySelectorAll<HTMLInputElement>("input[name=colour]")];

function applyLook(): void {
  const factor = Number(exaggeration.value);
  element("exaggeration-value").textContent = `× ${factor}`;
  const colouring = (colours.find((input) => input.checked)?.value ?? "none") as Colouring;
  element("legend").hidden = colouring === "none" || world === null;
  element("legend-title").textContent = colouring === "velocity" ? "Speed of the surface" : "Displacement";
  if (world === null) return;
  world.look = { exaggeration: factor, colouring, rigid: rigid.checked, follow: follow.checked };
  world.applyLook();
}

function nextColour(): void {
  const at = colours.findIndex((input) => input.checked);
  colours[(at + 1) % colours.length]!.checked = true;
  applyLook();
}

function stepExaggeration(up: boolean): void {
  if (up) exaggeration.stepUp();
  else exaggeration.stepDown();
  applyLook();
}

function togglePause(): void {
  plot.paused = !plot.paused;
  element("pause").setAttribute("aria-pressed", String(plot.paused));
  askPlot();
}

for (const input of [exaggeration, rigid, follow, ...colours]) input.addEventListener("input", applyLook);
element("put-back").onclick = () => connection.send(encodeCommand(Command.PutBack));
element("fit").onclick = () => world?.fit();
element("pause").onclick = togglePause;
element("csv").onclick = () => download("irdm-force.csv", new Blob([log.csv()], { type: "text/csv" }));
element("png").onclick = async () => {
  const picture = await plot.picture();
  if (picture !== null) download("irdm-force.png", picture);
};
element("plot").addEventListener("mousedown", () => {
  if (!plot.paused) togglePause(); // a zoom into curves that run away is none
});

const KEYS: Record<string, () => void> = {
  r: () => connection.send(encodeCommand(Command.PutBack)),
  f: () => world?.fit(),
  w: () => {
    rigid.checked = !rigid.checked;
    applyLook();
  },
  c: nextColour,
  "[": () => stepExaggeration(false),
  "]": () => stepExaggeration(true),
  " ": togglePause,
  "+": () => world?.move(0, 0, 1.15),
  "=": () => world?.move(0, 0, 1.15),
  "-": () => world?.move(0, 0, 1 / 1.15),
};
const TURN = 0.09; // [rad]
const CANVAS_KEYS: Record<string, () => void> = {
  ArrowLeft: () => world?.move(-TURN, 0, 1),
  ArrowRight: () => world?.move(TURN, 0, 1),
  ArrowUp: () => world?.move(0, -TURN, 1),
  ArrowDown: () => world?.move(0, TURN, 1),
};

addEventListener("keydown", (event) => {
  if (event.ctrlKey || event.metaKey || event.altKey) return;
  const target = event.target as HTMLElement;
  const onCanvas = target === document.body || target.id === "scene";
  // Space belongs to the control that has the focus.
  if (event.key === " " && !onCanvas) return;
  const action = KEYS[event.key.toLowerCase()] ?? (onCanvas ? CANVAS_KEYS[event.key] : undefined);
  if (action === undefined) return;
  event.preventDefault();
  action();
});

// Small print

function figure(value: number): string {
  return value.toPrecision(3);
}

function showLegend(): void {
  if (world === null) return;
  const [factor, unit] = world.look.colouring === "velocity" ? [100, "cm/s"] : [1000, "mm"];
  element("legend-max").textContent = `${figure(world.colourScale * factor)} ${unit}`;
}

function showScale(): void {
  if (world === null) return;
  const { centimetres, pixels } = scaleBar(world.metresPerPixel());
  element("scale").querySelector("span")!.textContent = `${centimetres} cm`;
  element("scale").querySelector("i")!.style.width = `${pixels.toFixed(1)}px`;
}

setInterval(() => {
  const now = performance.now();
  element("rate").textContent = `${pictures.perSecond(now)} frames/s`;
  element("bandwidth").textContent = `${(bytes.perSecond(now) / 1000).toFixed(0)} kB/s`;
  element("clock").textContent = newest === null ? "" : `t = ${newest.time.toFixed(2)} s`;
  showLegend();
}, 250);

document.querySelector<HTMLElement>(".ramp")!.style.background = cssRamp();
if (world !== null) world.onDraw = showScale;
onThemeChange(() => {
  world?.applyTheme(currentTheme());
  plot.applyTheme(currentTheme());
});
applyLook();
connection.open();

// For tests and for the curious at the browser's console: what is shown, as numbers.
const listeners: ((frame: Frame) => void)[] = [];
Object.assign(window, {
  irdm: {
    world,
    scene: () => scene,
    frame: () => newest,
    onFrame: (listener: (frame: Frame) => void) => listeners.push(listener),
  },
});
