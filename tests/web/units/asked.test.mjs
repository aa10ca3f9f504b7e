// What a page asks of an element before there is an avatar, which is then done once.

import assert from "node:assert/strict";
import { test } from "node:test";
import { Asked } from "../../../python/mua/web/asked.js";

function handle() {
  const done = [];
  const note = (name) => (value) => void done.push([name, value]);
  const playClip = async (...given) => (done.push(["playClip", ...given]), "played");
  return { done, setPose: note("setPose"), setExpressions: note("setExpressions"), playClip };
}

test("a pose, weights and a time are given to the first avatar alone", () => {
  const asked = Object.assign(new Asked(), { pose: "pose", weights: { jawOpen: 1 }, time: 2 });
  const [first, second, player] = [handle(), handle(), { time: 0 }];
  for (const each of [first, second]) asked.adopt(each);
  assert.deepEqual(first.done, [
    ["setPose", "pose"],
    ["setExpressions", { jawOpen: 1 }],
  ]);
  assert.deepEqual(second.done, []);
  asked.seek(player);
  assert.equal(player.time, 2);
  player.time = 1;
  asked.seek(player);
  assert.equal(player.time, 1);
});

test("it plays as was asked, the next one as its attributes say", () => {
  const asked = Object.assign(new Asked(), { playing: false });
  assert.deepEqual([asked.play(true), asked.play(true), asked.play(false)], [false, true, false]);
});

test("of two clips the later one is played, and none where no avatar comes", async () => {
  const [asked, first] = [new Asked(), handle()];
  const clips = [asked.playClip("a.bvh"), asked.playClip("b.bvh", { loop: false })];
  asked.adopt(first);
  assert.deepEqual(await Promise.all(clips), [null, "played"]);
  assert.deepEqual(first.done, [["playClip", "b.bvh", { loop: false }]]);
  const dropped = asked.playClip("c.bvh");
  asked.drop();
  assert.equal(await dropped, null);
});
