// How a player's avatars stand before a reader with a headset, and who draws meanwhile. The avatar is that of golden/.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { beforeEach, test } from "node:test";
import { read } from "../../../python/mua/web/format/read.js";
import { handleOf } from "../../../python/mua/web/handle.js";
import { Headset } from "../../../python/mua/web/headset.js";
import { boxAround, groundOf } from "../../../python/mua/web/placement.js";
import { Playback } from "../../../python/mua/web/playback.js";
import { VR } from "../../../python/mua/web/vr.js";

const content = readFileSync(new URL("../../golden/synthetic.muaavatar", import.meta.url));
const avatar = await read(Uint8Array.from(content).buffer);
const BEFORE = 1.2; // metres between the reader and what is nearest

let headsets; // that were opened

function engineOf(...places) {
  const noted = { vr: [], failed: [], drawn: 0, submitted: [] };
  const engine = {
    noted,
    entries: places.map((place) => ({
      avatar,
      grounds: new Map(),
      handle: { ...handleOf(avatar, { remove() {}, outside: () => 0 }), place },
    })),
    camera: { azimuth: 0.7 },
    drawn: "what the canvas shows",
    way: [0, 0, 0],
    followed: () => engine.way,
    takePoses() {},
    renderer: { device: "device", displays() {}, submit: (...given) => noted.submitted.push(given) },
    posed: () => "posed",
    look: "look",
    drawNow: () => (noted.drawn += 1),
    onvr: (vr) => noted.vr.push(vr),
    fail: (error) => noted.failed.push(error),
  };
  engine.playback = new Playback(() => engine.entries[0]?.handle.clips ?? []);
  return engine;
}

beforeEach(() => {
  headsets = [];
  Headset.open = async (device, asks) => {
    const headset = { device, asks, left: 0, leave: () => (headset.left += 1) };
    headsets.push(headset);
    return headset;
  };
});

const moved = (matrix, point) =>
  [0, 4, 8].map((row) => [0, 1, 2].reduce((sum, i) => sum + matrix[row + i] * point[i], matrix[row + 3]));
const near = (found, wanted) =>
  found.forEach((value, i) => assert.ok(Math.abs(value - wanted[i]) < 1e-9, `${found} is not ${wanted}`));

/** Middle of their box on the lowest ground, and half of the box' diagonal along the ground. */
function foot(engine) {
  const box = boxAround(engine.entries, engine.playback);
  const grounds = engine.entries.map((entry) => groundOf(entry, engine.playback) + entry.handle.place[1]);
  return [
    [(box[0] + box[3]) / 2, Math.min(...grounds), (box[2] + box[5]) / 2],
    Math.hypot(box[3] - box[0], box[5] - box[2]) / 2,
  ];
}

for (const places of [
  [[0, 0, 0]],
  [
    [-1, 0.3, 0],
    [1, -0.2, 2],
  ],
])
  test(`${places.length} avatars stand on the floor before the reader, the lowest of them`, () => {
    const engine = engineOf(...places);
    const [middle, reach] = foot(engine);
    const room = new VR(engine).standing()();
    near(moved(room, middle), [0, 0, -BEFORE - reach]);
    const up = moved(room, [middle[0], middle[1] + 1, middle[2]]);
    near(up, [0, 1, -BEFORE - reach]);
  });

test("they are seen from the side from which the page shows them", () => {
  const engine = engineOf([0, 0, 0]);
  const [middle, reach] = foot(engine);
  const room = new VR(engine).standing()();
  const towards = [Math.sin(0.7), 0, Math.cos(0.7)]; // where the page's camera stands
  near(
    moved(
      room,
      middle.map((at, axis) => at + towards[axis]),
    ),
    [0, 0, 1 - BEFORE - reach],
  );
});

test("a figure that is followed stays before the reader", () => {
  const engine = engineOf([0, 0, 0]);
  engine.way = [2, 0, 1];
  const [middle, reach] = foot(engine);
  const room = new VR(engine).standing();
  near(moved(room(), middle), [0, 0, -BEFORE - reach]);
  engine.way = [2.5, 0, 3];
  near(moved(room(), [middle[0] + 0.5, middle[1], middle[2] + 2]), [0, 0, -BEFORE - reach]);
});

test("entering and leaving is noted, and the canvas gets its picture back", async () => {
  const engine = engineOf([0, 0, 0]);
  const vr = new VR(engine);
  await vr.enter();
  assert.deepEqual([vr.headset, engine.noted.vr, headsets[0].device], [headsets[0], [true], "device"]);
  vr.leave();
  assert.equal(headsets[0].left, 1);
  headsets[0].asks.ended();
  assert.deepEqual([vr.headset, engine.noted.vr, engine.noted.drawn, engine.drawn], [null, [true, false], 1, ""]);
  vr.leave();
  assert.equal(headsets[0].left, 1);
});

test("a frame of the headset moves the clip on and draws what is posed", async () => {
  const engine = engineOf([0, 0, 0]);
  await new VR(engine).enter();
  engine.playback.begin(0);
  engine.playback.playing = true;
  headsets[0].asks.draw(100, "picture", "eyes");
  assert.ok(Math.abs(engine.playback.time - 0.1) < 1e-12);
  assert.deepEqual(engine.noted.submitted, [["picture", "posed", "look", "eyes"]]);
  headsets[0].asks.fail("broken");
  assert.deepEqual(engine.noted.failed, ["broken"]);
});

test("a second click opens no second session, neither while the first opens nor after", async () => {
  const vr = new VR(engineOf([0, 0, 0]));
  await Promise.all([vr.enter(), vr.enter()]);
  await vr.enter();
  assert.equal(headsets.length, 1);
});

test("after a refusal it can be tried again", async () => {
  const vr = new VR(engineOf([0, 0, 0]));
  const { open } = Headset;
  Headset.open = () => Promise.reject(new Error("denied"));
  await assert.rejects(vr.enter(), /denied/);
  Headset.open = open;
  await vr.enter();
  assert.equal(vr.headset, headsets[0]);
});

test("without an avatar or a device there is nothing to show", async () => {
  for (const engine of [engineOf(), Object.assign(engineOf([0, 0, 0]), { renderer: null })])
    await assert.rejects(new VR(engine).enter(), { name: "AvatarError" });
  assert.equal(headsets.length, 0);
});

test("a device that is lost while the session opens ends it, and nobody is noted of a beginning or an end", async () => {
  const engine = engineOf([0, 0, 0]);
  const vr = new VR(engine);
  const entering = vr.enter();
  engine.renderer = null;
  await entering;
  assert.deepEqual([headsets[0].left, vr.headset], [1, null]);
  headsets[0].asks.ended();
  assert.deepEqual([engine.noted.vr, engine.noted.drawn], [[], 0]);
});
