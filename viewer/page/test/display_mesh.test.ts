// Pure parts of display meshes: what hangs on nodes, what the shaders are given, what a ray meets.
import assert from "node:assert/strict";
import { test } from "node:test";
import { Ray, Vector3 } from "three";
import { means } from "../src/binding.ts";
import { VIRIDIS } from "../src/colour_map.ts";
import { smoothMesh, vertexNormals } from "../src/creases.ts";
import { NodeTexture } from "../src/node_texture.ts";
import { rampShader } from "../src/ramp_shader.ts";
import { firstOnRay } from "../src/surface_point.ts";
import { ball, cube } from "./server_messages.ts";

const round = ball(1, 4);
const REST = Float32Array.from(round.rest);
const TRIANGLES = Uint32Array.from(round.triangles);

test("a vertex has the weighted mean of its nodes", () => {
  const binding = { nodes: Uint32Array.of(0, 2, 1, 1, 1, 1), weights: Float32Array.of(0.5, 0.25, 0.25, 1, 0, 0) };
  const vectors = Float32Array.of(4, 0, 8, 0, 4, 0, 8, 8, 0);
  assert.deepEqual(means(binding, vectors), Float32Array.of(4, 3, 4, 0, 4, 0));
});

test("the ball is round, its triangles face outward, and it is bound to the octahedron below", () => {
  const { positions, normals, triangles, nodes, weights } = round.display;
  const bound = means({ nodes: Uint32Array.from(nodes), weights: Float32Array.from(weights) }, REST);
  for (let i = 0; i < positions.length; i += 3) {
    const point = new Vector3().fromArray(positions, i);
    assert.ok(Math.abs(point.length() - 1) < 1e-6);
    assert.ok(point.distanceTo(new Vector3().fromArray(normals, i)) < 1e-6);
    assert.ok(point.distanceTo(new Vector3().fromArray(bound, i).normalize()) < 1e-6);
  }
  const ends = new Float32Array(positions.length);
  vertexNormals(Float32Array.from(positions), smoothMesh(positions.length / 3, Uint32Array.from(triangles)), ends);
  for (let i = 0; i < ends.length; i += 3) assert.ok(new Vector3().fromArray(ends, i).dot(new Vector3().fromArray(normals, i)) > 0.9);
});

test("normals of nodes go across edges", () => {
  const normals = new Float32Array(REST.length);
  vertexNormals(REST, smoothMesh(REST.length / 3, TRIANGLES), normals);
  normals.forEach((part, i) => assert.ok(Math.abs(part - REST[i]!) < 1e-6));
});

test("what nodes have is where the shader looks for it, however many they are", () => {
  for (const nodes of [3, 4096, 5402]) {
    const texture = new NodeTexture(nodes);
    const vectors = Float32Array.from({ length: 3 * nodes }, (_, i) => i);
    texture.setDisplacements(vectors, 2);
    texture.setNormals(vectors);
    texture.setValues(Float32Array.from({ length: nodes }, (_, i) => (i === 1 ? Number.NaN : i)));
    const { data, width, height } = texture.texture.image as { data: Float32Array; width: number; height: number };
    const at = (block: number, node: number): number[] => {
      const first = 4 * ((block * (height / 2) + Math.floor(node / width)) * width + (node % width));
      return [...data.subarray(first, first + 4)];
    };
    assert.ok(width <= 4096 && data.length === 4 * width * height);
    const last = nodes - 1;
    assert.deepEqual(at(0, last), [6 * last, 6 * last + 2, 6 * last + 4, last]);
    assert.deepEqual(at(1, last).slice(0, 3), [3 * last, 3 * last + 1, 3 * last + 2]);
    assert.ok(at(0, 1)[3]! * 0.001 < -0.5, "next to nothing of what is not known is not known");
  }
});

test("a shader's ramp has all its colours", () => {
  const numbers = [...rampShader(VIRIDIS).matchAll(/vec3\((\d\.\d+), (\d\.\d+), (\d\.\d+)\)/g)];
  assert.deepEqual(numbers.map(([, ...parts]) => parts.map((part) => Math.round(255 * Number(part)))), VIRIDIS.map((colour) => [...colour]));
});

test("a ray meets the nearest triangle that faces it, and nothing beside", () => {
  const { rest, triangles } = cube(2, 2);
  const [positions, index] = [Float32Array.from(rest), Uint32Array.from(triangles)];
  const ray = new Ray(new Vector3(0.3, 0.4, 5), new Vector3(0, 0, -1));
  const hit = firstOnRay(ray, positions, index)!;
  assert.ok(Math.abs(hit.distance - 4) < 1e-6);
  const place = new Vector3();
  hit.point.nodes.forEach((node, i) => place.addScaledVector(new Vector3().fromArray(positions, 3 * node), hit.point.shares[i]!));
  assert.ok(place.distanceTo(new Vector3(0.3, 0.4, 1)) < 1e-6);
  assert.equal(firstOnRay(new Ray(new Vector3(3, 0, 5), new Vector3(0, 0, -1)), positions, index), null);
  assert.equal(firstOnRay(new Ray(new Vector3(0.3, 0.4, 0), new Vector3(0, 0, 1)), positions, index), null, "from inside");
});
