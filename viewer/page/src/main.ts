import "uplot/dist/uPlot.min.css";
import "./style.css";
import { rememberedView, rememberView } from "./camera_memory";
import { Connection, type LinkState } from "./connection";
import { element } from "./elements";
import { FeltForce } from "./felt_force";
import { ForcePanel } from "./force_panel";
import { HealthPanel } from "./health_panel";
import { Notices } from "./notices";
import { copy, isOnlooker, onlookerLink } from "./onlooker_link";
import { PlaybackBar } from "./playback_bar";
import { Command, encodeCommand, encodeSettings, encodeStylus, type Frame, type Scene, type ServerMessage, type State } from "./protocol";
import { RunControls } from "./run_controls";
import { ScenePanel } from "./scene_panel";
import { SettingsPanel } from "./settings_panel";
import { listenForShortcuts } from "./shortcuts";
import { StatusLine } from "./status_line";
import { currentTheme, onThemeChange } from "./theme";
import { Touch } from "./touch";
import { TouchKeys } from "./touch_keys";
import { TouchPointer } from "./touch_pointer";
import { ToolChoice } from "./tool_choice";
import { ViewControls } from "./view_controls";
import { VideoButton } from "./video";
import { remember, remembered } from "./visits";
import { World } from "./world";

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

const send = (message: ArrayBuffer): void => connection.send(message);
/** For what is answered by a notice when it cannot be done. */
const ask = (message: ArrayBuffer): void => {
  asked = true;
  send(message);
};
let asked = false;
const world = tryWorld();
const view = new ViewControls(world);
const forces = new ForcePanel();
const health = new HealthPanel(element("health"), element("counts"));
const status = new StatusLine();
if (world !== null) {
  world.onDraw.push(() => status.drawn());
  world.view.onMoved = (view) => rememberView(scene!, view);
}
const notices = new Notices(element("notices"));
if (world !== null) world.onFault = (text) => notices.tell(text);
const run = new RunControls(ask);
const playback = new PlaybackBar(ask);
const scenes = new ScenePanel(ask);
const settings = new SettingsPanel(element("settings"), element("settings-reason"), (values) =>
  ask(encodeSettings(values)),
);
const hand = world === null ? null : makeHand(world);
let scene: Scene | null = null;
let state: State | null = null;
let newest: Frame | null = null;

/** The viewers' stylus by mouse, finger or keys. */
function makeHand(world: World): { touch: Touch; felt: FeltForce; keys: TouchKeys } {
  const touch = new Touch(world, {
    send: (message) => send(encodeStylus(message)),
    say: (text) => notices.hint(text),
    changed: (active) => {
      if (active) {
        forces.chooseLast();
        element("hint").hidden = true;
        return;
      }
      pointer.ended();
      keys.ended();
      felt.hide();
    },
  });
  const tool = new ToolChoice();
  const felt = new FeltForce(element("felt"), world, touch);
  const pointer = new TouchPointer(world.canvas, touch, world.controls, tool);
  const keys = new TouchKeys(world.canvas, element("cross"), touch, element<HTMLButtonElement>("touch-keys"), tool);
  return { touch, felt, keys };
}

// What comes in

function showScene(next: Scene): void {
  scene = next;
  state = null;
  newest = null;
  world?.show(next, rememberedView(next));
  view.show(next);
  forces.show(next);
  playback.show(next);
  scenes.show(next);
  settings.show(next);
  hand?.touch.show(next);
  document.title = `${next.objects.map((object) => object.name).join(", ")} – irdm`;
}

function showState(next: State): void {
  const first = state === null;
  if (next.notice !== "" && (asked || next.notice !== state?.notice)) notices.tell(next.notice);
  asked = false;
  state = next;
  status.showState(scene!, next);
  run.showState(next);
  playback.showState(next);
  scenes.showState(next);
  view.showState(next);
  settings.showState(next);
  forces.showState(next);
  hand?.touch.showState(next);
  const touchable = hand !== null && scene!.viewersStylus && !next.onlyLooksOn && next.playback === null;
  element("tools").hidden = !touchable;
  if (!touchable) hand?.keys.set(false);
  if (first || !touchable) element("hint").hidden = !touchable;
}

function showFrame(frame: Frame): void {
  newest = frame;
  forces.follow(frame);
  playback.follow(frame);
  hand?.touch.follow(frame);
  world?.follow(frame);
  hand?.felt.follow(frame, scene!);
  for (const listener of listeners) listener(frame);
}

function take(message: ServerMessage, size: number): void {
  status.received(size, message.kind === "frame");
  if (message.kind === "scene") showScene(message);
  else if (message.kind === "frame") showFrame(message);
  else if (message.kind === "health") health.show(message, performance.now());
  else showState(message);
}

function showLink(link: LinkState, detail: string): void {
  status.link(link, detail);
  if (link === "live") return;
  run.lost();
  scenes.lost();
  settings.lost();
  hand?.touch.lost();
}

// Controls

const help = element<HTMLDetailsElement>("help");
help.open = remembered("visited") === null;
remember("visited", "yes");

async function share(): Promise<void> {
  const link = onlookerLink(location.href);
  if (!(await copy(link))) notices.tell(link);
  else if (token === "") notices.hint("Copied: a view-only link.");
  else notices.tell("Copied. It has your token in it: whoever takes watch=1 out can touch, too. The scene can have a token for view-only links (viewer.onlooker_token).");
}
element("share").onclick = () => void share();
new VideoButton(world);

const TURN = 0.09; // [rad]
const NEARER = 1.15;
listenForShortcuts(
  {
    r: () => run.reset(),
    p: () => run.togglePause(),
    ".": () => run.step(),
    f: () => world?.fit(),
    "1": () => world?.fit("front"),
    "2": () => world?.fit("side"),
    "3": () => world?.fit("top"),
    w: () => view.toggleRigid(),
    c: () => view.nextColour(),
    "[": () => view.exaggerate(false),
    "]": () => view.exaggerate(true),
    " ": () => forces.toggleFreeze(),
    escape: () => {
      hand?.touch.release();
      hand?.keys.set(false);
    },
    t: () => {
      if (!element("tools").hidden) hand?.keys.set(!hand.keys.on);
    },
    "+": () => world?.move(0, 0, NEARER),
    "=": () => world?.move(0, 0, NEARER),
    "-": () => world?.move(0, 0, 1 / NEARER),
  },
  {
    ArrowLeft: () => world?.move(-TURN, 0, 1),
    ArrowRight: () => world?.move(TURN, 0, 1),
    ArrowUp: () => world?.move(0, -TURN, 1),
    ArrowDown: () => world?.move(0, TURN, 1),
  },
);
onThemeChange(() => {
  world?.applyTheme(currentTheme());
  forces.applyTheme();
});
setInterval(() => {
  status.show(newest);
  view.showLegend();
}, 250);

const token = new URLSearchParams(location.hash.slice(1)).get("token") ?? "";
const live = new URL("live", location.href);
live.protocol = live.protocol.replace("http", "ws");
live.hash = "";
const connection = new Connection(live.href, token, isOnlooker(location.href), { message: take, state: showLink });
connection.open();

// For tests and for the curious at the browser's console: what is shown, as numbers.
const listeners: ((frame: Frame) => void)[] = [];
Object.assign(window, {
  irdm: {
    world,
    scene: () => scene,
    frame: () => newest,
    state: () => state,
    seek: (time: number) => send(encodeCommand(Command.Seek, 0, time)),
    onFrame: (listener: (frame: Frame) => void) => listeners.push(listener),
  },
});
