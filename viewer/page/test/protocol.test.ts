// The page's decoder on bytes that the server's encoder made: SAMPLES names their folder.
import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import path from "node:path";
import { test } from "node:test";
import { ProtocolError } from "../src/byte_reader.ts";
import { Command, decode, encodeCommand, encodeHello, encodeLoadScene, type Frame, type Health, type Scene, type State } from "../src/protocol.ts";

const folder = process.env["SAMPLES"]!;
const expected = JSON.parse(readFileSync(path.join(folder, "expected.json"), "utf8")) as Record<string, number[]>;

function bytes(name: string): ArrayBuffer {
  const content = readFileSync(path.join(folder, name));
  return content.buffer.slice(content.byteOffset, content.byteOffset + content.length) as ArrayBuffer;
}

const scene = decode(bytes("scene.bin"), null) as Scene;

function near(values: ArrayLike<number>, name: string, within: number, factor = 1): void {
  assert.equal(values.length, expected[name]!.length, name);
  expected[name]!.forEach((value, i) => assert.ok(Math.abs(values[i]! * factor - value) <= within, `${name} ${i}`));
}

test("a scene is what the server made it", () => {
  assert.equal(scene.kind, "scene");
  assert.equal(scene.dt, 0.002);
  assert.equal(scene.lockstep, true);
  assert.deepEqual(scene.floor, { normal: [0, 1, 0], height: -0.06 });
  assert.deepEqual(scene.styluses.map((stylus) => stylus.couplingStiffness), [400, 0]);
  assert.deepEqual(scene.objects.map((object) => object.name), ["würfel", "tet"]);
  near(scene.objects[0]!.rest, "rest", 0);
  near(scene.objects[1]!.triangles, "triangles", 0);
  assert.equal(scene.objects[0]!.regions, null);
  const regions = scene.objects[1]!.regions!;
  assert.deepEqual(regions.list[1], {
    number: 3,
    youngsModulus: { low: 500, high: 8000 },
    poissonRatio: { low: 0.25, high: 0.25 },
    density: { low: 1024, high: 1024 },
  });
  assert.deepEqual([regions.someUnlisted, regions.facesLeftOut], [true, false]);
  assert.deepEqual([...regions.surfaceModulus], [2000, 500, 8000, 2000]);
  assert.deepEqual([...regions.nodes], [0.5, 0, 0, 0, 0.5, 0, 0, 0, -0.5]);
  assert.deepEqual([...regions.faces], [0, 2, 1]);
  assert.deepEqual([...regions.faceModulus], [500]);
  const display = scene.objects[1]!.display!;
  assert.equal(scene.objects[0]!.display, null);
  assert.deepEqual([...display.positions], [0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 0.5, 0.25]);
  assert.deepEqual([...display.normals.subarray(9)], [0, 0, 1]);
  assert.deepEqual([...display.triangles], [0, 1, 2, 0, 2, 3]);
  assert.deepEqual([...display.nodes], new Array(12).fill(0));
  assert.deepEqual([...display.weights.subarray(9)], [0.5, 0.375, 0.125]);
  assert.deepEqual([...display.coordinates!], [0, 0, 1, 0, 1, 1, 0.25, 0.75]);
  assert.deepEqual([...display.texture!], [0xff, 0xd8, 0xff, 0xe0, 7]);
  assert.deepEqual(scene.scenery.map(({ name }) => name), ["wände", "box", "ball", "capsule"]);
  assert.deepEqual(scene.scenery[1]!.shape, { kind: "box", size: [0.5, 0.25, 0.125] });
  assert.deepEqual(scene.scenery[3]!.shape, { kind: "capsule", radius: 0.25, length: 0.75 });
  assert.deepEqual(scene.scenery[3]!.orientation, [0.5, 0.5, -0.5, 0.5]);
  near(scene.scenery[3]!.position, "capsule", 0);
});

test("a frame is what the server made it, to the quantisation", () => {
  const frame = decode(bytes("small.bin"), scene) as Frame;
  assert.equal(frame.step, 1039);
  assert.equal(frame.time, 2.08);
  assert.equal(frame.trail, 128);
  assert.deepEqual(frame.styluses.map((stylus) => [stylus.present, stylus.contact, stylus.object]), [
    [true, 2, 1],
    [false, 0, -1],
  ]);
  near(frame.styluses[1]!.tip, "tip", 0);
  near(frame.objects[1]!.position, "position", 0);
  near(frame.forces.subarray(0, 3), "oldestForce", 1e-7);
  near(frame.forces.subarray(3 * (2 * 128 - 1)), "newestForce", 1e-7);
  assert.deepEqual(frame.contacts.map(({ object, other }) => [object, other]), [
    [1, 0],
    [1, -4],
  ]);
  near(frame.contacts[1]!.normal, "contactNormal", 0.51 / 32767);
  near(frame.contacts[1]!.position, "contactPosition", 1e-7);
  near(frame.contacts[1]!.force, "contactForce", 1e-7);
  const { displacement, unit } = frame.objects[0]!;
  assert.ok(displacement instanceof Int16Array);
  near(displacement, "small", 0.51 * unit, unit);
});

test("large displacements come in four bytes", () => {
  const { displacement, unit } = (decode(bytes("large.bin"), scene) as Frame).objects[1]!;
  assert.ok(displacement instanceof Int32Array);
  assert.ok(unit <= 1e-5);
  near(displacement, "large", 0.5e-5, unit);
});

test("health is what the server made it", () => {
  const health = decode(bytes("health.bin"), scene) as Health;
  assert.equal(health.steps, 1234567890123);
  assert.deepEqual(health.stepTime, { p50: 1.5, p99: 2.5, max: 3.5 });
  assert.ok(Number.isNaN(health.wakeupDelay.p50));
  assert.equal(health.protocolErrors, 9);
});

test("the page's messages are those of the server's decoder", () => {
  assert.deepEqual(Buffer.from(encodeHello("token ü")), Buffer.from(bytes("hello.bin")));
  assert.deepEqual(Buffer.from(encodeCommand(Command.Reset)), Buffer.from(bytes("reset.bin")));
  assert.deepEqual(Buffer.from(encodeCommand(Command.SaveScene)), Buffer.from(bytes("save_scene.bin")));
  assert.deepEqual(Buffer.from(encodeLoadScene("würfel.h5")), Buffer.from(bytes("load_scene.bin")));
});

test("the state's scenes are those of the server", () => {
  const { scenes, recordings, notice } = decode(bytes("state.bin"), scene) as State;
  assert.deepEqual(scenes, { names: ["press.toml", "würfel.h5"], shown: 1, canLoad: true, preparing: false });
  assert.deepEqual(recordings.map(({ name }) => name), ["run-1.h5", "läufe.h5"]);
  assert.equal(notice, "a notice for a person");
});

test("a message that is cut, too long or of another kind is refused", () => {
  const good = bytes("small.bin");
  for (let size = 0; size < good.byteLength; ++size) {
    assert.throws(() => decode(good.slice(0, size), scene), ProtocolError);
  }
  const long = new Uint8Array(good.byteLength + 1);
  long.set(new Uint8Array(good));
  assert.throws(() => decode(long.buffer, scene), ProtocolError);
  assert.throws(() => decode(good, null), ProtocolError);
  const other = new Uint8Array(good.slice(0));
  other[6] = 9;
  assert.throws(() => decode(other.buffer, scene), ProtocolError);
});
