// Which avatars an engine holds on its device, while they come, go and the device is lost; the device is a stand-in.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { beforeEach, test } from "node:test";
import { Engine } from "../../../python/mua/web/engine.js";
import { read } from "../../../python/mua/web/format/read.js";
import { groundOf } from "../../../python/mua/web/placement.js";
import { Renderer } from "../../../python/mua/web/renderer.js";

const golden = (name) =>
  read(Uint8Array.from(readFileSync(new URL(`../../golden/${name}.muaavatar`, import.meta.url))).buffer);
const [avatar, expressive] = [await golden("synthetic"), await golden("expressions")];
const LONG = 10_000; // milliseconds that a device lasted
const settled = () => new Promise((done) => setTimeout(done));
const AWAY = { message: "The graphics device is away; try again in a moment." };

Object.assign(globalThis, { cancelAnimationFrame() {} });

let devices; // that were opened
let uploading; // called with each avatar that a device takes up, before it has it

class FakeRenderer {
  slots = [];
  drawn = [];
  closed = new AbortController();
  ready = true;
  bytes = 0;
  projecting = Promise.resolve();
  gpu = Object.assign(new EventTarget(), { queue: { onSubmittedWorkDone: async () => {} } });
  device = {
    gpu: this.gpu,
    since: performance.now(),
    whenLost: (reported, until) => (this.lose = ({ reason }) => until.aborted || reported(reason)),
  };

  get destroyed() {
    return this.closed.signal.aborted;
  }

  refuse(message) {
    this.gpu.dispatchEvent(Object.assign(new Event("uncapturederror"), { error: { message } }));
  }

  async add(one) {
    await uploading(one);
    const slot = { avatar: one, freed: 0, memory: { free: () => (slot.freed += 1) }, frame: { outside: 0.5 } };
    this.slots.push(slot);
    return slot;
  }

  replace(old, slot) {
    assert.ok(this.slots.includes(old) && this.slots.includes(slot));
    this.remove(old);
  }

  remove(slot) {
    assert.ok(this.slots.includes(slot), "a slot is given back where it is, once");
    this.slots = this.slots.filter((one) => one !== slot);
    slot.memory.free();
  }

  async compile() {}

  draw(posed) {
    this.drawn.push(posed.map(({ slot }) => slot));
  }

  destroy() {
    for (const slot of this.slots.splice(0)) slot.memory.free();
    this.closed.abort();
  }
}

beforeEach(() => {
  [devices, uploading] = [[], async () => {}];
  Renderer.open = async () => devices[devices.push(new FakeRenderer()) - 1];
});

async function begun() {
  const engine = await Engine.create({ width: 8, height: 8 }, {});
  const reported = [];
  engine.onerror = ({ message }) => reported.push(message);
  engine.show.shadow = false;
  return { engine, reported };
}

test("an avatar has a slot of the device from when it is shown until it is taken away, once", async () => {
  const { engine } = await begun();
  const [first, second] = [await engine.put(avatar, null, true), await engine.put(avatar, null, true)];
  assert.equal(first.handle.outsideTraining, 0.5);
  first.handle.remove();
  first.handle.remove();
  assert.deepEqual(devices[0].slots, [second.slot]);
  assert.deepEqual(engine.avatars, [second.handle]);
  assert.equal(first.handle.outsideTraining, 0);
});

test("the camera is put before the first avatar, and stays where the reader has it when others come", async () => {
  const { engine } = await begun();
  await engine.put(avatar, null, true);
  const { distance } = engine.camera;
  engine.camera.distance = 2 * distance;
  await engine.put(avatar, null, true);
  assert.deepEqual([distance !== 3.5, engine.camera.distance], [true, 2 * distance]);
});

test("weights that a page sets of a part stay when the whole avatar comes", async () => {
  const { engine } = await begun();
  const part = await engine.put(expressive, null, false);
  part.handle.setExpressions({ jawOpen: 0.25 });
  await engine.put(expressive, part, true);
  part.handle.setExpressions({ eyeBlinkLeft: 0.5 });
  assert.deepEqual([...part.weights].slice(0, 2), [0.25, 0.5]);
});

test("a clip in the place of one of its name has its own ground, and is listed once for all avatars", async () => {
  const { engine } = await begun();
  const entries = [];
  for (let i = 0; i < 3; i++) entries.push(await engine.put({ ...avatar }, null, true));
  const [{ name }] = avatar.clips;
  for (const entry of entries) {
    const ground = groundOf(entry, engine.playback);
    const lifted = { ...avatar.clips[0], translation: avatar.clips[0].translation.map((at) => at + 1) };
    entry.added = [lifted, { ...lifted, name: "dance" }];
    engine.addClips(entry);
    assert.ok(Math.abs(groundOf(entry, engine.playback) - ground) > 0.1);
  }
  assert.deepEqual(
    engine.clips.map((clip) => clip.name),
    [name, "dance"],
  );
});

test("a player that was disposed of does not start, and a canvas without pixels has no picture", async () => {
  const { engine } = await begun();
  engine.canvas.height = 0;
  await assert.rejects(engine.screenshot(), { message: /no picture of 0 x 0 pixels/ });
  globalThis.requestAnimationFrame = () => 1;
  engine.dispose();
  engine.start();
  assert.equal(engine.request, 0);
});

test("the whole avatar takes the slot of its part, and the handle stays", async () => {
  const { engine } = await begun();
  const part = await engine.put(avatar, null, false);
  const { handle, slot } = part;
  const after = await engine.put(avatar, part, true);
  assert.equal(after.handle, handle);
  assert.deepEqual([handle.whole, slot.freed, devices[0].slots], [true, 1, [after.slot]]);
});

