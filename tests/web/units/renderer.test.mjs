// What a renderer makes of the poses that it is given, and what it holds of each avatar; the device is a stand-in.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { Device } from "../../../python/mua/web/device.js";
import { read } from "../../../python/mua/web/format/read.js";
import { Renderer } from "../../../python/mua/web/renderer.js";
import { fakeGpu } from "./gpu.mjs";

const LOOK = {
  camera: { azimuth: 0, elevation: 0, distance: 3, target: [0, 1, 0], fov: 0.5 },
  stereo: false,
  level: "full",
  budget: null,
};
const SKELETON = { names: ["root"], parents: [-1], root: 0, bindTranslations: new Float32Array(3), translated: [] };
const CLIP = {
  name: "walk",
  rate: 30,
  frames: 2,
  rotations: Float32Array.of(1, 0, 0, 0, 1, 0, 0, 0),
  translation: new Float32Array(6),
  translations: [],
};

/** An avatar on the device that notes what is done with it; `changes` says whether each decode shows other channels. */
function slotOf({ changes = [], level = 0 } = {}) {
  const done = [];
  const avatar = { skeleton: SKELETON, encoding: { rate: 30, window: 1 }, bounds: [-1, 0, -1, 1, 2, 1] };
  const slot = {
    done,
    freed: 0,
    memory: { free: () => (slot.freed += 1) },
    frame: { buffers: { avatar }, repose: (_, __, place) => done.push(`posed at ${place}`) },
    overlays: { pose: (ground) => done.push(`ground ${ground}`) },
    levels: { shown: level, sizes: [64, 32] },
    schedule: { shown: null, record: (_, asked) => (done.push(asked), changes.shift() ?? false) },
    standing: "",
  };
  return slot;
}

const posedOf = (slot, more = {}) => ({
  slot,
  clip: CLIP,
  frame: 0,
  following: 1,
  place: [0, 0, 0],
  ground: 0,
  ...more,
});
const pose = (posed, look = {}) => Renderer.prototype.pose.call({}, "pass", posed, { ...LOOK, show: {}, ...look }, []);
const moves = (slot) => slot.done.splice(0).filter((each) => typeof each === "string");

test("an avatar is posed where it was decoded anew or stands elsewhere, and rests otherwise", () => {
  const slot = slotOf({ changes: [true, false, true] });
  pose([posedOf(slot)]);
  assert.deepEqual(moves(slot), ["posed at 0,0,0", "ground 0"]);
  pose([posedOf(slot)]);
  assert.deepEqual(moves(slot), []);
  pose([posedOf(slot)]);
  assert.equal(moves(slot).length, 2);
  pose([posedOf(slot, { place: [0, 1, 2] })]);
  assert.deepEqual(moves(slot), ["posed at 0,1,2", "ground 1"]);
  pose([posedOf(slot, { place: [0, 1, 2], ground: 0.5 })]);
  assert.deepEqual(moves(slot), ["posed at 0,1,2", "ground 1.5"]);
});

test("each avatar is decoded at the level that is asked for, the finest where its surface is shown", () => {
  for (const [look, wanted] of [
    [{ level: 32 }, 1],
    [{ level: "full" }, 0],
    [{ level: 32, show: { geometry: true } }, 0],
  ]) {
    const slot = slotOf();
    pose([posedOf(slot)], look);
    assert.deepEqual(slot.done[0], {
      due: { clip: "walk", frame: 0 },
      following: { clip: "walk", frame: 1 },
      level: wanted,
    });
  }
});

test("what comes next is decoded at the level that is shown, once its frame is", () => {
  const [shown, other, none] = [slotOf({ level: 1 }), slotOf(), slotOf()];
  shown.schedule.shown = { clip: "walk", frame: 3 };
  other.schedule.shown = { clip: "walk", frame: 2 };
  const posed = [shown, other, none].map((slot) => posedOf(slot, { frame: 3, following: 4 }));
  Renderer.prototype.lookAhead.call({ compute: (record) => record("pass") }, posed);
  assert.deepEqual([shown.done[0].level, other.done, none.done], [1, [], []]);
});

/** A renderer that holds these slots, and which of them it makes room for. */
function holding(...slots) {
  const renderer = { slots, rooms: [], rearrange: (next) => (renderer.rooms.push(next), (renderer.slots = next)) };
  return renderer;
}

test("an avatar that takes the place of its part stands where that stood, which is given back once", () => {
  const [first, part, last, whole] = Array.from({ length: 4 }, () => slotOf());
  const renderer = holding(first, part, last, whole);
  Renderer.prototype.replace.call(renderer, part, whole);
  assert.deepEqual(renderer.slots, [first, whole, last]);
  assert.deepEqual(
    [first, part, last, whole].map(({ freed }) => freed),
    [0, 1, 0, 0],
  );
});

test("an avatar that goes leaves the others and gives its memory back", () => {
  const [first, second] = [slotOf(), slotOf()];
  const renderer = holding(first, second);
  Renderer.prototype.remove.call(renderer, first);
  assert.deepEqual([renderer.slots, first.freed, second.freed], [[second], 1, 0]);
});

const content = readFileSync(new URL("../../golden/synthetic.muaavatar", import.meta.url));
const golden = await read(Uint8Array.from(content).buffer);

/** A renderer on a device that computes nothing. */
function opened() {
  const gpu = fakeGpu();
  const device = new Device({ info: {} }, gpu);
  const context = { configure() {}, unconfigure() {} };
  return { gpu, renderer: new Renderer(device, { width: 4, height: 4, getContext: () => context }, {}) };
}

test("an avatar that the device has no room for is a sentence, and the others keep theirs", async () => {
  const { gpu, renderer } = opened();
  const slot = await renderer.add(golden);
  const before = [renderer.bytes, gpu.held.size];
  gpu.lacking = { message: "out of memory" };
  await assert.rejects(renderer.add(golden), {
    name: "AvatarError",
    message: /too little free memory for this avatar/,
  });
  assert.deepEqual([renderer.slots, renderer.bytes, gpu.held.size], [[slot], ...before]);
});

test("an avatar of which a buffer is too large for the device is given back", async () => {
  const { gpu, renderer } = opened();
  const before = [renderer.bytes, gpu.held.size];
  gpu.limits.maxBufferSize = 4096;
  await assert.rejects(renderer.add(golden), {
    name: "AvatarError",
    message: /more than the 4096 that this device can bind/,
  });
  assert.deepEqual([renderer.slots, renderer.bytes, gpu.held.size], [[], ...before]);
});

test("an avatar whose kernels do not compile is given back", async () => {
  const { gpu, renderer } = opened();
  await renderer.decoding;
  const before = [renderer.bytes, gpu.held.size];
  gpu.broken = "UpsampleTexels";
  await assert.rejects(renderer.add(golden), /does not compile/);
  assert.deepEqual([renderer.slots, renderer.bytes, gpu.held.size], [[], ...before]);
});

test("a saved picture leaves no memory behind, also where it cannot be read", async () => {
  const { gpu, renderer } = opened();
  const held = gpu.held.size;
  renderer.submit = () => assert.equal(gpu.held.size, held + 1);
  gpu.createBuffer = () => {
    throw new Error("no room");
  };
  await assert.rejects(renderer.picture([], LOOK), /no room/);
  assert.deepEqual([gpu.held.size, renderer.bytes], [held, 0]);
});
