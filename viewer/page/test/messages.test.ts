// The protocol on bytes that these tests make themselves; protocol.test.ts takes those of the server.
import assert from "node:assert/strict";
import { test } from "node:test";
import { ProtocolError } from "../src/byte_reader.ts";
import {
  Command,
  decode,
  encodeCommand,
  encodeHello,
  encodeLoadScene,
  encodeSettings,
  encodeStylus,
  type Frame,
  type Health,
  type Scene,
  type State,
} from "../src/protocol.ts";
import {
  ABSENT,
  cube,
  frameMessage,
  healthMessage,
  inclusion,
  sceneMessage,
  SETTINGS,
  stateMessage,
  Writer,
  type SceneParts,
  type SceneryParts,
  type StateParts,
} from "./server_messages.ts";

const tetrahedron = { nodes: [0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1], triangles: [0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3] };
const scenery: SceneryParts[] = [
  { name: "wall", shape: 0, size: [0, 0, 0], position: [0, -0.5, 0], orientation: [0.5, 0.5, 0.5, 0.5] },
  { name: "box", shape: 1, size: [1, 2, 3], position: [0, 0, 0], orientation: [1, 0, 0, 0] },
  { name: "ball", shape: 2, size: [0.5, 0, 0], position: [0, 0, 0], orientation: [1, 0, 0, 0] },
  { name: "capsule", shape: 3, size: [0.5, 2, 0], position: [1, 2, 3], orientation: [0, 0, 1, 0] },
  { name: "mesh", shape: 4, size: [0, 0, 0], position: [0, 0, 0], orientation: [1, 0, 0, 0], surface: tetrahedron },
];
const parts: SceneParts = {
  objects: [cube(0.1, 2)],
  radii: [0, 0.008],
  ball: 1,
  dt: 0.002,
  flags: 4,
  floorHeight: 0,
  largestForce: 3,
  scenery,
};
const sceneBytes = sceneMessage(parts);
const scene = decode(sceneBytes, null) as Scene;
const nodes = scene.objects[0]!.rest.length;

const block = cube(0.1, 2);
const tissueBytes = sceneMessage({
  ...parts,
  objects: [{ ...block, regions: { ...inclusion(block, 0.03, 3250, 42500), flags: 2 } }],
  scenery: [],
});
const tissue = decode(tissueBytes, null) as Scene;

const frameBytes = frameMessage({
  step: 7,
  time: 0.016,
  styluses: [
    ABSENT,
    { ...ABSENT, present: true, contact: 1, object: 0, tip: [1, 2, 3], middle: [0.01, 0.02, 0.03], slips: true },
  ],
  objects: [{ position: [0, 0, 0], displacement: Array.from({ length: nodes }, (_, i) => i) }],
  contacts: [{ object: 0, other: -4, normal: [0, 1, 0], position: [1, 2, 3], force: [0, 0.5, -2], area: 0.25 }],
});

const times = (p50: number): { p50: number; p99: number; max: number } => ({ p50, p99: p50 + 1, max: p50 + 2 });
const healthBytes = healthMessage(9, [{ reports: true, roundTrip: times(100), forceAge: times(200) }]);

const STATE: StateParts = {
  flags: 1 + 2 + 8 + 32 + 64 + 128 + 256 + 1024,
  changes: 3,
  length: 12.5,
  speed: 0.5,
  shown: 2,
  recordings: [
    { number: 0, name: "first" },
    { number: 2, name: "zweite Übung" },
  ],
  scenes: ["press.toml", "Würfel.h5"],
  scene: 1,
  notice: "done",
  gravity: [0, -9.81, 0],
  objects: [{ ...SETTINGS, inertia: true, changeable: 2 }],
};

test("a scene says whose the last stylus is, how hard it may push, and how soft the object is", () => {
  assert.equal(scene.viewersStylus, true);
  assert.equal(scene.recordedOnly, false);
  assert.equal(scene.styluses[1]!.largestForce, 3);
  assert.deepEqual(
    scene.styluses.map(({ ball }) => ball),
    [false, true],
  );
  assert.equal(scene.objects[0]!.compliance.length, nodes / 3);
  assert.ok(Math.abs(scene.objects[0]!.compliance[0]! - parts.objects[0]!.compliance[0]!) < 1e-8);
});

test("a frame says where a stylus touches the surface at rest and whether it slips", () => {
  const [first, second] = (decode(frameBytes, scene) as Frame).styluses;
  assert.ok(first!.middle.every(Number.isNaN));
  assert.equal(first!.slips, false);
  assert.deepEqual(second!.middle.map((part) => Math.round(1000 * part)), [10, 20, 30]);
  assert.equal(second!.slips, true);
});

