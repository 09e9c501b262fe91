/**
 * The messages of docs/viewer-protocol.md as the page needs them. Pure: no DOM, no socket.
 *
 * Every length is checked before it is used; bytes that break a rule end in a ProtocolError.
 */

import { ProtocolError, Reader } from "./byte_reader";
import { readDisplay, type Display } from "./display";
import { readRegions, type Regions } from "./regions";

export const MAGIC = "IRVW";
export const VERSION = 1;
const enum Type {
  Scene = 1,
  Frame = 2,
  Health = 3,
  State = 4,
  Hello = 16,
  Command = 17,
  Stylus = 18,
  Settings = 19,
  LoadScene = 20,
}
const MAX_OBJECTS = 16;
const MAX_STYLUSES = 16;
const MAX_SCENERY = 16;
const MAX_TRAIL = 128;
export const MAX_CONTACTS = 256;
const NORMAL_UNITS = 32767;
const MAX_NAME = 256;
const MAX_REGIONS = 64;
const HAS_DISPLAY = 4; // of an object's flags
const MAX_TOKEN = 128;
const MAX_RECORDINGS = 100;
const RECORDING_NAME = 64;
const MAX_NOTICE = 512;
const NONE = 65535; // in place of a number
const MAX_SCENES = 200;
const MAX_SCENE_NAME = 128;
const MAX_COORDINATE = 1000; // of a tip [m]

export type Vec3 = readonly [number, number, number];
export type Quat = readonly [number, number, number, number];

export interface SceneStylus {
  /** of the fingertip or ball [m]; 0: a point */
  radius: number;
  /** [N/m]; 0: none */
  couplingStiffness: number;
  /** [m] */
  reach: number;
  /** that it can be pushed with [N]; 0: no bound of its own */
  largestForce: number;
  /** the tip is a ball about the position of the stylus */
  ball: boolean;
}

export interface SceneObject {
  name: string;
  /** [kg] */
  mass: number;
  /** Young's modulus [Pa] */
  stiffness: number;
  /** X, three numbers a node [m], B */
  rest: Float32Array;
  /** three node numbers a triangle, outward */
  triangles: Uint32Array;
  /** a node: displacement along the normal for a force along it [m/N]; NaN: not known */
  compliance: Float32Array;
  /** null: it is of one material, or rigid */
  regions: Regions | null;
  /** null: its computed surface is drawn */
  display: Display | null;
}

/** In its own frame: a plane has the normal +y, a capsule the axis y with `length` between its balls' centres. [m] */
export type Shape =
  | { kind: "plane" }
  | { kind: "box"; size: Vec3 }
  | { kind: "sphere"; radius: number }
  | { kind: "capsule"; radius: number; length: number }
  | { kind: "mesh"; nodes: Float32Array; triangles: Uint32Array };

/** A body that never moves. */
export interface Scenery {
  name: string;
  shape: Shape;
  /** [m], W */
  position: Vec3;
  /** w, x, y, z; shape to W */
  orientation: Quat;
}

export interface Scene {
  kind: "scene";
  /** force step [s] */
  dt: number;
  lockstep: boolean;
  /** the last stylus is that of the viewers */
  viewersStylus: boolean;
  /** there is no live run, only a recorded one */
  recordedOnly: boolean;
  floor: { normal: Vec3; height: number } | null;
  styluses: SceneStylus[];
  objects: SceneObject[];
  scenery: Scenery[];
}

export const enum Contact {
  Free = 0,
  Touching = 1,
  Held = 2,
}

export interface StylusState {
  present: boolean;
  contact: Contact;
  /** number of the object that it touches; -1: none */
  object: number;
  buttons: number;
  /** [m], W */
  tip: Vec3;
  proxy: Vec3;
  /** on the stylus [N], W */
  force: Vec3;
  /** of the contact, on the surface at rest [m], B of the object; NaN when free */
  middle: Vec3;
  slips: boolean;
}

export interface ObjectState {
  /** of the centre of mass [m], W */
  position: Vec3;
  /** w, x, y, z; B to W */
  orientation: Quat;
  /** of a number in `displacement` [m] */
  unit: number;
  /** u, three numbers a node, in units; B */
  displacement: Int16Array | Int32Array;
}

/** Where an object touches another one or scenery. */
export interface BodyContact {
  object: number;
  /** the object that it touches; -1 - i: scenery i */
  other: number;
  /** out of the other, unit, W */
  normal: Vec3;
  /** [m], W */
  position: Vec3;
  /** on the object; the other has the opposite [N], W */
  force: Vec3;
  /** of the patch that it stands for [m^2] */
  area: number;
}

