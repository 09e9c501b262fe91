// Settings on their way between sliders and server.
import assert from "node:assert/strict";
import { test } from "node:test";
import { isOnlooker, onlookerLink } from "../src/onlooker_link.ts";
import type { Scene, Settings, State } from "../src/protocol.ts";
import { SettingsDraft } from "../src/settings_draft.ts";
import { byFactor, fromZero } from "../src/slider_scale.ts";
import { modesOf } from "../src/status_line.ts";
import { SETTINGS } from "./server_messages.ts";

const server = (): Settings => ({ gravity: [0, 0, 0], objects: [{ ...SETTINGS }, { ...SETTINGS }] });

test("a change stays under the hand until the server has it, and what others change comes through", () => {
  const draft = new SettingsDraft(server());
  draft.changeObject(1, "tether", 55, 1000);
  draft.confirmed = { ...server(), gravity: [0, -5, 0] };
  assert.equal(draft.values(1100).objects[1]!.tether, 55);
  assert.equal(draft.values(1100).objects[0]!.tether, SETTINGS.tether);
  assert.deepEqual(draft.values(1100).gravity, [0, -5, 0]);
  assert.equal(draft.settled(1100), false);
});

test("what the server did not take is forgotten", () => {
  const draft = new SettingsDraft(server());
  draft.changeObject(0, "damping", 99, 1000);
  assert.equal(draft.settled(2000), true);
  assert.equal(draft.values(2000).objects[0]!.damping, SETTINGS.damping);
});

test("kinetic friction never goes out above static friction", () => {
  const draft = new SettingsDraft(server());
  draft.changeObject(0, "staticFriction", 0.2, 0);
  assert.equal(draft.values(1).objects[0]!.kineticFriction, 0.2);
});

test("a draft leaves the server's settings alone", () => {
  const draft = new SettingsDraft(server());
  draft.changeObject(0, "tether", 1, 0);
  draft.values(1);
  assert.deepEqual(draft.confirmed, server());
});

test("every place of a slider has a value that leads back to it", () => {
  for (const scale of [fromZero(2, 1), fromZero(200, 2), byFactor(0.1, 10)]) {
    for (let place = 0; place <= 1; place += 0.05) {
      assert.ok(Math.abs(scale.placeOf(scale.valueAt(place)) - place) < 0.01);
    }
  }
  assert.equal(fromZero(20, 2).valueAt(0), 0);
  assert.equal(fromZero(20, 2).placeOf(50), 1);
  assert.equal(byFactor(0.1, 10).valueAt(0.5), 1);
  assert.equal(byFactor(0.1, 10).valueAt(0), 0.1);
});

test("an onlooker's link keeps the token where the server never sees it", () => {
  const link = onlookerLink("http://10.0.0.1:8080/#token=secret");
  assert.equal(link, "http://10.0.0.1:8080/?watch=1#token=secret");
  assert.equal(isOnlooker(link), true);
  assert.equal(isOnlooker("http://10.0.0.1:8080/#token=secret"), false);
  assert.equal(onlookerLink(link), link);
});

test("the run's state is said in a word each", () => {
  const scene = { lockstep: false } as Scene;
  const state = { playback: null, paused: true, recording: true, onlyLooksOn: true } as State;
  assert.deepEqual(modesOf(scene, state), ["paused", "recording", "view only"]);
  const playback = { length: 1, speed: 1, playing: true, recording: 0 };
  const shown = { ...state, recording: false, onlyLooksOn: false, playback };
  assert.deepEqual(modesOf(scene, shown), ["recorded run"]);
});