test("a scene has the scenery with the sizes of each shape", () => {
  assert.deepEqual(scene.scenery.map(({ name }) => name), ["wall", "box", "ball", "capsule", "mesh"]);
  assert.deepEqual(scene.scenery.map(({ shape }) => shape), [
    { kind: "plane" },
    { kind: "box", size: [1, 2, 3] },
    { kind: "sphere", radius: 0.5 },
    { kind: "capsule", radius: 0.5, length: 2 },
    { kind: "mesh", nodes: Float32Array.from(tetrahedron.nodes), triangles: Uint32Array.from(tetrahedron.triangles) },
  ]);
  assert.deepEqual(scene.scenery[0]!.orientation, [0.5, 0.5, 0.5, 0.5]);
  assert.deepEqual(scene.scenery[3]!.position, [1, 2, 3]);
});

test("a frame has the contacts between bodies", () => {
  assert.deepEqual((decode(frameBytes, scene) as Frame).contacts, [
    { object: 0, other: -4, normal: [0, 1, 0], position: [1, 2, 3], force: [0, 0.5, -2], area: 0.25 },
  ]);
});

test("health has round trip and age of force of each bridge", () => {
  const { bridges } = decode(healthBytes, scene) as Health;
  assert.deepEqual(bridges, [{ reports: true, roundTrip: times(100), forceAge: times(200) }]);
});

test("a state is what was written", () => {
  const state = decode(stateMessage(STATE), scene) as State;
  const { changeable: _, ...settings } = STATE.objects[0]!;
  assert.deepEqual(state, {
    kind: "state",
    onlyLooksOn: true,
    stylusFree: true,
    stylusMine: false,
    paused: true,
    recording: false,
    canRecord: true,
    scenes: { names: ["press.toml", "Würfel.h5"], shown: 1, canLoad: false, preparing: true },
    changes: 3,
    playback: { length: 12.5, speed: 0.5, playing: true, recording: 2 },
    recordings: STATE.recordings,
    settings: { gravity: [0, -9.81, 0], objects: [settings] },
    changeable: [{ dampingFactor: false, inertia: true, motion: true }],
    notice: "done",
  });
});

test("the live run is no playback, and the server's own recorded run has no number", () => {
  const live = decode(stateMessage({ ...STATE, flags: 0 }), scene) as State;
  assert.equal(live.playback, null);
  assert.equal(live.scenes, null);
  const elsewhere = decode(stateMessage({ ...STATE, scene: 65535 }), scene) as State;
  assert.equal(elsewhere.scenes!.shown, null);
  const own = decode(stateMessage({ ...STATE, shown: 65535 }), scene) as State;
  assert.equal(own.playback!.recording, null);
});

test("what is cut, too long or comes before the scene is refused", () => {
  const state = stateMessage(STATE);
  for (const good of [sceneBytes, tissueBytes, frameBytes, healthBytes, state]) {
    const step = good.byteLength > 2000 ? 97 : 1;
    for (let size = 0; size < good.byteLength; size += step) {
      assert.throws(() => decode(good.slice(0, size), scene), ProtocolError);
    }
    const long = new Uint8Array(good.byteLength + 4);
    long.set(new Uint8Array(good));
    assert.throws(() => decode(long.buffer, scene), ProtocolError);
  }
  assert.throws(() => decode(state, null), ProtocolError);
  assert.throws(() => decode(frameBytes, null), ProtocolError);
});

test("an object of one material has no regions, another what was written", () => {
  assert.equal(scene.objects[0]!.regions, null);
  const { list, faces, faceModulus, nodes, surfaceModulus, someUnlisted, facesLeftOut } = tissue.objects[0]!.regions!;
  const one = (value: number): { low: number; high: number } => ({ low: Math.fround(value), high: Math.fround(value) });
  assert.deepEqual(list, [
    { number: 0, youngsModulus: one(3250), poissonRatio: one(0.45), density: one(1000) },
    { number: 1, youngsModulus: one(42500), poissonRatio: one(0.3), density: one(1100) },
  ]);
  assert.deepEqual([faces.length, faceModulus.length, nodes.length], [36, 12, 24]);
  assert.ok(surfaceModulus.every((value) => value === 3250));
  assert.deepEqual([someUnlisted, facesLeftOut], [false, true]);
});

