// How an avatar stands in the world and how far outside of training it is, with buffers that note what is written.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { window } from "../../../python/mua/web/clip.js";
import { read } from "../../../python/mua/web/format/read.js";
import { AvatarFrame } from "../../../python/mua/web/frame.js";
import { Levels } from "../../../python/mua/web/levels.js";

const content = readFileSync(new URL("../../golden/synthetic.muaavatar", import.meta.url));
const avatar = await read(Uint8Array.from(content).buffer);
const windowAt = (frame) => window(avatar.skeleton, avatar.clips[0], frame, avatar.encoding);

function frameOf() {
  const frame = Object.create(AvatarFrame.prototype);
  const level = (at) => ({ level: at, splatCount: 10 - at });
  Object.assign(frame, {
    buffers: {
      avatar,
      level,
      expressing: { shown: (weights) => weights.map((weight) => (weight < 0.1 ? 0 : weight)) },
    },
    device: { write() {} },
    hidden: null,
    shown: { outside: 0, components: "shown", weights: "weights" },
  });
  frame.decoder = { part() {} };
  frame.createChannels = () => ({ outside: 0, components: "hidden" });
  return frame;
}

test("an avatar's joints and box go with its place", () => {
  const frame = frameOf();
  const [pose] = windowAt(0);
  frame.writePose(pose, [0, 0, 0]);
  const [joints, box] = [Array.from(frame.places), frame.bounds];
  frame.writePose(pose, [1, -2, 3]);
  const near = (found, wanted) =>
    found.forEach((value, i) => assert.ok(Math.abs(value - wanted[i] - [1, -2, 3][i % 3]) < 1e-6));
  near(Array.from(frame.places), joints);
  near(frame.bounds, box);
});

test("what is known of a pose is reported once it is shown", () => {
  const frame = frameOf();
  const stretched = windowAt(0).map((pose) => ({
    ...pose,
    rotations: pose.rotations.map((value, i) => [0.5, 0.5, -0.5, 0.5][i % 4] + 0 * value),
  }));
  frame.begin(stretched, 1);
  assert.deepEqual([frame.outside, frame.shown.components], [0, "shown"]);
  for (let part = frame.partsLeft; part > 0; part--) frame.advance("pass");
  frame.show();
  assert.ok(frame.outside > 0.1);
  assert.deepEqual([frame.shown.components, frame.splatCount, frame.partsLeft], ["hidden", 9, 0]);
  const before = frame.outside;
  frame.decode("pass", windowAt(0), 0);
  assert.ok(frame.outside < before);
});

test("a face is decoded by the weights of the newest pose, and left as it is where all are 0", () => {
  const frame = frameOf();
  const written = [];
  frame.device.write = (buffer, content) => buffer === "weights" && written.push(Array.from(content));
  const express = (...weights) => {
    const poses = windowAt(0).map((pose, age) => ({ ...pose, expressions: weights[age] ?? Float32Array.of(0.5, 0.5) }));
    frame.decode("pass", poses, 0);
    return frame.shown.expressive;
  };
  assert.equal(express(Float32Array.of(0.25, 1)), true);
  assert.equal(express(Float32Array.of(0, 0)), false);
  assert.equal(express(Float32Array.of(0.05, 0)), false, "of what is held back");
  assert.deepEqual(written, [[0.25, 1]]);
  frame.decode("pass", windowAt(0), 0);
  assert.equal(frame.shown.expressive, false, "of poses without weights");
});

test("an avatar is as near as it stands", () => {
  const levels = new Levels(avatar);
  const camera = { position: [0, 1, 10], projection: new Array(16).fill(1), screen: [100, 100], near: 0.02 };
  const [here, behind] = [
    [0, 0, 0],
    [0, 0, -5],
  ].map((place) => levels.seen(windowAt(0)[0], place, [camera]));
  assert.ok(Math.abs(behind.distance - here.distance - 5) < 1e-5);
  assert.ok(behind.texel < here.texel);
});
