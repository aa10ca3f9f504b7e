// Which parts of which decode a displayed frame makes, with a frame of an avatar that notes it.

import assert from "node:assert/strict";
import { test } from "node:test";
import { PARTS } from "../../../python/mua/web/channels.js";
import { DecodeSchedule } from "../../../python/mua/web/schedule.js";

function begun() {
  const done = [];
  const frame = {
    partsLeft: 0,
    decode: (_, window, level) => done.push(`whole ${window} at ${level}`),
    begin: (window, level) => (done.push(`begin ${window} at ${level}`), (frame.partsLeft = PARTS)),
    advance: () => (done.push("part"), (frame.partsLeft -= 1)),
    show: () => done.push("show"),
  };
  const schedule = new DecodeSchedule(frame);
  /** What a displayed frame does, and whether other channels are shown. */
  const record = (due, following, level = 0, clip = "walk") => {
    const asked = { due: { clip, frame: due }, following: { clip, frame: following }, level };
    const changed = schedule.record("pass", asked, ({ clip: of, frame: at }) => `${of} ${at}`);
    return [changed, ...done.splice(0)];
  };
  return record;
}

test("the first pose is decoded at once, and nothing more in that frame", () => {
  const record = begun();
  assert.deepEqual(record(5, 6), [true, "whole walk 5 at 0"]);
});

test("the pose that follows is decoded a part in each frame, and shown when it is due", () => {
  const record = begun();
  record(5, 6);
  assert.deepEqual(record(5, 6), [false, "begin walk 6 at 0", "part"]);
  for (let part = 1; part < PARTS; part++) assert.deepEqual(record(5, 6), [false, "part"]);
  assert.deepEqual(record(5, 6), [false]);
  assert.deepEqual(record(6, 7), [true, "show", "begin walk 7 at 0", "part"]);
});

test("what is due before it is whole is completed, and nothing more in that frame", () => {
  const record = begun();
  record(5, 6);
  record(5, 6);
  assert.deepEqual(record(6, 7), [true, ...new Array(PARTS - 1).fill("part"), "show"]);
});

test("a pose that nobody saw coming is decoded at once", () => {
  const record = begun();
  record(5, 6);
  record(5, 6);
  assert.deepEqual(record(9, 10), [true, "whole walk 9 at 0"]);
  assert.deepEqual(record(9, 10, 0, "wave"), [true, "whole wave 9 at 0"]);
});

test("another level comes with the next pose while it plays, and at once while it rests", () => {
  const record = begun();
  record(5, 6);
  assert.deepEqual(record(5, 6, 1), [false, "begin walk 6 at 1", "part"]);
  assert.deepEqual(record(5, 5, 1), [true, "whole walk 5 at 1"]);
  assert.deepEqual(record(5, 5, 1), [false]);
});
