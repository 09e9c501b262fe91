// What a server says, byte by byte as docs/viewer-protocol.md has it: for tests without a server.
import type { BodyContact, ObjectSettings, Percentiles, Quat, Recording, Vec3 } from "../src/protocol.ts";

/** Bytes from front to back, little-endian. */
export class Writer {
  private readonly bytes: number[] = [];

  private put(size: number, set: (view: DataView) => void): this {
    const view = new DataView(new ArrayBuffer(size));
    set(view);
    this.bytes.push(...new Uint8Array(view.buffer));
    return this;
  }
  u8(...values: number[]): this {
    for (const value of values) this.put(1, (view) => view.setUint8(0, value));
    return this;
  }
  u16(...values: number[]): this {
    for (const value of values) this.put(2, (view) => view.setUint16(0, value, true));
    return this;
  }
  i8(...values: number[]): this {
    for (const value of values) this.put(1, (view) => view.setInt8(0, value));
    return this;
  }
  i16(...values: number[]): this {
    for (const value of values) this.put(2, (view) => view.setInt16(0, value, true));
    return this;
  }
  u32(...values: number[]): this {
    for (const value of values) this.put(4, (view) => view.setUint32(0, value, true));
    return this;
  }
  u64(...values: number[]): this {
    for (const value of values) this.put(8, (view) => view.setBigUint64(0, BigInt(value), true));
    return this;
  }
  f32(...values: number[]): this {
    for (const value of values) this.put(4, (view) => view.setFloat32(0, value, true));
    return this;
  }
  f64(...values: number[]): this {
    for (const value of values) this.put(8, (view) => view.setFloat64(0, value, true));
    return this;
  }
  zeros(count: number): this {
    for (let i = 0; i < count; ++i) this.bytes.push(0);
    return this;
  }
  align(): this {
    return this.zeros((4 - (this.bytes.length % 4)) % 4);
  }
  raw(bytes: Uint8Array): this {
    this.bytes.push(...bytes);
    return this;
  }
  done(): ArrayBuffer {
    return Uint8Array.from(this.bytes).buffer;
  }
}

function begin(type: number): Writer {
  return new Writer().raw(utf8("IRVW")).u16(1, type);
}

function utf8(text: string): Uint8Array {
  return new TextEncoder().encode(text);
}

export interface ObjectParts {
  name: string;
  rest: number[];
  triangles: number[];
  compliance: number[];
  regions?: RegionsParts;
  display?: DisplayParts;
}

/** Bound to the object's surface by three nodes and weights a vertex. */
export interface DisplayParts {
  positions: number[];
  normals: number[];
  triangles: number[];
  nodes: number[];
  weights: number[];
  /** none: left out */
  coordinates?: number[];
  /** a file's bytes; none: left out */
  texture?: number[];
}

export interface RegionsParts {
  /** number; least and greatest Young's modulus, Poisson's ratio, density */
  list: { number: number; spans: number[] }[];
  /** bit 0 some are not listed, 1 faces inside are left out */
  flags: number;
  surfaceModulus: number[];
  nodes: number[];
  faces: number[];
  faceModulus: number[];
}

export { ball } from "./display_ball.ts";

/** A cube of its own in the middle of an object: region 1. */
export function inclusion(object: ObjectParts, edge: number, soft: number, stiff: number): RegionsParts {
  const { rest, triangles } = cube(edge, 1);
  return {
    list: [
      { number: 0, spans: [soft, soft, 0.45, 0.45, 1000, 1000] },
      { number: 1, spans: [stiff, stiff, 0.3, 0.3, 1100, 1100] },
    ],
    flags: 0,
    surfaceModulus: new Array<number>(object.triangles.length / 3).fill(soft),
    nodes: rest,
    faces: triangles,
    faceModulus: new Array<number>(triangles.length / 3).fill(stiff),
  };
}

