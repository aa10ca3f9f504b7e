// When an engine draws and what of which avatar, on a device that notes what it is given. The avatar is that of golden/.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { beforeEach, test } from "node:test";
import { framing } from "../../../python/mua/web/camera.js";
import { Engine } from "../../../python/mua/web/engine.js";
import { read } from "../../../python/mua/web/format/read.js";
import { boxAround } from "../../../python/mua/web/placement.js";
import { Renderer } from "../../../python/mua/web/renderer.js";

const content = readFileSync(new URL("../../golden/synthetic.muaavatar", import.meta.url));
const golden = await read(Uint8Array.from(content).buffer);
const FRAME = 1000 / golden.encoding.rate; // milliseconds
const walking = {
  ...golden.clips[0],
  translation: golden.clips[0].translation.map((at, i) => (i % 3 ? at : at + i / 3)),
}; // a metre a frame
const avatar = { ...golden, clips: [walking] };

let device; // that was opened last
let asked; // frames of the display

Object.assign(globalThis, {
  requestAnimationFrame: (draws) => asked.push(draws),
  cancelAnimationFrame: () => (asked = []),
});

class FakeRenderer {
  ready = true;
  done = [];
  projecting = Promise.resolve();
  closed = new AbortController();
  device = { whenLost() {}, gpu: Object.assign(new EventTarget(), { queue: { onSubmittedWorkDone: async () => {} } }) };

  async add() {
    return { memory: { free() {} }, frame: { outside: 0 } };
  }

  replace() {}

  displays() {}

  async compile() {}

  draw(posed, look) {
    this.done.push({ draw: posed, look });
  }

  async drawEarly(posed, look) {
    this.done.push({ early: posed, look });
  }

  lookAhead(posed) {
    this.done.push({ ahead: posed });
  }
}

beforeEach(() => {
  asked = [];
  Renderer.open = async () => (device = new FakeRenderer());
});

async function begun(...avatars) {
  const engine = await Engine.create({ width: 80, height: 40 }, {});
  for (const one of avatars) await engine.put(one, null, true);
  engine.onerror = (error) => {
    throw error;
  };
  return engine;
}

/** Let the display show a frame so late, milliseconds after the engine started. */
function show(engine, milliseconds) {
  engine.playback.begin(0);
  for (const draws of asked.splice(0)) draws(milliseconds);
  return device.done.splice(0).map((each) => Object.keys(each)[0]);
}

test("a picture that would be the same is not drawn again; what changes in it is", async () => {
  const engine = await begun(avatar);
  engine.playing = false;
  engine.start();
  assert.deepEqual([show(engine, 1), show(engine, 2)], [["draw"], []]);
  for (const change of [
    () => (engine.avatars[0].place = [1, 0, 0]),
    () => (engine.avatars[0].place[2] = 3),
    () => (engine.time = 1 / avatar.encoding.rate),
    () => (engine.show.template = true),
    () => (engine.camera.azimuth = 1),
    () => (engine.level = "full"),
    () => (engine.budget = 5),
    () => (engine.frameBudget = 5),
    () => (engine.stereo = true),
    () => (engine.canvas.width = 100),
  ]) {
    change();
    assert.deepEqual([show(engine, 1), show(engine, 2)], [["draw"], []], String(change));
  }
});

test("while a frame of the clip lasts, the next one is decoded; paused, nothing is", async () => {
  const engine = await begun(avatar);
  engine.start();
  show(engine, FRAME / 4);
  assert.deepEqual(show(engine, FRAME / 4), ["ahead"]);
  engine.playing = false;
  assert.deepEqual(show(engine, FRAME / 4), []);
});

test("an engine that stood still draws when it goes on, and no time has passed", async () => {
  const engine = await begun(avatar);
  engine.playing = false;
  engine.start();
  show(engine, 1);
  engine.stop();
  assert.deepEqual(show(engine, 2), []);
  engine.playing = true;
  const now = performance.now();
  engine.start();
  for (const draws of asked.splice(0)) draws(now);
  assert.deepEqual([engine.time, device.done.map((each) => "draw" in each)], [0, [true]]);
});

test("while kernels are still compiled, pictures are drawn without them, one after the other", async () => {
  const engine = await begun(avatar);
  device.ready = false;
  let release;
  device.drawEarly = (posed) => (device.done.push({ early: posed }), new Promise((done) => (release = done)));
  engine.start();
  assert.deepEqual(show(engine, 1), ["early"]);
  engine.camera.azimuth = 1;
  assert.deepEqual(show(engine, 2), []);
  const drawn = engine.draw();
  assert.deepEqual(device.done, []);
  release();
  await new Promise((done) => setTimeout(done));
  assert.deepEqual(
    device.done.map((each) => Object.keys(each)[0]),
    ["early"],
  );
  release();
  await drawn;
});