export interface Frame {
  kind: "frame";
  /** force step k */
  step: number;
  /** [s] */
  time: number;
  styluses: StylusState[];
  /** steps in `forces`: step - trail + 1 .. step */
  trail: number;
  /** for each of these steps, for each stylus: three numbers [N], W */
  forces: Float32Array;
  objects: ObjectState[];
  contacts: BodyContact[];
}

/** Median, 99th percentile, maximum [us]; NaN: not measured. */
export interface Percentiles {
  p50: number;
  p99: number;
  max: number;
}

export interface Health {
  kind: "health";
  steps: number;
  stepTime: Percentiles;
  wakeupDelay: Percentiles;
  missed: number;
  unsolved: number;
  resets: number;
  lostSteps: number;
  surfaceRate: number;
  viewers: number;
  sessions: number;
  samples: number;
  forces: number;
  forcesReplaced: number;
  protocolErrors: number;
  bridges: BridgeHealth[];
}

/** What the bridge of a stylus told of its last second. */
export interface BridgeHealth {
  /** else the times mean nothing */
  reports: boolean;
  roundTrip: Percentiles;
  /** of the force that the hand feels */
  forceAge: Percentiles;
}

export interface ObjectSettings {
  /** 0 <= kinetic <= static <= 10 */
  staticFriction: number;
  kineticFriction: number;
  /** [1/s] */
  damping: number;
  angularDamping: number;
  /** [N/m] */
  tether: number;
  /** [N m/rad] */
  angularTether: number;
  /** of the material's damping, 0.1 to 10 */
  dampingFactor: number;
  /** the object's own spin loads its elastic part */
  inertia: boolean;
}

export interface Settings {
  /** [m/s^2], W */
  gravity: Vec3;
  objects: ObjectSettings[];
}

/** Which of an object's settings can be changed; the others always can. */
export interface Changeable {
  dampingFactor: boolean;
  inertia: boolean;
  /** it moves as a whole: damping of motion and tethers do something */
  motion: boolean;
}

export interface Recording {
  number: number;
  name: string;
}

/** What can change while the server runs, and what this viewer may do about it. */
export interface State {
  kind: "state";
  onlyLooksOn: boolean;
  stylusFree: boolean;
  stylusMine: boolean;
  paused: boolean;
  recording: boolean;
  canRecord: boolean;
  /** null: the server has no folder of scenes */
  scenes: Scenes | null;
  /** number of changes of settings so far */
  changes: number;
  /** of the recorded run that is shown; null: the live run is */
  playback: Playback | null;
  recordings: Recording[];
  settings: Settings;
  /** for each object */
  changeable: Changeable[];
  /** what the last thing asked for led to, for a person; empty: nothing to say */
  notice: string;
}

/** The scenes that the server can load. */
export interface Scenes {
  names: string[];
  /** number of the one that runs; null: it is not in the list */
  shown: number | null;
  /** another one may take the place of this run */
  canLoad: boolean;
  /** one is being loaded or saved */
  preparing: boolean;
}

export interface Playback {
  /** [s] */
  length: number;
  speed: number;
  playing: boolean;
  /** null: the one that the server was started with */
  recording: number | null;
}

export type ServerMessage = Scene | Frame | Health | State;

function upTo(largest: number, value: number): number {
  if (value > largest) throw new ProtocolError("a number is out of range");
  return value;
}

function count(reader: Reader, largest: number): number {
  const value = upTo(largest, reader.u16());
  if (value < 1) throw new ProtocolError("nothing where there has to be something");
  return value;
}

function repeat<T>(times: number, make: () => T): T[] {
  return Array.from({ length: times }, make);
}

function readObject(reader: Reader): SceneObject {
  const nodes = reader.u32();
  const triangleCount = reader.u32();
  const length = reader.u32();
  if (length > MAX_NAME) throw new ProtocolError("a name is too long");
  const mass = reader.f32();
  const stiffness = reader.f32();
  const regionCount = upTo(MAX_REGIONS, reader.u16());
  const flags = reader.u16();
  const name = reader.text(length);
  reader.align();
  const rest = reader.singles(3 * nodes);
  const triangles = reader.words(3 * triangleCount);
  if (triangles.some((node) => node >= nodes)) throw new ProtocolError("a triangle has a node that is not there");
  const compliance = reader.singles(nodes);
  const regions = regionCount > 0 ? readRegions(reader, regionCount, flags, triangleCount) : null;
  const display = (flags & HAS_DISPLAY) !== 0 ? readDisplay(reader, nodes) : null;
  return { name, mass, stiffness, rest, triangles, compliance, regions, display };
}