/** A cube of that many cells an edge, centred; compliance grows towards its edges. [m] */
export function cube(edge: number, cells: number, name = "cube"): ObjectParts {
  const numbers = new Map<string, number>();
  const rest: number[] = [];
  const triangles: number[] = [];
  const node = (point: number[]): number => {
    const key = point.map((part) => part.toFixed(9)).join();
    if (!numbers.has(key)) {
      numbers.set(key, rest.length / 3);
      rest.push(...point);
    }
    return numbers.get(key)!;
  };
  for (let axis = 0; axis < 3; ++axis) {
    for (const side of [-1, 1]) {
      const corner = (i: number, j: number): number => {
        const point = [0, 0, 0];
        point[axis] = (side * edge) / 2;
        point[(axis + 1) % 3] = (i / cells - 0.5) * edge;
        point[(axis + 2) % 3] = (j / cells - 0.5) * edge;
        return node(point);
      };
      for (let i = 0; i < cells; ++i) {
        for (let j = 0; j < cells; ++j) {
          const [a, b, c, d] = [corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)];
          triangles.push(...(side > 0 ? [a, b, c, a, c, d] : [a, c, b, a, d, c]));
        }
      }
    }
  }
  const compliance = Array.from({ length: rest.length / 3 }, (_, i) => 0.002 + 1.5 * Math.hypot(...rest.slice(3 * i, 3 * i + 3)) ** 2);
  return { name, rest, triangles, compliance };
}

export interface SceneryParts {
  name: string;
  /** 0 plane, 1 box, 2 sphere, 3 capsule, 4 mesh */
  shape: number;
  size: Vec3;
  position: Vec3;
  orientation: Quat;
  /** of a mesh */
  surface?: { nodes: number[]; triangles: number[] };
}

export interface SceneParts {
  objects: ObjectParts[];
  /** of their tips [m] */
  radii: number[];
  /** the stylus whose tip is a ball, if there is one */
  ball?: number;
  dt: number;
  /** bit 0 lockstep, 1 floor, 2 viewers' stylus, 3 recorded run only */
  flags: number;
  floorHeight: number;
  largestForce: number;
  scenery: SceneryParts[];
}

function putRegions(to: Writer, { list, surfaceModulus, nodes, faces, faceModulus }: RegionsParts): void {
  for (const { number, spans } of list) to.u32(number).f32(...spans);
  to.f32(...surfaceModulus).u32(nodes.length / 3, faces.length / 3);
  to.f32(...nodes).u32(...faces).f32(...faceModulus);
}

function putDisplay(to: Writer, display: DisplayParts): void {
  const { positions, normals, triangles, nodes, weights, coordinates, texture } = display;
  to.u32(positions.length / 3, triangles.length / 3, coordinates === undefined ? 0 : 1, texture?.length ?? 0);
  to.f32(...positions, ...normals).u32(...triangles, ...nodes).f32(...weights, ...(coordinates ?? []));
  to.u8(...(texture ?? [])).align();
}

export function sceneMessage(parts: SceneParts): ArrayBuffer {
  const to = begin(1).u16(parts.objects.length, parts.radii.length).u16(parts.flags, parts.scenery.length).f64(parts.dt);
  to.f64(0, (parts.flags & 2) !== 0 ? 1 : 0, 0, parts.floorHeight);
  parts.radii.forEach((radius, s) => to.f32(radius, 400, 0, parts.largestForce).u32(s === parts.ball ? 1 : 0));
  for (const object of parts.objects) {
    const name = utf8(object.name);
    to.u32(object.rest.length / 3, object.triangles.length / 3, name.length).f32(0.1, 2e4);
    to.u16(object.regions?.list.length ?? 0, (object.regions?.flags ?? 0) | (object.display === undefined ? 0 : 4)).raw(name).align();
    to.f32(...object.rest).u32(...object.triangles).f32(...object.compliance);
    if (object.regions !== undefined) putRegions(to, object.regions);
    if (object.display !== undefined) putDisplay(to, object.display);
  }
  for (const scenery of parts.scenery) {
    const name = utf8(scenery.name);
    to.u16(scenery.shape, name.length).f32(...scenery.size).f64(...scenery.position).f32(...scenery.orientation);
    to.raw(name).align();
    if (scenery.surface === undefined) continue;
    const { nodes, triangles } = scenery.surface;
    to.u32(nodes.length / 3, triangles.length / 3).f32(...nodes).u32(...triangles);
  }
  return to.done();
}

export interface StylusParts {
  present: boolean;
  contact: number;
  object: number;
  buttons: number;
  tip: Vec3;
  proxy: Vec3;
  force: Vec3;
  middle: Vec3;
  slips: boolean;
}

