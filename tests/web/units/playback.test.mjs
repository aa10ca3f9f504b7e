// What avatars play, and when: backward, paused at an end, several with clips of their own.

import assert from "node:assert/strict";
import { test } from "node:test";
import { Playback } from "../../../python/mua/web/playback.js";

const RATE = 30;
const clip = (name, frames) => ({ name, rate: RATE, frames });
const avatarOf = (...clips) => ({ clips, encoding: { rate: RATE } });
const WALK = avatarOf(clip("walk", 60), clip("wave", 30));
const OTHER = avatarOf(clip("sit", 15), clip("wave", 45));

/** The playback of avatars, the first of which says which clips there are. */
function playing(...avatars) {
  const clips = avatars[0].clips.map(({ name, frames }) => ({ name, frames, seconds: frames / RATE }));
  const playback = new Playback(() => clips);
  playback.begin(0);
  return playback;
}

test("a negative speed plays backward, from the first frame to the last", () => {
  const playback = playing(WALK);
  playback.speed = -1;
  playback.advance(100);
  assert.ok(Math.abs(playback.time - 1.9) < 1e-9);
  assert.deepEqual([playback.frameOf(WALK), playback.followingOf(WALK)], [57, 57]);
  playback.advance(200);
  assert.equal(playback.frameOf(WALK), 54);
});

test("each avatar plays its own clip of the name that was chosen, or its first", () => {
  const playback = playing(WALK, OTHER);
  playback.time = 40 / RATE;
  assert.deepEqual(
    [WALK, OTHER].map((one) => playback.clipOf(one).name),
    ["walk", "sit"],
  );
  assert.deepEqual(
    [WALK, OTHER].map((one) => playback.frameOf(one)),
    [40, 10],
  );
  playback.clip = "wave";
  assert.equal(playback.time, 0);
  playback.time = 29 / RATE;
  assert.deepEqual(
    [WALK, OTHER].map((one) => playback.clipOf(one).frames),
    [30, 45],
  );
  assert.deepEqual(
    [WALK, OTHER].map((one) => playback.frameOf(one)),
    [29, 29],
  );
});

test("a pose of no time stands at the first frame", () => {
  const playback = playing(WALK);
  for (const time of [NaN, Infinity, -Infinity]) {
    playback.time = 1;
    playback.time = time;
    assert.equal(playback.frameOf(WALK), 0);
  }
});