test("a pose is decoded ahead while the display or a headset goes on, and exactly as it is asked for elsewhere", async () => {
  const engine = await begun(avatar);
  engine.playback.step = FRAME / 4000;
  const ahead = () => engine.posed().map(({ frame, following }) => following - frame)[0];
  assert.equal(ahead(), 0);
  engine.room = { headset: {} };
  assert.equal(ahead(), 1);
  engine.room = null;
  engine.request = 1;
  assert.equal(ahead(), 1);
  engine.show.geometry = true;
  assert.equal(ahead(), 0);
});

test("the whole of an avatar stands on its own ground, not on that of the part before it", async () => {
  const engine = await begun();
  const low = {
    ...avatar,
    clips: [{ ...walking, translation: walking.translation.map((at, i) => (i % 3 === 1 ? at - 1 : at)) }],
  };
  const part = await engine.put(low, null, false);
  const before = engine.posed()[0].ground;
  await engine.put(avatar, part, true);
  assert.ok(Math.abs(engine.posed()[0].ground - before - 1) < 1e-5);
});

test("an avatar that is framed while the camera follows stays in the middle as it goes on", async () => {
  const engine = await begun(avatar);
  engine.follow = true;
  engine.time = 2.01 / avatar.encoding.rate;
  engine.frameAll();
  const middle = () => {
    const box = boxAround(engine.entries, engine.playback);
    return [0, 1, 2].map((axis) => Math.abs((box[axis] + box[axis + 3]) / 2 - engine.look.camera.target[axis]));
  };
  assert.ok(Math.max(...middle()) < 1e-5);
  engine.time = 0;
  assert.ok(Math.max(...middle().filter((_, axis) => axis !== 1)) < 1e-5);
});

test("in stereo an avatar is framed for one eye, which has half of the width", async () => {
  const engine = await begun(avatar);
  engine.canvas.height = 300;
  const box = boxAround(engine.entries, engine.playback);
  const found = [];
  for (const [stereo, screen] of [
    [false, [80, 300]],
    [true, [40, 300]],
  ]) {
    engine.stereo = stereo;
    engine.frameAll();
    assert.equal(engine.camera.distance, framing(box, engine.camera, screen).distance);
    found.push(engine.camera.distance);
  }
  assert.ok(found[1] > found[0]);
});

test("only those that were chosen are framed", async () => {
  const engine = await begun(avatar, avatar);
  engine.avatars[1].place = [50, 0, 0];
  engine.frameAll([engine.avatars[1]]);
  const [first, second] = engine.entries.map((entry) => boxAround([entry], engine.playback));
  assert.ok(Math.abs(engine.camera.target[0] - (second[0] + second[3]) / 2) < 1e-5);
  engine.frameAll();
  assert.ok(Math.abs(engine.camera.target[0] - (first[0] + second[3]) / 2) < 1e-5);
});

test("a device that is lost ends the headset's session", async () => {
  const engine = await begun(avatar);
  let left = 0;
  engine.room = { headset: {}, leave: () => (left += 1) };
  await engine.recover(10_000);
  assert.equal(left, 1);
});

test("an engine draws by the frames of the window that its canvas is in, at times of the page's clock", async () => {
  const engine = await begun(avatar);
  engine.start();
  const other = { asked: [], performance: { timeOrigin: performance.timeOrigin + 60_000 } };
  Object.assign(other, { requestAnimationFrame: (draws) => other.asked.push(draws), cancelAnimationFrame() {} });
  engine.canvas.ownerDocument = { defaultView: other };
  engine.playback.begin(0);
  for (const draws of asked.splice(0)) draws(FRAME);
  for (const draws of other.asked.splice(0)) draws(2 * FRAME - 60_000);
  assert.ok(Math.abs(engine.time - (2 * FRAME) / 1000) < 1e-6, String(engine.time));
  assert.deepEqual([asked.length, other.asked.length], [0, 1]);
});

test("a picture that cannot be drawn stops the loop and is reported", async () => {
  const engine = await begun(avatar);
  const reported = [];
  engine.onerror = ({ message }) => reported.push(message);
  device.draw = () => {
    throw new Error("too large");
  };
  engine.start();
  show(engine, 1);
  assert.deepEqual([reported, engine.request], [["The avatar cannot be drawn: too large"], 0]);
});
