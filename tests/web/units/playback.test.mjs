// What avatars play, and when: backward, paused at an end, several with clips of their own.

import assert from "node:assert/strict";
import { test } from "node:test";
import { framesAt, sample } from "../../../python/mua/web/clip.js";
import { Playback } from "../../../python/mua/web/playback.js";

const RATE = 30;
const clip = (name, frames, loop) => ({ name, rate: RATE, frames, loop });
const avatarOf = (...clips) => ({ clips, encoding: { rate: RATE } });
const WALK = avatarOf(clip("walk", 60), clip("wave", 30));
const OTHER = avatarOf(clip("sit", 15), clip("wave", 45));

/** The playback of avatars, the first of which says which clips there are, and what it has told. */
function playing(...avatars) {
  const clips = avatars[0].clips.map(({ name, frames, loop }) => ({ name, frames, seconds: frames / RATE, loop }));
  const told = [];
  const playback = new Playback(
    () => clips,
    (what) => told.push([what, playback.frameOf(avatars[0])]),
  );
  playback.begin(0);
  return Object.assign(playback, { told });
}

test("rounding takes no frame off a clip of another rate", () => {
  assert.equal(framesAt({ ...clip("fast", 85), rate: 120 }, 90), 64);
});

test("a clip that a page loaded moves joints of its own", () => {
  const skeleton = { names: ["root", "arm"], root: 0, bindTranslations: new Float64Array(6), translated: [] };
  const loaded = {
    ...clip("loaded", 1),
    rotations: Float32Array.of(1, 0, 0, 0, 1, 0, 0, 0),
    translation: new Float32Array(3),
    translations: Float32Array.of(0, 2, 0),
    translated: Int32Array.of(1),
  };
  assert.deepEqual([...sample(skeleton, loaded, 0, RATE).translations], [0, 0, 0, 0, 2, 0]);
});

test("a negative speed plays backward, from the first frame to the last", () => {
  const playback = playing(WALK);
  playback.speed = -1;
  playback.advance(100);
  assert.ok(Math.abs(playback.time - 1.9) < 1e-9);
  assert.deepEqual([playback.frameOf(WALK), playback.followingOf(WALK)], [57, 57]);
  playback.advance(200);
  assert.equal(playback.frameOf(WALK), 54);
});

test("another clip begins at its first frame, the same one goes on", () => {
  const playback = playing(WALK);
  playback.time = 0.5;
  playback.clip = "walk";
  assert.equal(playback.time, 0.5);
  playback.clip = "wave";
  assert.equal(playback.time, 0);
});

test("an avatar that is paused at its last frame stays there, and goes on with the first", () => {
  const playback = playing(WALK);
  playback.time = 59 / RATE;
  playback.playing = false;
  playback.advance(20);
  assert.deepEqual([playback.frameOf(WALK), playback.followingOf(WALK)], [59, 59]);
  playback.playing = true;
  playback.advance(40);
  assert.deepEqual([playback.frameOf(WALK), playback.followingOf(WALK)], [59, 0]);
  playback.advance(60);
  assert.equal(playback.frameOf(WALK), 0);
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

/** Let time go on in steps of 100 ms. */
function go(playback, steps, from = 0) {
  for (let i = 1; i <= steps; i++) playback.advance(from + 100 * i);
}

test("each pass of a clip that starts over is told once, forward and backward", () => {
  for (const speed of [1, -1]) {
    const playback = playing(WALK);
    playback.speed = speed;
    go(playback, 45);
    assert.deepEqual(
      playback.told.map(([what]) => what),
      speed > 0 ? ["loop", "loop"] : ["loop", "loop", "loop"], // backward, the first step leaves the start
    );
  }
});

test("a clip that does not start over ends at its last frame, once, and plays from its start when it is asked to", () => {
  const once = avatarOf(clip("jump", 30, false));
  const playback = playing(once);
  go(playback, 15);
  assert.deepEqual([playback.told, playback.playing, playback.frameOf(once)], [[["end", 29]], false, 29]);
  playback.playing = true;
  playback.advance(1540);
  assert.deepEqual([playback.told.slice(1), playback.frameOf(once)], [[["play", 0]], 1]);
});

test("backward, it ends at its first frame and plays from its last", () => {
  const once = avatarOf(clip("jump", 30, false));
  const playback = playing(once);
  playback.speed = -1;
  playback.time = 0.35;
  go(playback, 5);
  assert.deepEqual([playback.told, playback.frameOf(once)], [[["end", 0]], 0]);
  playback.playing = true;
  assert.equal(playback.frameOf(once), 29);
});

test("one that has ended and is moved plays on from there", () => {
  const once = avatarOf(clip("jump", 30, false));
  const playback = playing(once);
  go(playback, 15);
  playback.time = 0.5;
  playback.playing = true;
  assert.equal(playback.frameOf(once), 15);
});

test("playing and pausing are told where they change something", () => {
  const playback = playing(WALK);
  for (const now of [true, false, false, true]) playback.playing = now;
  playback.time = 3; // going elsewhere is no pass of the clip
  assert.deepEqual(
    playback.told.map(([what]) => what),
    ["pause", "play"],
  );
});

test("a clip of one frame neither starts over nor ends", () => {
  const playback = playing(avatarOf(clip("still", 1, false)));
  go(playback, 5);
  assert.deepEqual([playback.told, playback.playing], [[], true]);
});
