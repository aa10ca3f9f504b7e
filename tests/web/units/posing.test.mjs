// Avatars of an engine that a page poses: while they load, beside each other, and after they were taken away.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { beforeEach, test } from "node:test";
import { Engine } from "../../../python/mua/web/engine.js";
import { read } from "../../../python/mua/web/format/read.js";
import { Renderer } from "../../../python/mua/web/renderer.js";

const content = readFileSync(new URL("../../golden/synthetic.muaavatar", import.meta.url));
const avatarOf = async (more = {}) => ({ ...(await read(Uint8Array.from(content).buffer)), ...more });
const RATE = (await avatarOf()).encoding.rate;
const SAMPLED = 30; // frames per second that clips of glTF are read at
const BEND = { rotations: { middle: [0.6, 0, 0, 0.8] } };
const HOP = { translations: { root: [0, 2, 0] } };

Object.assign(globalThis, { cancelAnimationFrame() {}, requestAnimationFrame: () => 1 });

class FakeRenderer {
  closed = new AbortController();
  ready = true;
  projecting = Promise.resolve();
  gpu = Object.assign(new EventTarget(), { queue: { onSubmittedWorkDone: async () => {} } });
  device = { gpu: this.gpu, since: 0, whenLost() {} };
  add = async (avatar) => ({ avatar, memory: { free() {} }, frame: { outside: 0, buffers: { avatar } } });
  replace() {}
  remove() {}
  draw() {}
  displays() {}
  lookAhead() {}
}

beforeEach(() => {
  Renderer.open = async () => new FakeRenderer();
});

/** An engine with avatars, and what it has told. */
async function begun(...avatars) {
  const engine = await Engine.create({ width: 8, height: 8 }, {});
  for (const one of avatars) await engine.put(one, null, true);
  engine.show.shadow = false;
  const told = [];
  engine.onplayback = ({ type, clip }) => told.push(`${type} ${clip}`);
  return { engine, told, handles: engine.avatars };
}

const posedAt = (engine, seconds) => (engine.takePoses(1000 * seconds), engine.posed());
const bend = ({ live }) => live?.current.rotations[5]; // x of the middle joint

/** A glTF file with the avatar's own skeleton, of which one joint turns. */
function glbOf({ skeleton }, frames = 6) {
  const wide = (q, at) => [q[4 * at + 1], q[4 * at + 2], q[4 * at + 3], q[4 * at]];
  const nodes = skeleton.names.map((name, joint) => ({
    name,
    rotation: wide(skeleton.bindRotations, joint),
    translation: Array.from(skeleton.bindTranslations.subarray(3 * joint, 3 * joint + 3)),
    children: Array.from(skeleton.parents.keys()).filter((other) => skeleton.parents[other] === joint),
  }));
  const times = Float32Array.from({ length: frames }, (_, i) => i / SAMPLED);
  const turns = Float32Array.from({ length: 4 * frames }, (_, i) => [0.6 * ((i >> 2) / frames), 0, 0, 1][i % 4]);
  const bytes = Buffer.concat([times, turns].map(({ buffer }) => Buffer.from(buffer)));
  return new TextEncoder().encode(
    JSON.stringify({
      nodes,
      buffers: [{ uri: `data:application/octet-stream;base64,${bytes.toString("base64")}` }],
      bufferViews: [
        { buffer: 0, byteLength: 4 * frames },
        { buffer: 0, byteOffset: 4 * frames, byteLength: 16 * frames },
      ],
      accessors: [
        { bufferView: 0, componentType: 5126, count: frames, type: "SCALAR" },
        { bufferView: 1, componentType: 5126, count: frames, type: "VEC4" },
      ],
      animations: [
        { samplers: [{ input: 0, output: 1 }], channels: [{ sampler: 0, target: { node: 1, path: "rotation" } }] },
      ],
    }),
  ).buffer;
}

test("a pose replaces the clip until it is given back", async () => {
  const { engine, handles } = await begun(await avatarOf());
  const clip = posedAt(engine, 1)[0];
  assert.equal(clip.live, null);
  handles[0].setPose(BEND);
  assert.equal(bend(posedAt(engine, 1.1)[0]), 0.6);
  handles[0].setPose(null);
  assert.deepEqual([posedAt(engine, 1.2)[0].live, engine.moving], [null, true]);
});