test("what comes after its part was taken away is given back at once", async () => {
  const { engine } = await begun();
  const part = await engine.put(avatar, null, false);
  uploading = async () => part.handle.remove();
  await engine.put(avatar, part, true);
  assert.deepEqual([devices[0].slots, engine.avatars], [[], []]);
});

test("an avatar whose device is lost while it comes is a sentence and is not shown", async () => {
  const { engine } = await begun();
  uploading = async () => (engine.renderer = null);
  await assert.rejects(engine.put(avatar, null, true), AWAY);
  await assert.rejects(engine.put(avatar, null, true), AWAY);
  assert.deepEqual(engine.avatars, []);
});

test("a device that comes back draws all avatars by slots of its own", async () => {
  const { engine, reported } = await begun();
  for (let i = 0; i < 2; i++) await engine.put(avatar, null, true);
  await engine.recover(LONG);
  assert.equal(devices.length, 2);
  assert.deepEqual(
    engine.entries.map(({ slot }) => slot),
    devices[1].slots,
  );
  assert.deepEqual(devices[1].drawn, [devices[1].slots]);
  assert.deepEqual([engine.renderer, reported], [devices[1], []]);
});

test("an avatar that is taken away while its device comes back holds nothing there", async () => {
  const { engine, reported } = await begun();
  const [first, second] = [await engine.put(avatar, null, true), await engine.put(avatar, null, true)];
  uploading = async () => first.handle.remove();
  await engine.recover(LONG);
  assert.deepEqual([devices[1].slots, devices[1].drawn, reported], [[second.slot], [[second.slot]], []]);
});

test("a player that is disposed of while its device comes back leaves no device behind", async () => {
  const { engine, reported } = await begun();
  await engine.put(avatar, null, true);
  uploading = async () => engine.dispose();
  await engine.recover(LONG);
  assert.deepEqual([devices[1].destroyed, devices[1].drawn, engine.renderer, reported], [true, [], null, []]);
});

test("a device that goes because the player was disposed of does not come back", async () => {
  const { engine, reported } = await begun();
  const entry = await engine.put(avatar, null, true);
  engine.dispose();
  engine.dispose();
  devices[0].lose({ reason: "unknown" });
  await settled();
  assert.deepEqual([devices.length, devices[0].destroyed, entry.slot.freed, reported], [1, true, 1, []]);
  entry.handle.remove();
  assert.equal(entry.handle.outsideTraining, 0);
});

test("a device that does not come back is reported and nothing is drawn", async () => {
  const { engine, reported } = await begun();
  await engine.put(avatar, null, true);
  Renderer.open = async () => {
    throw new Error("no adapter");
  };
  await engine.recover(LONG);
  assert.deepEqual(reported, ["The graphics device was lost and did not come back: no adapter"]);
  await assert.rejects(engine.screenshot(), AWAY);
});

test("a device that comes back and cannot take up the avatars is given back, and reported", async () => {
  const { engine, reported } = await begun();
  await engine.put(avatar, null, true);
  uploading = () => Promise.reject(new Error("too little memory"));
  await engine.recover(LONG);
  assert.deepEqual([devices[1].destroyed, engine.renderer], [true, null]);
  assert.deepEqual(reported, ["The graphics device was lost and did not come back: too little memory"]);
});

test("a device that is lost again while it takes up the avatars is reported and draws nothing", async () => {
  const { engine, reported } = await begun();
  await engine.put(avatar, null, true);
  uploading = async () => (devices[1].lose({ reason: "unknown" }), settled());
  await engine.recover(LONG);
  assert.deepEqual([devices.length, devices[1].destroyed, devices[1].drawn, engine.renderer], [2, true, [], null]);
  assert.match(reported.join(), /lost twice/);
});

test("a device that is lost for a while comes back, and is reported where it is lost again at once", async () => {
  const { engine, reported } = await begun();
  await engine.recover(LONG);
  devices[1].lose({ reason: "unknown" });
  await settled();
  assert.equal(devices.length, 2);
  assert.match(reported.join(), /lost twice/);
});

test("nothing is reported of a player that was disposed of", async () => {
  const { engine, reported } = await begun();
  await engine.put(avatar, null, true);
  uploading = async () => (engine.dispose(), Promise.reject(new Error("gone")));
  await engine.recover(LONG);
  devices[0].refuse("destroyed");
  assert.deepEqual([devices[1].destroyed, reported], [true, []]);
});

test("an avatar stands on the ground of the clip that it plays, where a shadow is asked for", async () => {
  const higher = { ...avatar.clips[0], name: "higher", translation: avatar.clips[0].translation.map((at) => at + 0.5) };
  const { engine } = await begun();
  await engine.put({ ...avatar, clips: [avatar.clips[0], higher] }, null, true);
  assert.equal(engine.posed()[0].ground, 0);
  engine.show.shadow = true;
  const [{ ground }] = engine.posed();
  engine.clip = "higher";
  assert.ok(Math.abs(engine.posed()[0].ground - ground - 0.5) < 1e-6);
  engine.clip = avatar.clips[0].name;
  assert.equal(engine.posed()[0].ground, ground);
  assert.notEqual(ground, 0);
});

test("before its first picture an avatar is not outside of training", async () => {
  const { engine } = await begun();
  const entry = await engine.put(avatar, null, true);
  entry.slot.frame = new Proxy({}, { get: () => undefined });
  assert.equal(entry.handle.outsideTraining, 0);
});

test("what the device refuses is reported, until the player is disposed of", async () => {
  const { engine, reported } = await begun();
  devices[0].refuse("too large");
  engine.dispose();
  devices[0].refuse("gone");
  assert.deepEqual(reported, ["The graphics device refused: too large"]);
});