function readShape(number: number, [x, y, z]: Vec3): Shape {
  switch (number) {
    case 0:
      return { kind: "plane" };
    case 1:
      return { kind: "box", size: [x, y, z] };
    case 2:
      return { kind: "sphere", radius: x };
    case 3:
      return { kind: "capsule", radius: x, length: y };
    case 4:
      return { kind: "mesh", nodes: new Float32Array(), triangles: new Uint32Array() };
    default:
      throw new ProtocolError("scenery of an unknown shape");
  }
}

function readMesh(reader: Reader): Shape {
  const count = reader.u32();
  const triangleCount = reader.u32();
  const nodes = reader.singles(3 * count);
  const triangles = reader.words(3 * triangleCount);
  if (triangles.some((node) => node >= count)) throw new ProtocolError("a triangle has a node that is not there");
  return { kind: "mesh", nodes, triangles };
}

function readScenery(reader: Reader): Scenery {
  const number = reader.u16();
  const length = upTo(MAX_NAME, reader.u16());
  const shape = readShape(number, reader.singleVector());
  const position = reader.vector();
  const orientation = reader.quaternion();
  const name = reader.text(length);
  reader.align();
  return { name, shape: shape.kind === "mesh" ? readMesh(reader) : shape, position, orientation };
}

function readScene(reader: Reader): Scene {
  const objects = count(reader, MAX_OBJECTS);
  const styluses = count(reader, MAX_STYLUSES);
  const flags = reader.u16();
  const scenery = upTo(MAX_SCENERY, reader.u16());
  const dt = reader.f64();
  const normal = reader.vector();
  const height = reader.f64();
  return {
    kind: "scene",
    dt,
    lockstep: (flags & 1) !== 0,
    viewersStylus: (flags & 4) !== 0,
    recordedOnly: (flags & 8) !== 0,
    floor: (flags & 2) !== 0 ? { normal, height } : null,
    styluses: repeat(styluses, () => ({
      radius: reader.f32(),
      couplingStiffness: reader.f32(),
      reach: reader.f32(),
      largestForce: reader.f32(),
      ball: upTo(1, reader.u32()) === 1,
    })),
    objects: repeat(objects, () => readObject(reader)),
    scenery: repeat(scenery, () => readScenery(reader)),
  };
}

function readStylus(reader: Reader): StylusState {
  const present = upTo(1, reader.u8());
  const contact = upTo(Contact.Held, reader.u8());
  const stylus = {
    present: present === 1,
    contact: contact as Contact,
    object: reader.i16(),
    buttons: reader.u32(),
    tip: reader.vector(),
    proxy: reader.vector(),
    force: reader.singleVector(),
    middle: reader.singleVector(),
    slips: upTo(1, reader.u8()) === 1,
  };
  reader.skip(7);
  return stylus;
}

function readSurface(reader: Reader, nodes: number): ObjectState {
  const position = reader.vector();
  const orientation = reader.quaternion();
  const width = reader.u8();
  if (width !== 2 && width !== 4) throw new ProtocolError("numbers of an unknown size");
  reader.skip(3);
  const unit = reader.f32();
  const displacement = width === 2 ? reader.shorts(3 * nodes) : reader.longs(3 * nodes);
  reader.align();
  return { position, orientation, unit, displacement };
}

function readContact(reader: Reader, scene: Scene): BodyContact {
  const object = reader.u8();
  const other = reader.i8();
  const objects = scene.objects.length;
  if (object >= objects || other >= objects || -1 - other >= scene.scenery.length + scene.styluses.length) {
    throw new ProtocolError("a contact of a body that is not there");
  }
  const part = (): number => reader.i16() / NORMAL_UNITS;
  return {
    object,
    other,
    normal: [part(), part(), part()],
    position: reader.singleVector(),
    force: reader.singleVector(),
    area: reader.f32(),
  };
}

