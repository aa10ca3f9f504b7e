// What a renderer makes of the poses that it is given, and what it holds of each avatar; the device is a stand-in.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { camerasOf } from "../../../python/mua/web/camera.js";
import { Decodes } from "../../../python/mua/web/decodes.js";
import { Device } from "../../../python/mua/web/device.js";
import { read } from "../../../python/mua/web/format/read.js";
import { Levels } from "../../../python/mua/web/levels.js";
import { Renderer } from "../../../python/mua/web/renderer.js";
import { fakeGpu } from "./gpu.mjs";

const LOOK = {
  camera: { azimuth: 0, elevation: 0, distance: 3, target: [0, 1, 0], fov: 0.5 },
  stereo: false,
  level: "full",
  budget: null,
  frameBudget: null,
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

/** An avatar on the device that notes what is done with it. */
function slotOf({ level = 0 } = {}) {
  const done = [];
  const avatar = {
    skeleton: SKELETON,
    encoding: { rate: 30, window: 1 },
    bounds: [-1, 0, -1, 1, 2, 1],
    texels: { size: 64, texels: [0, 1], length: 0.01, levels: [{ texels: [0] }] },
  };
  const slot = {
    done,
    freed: 0,
    memory: { free: () => (slot.freed += 1) },
    frame: {
      buffers: { avatar },
      splatCount: 2,
      decode: (_, __, at) => done.push(`whole at ${at}`),
      begin: (_, at) => done.push(`begin at ${at}`),
      advance: () => done.push("part"),
      show: () => done.push("show"),
      repose: (_, __, place) => done.push(`posed at ${place}`),
    },
    overlays: { pose: (ground) => done.push(`ground ${ground}`) },
    levels: Object.assign(new Levels(avatar), { shown: level }),
    decoded: null,
    standing: "",
  };
  return slot;
}

const posedOf = (slot, more = {}) => ({
  slot,
  clip: CLIP,
  frame: 0,
  following: 0,
  spread: false,
  place: [0, 0, 0],
  ground: 0,
  ...more,
});

/** A renderer, without a device, that draws pictures one after the other. */
function drawing() {
  const renderer = Object.assign(Object.create(Renderer.prototype), { decodes: new Decodes(), cameras: [] });
  renderer.compute = (record) => record("pass");
  const cameras = camerasOf(LOOK.camera, false, [100, 100]);
  const pose = (posed, look = {}) => renderer.pose("pass", posed, { ...LOOK, show: {}, ...look }, cameras);
  return { renderer, pose };
}

const moves = (slot) => slot.done.splice(0).filter((each) => /posed|ground/.test(each));

test("an avatar is posed where it plays on or stands elsewhere, and rests otherwise", () => {
  const slot = slotOf();
  const { pose } = drawing();
  pose([posedOf(slot)]);
  assert.deepEqual(moves(slot), ["posed at 0,0,0", "ground 0"]);
  pose([posedOf(slot)]);
  assert.deepEqual(moves(slot), []);
  pose([posedOf(slot, { frame: 1, following: 1 })]);
  assert.equal(moves(slot).length, 2);
  pose([posedOf(slot, { frame: 1, following: 1, place: [0, 1, 2] })]);
  assert.deepEqual(moves(slot), ["posed at 0,1,2", "ground 1"]);
  pose([posedOf(slot, { frame: 1, following: 1, place: [0, 1, 2], ground: 0.5 })]);
  assert.deepEqual(moves(slot), ["posed at 0,1,2", "ground 1.5"]);
});

test("each avatar is decoded at the level that is asked for, the finest where its surface is shown", () => {
  for (const [look, wanted] of [
    [{ level: 32 }, 1],
    [{ level: "full" }, 0],
    [{ level: 32, show: { geometry: true } }, 0],
  ]) {
    const slot = slotOf();
    drawing().pose([posedOf(slot)], look);
    assert.equal(slot.done[0], `whole at ${wanted}`);
  }
});

test("what comes next is decoded at the level that is shown", () => {
  const slot = slotOf();
  const { renderer, pose } = drawing();
  pose([posedOf(slot, { spread: true, following: 1 })], { level: 32 });
  slot.done.length = 0;
  renderer.lookAhead([posedOf(slot, { spread: true, following: 1 })]);
  assert.deepEqual(slot.done, ["begin at 1", "part", "part"]);
});

test("of several, one is decoded a part in a picture, and all are posed", () => {
  const slots = [slotOf(), slotOf()];
  const { pose } = drawing();
  const show = (frame) => pose(slots.map((slot) => posedOf(slot, { spread: true, frame, following: 1 })));
  show(0);
  assert.deepEqual(
    slots.map(({ done }) => done.splice(0)[0]),
    ["whole at 0", "whole at 0"], // the first of each comes at once
  );
  const parts = [0, 0, 1, 1].map((frame) => {
    show(frame);
    return slots.map(({ done }) => done.filter((each) => each === "part").length);
  });
  assert.deepEqual(
    parts,
    [1, 2, 3, 4].map((made) => [made, 0]),
  );
  assert.deepEqual(
    slots.map((slot) => moves(slot).length),
    [2, 2],
  );
});

test("an avatar that nobody sees takes no turn", () => {
  const [seen, behind] = [slotOf(), slotOf()];
  const { pose } = drawing();
  const posed = (frame) => [
    posedOf(behind, { spread: true, frame, following: 1 - frame, place: [0, 0, 50] }),
    posedOf(seen, { spread: true, frame, following: 1 - frame }),
  ];
  pose(posed(0));
  behind.done.length = 0;
  for (const frame of [0, 0, 1, 1, 0]) pose(posed(frame));
  assert.ok(behind.done.every((each) => !/part|whole|begin/.test(each)));
  assert.ok(seen.done.includes("show"));
});

test("an avatar that one of several eyes sees takes its turn", () => {
  const slots = [slotOf(), slotOf()];
  const { renderer } = drawing();
  const away = camerasOf({ ...LOOK.camera, azimuth: Math.PI, distance: -3 }, false, [100, 100]);
  const eyes = [...away, ...camerasOf(LOOK.camera, false, [100, 100])];
  for (const frame of [0, 0, 0, 0, 1, 1]) {
    const posed = slots.map((slot) => posedOf(slot, { spread: true, frame, following: 1 - frame }));
    renderer.pose("pass", posed, { ...LOOK, show: {} }, eyes);
  }
  assert.ok(slots.some(({ done }) => done.includes("part")));
});

test("of two budgets the smaller one holds, and that of milliseconds where distance chooses the level alone", () => {
  const { renderer, pose } = drawing();
  renderer.decodes.budget.splats = 100;
  const budgets = [null, 50, 200].map((budget) => renderer.limited({ ...LOOK, budget, frameBudget: 10 }).budget);
  assert.deepEqual(budgets, [100, 50, 100]);
  const measured = ["auto", "full"].map((level) => {
    pose([posedOf(slotOf())], { level, frameBudget: 10 });
    return renderer.decodes.measured.splats;
  });
  assert.deepEqual(measured, [[2, 2], null]);
});

test("a picture that takes too long has fewer splats, where a number of milliseconds is asked for", () => {
  for (const [frameBudget, limited] of [
    [null, null],
    [10, 2],
  ]) {
    const { renderer, pose } = drawing();
    const look = { frameBudget, level: "auto" };
    const slots = [slotOf(), slotOf()];
    for (let i = 0; i < 100; i++) {
      pose(
        slots.map((slot) => posedOf(slot)),
        look,
      );
      renderer.decodes.time(20);
    }
    const { budget } = renderer.limited({ ...LOOK, ...look });
    assert.equal(budget !== null, limited !== null);
    assert.ok(budget === null || budget < 4);
  }
});

/** A renderer that holds these slots, and which of them it makes room for. */
function holding(...slots) {
  const renderer = {
    slots,
    decodes: new Decodes(),
    free: Renderer.prototype.free,
    rooms: [],
    rearrange: (next) => (renderer.rooms.push(next), (renderer.slots = next)),
  };
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

test("a canvas is drawn on as its page is, and given back with the device", async (context) => {
  const [gpu, called] = [fakeGpu(), []];
  const surface = { configure: ({ alphaMode }) => called.push(alphaMode), unconfigure: () => called.push("free") };
  context.mock.method(Device, "open", async () => new Device({ info: {} }, gpu));
  context.mock.timers.enable({ apis: ["setTimeout"] });
  const renderer = await Renderer.open({ width: 4, height: 4, getContext: () => surface }, {});
  renderer.destroy();
  context.mock.timers.tick(60_000);
  assert.deepEqual([called, gpu.destroyed], [["premultiplied", "free"], true]);
});

test("avatars that came and went leave no memory behind", async () => {
  const { gpu, renderer } = opened();
  const before = [renderer.bytes, gpu.held.size];
  const [first, second] = [await renderer.add(golden), await renderer.add(golden)];
  const whole = await renderer.add(golden);
  renderer.replace(first, whole);
  assert.deepEqual(renderer.slots, [whole, second]);
  renderer.remove(second);
  renderer.remove(whole);
  assert.deepEqual([renderer.bytes, gpu.held.size], before);
});

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
