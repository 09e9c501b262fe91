// A server of a few lines, for tests of the page alone: it serves the built page to playwright's browser and answers
// at its WebSocket. Its cube stands still and pushes back as a spring does.
import * as esbuild from "esbuild";
import { readFile } from "node:fs/promises";
import path from "node:path";
import { fileURLToPath } from "node:url";

const here = path.dirname(fileURLToPath(import.meta.url));
const TYPES = { ".html": "text/html", ".js": "text/javascript", ".css": "text/css", ".svg": "image/svg+xml" };
const EDGE = 0.1;
const STIFFNESS = 300; // [N/m]
const WIDTH = 0.018; // of the dent [m]
const BOUND = 3; // [N]
const ADDRESS = "http://viewer.test/";
const FLAG = { looksOn: 1, free: 2, mine: 4, paused: 8, recording: 16, playback: 32, playing: 64, canRecord: 128, hasScenes: 256, canLoad: 512, preparing: 1024 };

/** The messages that test/server_messages.ts writes. */
export async function loadMessages() {
  const built = await esbuild.build({
    entryPoints: [path.join(here, "../test/server_messages.ts")],
    bundle: true,
    format: "esm",
    write: false,
  });
  return import("data:text/javascript;base64," + Buffer.from(built.outputFiles[0].contents).toString("base64"));
}

export class FakeServer {
  /** what the page said: { type, ... } */
  received = [];
  /** between bodies, in each frame */
  contacts = [];
  stylus = { present: false, grab: false, tip: [0, 0, 0] };
  /** the other styluses, in each frame: what differs from an absent one */
  others = [];
  /** of the dent: width [m]; way out of the surface [m], null: half the depth of the tip inwards */
  dent = { width: WIDTH, out: null };
  /** of the first object instead of a dent: from a node's place at rest to its displacement [m] */
  move = null;
  /** [N/m] */
  stiffness = STIFFNESS;
  state;
  scene;
  #messages;
  #socket = null;
  #step = 8;
  #timer = null;

  /**
   * @param page where the page was built to
   * @param changes `scene`, `state`: parts of the messages; `inclusions`: beside a cube of one material there is one
   *   with a stiff cube inside, whose regions have these parts
   */
  static async start(context, folder, changes = {}) {
    const server = new FakeServer();
    server.#messages = await loadMessages();
    const { cube, inclusion, SETTINGS } = server.#messages;
    if (changes.inclusions) {
      const plain = cube(EDGE, 12, "plain");
      const tissue = cube(EDGE, 12, "tissue");
      const regions = { ...inclusion(tissue, 0.03, 3250, 42500), ...changes.inclusions };
      changes.scene = { objects: [plain, { ...tissue, regions }], ...changes.scene };
    }
    server.scene = { objects: [cube(EDGE, 12)], radii: [0, 0.006], dt: 0.002, flags: 4, floorHeight: 0, largestForce: BOUND, scenery: [], ...changes.scene };
    server.state = {
      flags: FLAG.free | FLAG.canRecord,
      changes: 0,
      length: 0,
      speed: 1,
      shown: 65535,
      recordings: [],
      notice: "",
      gravity: [0, 0, 0],
      objects: server.scene.objects.map(() => ({ ...SETTINGS })),
      ...changes.state,
    };
    await context.route(ADDRESS + "**", (route) => server.#serve(route, folder));
    await context.routeWebSocket(/\/live$/, (socket) => server.#meet(socket));
    return server;
  }

  get address() {
    return ADDRESS;
  }

  async #serve(route, folder) {
    const { pathname } = new URL(route.request().url());
    const name = pathname === "/" ? "index.html" : pathname.slice(1);
    const body = await readFile(path.join(folder, name));
    await route.fulfill({ body, contentType: TYPES[path.extname(name)] });
  }

  #meet(socket) {
    this.#socket = socket;
    socket.onMessage((data) => this.#take(new DataView(data.buffer, data.byteOffset, data.byteLength)));
    socket.onClose(() => this.stop());
  }

  stop() {
    clearInterval(this.#timer);
  }

  /** Changes the state and says so. */
  tell(changes) {
    Object.assign(this.state, changes);
    this.#send(this.#messages.stateMessage(this.state));
  }

  flag(name, on) {
    const bit = FLAG[name];
    this.tell({ flags: on ? this.state.flags | bit : this.state.flags & ~bit });
  }

  #send(bytes) {
    this.#socket?.send(Buffer.from(bytes));
  }

  #take(view) {
    const type = view.getUint16(6, true);
    if (type === 16) this.#greet(view.getUint16(10, true));
    else if (type === 17) this.#command(view);
    else if (type === 18) this.#hand(view);
    else if (type === 19) this.#settings(view);
    else if (type === 20) this.#load(view);
  }