function readFrame(reader: Reader, scene: Scene | null): Frame {
  if (scene === null) throw new ProtocolError("a frame comes before its scene");
  const objects = count(reader, MAX_OBJECTS);
  const styluses = count(reader, MAX_STYLUSES);
  if (objects !== scene.objects.length || styluses !== scene.styluses.length) {
    throw new ProtocolError("a frame does not fit the scene");
  }
  const trail = reader.u16();
  if (trail > MAX_TRAIL) throw new ProtocolError("a trail of forces is too long");
  const contacts = upTo(MAX_CONTACTS, reader.u16());
  const step = reader.u64();
  const time = reader.f64();
  return {
    kind: "frame",
    step,
    time,
    styluses: repeat(styluses, () => readStylus(reader)),
    trail,
    forces: reader.singles(3 * trail * styluses),
    objects: scene.objects.map((object) => readSurface(reader, object.rest.length / 3)),
    contacts: repeat(contacts, () => readContact(reader, scene)),
  };
}

function readPercentiles(reader: Reader): Percentiles {
  return { p50: reader.f32(), p99: reader.f32(), max: reader.f32() };
}

function readBridge(reader: Reader): BridgeHealth {
  const reports = upTo(1, reader.u32()) === 1;
  const bridge = { reports, roundTrip: readPercentiles(reader), forceAge: readPercentiles(reader) };
  reader.skip(4);
  return bridge;
}

function readBridges(reader: Reader): BridgeHealth[] {
  const bridges = upTo(MAX_STYLUSES, reader.u16());
  reader.skip(6);
  return repeat(bridges, () => readBridge(reader));
}

function readHealth(reader: Reader): Health {
  return {
    kind: "health",
    steps: reader.u64(),
    stepTime: readPercentiles(reader),
    wakeupDelay: readPercentiles(reader),
    missed: reader.u64(),
    unsolved: reader.u64(),
    resets: reader.u64(),
    lostSteps: reader.u64(),
    surfaceRate: reader.f32(),
    viewers: reader.u32(),
    sessions: reader.u64(),
    samples: reader.u64(),
    forces: reader.u64(),
    forcesReplaced: reader.u64(),
    protocolErrors: reader.u64(),
    bridges: readBridges(reader),
  };
}

function readObjectSettings(reader: Reader): [ObjectSettings, Changeable] {
  const settings = {
    staticFriction: reader.f64(),
    kineticFriction: reader.f64(),
    damping: reader.f64(),
    angularDamping: reader.f64(),
    tether: reader.f64(),
    angularTether: reader.f64(),
    dampingFactor: reader.f64(),
    inertia: upTo(1, reader.u8()) === 1,
  };
  const bits = reader.u8();
  reader.skip(22);
  return [settings, { dampingFactor: (bits & 1) !== 0, inertia: (bits & 2) !== 0, motion: (bits & 4) === 0 }];
}

function readRecording(reader: Reader): Recording {
  const number = reader.u16();
  const length = reader.u16();
  return { number, name: reader.field(length, RECORDING_NAME) };
}

function readScenes(reader: Reader, count: number): string[] {
  return repeat(count, () => reader.text(upTo(MAX_SCENE_NAME, reader.u16())));
}

function readState(reader: Reader, scene: Scene | null): State {
  if (scene === null) throw new ProtocolError("a state comes before its scene");
  const flags = reader.u32();
  const flag = (bit: number): boolean => ((flags >> bit) & 1) !== 0;
  const changes = reader.u32();
  const length = reader.f64();
  const speed = reader.f64();
  const shown = reader.u16();
  const recordings = upTo(MAX_RECORDINGS, reader.u16());
  const noticeLength = upTo(MAX_NOTICE, reader.u16());
  const sceneCount = upTo(MAX_SCENES, reader.u16());
  const shownScene = reader.u16();
  reader.skip(6);
  const gravity = reader.vector();
  const objects = scene.objects.map(() => readObjectSettings(reader));
  const list = repeat(recordings, () => readRecording(reader));
  const names = readScenes(reader, sceneCount);
  const notice = reader.text(noticeLength);
  reader.align();
  return {
    kind: "state",
    onlyLooksOn: flag(0),
    stylusFree: flag(1),
    stylusMine: flag(2),
    paused: flag(3),
    recording: flag(4),
    canRecord: flag(7),
    scenes: flag(8) ? { names, shown: shownScene === NONE ? null : shownScene, canLoad: flag(9), preparing: flag(10) } : null,
    changes,
    playback: flag(5)
      ? { length, speed, playing: flag(6), recording: shown === NONE ? null : shown }
      : null,
    recordings: list,
    settings: { gravity, objects: objects.map(([settings]) => settings) },
    changeable: objects.map(([, changeable]) => changeable),
    notice,
  };
}

