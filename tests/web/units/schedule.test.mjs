// Which parts of which decode a displayed frame makes; test_modules.py compares all of it with Python.

import assert from "node:assert/strict";
import { test } from "node:test";
import { PARTS } from "../../../python/mua/web/channels.js";
import { ALONE, DecodeSchedule } from "../../../python/mua/web/schedule.js";

const NOTHING = { whole: null, finish: 0, show: false, begin: null, parts: 0 };
const walk = (frame, level = 0) => ({ clip: "walk", frame, level });

/** What displayed frames do for avatars, of which each is [due, following, more]. */
function begun() {
  const schedule = new DecodeSchedule();
  let displayed = 0;
  return (avatars, parts = 1) => {
    displayed += 1;
    const asks = Object.entries(avatars).map(([key, [due, following, more = {}]]) => {
      const clip = "walk";
      const moments = { due: { clip, frame: due }, following: { clip, frame: following } };
      return [key, { ...moments, level: 0, rank: 0, spread: true, ...more }];
    });
    return Object.fromEntries(schedule.plan(new Map(asks), displayed, parts));
  };
}

test("the first pose of an avatar alone is decoded at once, and nothing more in that frame", () => {
  assert.deepEqual(begun()({ a: [5, 6] }).a, { ...NOTHING, whole: walk(5) });
});

test("the pose that follows is decoded a half in each frame, and shown when it is due", () => {
  const frame = begun();
  frame({ a: [5, 6] });
  assert.deepEqual(frame({ a: [5, 6] }).a, { ...NOTHING, begin: walk(6), parts: ALONE });
  assert.deepEqual(frame({ a: [5, 6] }).a, { ...NOTHING, parts: PARTS - ALONE });
  assert.deepEqual(frame({ a: [5, 6] }).a, NOTHING);
  assert.deepEqual(frame({ a: [6, 7] }).a, { ...NOTHING, show: true, begin: walk(7), parts: ALONE });
});

test("several take turns, a part in a frame, the larger first", () => {
  const frame = begun();
  const avatars = { a: [5, 6, { rank: 1 }], b: [8, 9, { rank: 2 }] };
  assert.deepEqual(frame(avatars), { a: NOTHING, b: { ...NOTHING, begin: walk(9), parts: 1 } });
  for (let part = 1; part < PARTS; part++) assert.deepEqual(frame(avatars).b.parts, 1);
  assert.deepEqual(frame(avatars), { a: { ...NOTHING, begin: walk(6), parts: 1 }, b: NOTHING });
});

test("what may not be spread is decoded at once, also beside others", () => {
  const shown = begun()({ a: [5, 5, { spread: false, level: 2 }], b: [8, 9] });
  assert.deepEqual([shown.a, shown.b.parts], [{ ...NOTHING, whole: walk(5, 2) }, 1]);
});
