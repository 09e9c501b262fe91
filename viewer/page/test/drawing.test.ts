// Pure parts of how things are drawn: arrows' length, held patches, what looks the same.
import assert from "node:assert/strict";
import { test } from "node:test";
import { Vector3 } from "three";
import { ArrowScale, roundBelow } from "../src/arrow_scale.ts";
import { rangeAsSet } from "../src/colour_range.ts";
import { DrawnSurface } from "../src/drawn_surface.ts";
import { looksTheSame } from "../src/frame_changes.ts";
import { withPatches } from "../src/held_patch.ts";
import type { Frame, SceneObject } from "../src/protocol.ts";
import { forceBar } from "../src/scale_bar.ts";
import { mixed, nearestOnSurface } from "../src/surface_point.ts";
import { cube } from "./server_messages.ts";

test("round numbers are 1, 2, 5 times powers of ten", () => {
  assert.deepEqual([0.0149, 0.02, 0.3, 5, 999].map(roundBelow), [0.01, 0.02, 0.2, 5, 500]);
});

test("the arrow of the largest force has room, at once where it grows and after a while where it falls", () => {
  const scale = new ArrowScale(0.1);
  assert.equal(scale.metresPerNewton, 0.1);
  scale.follow(9, 0);
  assert.equal(scale.metresPerNewton, 0.01);
  scale.follow(0.5, 1);
  assert.equal(scale.metresPerNewton, 0.01);
  scale.follow(0.5, 30);
  assert.equal(scale.metresPerNewton, 0.2);
  scale.follow(0, 1000);
  assert.equal(scale.metresPerNewton, 1, "noise is not drawn large");
});

test("the scale of forces is a round force whose arrow fits", () => {
  const { newtons, pixels } = forceBar(0.013);
  assert.equal(newtons, 1);
  assert.ok(Math.abs(pixels - 1 / 0.013) < 1e-9);
});

const { rest, triangles } = cube(0.1, 10);
const REST = Float32Array.from(rest);
const NODES = REST.length / 3;
const TRIANGLES = Uint32Array.from(triangles);
const nodeAt = (point: number[]): number =>
  [...Array(NODES).keys()].find((i) => Math.hypot(...point.map((part, c) => part - REST[3 * i + c]!)) < 1e-6)!;

test("a held spike becomes a patch that moves as one, and the rest stays", () => {
  const top = nodeAt([0, 0.05, 0]);
  const spike = new Float32Array(3 * NODES);
  spike[3 * top + 1] = 0.03;
  const drawn = new Float32Array(3 * NODES);
  withPatches(REST, spike, [{ middle: [0, 0.05, 0], radius: 0.015 }], drawn);
  assert.ok(Math.abs(drawn[3 * top + 1]! - 0.03 / 9) < 1e-6, "the mean of nine nodes");
  assert.equal(drawn[3 * nodeAt([0.01, 0.05, 0]) + 1], drawn[3 * top + 1]);
  const beside = drawn[3 * nodeAt([0.02, 0.05, 0]) + 1]!;
  assert.ok(beside > 0 && beside < drawn[3 * top + 1]!, "smooth to the surroundings");
  assert.equal(drawn[3 * nodeAt([0.04, 0.05, 0]) + 1], 0);
});

test("what touches the surface is moved with it", () => {
  const object = { rest: REST, triangles: TRIANGLES } as SceneObject;
  const u = new Float32Array(3 * NODES);
  const surface = new DrawnSurface(object, u);
  for (let i = 0; i < NODES; ++i) u[3 * i + 1] = -0.001; // all of it goes down
  surface.follow([]);
  const middle = [0.003, 0.05, 0.004] as const;
  assert.equal(surface.shiftOfStylus(0, middle).length(), 0, "not exaggerated");
  surface.exaggeration = 5;
  assert.ok(surface.shiftOfStylus(0, middle).distanceTo(new Vector3(0, -0.004, 0)) < 1e-8);
  assert.ok(surface.shiftAt(new Vector3(...middle)).distanceTo(new Vector3(0, -0.004, 0)) < 1e-8);
  assert.equal(surface.shiftOfStylus(0, [Number.NaN, 0, 0]).length(), 0, "it is free");
});

test("a point of the surface is a mixture of its triangle's nodes", () => {
  const point = nearestOnSurface(new Vector3(0.003, 0.06, 0.004), REST, TRIANGLES);
  assert.ok(mixed(point, REST).distanceTo(new Vector3(0.003, 0.05, 0.004)) < 1e-8);
});

test("frames look the same when nothing that is drawn differs", () => {
  const frame = (y: number, force: number): Frame => ({
    kind: "frame",
    step: 1,
    time: 1,
    styluses: [{ present: true, contact: 1, object: 0, buttons: 0, tip: [0, 0, 0], proxy: [0, 0, 0], force: [force, 0, 0], middle: [Number.NaN, 0, 0], slips: false }],
    trail: 0,
    forces: new Float32Array(),
    objects: [{ position: [0, y, 0], orientation: [1, 0, 0, 0], unit: 1, displacement: Int16Array.of(1, 2, 3) }],
    contacts: [{ object: 0, other: -1, normal: [0, 1, 0], position: [0, 0, 0], force: [0, 1, 0], area: 1 }],
  });
  assert.equal(looksTheSame(frame(0, 1), { ...frame(0, 1), step: 9, time: 9 }), true);
  assert.equal(looksTheSame(frame(0, 1), frame(0.1, 1)), false);
  assert.equal(looksTheSame(frame(0, 1), frame(0, 2)), false);
  assert.equal(looksTheSame(frame(0, 1), { ...frame(0, 1), contacts: [] }), false);
});

test("a range follows what is shown at the ends that are not set", () => {
  assert.deepEqual(rangeAsSet({ low: 1, high: 2 }, { low: null, high: 5 }), { low: 1, high: 5 });
});
