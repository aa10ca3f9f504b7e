// The window of poses that an avatar is decoded from while a page sets its pose, at whatever times that is.

import assert from "node:assert/strict";
import { test } from "node:test";
import { LivePose } from "../../../python/mua/web/live.js";

const RATE = 30;
const FRAME = 1 / RATE;
const encoding = { window: 3, rate: RATE };
const pose = (turn) => ({ rotations: Float64Array.from([1, turn, 0, 0]), translations: new Float64Array(3) });
const turnsOf = ({ window }) => window.map(({ rotations }) => rotations[1]);

/** A pose of 0 at 10 s, then those of [turn, seconds later] each. */
function posed(...samples) {
  const live = new LivePose(encoding, pose(0), 10);
  for (const [turn, seconds] of samples) live.sample(pose(turn), 10 + seconds);
  return live;
}

test("the first pose fills the window", () => {
  assert.deepEqual(turnsOf(posed()), [0, 0, 0]);
  assert.equal(posed().settled, true);
});

test("poses at the avatar's rate are the window, the newest first", () => {
  assert.deepEqual(turnsOf(posed([1, FRAME], [2, 2 * FRAME], [3, 3 * FRAME])), [3, 2, 1]);
});

test("poses that come more often are taken once in a frame, and the present one is drawn", () => {
  const live = posed(...Array.from({ length: 12 }, (_, i) => [i + 1, ((i + 1) * FRAME) / 4]));
  assert.deepEqual(turnsOf(live), [12, 8, 4]);
  assert.equal(live.current.rotations[1], 12);
});

test("a pose that comes late is held until then", () => {
  const ticks = Array.from({ length: 6 }, (_, i) => [i < 4 ? 1 : 5, (i + 1) * FRAME]);
  assert.deepEqual(turnsOf(posed(...ticks)), [5, 5, 1]);
});

test("a pose that no other follows fills the window frame by frame and then rests", () => {
  const live = posed([1, FRAME]);
  assert.deepEqual([turnsOf(live), live.settled], [[1, 0, 0], false]);
  const seen = [2, 3].map((frame) => (live.sample(pose(1), 10 + frame * FRAME), [turnsOf(live), live.settled]));
  assert.deepEqual(seen, [
    [[1, 1, 0], false],
    [[1, 1, 1], true],
  ]);
  const { due } = live;
  live.sample(pose(1), 12);
  assert.equal(live.due, due);
});

test("after a rest, however long nothing was drawn, motion begins from the pose at rest", () => {
  const live = posed([1, 60]);
  assert.deepEqual([turnsOf(live), live.settled], [[1, 0, 0], false]);
  live.sample(pose(2), 10 + 60 + FRAME);
  assert.deepEqual(turnsOf(live), [2, 1, 0]);
});

test("a gap in the middle of motion, and a clock that goes back, fill the window with what comes then", () => {
  assert.deepEqual(turnsOf(posed([1, FRAME], [2, 2 * FRAME], [7, 9 * FRAME])), [7, 7, 7]);
  assert.deepEqual(turnsOf(posed([1, FRAME], [2, 2 * FRAME], [7, -9 * FRAME])), [7, 7, 7]);
});

test("windows have numbers of their own, of all avatars", () => {
  const [one, other] = [posed([1, FRAME], [2, 2 * FRAME]), posed([1, FRAME], [2, 2 * FRAME])];
  assert.notEqual(one.due, other.due);
  const { due, version } = one;
  one.sample(pose(3), 10 + 2.2 * FRAME);
  assert.deepEqual([one.due, one.version], [due, version + 1], "drawn anew, and not decoded");
});

test("another face is another pose, though no joint moves", () => {
  const live = posed([1, FRAME], [1, 2 * FRAME], [1, 3 * FRAME]);
  live.sample({ ...pose(1), expressions: Float32Array.of(0.5) }, 10 + 4 * FRAME);
  assert.deepEqual(
    [live.settled, live.window.map(({ expressions }) => expressions?.[0])],
    [false, [0.5, undefined, undefined]],
  );
});

test("a decode may take some displayed frames where these are short", () => {
  const live = posed([1, FRAME]);
  live.sample(pose(2), 10 + 1.4 * FRAME);
  assert.equal(live.mayLag, true);
  live.sample(pose(3), 10 + 2.4 * FRAME);
  assert.equal(live.mayLag, false);
});
