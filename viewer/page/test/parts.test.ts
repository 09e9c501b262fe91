// The page's pure parts.
import assert from "node:assert/strict";
import { test } from "node:test";
import { cssPart, logarithmic } from "../src/colour_map.ts";
import { creaseMesh, vertexNormals } from "../src/creases.ts";
import { ForceLog } from "../src/force_log.ts";
import { stressText } from "../src/material_legend.ts";
import type { Frame } from "../src/protocol.ts";
import { scaleBar } from "../src/scale_bar.ts";
import { cube } from "./server_messages.ts";

// Two squares that meet at x = 1 under a right angle: eight triangles' corners, six nodes.
const POINTS = Float32Array.from([0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 1, 0, -1, 1, 1, -1]);
const TRIANGLES = Uint32Array.from([0, 1, 2, 0, 2, 3, 1, 4, 5, 1, 5, 2]);

test("kinds of triangles share no vertex and are smooth all the same", () => {
  const flat = Uint32Array.from([0, 1, 2, 0, 2, 3]);
  const mesh = creaseMesh(POINTS, flat, 35, [2000, 3000]);
  assert.equal(mesh.nodeOf.length, 6); // two of four nodes twice
  mesh.index.forEach((vertex, corner) => assert.equal(mesh.nodeOf[vertex], flat[corner]));
  assert.notEqual(mesh.index[0], mesh.index[3]);
  assert.equal(mesh.firstOf[mesh.index[0]!], mesh.firstOf[mesh.index[3]!]);
  const bent = Float32Array.from(POINTS);
  bent[11] = 0.3; // the second triangle leans
  const positions = new Float32Array(18);
  mesh.nodeOf.forEach((node, v) => positions.set(bent.subarray(3 * node, 3 * node + 3), 3 * v));
  const normals = new Float32Array(18);
  vertexNormals(positions, mesh, normals);
  const of = (corner: number): number[] => [...normals.subarray(3 * mesh.index[corner]!, 3 * mesh.index[corner]! + 3)];
  assert.deepEqual(of(0), of(3));
  assert.ok(of(0)[2]! < 1);
  assert.deepEqual(of(1), [0, 0, 1]);
});

test("triangles of unknown material are of one kind", () => {
  const mesh = creaseMesh(POINTS, Uint32Array.from([0, 1, 2, 0, 2, 3]), 35, [Number.NaN, Number.NaN]);
  assert.equal(mesh.nodeOf.length, 4);
});

test("moduli have readable units", () => {
  const text = (low: number, high = low): string => stressText({ low, high }).replace("\u00a0", " ");
  assert.equal(text(500), "500 Pa");
  assert.equal(text(3250), "3.25 kPa");
  assert.equal(text(3250, 42500), "3.25 to 42.5 kPa");
  assert.equal(text(2e6), "2 MPa");
  assert.equal(text(210e9), "210 GPa");
});

test("a logarithmic ramp has the middle at the geometric mean", () => {
  const range = { low: 100, high: 10000 };
  assert.equal(logarithmic(1000, range), 0.5);
  assert.deepEqual([100, 10000].map((value) => logarithmic(value, range)), [0, 1]);
  assert.equal(logarithmic(5, { low: 5, high: 5 }), 0);
  assert.equal(cssPart([[0, 0, 0], [255, 255, 255]], 1, 1), `linear-gradient(to right, ${Array(5).fill("rgb(255 255 255)").join(", ")})`);
});

test("an edge stays an edge, what is smooth is shared", () => {
  const mesh = creaseMesh(POINTS, TRIANGLES);
  assert.equal(mesh.nodeOf.length, 8); // the two nodes of the edge twice
  mesh.index.forEach((vertex, corner) => assert.equal(mesh.nodeOf[vertex], TRIANGLES[corner]));
  assert.equal(creaseMesh(POINTS, TRIANGLES, 100).nodeOf.length, 6);
});

test("an edge that ends on the surface is smoothed away, one that closes stays", () => {
  // A tent of four triangles on a flat square of sixteen: its ridges end at its foot.
  const grid = cube(4, 4);
  const [rest, triangles] = [Float32Array.from(grid.rest), Uint32Array.from(grid.triangles)];
  const edgesOfCube = creaseMesh(rest, triangles).nodeOf.length;
  const top = [...rest.keys()].find((i) => i % 3 === 0 && rest[i] === 0 && rest[i + 1] === 2 && rest[i + 2] === 0)!;
  rest[top + 1] = 2.55; // 29 degrees to its surroundings, up to 58 between its sides
  const { nodeOf } = creaseMesh(rest, triangles);
  assert.equal(nodeOf.length, edgesOfCube, "only the twelve edges of the cube are creases");
  assert.equal(nodeOf.filter((node) => node === top / 3).length, 1);
});

test("normals are those of the faces on either side of an edge", () => {
  const mesh = creaseMesh(POINTS, TRIANGLES);
  const positions = new Float32Array(24);
  mesh.nodeOf.forEach((node, v) => positions.set(POINTS.subarray(3 * node, 3 * node + 3), 3 * v));
  const normals = new Float32Array(24);
  vertexNormals(positions, mesh, normals);
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
