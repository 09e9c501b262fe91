// The hand that a pointer or keys are. Distances in m, times in ms.
import assert from "node:assert/strict";
import { test } from "node:test";
import { Ray, Vector3 } from "three";
import { feltText } from "../src/felt_force.ts";
import { Hand } from "../src/hand.ts";
import { Contact, type Scene, type State } from "../src/protocol.ts";
import { refusal } from "../src/touch.ts";

// The eye looks along -z onto a surface at z = 0.
const FORWARD = new Vector3(0, 0, -1);
const ray = (x: number): Ray => new Ray(new Vector3(x, 0, 1), FORWARD.clone());
const press = new Vector3(0, 0, 0);
const NO_REACH = 0;

function near(actual: Vector3 | number, expected: Vector3 | number, within = 1e-12): void {
  const away = typeof actual === "number" ? Math.abs(actual - (expected as number)) : actual.distanceTo(expected as Vector3);
  assert.ok(away <= within, `${JSON.stringify(actual)} is not ${JSON.stringify(expected)}`);
}

/** A hand that is on its way since 0. */
function begun(reach: number, grabs: boolean): Hand {
  const hand = new Hand(press, ray(0), FORWARD, reach, grabs);
  hand.tip(0);
  return hand;
}

test("a press begins with the tip 5 mm outside and ends 8 mm inside", () => {
  const hand = new Hand(press, ray(0), FORWARD, NO_REACH, false);
  near(hand.tip(1000), new Vector3(0, 0, 0.005));
  near(hand.tip(1120), new Vector3(0, 0, -0.008));
  near(hand.tip(9000), hand.tip(1120));
  let before = hand.tip(1000).z;
  for (let now = 1000; now <= 1120; now += 5) {
    const { z } = hand.tip(now);
    assert.ok(z <= before && before - z < 0.0015, "gently, and never back");
    before = z;
  }
});

test("taking hold pushes as little as can be", () => {
  const touching = begun(NO_REACH, true);
  near(touching.tip(200), new Vector3(0, 0, -0.001));
  assert.equal(touching.mayTakeHold(0), true); // it takes hold of nothing before it touches
  const reaching = new Hand(press, ray(0), FORWARD, 0.01, true);
  near(reaching.tip(0), new Vector3(0, 0, 0.005));
  near(reaching.tip(200), new Vector3(0, 0, 0.002));
  assert.equal(reaching.mayTakeHold(50), false);
  assert.equal(reaching.mayTakeHold(120), true);
});

test("the centre of a ball stays its radius before the surface", () => {
  const hand = new Hand(press, ray(0), FORWARD, NO_REACH, false, 0.012);
  near(hand.tip(0), new Vector3(0, 0, 0.017));
  near(hand.tip(200), new Vector3(0, 0, 0.004));
});

test("dragging slides in the plane parallel to the screen", () => {
  const hand = begun(NO_REACH, false);
  hand.aim(new Ray(new Vector3(0, 0, 1), new Vector3(0.3, 0.1, -1).normalize()));
  const tip = hand.tip(200);
  near(tip.z, -0.008);
  near(tip.x, 0.3 * 1.008);
});

test("the wheel goes deeper, not through the whole object, and carries what is held as far as it likes", () => {
  const hand = begun(NO_REACH, false);
  hand.deepen(0.004);
  near(hand.tip(200).z, -0.012);
  hand.deepen(10);
  near(hand.tip(200).z, -0.08);
  hand.deepen(-10);
  near(hand.tip(200).z, 0.005);
  hand.carry(-0.5);
  near(hand.tip(200).z, 0.505);
});

test("a hand that was lost comes from outside again", () => {
  const hand = begun(NO_REACH, false);
  hand.again();
  near(hand.tip(500), new Vector3(0, 0, 0.005));
  near(hand.tip(700), new Vector3(0, 0, -0.008));
});

test("the way in begins when it is first asked for, however late", () => {
  const hand = new Hand(press, ray(0), FORWARD, 0.01, true);
  assert.equal(hand.mayTakeHold(5000), false);
  near(hand.tip(5000), new Vector3(0, 0, 0.005));
  assert.equal(hand.mayTakeHold(5119), false);
  assert.equal(hand.mayTakeHold(5120), true);
});

test("what is felt is said in words", () => {
  assert.deepEqual(feltText(1.234, Contact.Touching, false, 3), ["1.23 N", "sticks"]);
  assert.deepEqual(feltText(1.234, Contact.Touching, true, 3), ["1.23 N", "slips"]);
  assert.deepEqual(feltText(2.99, Contact.Touching, true, 3), ["2.99 N", "as hard as it may"]);
  assert.deepEqual(feltText(2.99, Contact.Held, false, 0), ["2.99 N", "held"]);
  assert.deepEqual(feltText(0, Contact.Free, false, 0), ["0.00 N", "in the air"]);
});

test("whoever cannot touch is told why", () => {
  const scene = { viewersStylus: true, lockstep: false } as Scene;
  const state = { stylusFree: true, stylusMine: false, onlyLooksOn: false, playback: null, paused: false } as State;
  assert.equal(refusal(scene, state), null);
  assert.equal(refusal(scene, { ...state, stylusFree: false, stylusMine: true }), null);
  assert.match(refusal(null, null)!, /no connection/);
  assert.match(refusal({ ...scene, viewersStylus: false }, state)!, /no stylus/);
  assert.match(refusal(scene, { ...state, onlyLooksOn: true })!, /view only/);
  assert.match(refusal(scene, { ...state, stylusFree: false })!, /Another viewer/);
  assert.match(refusal(scene, { ...state, playback: {} as State["playback"] })!, /recorded run/);
  assert.match(refusal(scene, { ...state, paused: true })!, /paused/);
  assert.equal(refusal({ ...scene, lockstep: true }, { ...state, paused: true }), null);
});