export const ABSENT: StylusParts = {
  present: false,
  contact: 0,
  object: -1,
  buttons: 0,
  tip: [0, 0, 0],
  proxy: [0, 0, 0],
  force: [0, 0, 0],
  middle: [Number.NaN, Number.NaN, Number.NaN],
  slips: false,
};

export interface FrameParts {
  step: number;
  time: number;
  styluses: StylusParts[];
  /** for each: position and, in units of 1 um, displacements */
  objects: { position: Vec3; displacement: number[] }[];
  contacts: BodyContact[];
}

/** @param trail steps for which the force has been the same */
export function frameMessage(parts: FrameParts, trail = 1): ArrayBuffer {
  const to = begin(2).u16(parts.objects.length, parts.styluses.length, trail, parts.contacts.length);
  to.u64(parts.step).f64(parts.time);
  for (const stylus of parts.styluses) {
    to.u8(stylus.present ? 1 : 0, stylus.contact).i16(stylus.object).u32(stylus.buttons);
    to.f64(...stylus.tip, ...stylus.proxy).f32(...stylus.force, ...stylus.middle).u8(stylus.slips ? 1 : 0).zeros(7);
  }
  for (let i = 0; i < trail; ++i) for (const stylus of parts.styluses) to.f32(...stylus.force);
  for (const object of parts.objects) {
    to.f64(...object.position).f32(1, 0, 0, 0).u8(2).zeros(3).f32(1e-6).i16(...object.displacement).align();
  }
  for (const { object, other, normal, position, force, area } of parts.contacts) {
    to.u8(object).i8(other).i16(...normal.map((part) => Math.round(32767 * part))).f32(...position, ...force, area);
  }
  return to.done();
}

export interface BridgeParts {
  reports: boolean;
  roundTrip: Percentiles;
  forceAge: Percentiles;
}

export function healthMessage(steps: number, bridges: BridgeParts[]): ArrayBuffer {
  const to = begin(3).u64(steps).f32(12, 31, 48, 55, 90, 140).u64(0, 0, 1, 0).f32(60).u32(1).u64(1, 2000, 1000, 0, 0);
  to.u16(bridges.length).zeros(6);
  for (const { reports, roundTrip, forceAge } of bridges) {
    to.u32(reports ? 1 : 0);
    for (const times of [roundTrip, forceAge]) to.f32(times.p50, times.p99, times.max);
    to.zeros(4);
  }
  return to.done();
}

export interface StateParts {
  flags: number;
  changes: number;
  length: number;
  speed: number;
  shown: number;
  recordings: Recording[];
  scenes?: string[];
  /** number of the one that runs */
  scene?: number;
  notice: string;
  gravity: Vec3;
  /** with the bits of what can be changed */
  objects: (ObjectSettings & { changeable: number })[];
}

export const SETTINGS: ObjectSettings & { changeable: number } = {
  staticFriction: 0.6,
  kineticFriction: 0.5,
  damping: 1,
  angularDamping: 2,
  tether: 30,
  angularTether: 0.01,
  dampingFactor: 1,
  inertia: false,
  changeable: 3,
};

export function stateMessage(parts: StateParts): ArrayBuffer {
  const notice = utf8(parts.notice);
  const to = begin(4).u32(parts.flags, parts.changes).f64(parts.length, parts.speed);
  to.u16(parts.shown, parts.recordings.length, notice.length);
  to.u16(parts.scenes?.length ?? 0, parts.scene ?? 65535).zeros(6).f64(...parts.gravity);
  for (const object of parts.objects) {
    to.f64(object.staticFriction, object.kineticFriction, object.damping, object.angularDamping);
    to.f64(object.tether, object.angularTether, object.dampingFactor);
    to.u8(object.inertia ? 1 : 0, object.changeable).zeros(22);
  }
  for (const { number, name } of parts.recordings) {
    const text = utf8(name);
    to.u16(number, text.length).raw(text).zeros(64 - text.length);
  }
  for (const name of parts.scenes ?? []) {
    const text = utf8(name);
    to.u16(text.length).raw(text);
  }
  return to.raw(notice).align().done();
}
