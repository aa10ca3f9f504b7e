// What a renderer makes of the poses that it is given, and what it holds of each avatar; the device is a stand-in.

import assert from "node:assert/strict";
import { test } from "node:test";
import { Renderer } from "../../../python/mua/web/renderer.js";

const LOOK = { camera: { azimuth: 0, elevation: 0, distance: 3, target: [0, 1, 0], fov: 0.5 }, stereo: false, level: "full", budget: null };
const SKELETON = { names: ["root"], parents: [-1], root: 0, bindTranslations: new Float32Array(3), translated: [] };
const CLIP = { name: "walk", rate: 30, frames: 2, rotations: Float32Array.of(1, 0, 0, 0, 1, 0, 0, 0), translation: new Float32Array(6), translations: [] };

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

const posedOf = (slot, more = {}) => ({ slot, clip: CLIP, frame: 0, following: 1, place: [0, 0, 0], ground: 0, ...more });
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
  for (const [look, wanted] of [[{ level: 32 }, 1], [{ level: "full" }, 0], [{ level: 32, show: { geometry: true } }, 0]]) {
    const slot = slotOf();
    pose([posedOf(slot)], look);
    assert.deepEqual(slot.done[0], { due: { clip: "walk", frame: 0 }, following: { clip: "walk", frame: 1 }, level: wanted });
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
  assert.deepEqual([first, part, last, whole].map(({ freed }) => freed), [0, 1, 0, 0]);
});

test("an avatar that goes leaves the others and gives its memory back", () => {
  const [first, second] = [slotOf(), slotOf()];
  const renderer = holding(first, second);
  Renderer.prototype.remove.call(renderer, first);
  assert.deepEqual([renderer.slots, first.freed, second.freed], [[second], 1, 0]);
});

/** A device whose buffers and textures are counted. */
function counting() {
  const device = { held: 0, gpu: { createTexture: () => ((device.held += 1), { destroy: () => (device.held -= 1) }) } };
  return device;
}

globalThis.GPUTextureUsage = { RENDER_ATTACHMENT: 16, COPY_SRC: 1 };

test("a saved picture leaves no memory behind, also where it cannot be read", async () => {
  for (const broken of [true, false]) {
    const device = counting();
    device.gpu.createBuffer = () => {
      throw new Error(broken ? "no room" : "");
    };
    const renderer = { device, canvas: { width: 4, height: 4 }, submit: () => assert.equal(device.held, 1) };
    await assert.rejects(Renderer.prototype.picture.call(renderer, [], LOOK));
    assert.equal(device.held, 0);
  }
});

test("an avatar whose kernels do not compile is given back", async () => {
  const slot = slotOf();
  const renderer = { decoding: Promise.reject(new Error("no kernel")), device: {}, upload: async () => slot, removed: [] };
  renderer.remove = (one) => renderer.removed.push(one);
  renderer.decoding.catch(() => {});
  await assert.rejects(Renderer.prototype.add.call(renderer, { geometry: {}, appearance: {} }));
});