test("regions that break the rules are refused", () => {
  const changed = (offset: number, ...values: number[]): ArrayBuffer => {
    const copy = tissueBytes.slice(0);
    new Uint8Array(copy).set(values, offset);
    return copy;
  };
  const block = 12 * 3 * 4; // faces
  const counts = tissueBytes.byteLength - 12 * 4 - block - 8 * 12 - 8;
  const header = 56 + 2 * 20 + 20;
  const list = counts - 4 * (tissue.objects[0]!.triangles.length / 3) - 2 * 28;
  assert.equal(decode(changed(counts, 8), null)?.kind, "scene");
  const unknown = decode(changed(list + 2 * 28, 0, 0, 0xc0, 0x7f), null) as Scene;
  assert.ok(Number.isNaN(unknown.objects[0]!.regions!.surfaceModulus[0]));
  for (const [offset, ...values] of [
    [header, 65], // regions
    [header, 0], // none, and yet their bytes
    [list + 4, 0, 0, 0x80, 0x7f], // least above greatest
    [list + 4, 0, 0, 0xc0, 0x7f], // not a number
    [counts, 9], // nodes
    [counts + 4, 13], // faces
    [counts + 4, 0x21, 0x4e], // more faces than there can be
    [counts + 8 + 8 * 12, 8], // node of a face
    [list + 4, 0, 0, 0, 0x80], // least modulus: -0
    [list + 2 * 28, 0, 0, 0x80, 0xff], // modulus at the surface: infinite
    [tissueBytes.byteLength - 4, 0, 0, 0xc0, 0x7f], // modulus of a face: not a number
  ] as [number, ...number[]][]) {
    assert.throws(() => decode(changed(offset, ...values), null), ProtocolError, `${offset}: ${values.join()}`);
  }
});

test("a number out of its range is refused", () => {
  const state = stateMessage(STATE);
  const changed = (bytes: ArrayBuffer, offset: number, value: number): ArrayBuffer => {
    const copy = bytes.slice(0);
    new DataView(copy).setUint8(offset, value);
    return copy;
  };
  const object = 72;
  const recording = object + 80;
  const stylus = 32 + 88;
  const contact = frameBytes.byteLength - 36;
  const mesh = sceneBytes.byteLength - 56 - 4 - 104;
  const capsule = mesh - 56 - 8;
  for (const [bytes, offset, value] of [
    [state, 34, 101], // recordings
    [state, 37, 3], // length of the notice, high byte
    [state, 38, 201], // scenes
    [state, object + 56, 2], // coupling to inertia
    [state, recording + 2, 65], // length of a name
    [state, recording + 2 * 68, 129], // length of a scene's name
    [frameBytes, stylus, 2], // present
    [frameBytes, stylus + 1, 3], // contact
    [frameBytes, stylus + 80, 2], // slips
    [frameBytes, 15, 2], // contacts, high byte
    [frameBytes, contact, 1], // object that touches
    [frameBytes, contact + 1, 1], // object that is touched
    [frameBytes, contact + 1, 0x80], // scenery or ball that is touched
    [sceneBytes, 14, 17], // scenery
    [sceneBytes, 56 + 16, 2], // kind of a stylus
    [sceneBytes, capsule, 5], // shape
    [sceneBytes, mesh + 60, 5], // nodes of a mesh
    [sceneBytes, mesh + 160, 4], // a node of its last triangle
    [sceneBytes, capsule + 3, 2], // length of a name, high byte
    [healthBytes, 120, 5], // bridges
    [healthBytes, 128, 2], // reports
  ] as const) {
    assert.throws(() => decode(changed(bytes, offset, value), scene), ProtocolError, `${offset}: ${value}`);
  }
});

const header = (type: number): Writer => new Writer().raw(new TextEncoder().encode("IRVW")).u16(1, type);

test("what the page says is what the protocol has", () => {
  const hello = header(16).u16(2, 1).raw(new TextEncoder().encode("ab"));
  assert.deepEqual(encodeHello("ab", true), hello.done());
  assert.deepEqual(encodeHello(""), header(16).u16(0, 0).done());
  assert.deepEqual(encodeCommand(Command.Seek, 0, 2.5), header(17).u16(11, 0).zeros(4).f64(2.5).done());
  assert.deepEqual(encodeCommand(Command.Step, 5), header(17).u16(4, 5).zeros(4).f64(0).done());
  assert.deepEqual(encodeCommand(Command.SaveScene), header(17).u16(13, 0).zeros(4).f64(0).done());
  assert.deepEqual(encodeLoadScene("ü.h5"), header(20).u16(5).zeros(2).raw(new TextEncoder().encode("ü.h5")).done());
  const stylus = header(18).u8(1).zeros(3).u32(1).f64(0.1, -1000, 1000);
  assert.deepEqual(encodeStylus({ present: true, grab: true, tip: [0.1, -1e9, 1e9] }), stylus.done());
  const settings = header(19).u16(1).zeros(6).f64(0, -9.81, 0, 0.6, 0.5, 1, 2, 30, 0.01, 1).u8(1).zeros(23);
  const { changeable: _, ...object } = STATE.objects[0]!;
  assert.deepEqual(encodeSettings({ gravity: [0, -9.81, 0], objects: [object] }), settings.done());
});