test("each of two avatars has a pose of its own", async () => {
  const { engine, handles } = await begun(await avatarOf(), await avatarOf());
  handles[1].setPose(BEND);
  assert.deepEqual(posedAt(engine, 1).map(bend), [undefined, 0.6]);
  handles[0].setPose(HOP);
  const [first, second] = posedAt(engine, 2);
  assert.deepEqual([first.live.current.translations[1], bend(second)], [2, 0.6]);
  assert.notEqual(first.frame, second.frame, "windows tell avatars apart");
});

test("a pose that is set while only a part of the avatar is there stays when all of it is", async () => {
  const { engine } = await begun();
  const part = await engine.put(await avatarOf(), null, false);
  part.handle.setPose(BEND);
  posedAt(engine, 1);
  await engine.put(await avatarOf(), part, true);
  assert.equal(bend(posedAt(engine, 2)[0]), 0.6);
});

test("an avatar that was taken away takes no pose and plays no clip, which is no error", async () => {
  const { engine, handles } = await begun(await avatarOf());
  const [handle] = handles;
  const loading = handle.playClip(glbOf(await avatarOf()));
  handle.remove();
  handle.setPose(BEND);
  handle.setExpressions({ none: 1 });
  assert.deepEqual([await loading, await handle.playClip("nowhere.bvh"), engine.posed()], [null, null, []]);
  await assert.rejects(handle.retarget({}), { message: "retarget: the avatar was taken away." });
});

test("what is wrong is thrown and changes nothing", async () => {
  const { engine, handles } = await begun(await avatarOf());
  handles[0].setPose(BEND);
  assert.throws(() => handles[0].setPose({ rotations: [1] }), { name: "AvatarError" });
  assert.throws(() => handles[0].setExpressions({ smile: 1 }), { name: "AvatarError" });
  assert.equal(bend(posedAt(engine, 1)[0]), 0.6);
});

test("pictures change until a pose that was set has come to rest", async () => {
  const { engine, handles } = await begun(await avatarOf());
  engine.playing = false;
  const changes = [];
  engine.onchange = () => changes.push(engine.moving);
  const seen = [];
  for (const [i, pose] of [BEND, HOP, HOP, HOP].entries()) {
    if (i < 2) handles[0].setPose(pose);
    posedAt(engine, 1 + i / RATE);
    seen.push(engine.moving);
  }
  assert.deepEqual(
    [changes, seen],
    [
      [true, true],
      [false, true, true, false],
    ],
  );
});

test("while poses come, a decode may lag; at rest it is exact", async () => {
  const { engine, handles } = await begun(await avatarOf());
  engine.start();
  handles[0].setPose(BEND);
  assert.deepEqual(
    [posedAt(engine, 1)[0].spread, posedAt(engine, 1)[0].following === posedAt(engine, 1)[0].frame],
    [false, true],
  );
  handles[0].setPose(HOP);
  const [{ spread, mayLag }] = posedAt(engine, 1.01);
  assert.deepEqual([spread, mayLag], [true, true]);
});

test("a clip that a page loads is one of the avatar's, plays from its start and tells when it ends", async () => {
  const { engine, told, handles } = await begun(await avatarOf());
  engine.playing = false;
  handles[0].setPose(BEND);
  const played = await handles[0].playClip(glbOf(await avatarOf()), { name: "nod", loop: false });
  assert.deepEqual({ ...played, seconds: 0 }, { name: "nod", frames: 5, seconds: 0, loop: false, notes: [] });
  assert.deepEqual([engine.clip, engine.time, engine.playing, posedAt(engine, 1)[0].live], ["nod", 0, true, null]);
  assert.deepEqual(
    engine.clips.map(({ name }) => name),
    ["wave", "nod"],
  );
  engine.playback.begin(0);
  for (let i = 1; i <= 8; i++) engine.playback.advance((1000 * i) / RATE);
  assert.deepEqual([told, engine.playing], [["pause wave", "play nod", "end nod"], false]);
});

test("a clip stays when the rest of its avatar comes, and one of its name replaces it", async () => {
  const { engine } = await begun();
  const part = await engine.put(await avatarOf(), null, false);
  await part.handle.playClip(glbOf(await avatarOf()), { name: "nod" });
  const { stamp } = engine.posed()[0];
  await engine.put(await avatarOf(), part, true);
  const names = () => part.handle.clips.map(({ name, frames }) => `${name} ${frames}`);
  assert.deepEqual([names(), engine.clip], [["wave 7", "nod 5"], "nod"]);
  await part.handle.playClip(glbOf(await avatarOf(), 11), { name: "nod" });
  assert.deepEqual(names(), ["wave 7", "nod 9"]);
  assert.notEqual(engine.posed()[0].stamp, stamp, "its frames are decoded anew");
});