  #greet(looksOn) {
    this.received.push({ type: "hello", looksOn });
    if (looksOn) this.state.flags |= FLAG.looksOn;
    this.#send(this.#messages.sceneMessage(this.scene));
    this.#send(this.#messages.stateMessage(this.state));
    const times = (p50) => ({ p50, p99: 1.6 * p50, max: 3 * p50 });
    const bridges = this.scene.radii.slice(1).map(() => ({ reports: true, roundTrip: times(310), forceAge: times(1900) }));
    this.#send(this.#messages.healthMessage(1, bridges));
    this.stop();
    this.#timer = setInterval(() => this.#frame(), 80);
  }

  #command(view) {
    const [what, number, value] = [view.getUint16(8, true), view.getUint16(10, true), view.getFloat64(16, true)];
    this.received.push({ type: "command", what, number, value });
    const does = {
      2: () => this.flag("paused", true),
      3: () => this.flag("paused", false),
      5: () => this.flag("recording", true),
      6: () => {
        this.state.recordings.push({ number: this.state.recordings.length, name: `run-${this.state.recordings.length + 1}.h5` });
        this.flag("recording", false);
      },
      7: () => this.tell({ flags: this.state.flags | FLAG.playback | FLAG.paused, shown: number, length: 8 }),
      8: () => this.tell({ flags: this.state.flags & ~(FLAG.playback | FLAG.playing | FLAG.paused), shown: 65535, length: 0 }),
      9: () => this.flag("playing", true),
      10: () => this.flag("playing", false),
      11: () => (this.#step = Math.round(value / this.scene.dt)),
      12: () => this.tell({ speed: value }),
    };
    does[what]?.();
  }

  #load(view) {
    const name = new TextDecoder().decode(new Uint8Array(view.buffer, view.byteOffset + 12, view.getUint16(8, true)));
    this.received.push({ type: "load", name });
    this.flag("preparing", true);
  }

  #hand(view) {
    const at = (i) => view.getFloat64(16 + 8 * i, true);
    this.stylus = { present: view.getUint8(8) === 1, grab: view.getUint32(12, true) === 1, tip: [at(0), at(1), at(2)] };
    this.received.push({ type: "stylus", ...this.stylus });
    const mine = (this.state.flags & FLAG.mine) !== 0;
    if (mine !== this.stylus.present) {
      this.tell({ flags: (this.state.flags & ~(FLAG.mine | FLAG.free)) | (this.stylus.present ? FLAG.mine : FLAG.free) });
    }
  }

  #settings(view) {
    const at = (i) => view.getFloat64(16 + 8 * i, true);
    this.received.push({ type: "settings", gravity: [at(0), at(1), at(2)], staticFriction: at(3), kineticFriction: at(4) });
    Object.assign(this.state.objects[0], { staticFriction: at(3), kineticFriction: at(4), damping: at(5), angularDamping: at(6) });
    Object.assign(this.state.objects[0], { tether: at(7), angularTether: at(8), dampingFactor: at(9) });
    this.tell({ gravity: [at(0), at(1), at(2)], changes: this.state.changes + 1 });
  }

  /** The contact of a tip with the cube: out through the nearest face. */
  #touch() {
    const { ABSENT } = this.#messages;
    const { present, grab, tip } = this.stylus;
    const state = { ...ABSENT, present, tip, proxy: tip, buttons: grab ? 1 : 0 };
    const axis = tip.reduce((most, part, i) => (Math.abs(part) > Math.abs(tip[most]) ? i : most), 0);
    const deep = EDGE / 2 - Math.abs(tip[axis]);
    if (!present || deep <= 0) return { state, dent: null };
    const side = Math.sign(tip[axis]);
    const size = Math.min(this.stiffness * deep, this.scene.largestForce || Number.POSITIVE_INFINITY);
    const vector = (value) => tip.map((_, i) => (i === axis ? value : 0));
    const proxy = tip.map((part, i) => (i === axis ? side * (EDGE / 2 - 0.5 * deep) : part));
    const middle = tip.map((part, i) => (i === axis ? (side * EDGE) / 2 : part));
    const touched = { ...state, contact: grab ? 2 : 1, object: 0, proxy, middle, force: vector(side * size), slips: false };
    return { state: touched, dent: { middle, push: vector(side * (this.dent.out ?? -0.5 * deep)) } };
  }

  #frame() {
    if ((this.state.flags & FLAG.paused) === 0 || (this.state.flags & FLAG.playing) !== 0) this.#step += 40;
    const { state, dent } = this.#touch();
    const { ABSENT, frameMessage } = this.#messages;
    const objects = this.scene.objects.map(({ rest }, object) => {
      const displacement = rest.map((part, i) => {
        const node = rest.slice(i - (i % 3), i - (i % 3) + 3);
        if (this.move !== null && object === 0) return Math.round(1e6 * this.move(node)[i % 3]);
        if (dent === null || object > 0) return 0;
        const away = Math.hypot(...node.map((part, c) => part - dent.middle[c]));
        return Math.round(1e6 * dent.push[i % 3] * Math.exp(-((away / this.dent.width) ** 2)));
      });
      return { position: [0.13 * object, 0, 0], displacement };
    });
    const styluses = this.scene.radii.map((_, s) => (s === this.scene.radii.length - 1 ? state : { ...ABSENT, ...this.others[s] }));
    const time = (this.#step + 1) * this.scene.dt;
    this.#send(frameMessage({ step: this.#step, time, styluses, objects, contacts: this.contacts }, 8));
  }
}
