// What the picture has of contacts between bodies and of scenery, without a picture.
import assert from "node:assert/strict";
import { test } from "node:test";
import * as THREE from "three";
import { ContactMarks, pressure } from "../src/contact_marks.ts";
import { ALL_OVERLAYS } from "../src/overlays.ts";
import { MAX_CONTACTS, type BodyContact, type Quat, type Shape } from "../src/protocol.ts";
import { SceneryBody } from "../src/scenery_body.ts";
import type { Theme } from "../src/theme.ts";

const THEME = { dark: false, scenery: "#808080", line: "#202020", force: "#ff0000" } as Theme;
const CONTACT: BodyContact = { object: 0, other: -1, normal: [0, 1, 0], position: [1, 2, 3], force: [0, 0.5, 0], area: Math.PI };

interface Placed {
  position: number[];
  /** lengths along the instance's own axes */
  scale: number[];
  /** where its own axis leads to: y of an arrow, z of a disc */
  axis: number[];
}

function placed(mesh: THREE.InstancedMesh, i: number, own: THREE.Vector3): Placed {
  const matrix = new THREE.Matrix4();
  mesh.getMatrixAt(i, matrix);
  const [position, turn, scale] = [new THREE.Vector3(), new THREE.Quaternion(), new THREE.Vector3()];
  matrix.decompose(position, turn, scale);
  const round = (v: THREE.Vector3): number[] => v.toArray().map((part) => Math.round(1e4 * part) / 1e4 + 0);
  return { position: round(position), scale: round(scale), axis: round(own.clone().applyQuaternion(turn)) };
}

const Y = new THREE.Vector3(0, 1, 0);
const Z = new THREE.Vector3(0, 0, 1);

function colourOf(mesh: THREE.InstancedMesh, i: number): string {
  const colour = new THREE.Color();
  mesh.getColorAt(i, colour);
  return colour.getHexString();
}

test("pressure is the force along the normal per area, never a pull", () => {
  assert.equal(pressure({ ...CONTACT, force: [3, 4, 0], area: 0.5 }), 8);
  assert.equal(pressure({ ...CONTACT, force: [3, -4, 0] }), 0);
  assert.equal(pressure({ ...CONTACT, area: 0 }), 0);
});

test("a contact has an arrow of its length a newton and a disc of its area across the normal", () => {
  const marks = new ContactMarks();
  marks.follow([CONTACT, { ...CONTACT, force: [2, 0, 0], area: 4 * Math.PI, normal: [1, 0, 0] }], ALL_OVERLAYS, 0.04);
  assert.deepEqual([marks.shafts.count, marks.heads.count, marks.discs.count], [2, 2, 2]);
  assert.deepEqual(placed(marks.shafts, 0, Y), { position: [1, 2, 3], scale: [1, 0.02, 1], axis: [0, 1, 0] });
  assert.deepEqual(placed(marks.shafts, 1, Y), { position: [1, 2, 3], scale: [1, 0.08, 1], axis: [1, 0, 0] });
  assert.deepEqual(placed(marks.heads, 1, Y), { position: [1.08, 2, 3], scale: [1, 1, 1], axis: [1, 0, 0] });
  assert.deepEqual(placed(marks.discs, 0, Z), { position: [1, 2, 3], scale: [1, 1, 1], axis: [0, 1, 0] });
  assert.deepEqual(placed(marks.discs, 1, Z), { position: [1, 2, 3], scale: [2, 2, 1], axis: [1, 0, 0] });
});

test("a short arrow is small, and a force that is next to none has none", () => {
  const marks = new ContactMarks();
  marks.follow([
    { ...CONTACT, force: [0, 0.001, 0] },
    { ...CONTACT, force: [0, 0.175, 0] },
  ], ALL_OVERLAYS, 0.04);
  assert.deepEqual([marks.shafts.count, marks.discs.count], [1, 2]);
  assert.deepEqual(placed(marks.heads, 0, Y).scale, [0.5, 0.5, 0.5]);
  assert.deepEqual(placed(marks.shafts, 0, Y).scale, [0.5, 0.007, 0.5]);
});

test("the colours go from no pressure to the largest one, which falls slowly while something touches", () => {
  const marks = new ContactMarks();
  assert.equal(marks.end, 0);
  const area = 0.001;
  marks.follow([{ ...CONTACT, area, force: [1, 0, 0] }, { ...CONTACT, area, force: [0, 2, 0] }], ALL_OVERLAYS, 0.04);
  assert.equal(marks.end, 2000);
  assert.deepEqual([colourOf(marks.discs, 0), colourOf(marks.discs, 1)], ["0d0887", "f0f921"]);
  marks.follow([{ ...CONTACT, area, force: [0, 1, 0] }], ALL_OVERLAYS, 0.04);
  assert.equal(marks.end, 1990);
  marks.follow([], ALL_OVERLAYS, 0.04);
  assert.equal(marks.end, 1990);
  assert.deepEqual([marks.shafts.count, marks.heads.count, marks.discs.count], [0, 0, 0]);
  marks.follow([{ ...CONTACT, area, force: [0, 1, 0] }], { ...ALL_OVERLAYS, pressureEnd: 5000 }, 0.04);
  assert.equal(marks.end, 5000);
  marks.clear();
  assert.equal(marks.end, 0);
});

test("as many contacts as a frame can have are drawn", () => {
  const marks = new ContactMarks();
  marks.follow(Array.from({ length: MAX_CONTACTS }, () => CONTACT), ALL_OVERLAYS, 0.04);
  assert.equal(marks.discs.count, MAX_CONTACTS);
});

const HALF = Math.SQRT1_2;

function body(shape: Shape, orientation: Quat = [1, 0, 0, 0]): SceneryBody {
  const body = new SceneryBody({ name: "body", shape, position: [0, -0.5, 0], orientation });
  body.applyTheme(THEME);
  body.place(new THREE.Sphere(new THREE.Vector3(1, 2, 3), 0.1), THEME);
  body.group.updateMatrixWorld(true);
  return body;
}

function extent(body: SceneryBody): { middle: number[]; size: number[] } {
  const box = new THREE.Box3().setFromObject(body.group, true);
  const round = (v: THREE.Vector3): number[] => v.toArray().map((part) => Math.round(1e3 * part) / 1e3 + 0);
  return { middle: round(box.getCenter(new THREE.Vector3())), size: round(box.getSize(new THREE.Vector3())) };
}

test("solid scenery has its place, direction and size", () => {
  const upright: Quat = [1, 0, 0, 0];
  const lying: Quat = [HALF, 0, 0, HALF]; // y to -x
  const middle = [0, -0.5, 0];
  assert.deepEqual(extent(body({ kind: "box", size: [1, 2, 3] }, lying)), { middle, size: [2, 1, 3] });
  assert.deepEqual(extent(body({ kind: "sphere", radius: 0.25 })), { middle, size: [0.5, 0.5, 0.5] });
  assert.deepEqual(extent(body({ kind: "capsule", radius: 0.25, length: 1 }, upright)), { middle, size: [0.5, 1.5, 0.5] });
});

test("a plane has lines round the objects, at its own height and across its normal", () => {
  const { middle, size } = extent(body({ kind: "plane" }));
  assert.deepEqual(middle, [1, -0.5, 3]);
  assert.deepEqual(size, [4, 0, 4]);
  const wall = extent(body({ kind: "plane" }, [HALF, 0, 0, -HALF])); // y to x
  assert.deepEqual(wall.middle, [0, 2, 3]);
  assert.deepEqual(wall.size, [0, 4, 4]);
});