test("of two clips that are asked for at once, the later one plays", async () => {
  const { engine, handles } = await begun(await avatarOf());
  const avatar = await avatarOf();
  const found = await Promise.all(["one", "two"].map((name) => handles[0].playClip(glbOf(avatar), { name })));
  assert.deepEqual([found[0], found[1].name, engine.clip], [null, "two", "two"]);
});

test("two avatars play clips of one name together, also where only the second has it", async () => {
  const { engine, handles } = await begun(await avatarOf(), await avatarOf());
  await handles[1].playClip(glbOf(await avatarOf()), { name: "nod" });
  assert.equal(engine.clip, "nod");
  assert.deepEqual(
    engine.posed().map(({ clip }) => clip.name),
    ["wave", "nod"],
  );
});

test("weights that are set go with clip and pose alike, and are forgotten on request", async () => {
  const { engine, handles } = await begun(await avatarOf({ expressions: ["blink", "smile"] }));
  const [handle] = handles;
  assert.deepEqual(handle.expressions, ["blink", "smile"]);
  handle.setExpressions({ smile: 0.25 });
  const [clip] = posedAt(engine, 1);
  assert.deepEqual([Array.from(clip.weights, (weight) => weight || 0), clip.stamp === ""], [[0, 0.25], false]);
  handle.setPose({ ...BEND, expressions: [0.5, 1] });
  assert.deepEqual(Array.from(posedAt(engine, 2)[0].live.current.expressions), [0.5, 0.25]);
  handle.setExpressions(null);
  assert.deepEqual(Array.from(posedAt(engine, 3)[0].live.current.expressions), [0.5, 1]);
});

test("weights that change quickly are taken once in a frame of the avatar, and the last of them are", async () => {
  const { engine, handles } = await begun(await avatarOf({ expressions: ["blink", "smile"] }));
  engine.playing = false;
  engine.request = 1; // pictures follow each other
  const smileAt = (frames) => posedAt(engine, 1 + frames / RATE)[0].weights[1];
  handles[0].setExpressions({ smile: 0.25 });
  assert.deepEqual([engine.moving, smileAt(0), engine.moving], [true, 0.25, false]);
  const { stamp } = posedAt(engine, 1)[0];
  handles[0].setExpressions({ smile: 0.5 });
  assert.deepEqual([smileAt(0.4), engine.moving, posedAt(engine, 1)[0].stamp === stamp], [0.25, true, true]);
  handles[0].setExpressions({ smile: 0.75 });
  assert.deepEqual([smileAt(1.1), engine.moving, posedAt(engine, 1)[0].stamp === stamp], [0.75, false, false]);
  engine.request = 0; // a picture alone
  handles[0].setExpressions({ smile: 1 });
  assert.equal(smileAt(1.2), 1);
});

test("weights that are set again change nothing", async () => {
  const { engine, handles } = await begun(await avatarOf({ expressions: ["blink", "smile"] }));
  let changes = 0;
  engine.onchange = () => (changes += 1);
  for (const smile of [0.5, 0.5, 0.75]) handles[0].setExpressions({ smile });
  assert.equal(changes, 2);
});

test("a motion file that is wrong rejects with a sentence, and what plays goes on", async () => {
  const { engine, handles } = await begun(await avatarOf());
  const wrong = new TextEncoder().encode("HIERARCHY").buffer;
  await assert.rejects(handles[0].playClip(wrong), {
    name: "AvatarError",
    message: "The motion: expected a line MOTION after the hierarchy, found none.",
  });
  assert.deepEqual([engine.clip, engine.playing], ["wave", true]);
});

test("nothing is told of a player without avatars", async () => {
  const { engine, told } = await begun();
  engine.playing = false;
  assert.deepEqual(told, []);
});

test("a rig that is wrong rejects with a sentence", async () => {
  const { handles } = await begun(await avatarOf());
  const one = { names: ["Hips"], parents: [-1], rotations: [0, 0, 0, 1], positions: [0, 1, 0] };
  for (const [change, message] of [
    [{ parents: [0] }, "parents: expected one of each of 1 joints, before the joint itself; -1 for none"],
    [{ rotations: [0, 0, 0] }, "rotations holds 3 numbers, expected 4 of each of 1 joints"],
    [{ positions: [0, NaN, 0] }, "positions: expected finite numbers, found NaN"],
  ])
    await assert.rejects(handles[0].retarget({ ...one, ...change }), { message: `retarget: ${message}.` });
});
