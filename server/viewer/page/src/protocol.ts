/**
 * The messages of docs/viewer-protocol.md as the page needs them. Pure: no DOM, no socket.
 *
 * Every length is checked before it is used; bytes that break a rule end in a ProtocolError.
 */

export const MAGIC = "IRVW";
export const VERSION = 1;
const enum Type {
  Scene = 1,
  Frame = 2,
  Health = 3,
  Hello = 16,
  Command = 17,
}
const MAX_OBJECTS = 4;
const MAX_STYLUSES = 4;
const MAX_TRAIL = 32;
const MAX_NAME = 256;
const MAX_TOKEN = 128;

export type Vec3 = readonly [number, number, number];
export type Quat = readonly [number, number, number, number];

export interface SceneStylus {
  /** of the fingertip [m]; 0: a point */
  radius: number;
  /** [N/m]; 0: none */
  couplingStiffness: number;
  /** [m] */
  reach: number;
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
}

export interface Scene {
  kind: "scene";
  /** force step [s] */
  dt: number;
  lockstep: boolean;
  floor: { normal: Vec3; height: number } | null;
  styluses: SceneStylus[];
  objects: SceneObject[];
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
}

export type ServerMessage = Scene | Frame | Health;

export class ProtocolError extends Error {}

class Reader {
  private at = 0;
  private readonly view: DataView;

  constructor(private readonly bytes: ArrayBuffer) {
    this.view = new DataView(bytes);
  }
  private take(count: number): number {
    if (count > this.bytes.byteLength - this.at) throw new ProtocolError("a message is too short");
    const at = this.at;
    this.at += count;
    return at;
  }
  u8(): number {
    return this.view.getUint8(this.take(1));
  }
  u16(): number {
    return this.view.getUint16(this.take(2), true);
  }
  i16(): number {
    return this.view.getInt16(this.take(2), true);
  }
  u32(): number {
    return this.view.getUint32(this.take(4), true);
  }
  /** Exact up to 2^53, which is enough for counts. */
  u64(): number {
    return Number(this.view.getBigUint64(this.take(8), true));
  }
  f32(): number {
    return this.view.getFloat32(this.take(4), true);
  }
  f64(): number {
    return this.view.getFloat64(this.take(8), true);
  }
  vector(): Vec3 {
    return [this.f64(), this.f64(), this.f64()];
  }
  singleVector(): Vec3 {
    return [this.f32(), this.f32(), this.f32()];
  }
  text(length: number): string {
    return new TextDecoder().decode(new Uint8Array(this.bytes, this.take(length), length));
  }
  /** Little-endian, as every machine is that has a browser. The offsets in the protocol are multiples of 4. */
  singles(count: number): Float32Array {
    return new Float32Array(this.bytes, this.take(4 * count), count);
  }
  words(count: number): Uint32Array {
    return new Uint32Array(this.bytes, this.take(4 * count), count);
  }
  shorts(count: number): Int16Array {
    return new Int16Array(this.bytes, this.take(2 * count), count);
  }
  longs(count: number): Int32Array {
    return new Int32Array(this.bytes, this.take(4 * count), count);
  }
  skip(count: number): void {
    this.take(count);
  }
  align(): void {
    this.skip((4 - (this.at % 4)) % 4);
  }
  finish(): void {
    if (this.at !== this.bytes.byteLength) throw new ProtocolError("a message is too long");
  }
}

function count(reader: Reader, largest: number): number {
  const value = reader.u16();
  if (value < 1 || value > largest) throw new ProtocolError("a count is out of range");
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
  reader.skip(4);
  const name = reader.text(length);
  reader.align();
  const rest = reader.singles(3 * nodes);
  const triangles = reader.words(3 * triangleCount);
  if (triangles.some((node) => node >= nodes)) throw new ProtocolError("a triangle has a node that is not there");
  return { name, mass, stiffness, rest, triangles };
}

function readScene(reader: Reader): Scene {
  const objects = count(reader, MAX_OBJECTS);
  const styluses = count(reader, MAX_STYLUSES);
  const flags = reader.u32();
  const dt = reader.f64();
  const normal = reader.vector();
  const height = reader.f64();
  return {
    kind: "scene",
    dt,
    lockstep: (flags & 1) !== 0,
    floor: (flags & 2) !== 0 ? { normal, height } : null,
    styluses: repeat(styluses, () => {
      const stylus = { radius: reader.f32(), couplingStiffness: reader.f32(), reach: reader.f32() };
      reader.skip(4);
      return stylus;
    }),
    objects: repeat(objects, () => readObject(reader)),
  };
}

function readStylus(reader: Reader): StylusState {
  const present = reader.u8();
  const contact = reader.u8();
  if (present > 1 || contact > 2) throw new ProtocolError("a stylus is out of range");
  const stylus = {
    present: present === 1,
    contact: contact as Contact,
    object: reader.i16(),
    buttons: reader.u32(),
    tip: reader.vector(),
    proxy: reader.vector(),
    force: reader.singleVector(),
  };
  reader.skip(4);
  return stylus;
}

function readSurface(reader: Reader, nodes: number): ObjectState {
  const position = reader.vector();
  const orientation: Quat = [reader.f32(), reader.f32(), reader.f32(), reader.f32()];
  const width = reader.u8();
  if (width !== 2 && width !== 4) throw new ProtocolError("numbers of an unknown size");
  reader.skip(3);
  const unit = reader.f32();
  const displacement = width === 2 ? reader.shorts(3 * nodes) : reader.longs(3 * nodes);
  reader.align();
  return { position, orientation, unit, displacement };
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
  reader.skip(2);
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
  };
}

function readPercentiles(reader: Reader): Percentiles {
  return { p50: reader.f32(), p99: reader.f32(), max: reader.f32() };
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
      default:
        throw new ProtocolError("a message of unknown type " + type);
    }
  };
  const message = read();
  reader.finish();
  return message;
}

function header(type: Type, size: number): DataView {
  const view = new DataView(new ArrayBuffer(8 + size));
  for (let i = 0; i < 4; ++i) view.setUint8(i, MAGIC.charCodeAt(i));
  view.setUint16(4, VERSION, true);
  view.setUint16(6, type, true);
  return view;
}

export function encodeHello(token: string): ArrayBuffer {
  const text = new TextEncoder().encode(token).slice(0, MAX_TOKEN);
  const view = header(Type.Hello, 2 + text.length);
  view.setUint16(8, text.length, true);
  new Uint8Array(view.buffer).set(text, 10);
  return view.buffer as ArrayBuffer;
}

export function encodePutBack(): ArrayBuffer {
  const view = header(Type.Command, 4);
  view.setUint16(8, 1, true);
  return view.buffer as ArrayBuffer;
}
