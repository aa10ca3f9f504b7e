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

test("several stand side by side, their row in the middle, with 15 cm between them", () => {
  const { stage, player } = staged({}, box(1, 0.5), box(0.4), box(0.8, -2));
  stage.arrange();
  const spans = player.avatars.map(({ bounds: [low, high], place }) => [low[0] + place[0], high[0] + place[0]]);
  for (const [i, [low]] of spans.slice(1).entries()) assert.ok(Math.abs(low - spans[i][1] - 0.15) < 1e-12);
  assert.ok(Math.abs(spans[0][0] + spans[2][1]) < 1e-12);
  assert.deepEqual(
    player.avatars.map(({ place }) => place.slice(1)),
    [
      [0, 0],
      [0, 0],
      [0, 0],
    ],
  );
});

test("the camera stands where the attributes say and sees all", () => {
  const { stage, player } = staged({ azimuth: "30", elevation: "-10" }, box(1));
  stage.reset();
  assert.deepEqual(player.framed, [undefined]);
  assert.equal(player.camera.azimuth, 30 * DEGREE);
  assert.equal(player.camera.elevation, -10 * DEGREE);
  assert.equal(stage.framed, 4);
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

test("it goes round by so many degrees a second", () => {
  const { stage, player } = staged({ orbit: "12" }, box(1));
  stage.orbit(0.5);
  assert.ok(Math.abs(player.camera.azimuth - 6 * DEGREE) < 1e-12);
  const still = staged({}, box(1));
  still.stage.orbit(5);
  assert.equal(still.player.camera.azimuth, 0);
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

test("a picture of another shape shows all again where the reader has not moved nearer or away", () => {
  const { stage, player } = staged({}, box(1));
  stage.reset();
  player.camera.target = [1, 2, 3];
  stage.refit();
  assert.deepEqual([player.framed.length, player.camera.target], [2, [1, 2, 3]]);
  stage.zoom(1);
  stage.refit();
  assert.equal(player.framed.length, 2);
});