/** @param scene the session's, once it has come: a frame cannot be read without it */
export function decode(bytes: ArrayBuffer, scene: Scene | null): ServerMessage {
  const reader = new Reader(bytes);
  if (reader.text(4) !== MAGIC) throw new ProtocolError("a message does not begin with " + MAGIC);
  if (reader.u16() !== VERSION) throw new ProtocolError("the server speaks another version; reload the page");
  const read = (): ServerMessage => {
    const type = reader.u16();
    switch (type) {
      case Type.Scene:
        return readScene(reader);
      case Type.Frame:
        return readFrame(reader, scene);
      case Type.Health:
        return readHealth(reader);
      case Type.State:
        return readState(reader, scene);
      default:
        throw new ProtocolError("a message of unknown type " + type);
    }
  };
  const message = read();
  reader.finish();
  return message;
}

/** A message of `size` bytes, header and all, zero but for the header. */
function begin(type: Type, size: number): DataView {
  const view = new DataView(new ArrayBuffer(size));
  for (let i = 0; i < 4; ++i) view.setUint8(i, MAGIC.charCodeAt(i));
  view.setUint16(4, VERSION, true);
  view.setUint16(6, type, true);
  return view;
}

function putNumbers(view: DataView, offset: number, values: readonly number[]): void {
  values.forEach((value, i) => view.setFloat64(offset + 8 * i, value, true));
}

function bytesOf(view: DataView): ArrayBuffer {
  return view.buffer as ArrayBuffer;
}

export function encodeHello(token: string, onlyLooksOn = false): ArrayBuffer {
  const text = new TextEncoder().encode(token).slice(0, MAX_TOKEN);
  const view = begin(Type.Hello, 12 + text.length);
  view.setUint16(8, text.length, true);
  view.setUint16(10, onlyLooksOn ? 1 : 0, true);
  new Uint8Array(view.buffer).set(text, 12);
  return bytesOf(view);
}

export const enum Command {
  Reset = 1,
  Pause = 2,
  Resume = 3,
  Step = 4,
  BeginRecording = 5,
  EndRecording = 6,
  ShowRecording = 7,
  BackToLive = 8,
  Play = 9,
  PausePlayback = 10,
  Seek = 11,
  Speed = 12,
  SaveScene = 13,
}

/**
 * @param number of steps to make, or of the recording to show
 * @param value time [s] to go to, or speed
 */
export function encodeCommand(what: Command, number = 0, value = 0): ArrayBuffer {
  const view = begin(Type.Command, 24);
  view.setUint16(8, what, true);
  view.setUint16(10, number, true);
  view.setFloat64(16, value, true);
  return bytesOf(view);
}

/** The viewers' stylus: where this viewer's hand is. */
export interface HandMessage {
  present: boolean;
  grab: boolean;
  /** [m], W */
  tip: Vec3;
}

export function encodeStylus(hand: HandMessage): ArrayBuffer {
  const view = begin(Type.Stylus, 40);
  view.setUint8(8, hand.present ? 1 : 0);
  view.setUint32(12, hand.grab ? 1 : 0, true);
  putNumbers(view, 16, hand.tip.map((part) => clamp(part, -MAX_COORDINATE, MAX_COORDINATE)));
  return bytesOf(view);
}

/** @param name from the list in State */
export function encodeLoadScene(name: string): ArrayBuffer {
  const text = new TextEncoder().encode(name).slice(0, MAX_SCENE_NAME);
  const view = begin(Type.LoadScene, 12 + text.length);
  view.setUint16(8, text.length, true);
  new Uint8Array(view.buffer).set(text, 12);
  return bytesOf(view);
}

export function encodeSettings(settings: Settings): ArrayBuffer {
  const view = begin(Type.Settings, 40 + 80 * settings.objects.length);
  view.setUint16(8, settings.objects.length, true);
  putNumbers(view, 16, settings.gravity);
  settings.objects.forEach((object, i) => {
    const at = 40 + 80 * i;
    const { staticFriction, kineticFriction, damping, angularDamping, tether, angularTether } = object;
    const numbers = [staticFriction, kineticFriction, damping, angularDamping, tether, angularTether];
    putNumbers(view, at, [...numbers, object.dampingFactor]);
    view.setUint8(at + 56, object.inertia ? 1 : 0);
  });
  return bytesOf(view);
}

function clamp(value: number, low: number, high: number): number {
  return Math.min(Math.max(value, low), high);
}
