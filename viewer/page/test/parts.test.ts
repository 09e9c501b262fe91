// The page's pure parts.
import assert from "node:assert/strict";
import { test } from "node:test";
import { creaseMesh, vertexNormals } from "../src/creases.ts";
import { ForceLog } from "../src/force_log.ts";
import type { Frame } from "../src/protocol.ts";
import { scaleBar } from "../src/scale_bar.ts";

// Two squares that meet at x = 1 under a right angle: eight triangles' corners, six nodes.
const POINTS = Float32Array.from([0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 1, 0, -1, 1, 1, -1]);
const TRIANGLES = Uint32Array.from([0, 1, 2, 0, 2, 3, 1, 4, 5, 1, 5, 2]);

test("an edge stays an edge, what is smooth is shared", () => {
  const mesh = creaseMesh(POINTS, TRIANGLES);
  assert.equal(mesh.nodeOf.length, 8); // the two nodes of the edge twice
  mesh.index.forEach((vertex, corner) => assert.equal(mesh.nodeOf[vertex], TRIANGLES[corner]));
  assert.equal(creaseMesh(POINTS, TRIANGLES, 100).nodeOf.length, 6);
});

test("normals are those of the faces on either side of an edge", () => {
  const mesh = creaseMesh(POINTS, TRIANGLES);
  const positions = new Float32Array(24);
  mesh.nodeOf.forEach((node, v) => positions.set(POINTS.subarray(3 * node, 3 * node + 3), 3 * v));
  const normals = new Float32Array(24);
  vertexNormals(positions, mesh.index, normals);
  const of = (corner: number): number[] => [...normals.subarray(3 * mesh.index[corner]!, 3 * mesh.index[corner]! + 3)];
  assert.deepEqual(of(1), [0, 0, 1]);
  assert.deepEqual(of(6), [1, 0, 0]);
});

function frame(step: number, trail: number): Frame {
  const forces = Float32Array.from({ length: 3 * trail }, (_, i) => step - (trail - 1 - Math.floor(i / 3)));
  return { kind: "frame", step, time: 0, styluses: [], trail, forces, objects: [], contacts: [] };
}

test("forces of overlapping frames are logged once, and a gap is a gap", () => {
  const log = new ForceLog(1, 0.002);
  log.follow(frame(9, 4));
  log.follow(frame(11, 4));
  assert.deepEqual(log.steps, [6, 7, 8, 9, 10, 11]);
  assert.deepEqual(log.columns[0]![0], [6, 7, 8, 9, 10, 11]);
  log.follow(frame(20, 2));
  assert.deepEqual(log.steps.slice(6), [18, 19, 20]);
  assert.deepEqual(log.columns[0]![1]!.slice(6), [null, 19, 20]);
  assert.equal(log.since(0.04, 0)[0].length, 2);
  assert.equal(log.csv().split("\n").length, 1 + 8 + 1);
  assert.match(log.csv(), /^step,time_s,stylus0_x_N,stylus0_y_N,stylus0_z_N\n6,0.014000,6.00000,/);
});

test("a server that begins anew is followed", () => {
  const log = new ForceLog(1, 0.002);
  log.follow(frame(1000, 2));
  log.follow(frame(1, 2));
  assert.deepEqual(log.steps.slice(-2), [0, 1]);
});

test("the scale is a round length that fits", () => {
  assert.deepEqual(scaleBar(0.001), { centimetres: 10, pixels: 100 });
  for (const size of [1e-6, 1e-4, 0.002]) {
    const { centimetres, pixels } = scaleBar(size);
    assert.ok(pixels <= 130 && pixels > 30);
    assert.ok(Math.abs(pixels * size * 100 - centimetres) < 1e-9);
  }
});
