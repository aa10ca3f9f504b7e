// Where an element's avatars stand, and from where they are seen.

import assert from "node:assert/strict";
import { test } from "node:test";
import { Stage } from "../../../python/mua/web/stage.js";
import { box, FakeElement, fakePlayer } from "./page.mjs";

const DEGREE = Math.PI / 180;

function staged(attributes, ...bounds) {
  const element = new FakeElement(attributes);
  element.player = fakePlayer(...bounds);
  return { stage: new Stage(element), player: element.player };
}

test("one avatar stands where it is, also if it is not in the middle of its box", () => {
  const { stage, player } = staged({}, box(1, 3));
  stage.arrange();
  assert.deepEqual(player.avatars[0].place, [0, 0, 0]);
});

test("without attributes it stands before them", () => {
  const { stage, player } = staged({}, box(1));
  Object.assign(player.camera, { azimuth: 1, elevation: 1 });
  stage.reset();
  assert.deepEqual([player.camera.azimuth, player.camera.elevation], [0, 0]);
});

test("each avatar is looked at in turn, and the first again where they stand anew", () => {
  const { stage, player } = staged({}, box(1), box(1));
  stage.arrange();
  const [first, second] = player.avatars;
  player.framed.length = 0;
  for (let i = 0; i < 3; i++) stage.lookAtNext();
  assert.deepEqual(player.framed, [[first], [second], [first]]);
  stage.arrange();
  stage.lookAtNext();
  assert.deepEqual(player.framed.at(-1), [first]);
});

test("a zoom is held by the distance from which all is seen, however often", () => {
  const { stage, player } = staged({}, box(1));
  stage.reset();
  for (let i = 0; i < 9; i++) stage.zoom(20);
  assert.ok(Math.abs(player.camera.distance - 0.04) < 1e-12);
  for (let i = 0; i < 9; i++) stage.zoom(-20);
  assert.ok(Math.abs(player.camera.distance - 120) < 1e-9);
});

test("a drag turns the camera: right, and up over the horizon", () => {
  const { stage, player } = staged({}, box(1));
  stage.turn(10, 5);
  assert.ok(Math.abs(player.camera.azimuth + 4 * DEGREE) < 1e-12);
  assert.ok(Math.abs(player.camera.elevation - 2 * DEGREE) < 1e-12);
});

test("where nothing is shown, nothing moves", () => {
  const element = new FakeElement({ orbit: "12" });
  const stage = new Stage(element);
  for (const act of [
    () => stage.reset(),
    () => stage.lookAtNext(),
    () => stage.orbit(1),
    () => stage.turn(1, 1),
    () => stage.zoom(1),
  ])
    act();
  element.player = fakePlayer();
  stage.reset();
  stage.lookAtNext();
  assert.deepEqual(element.player.framed, []);
});
