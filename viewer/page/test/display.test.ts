// A display mesh in the Scene message, on bytes that these tests make themselves.
import assert from "node:assert/strict";
import { test } from "node:test";
import { ProtocolError } from "../src/byte_reader.ts";
import { decode, type Scene } from "../src/protocol.ts";
import { ball, cube, inclusion, sceneMessage, type ObjectParts, type SceneParts } from "./server_messages.ts";

const parts = (...objects: ObjectParts[]): SceneParts => {
  return { objects, radii: [0], dt: 0.002, flags: 4, floorHeight: 0, largestForce: 3, scenery: [] };
};
const read = (...objects: ObjectParts[]): Scene => decode(sceneMessage(parts(...objects)), null) as Scene;

const round = ball(0.05, 3);
const bytes = sceneMessage(parts(round));
const { display } = round;

test("a display mesh is what was written", () => {
  const read = (decode(bytes, null) as Scene).objects[0]!.display!;
  assert.deepEqual(read.positions, Float32Array.from(display.positions));
  assert.deepEqual(read.normals, Float32Array.from(display.normals));
  assert.deepEqual(read.triangles, Uint32Array.from(display.triangles));
  assert.deepEqual(read.nodes, Uint32Array.from(display.nodes));
  assert.deepEqual(read.weights, Float32Array.from(display.weights));
  assert.deepEqual(read.coordinates, Float32Array.from(display.coordinates!));
  assert.deepEqual([...read.texture!], display.texture);
});

test("an object without one comes after one with it, and regions come before it", () => {
  const plain = cube(0.1, 2);
  const scene = read({ ...round, regions: inclusion(round, 0.03, 3250, 42500) }, plain);
  assert.equal(scene.objects[0]!.regions!.list.length, 2);
  assert.equal(scene.objects[0]!.display!.positions.length, display.positions.length);
  assert.equal(scene.objects[1]!.display, null);
  assert.equal(scene.objects[1]!.rest.length, plain.rest.length);
});

test("texture and coordinates can be missing", () => {
  const untextured = read({ ...round, display: { ...display, texture: [] } }).objects[0]!.display!;
  assert.equal(untextured.texture, null);
  assert.notEqual(untextured.coordinates, null);
  const { coordinates: _, texture: __, ...bare } = display;
  assert.equal(read({ ...round, display: bare }).objects[0]!.display!.coordinates, null);
});

test("a display mesh that breaks the rules is refused", () => {
  const vertices = display.positions.length / 3;
  const triangles = display.triangles.length / 3;
  const start = bytes.byteLength - 4 * Math.ceil(display.texture!.length / 4) - vertices * (4 * 12 + 8) - triangles * 12 - 16;
  const corner = start + 16 + vertices * 24;
  const node = corner + triangles * 12;
  const weight = node + vertices * 12;
  for (const [what, offset, value] of [
    ["more vertices than come", start, vertices + 1],
    ["as many vertices as can be", start, 0xffffffff],
    ["no vertices", start, 0],
    ["no triangles", start + 4, 0],
    ["more triangles than come", start + 4, triangles + 1],
    ["a texture without coordinates", start + 8, 0],
    ["more of a texture than comes", start + 12, display.texture!.length + 8],
    ["a corner that is no vertex", corner, vertices],
    ["a vertex at no node", node, 6],
    ["weights of another sum", weight, 0x40000000],
    ["weights that are no number", weight, 0x7fc00000],
  ] as const) {
    const copy = bytes.slice(0);
    new DataView(copy).setUint32(offset, value, true);
    assert.throws(() => decode(copy, null), ProtocolError, what);
  }
  assert.equal(new DataView(bytes).getUint32(start, true), vertices, "the offsets are right");
  assert.equal(new DataView(bytes).getUint32(node, true), display.nodes[0], "the offsets are right");
});

test("a scene that ends within a display mesh is refused", () => {
  for (let size = 0; size < bytes.byteLength; size += 13) {
    assert.throws(() => decode(bytes.slice(0, size), null), ProtocolError);
  }
});

test("a texture that is too large is refused however many bytes come", () => {
  const large = new Uint8Array(bytes.byteLength + 16_777_217 + 3);
  const at = bytes.byteLength - 4 * Math.ceil(display.texture!.length / 4);
  large.set(new Uint8Array(bytes));
  const size = at - (display.positions.length / 3) * (4 * 12 + 8) - 4 * display.triangles.length - 4;
  const view = new DataView(large.buffer);
  assert.equal(view.getUint32(size, true), display.texture!.length);
  view.setUint32(size, 16_777_217, true);
  const whole = large.buffer.slice(0, at + 16_777_220);
  assert.throws(() => decode(whole, null), /texture is too large/);
  view.setUint32(size, 16_777_216, true);
  assert.equal((decode(large.buffer.slice(0, at + 16_777_216), null) as Scene).objects[0]!.display!.texture!.length, 16_777_216);
});
