// What the browser player's modules that need no graphics device make of files, for tests: modules.mjs WHAT FILE...
//   answers        a line for each file: ok, or code, field and sentence as JSON
//   mutants        the same of files on the standard input, each after its length as four bytes, that also arrive in steps;
//                  and the most bytes that this process has taken by then
//   measured RUNS  of a file that is read so often: seconds of the processor and by the clock, and the most bytes that the first took
//   values FRAMES  of the file's first clip, those frames: descriptors, components, joints, boxes; and what the kernels read
//   expressions FRAMES  of a file: their names, what they move, the reach at every level, weights at frames of the first clip and what shows
//   stages STEP    of a file that arrives in such steps: how much was there, and what it shows, or code and field of the fault
//   soon TOTAL BYTES...  whether the rest of so many bytes is expected soon, after so many more every 100 ms; 0: none came
//   played CHANGES of a file: clip, time, frame, next frame and box after each change, such as ["speed", 2] or ["advance", 40]
//   order KEYS     of splats
//   turns          of a file of displayed frames, as turn_scenarios.py writes them: the steps of each
//   budget         of a file of frames' milliseconds, likewise: what the next frame may hold
//   roles          of a file of skeletons: the joints of every role
//   retarget       of a skeleton's file, and a motion's: the clip and notes, or the sentence that says what is wrong
//   live           of a skeleton's file and a rig's, with poses of the latter: the avatar's
//   names          of a file of pairs, an avatar's names of expressions and a source's: the shares of each
//   rules          of a file of pairs, rules of expressions and weights: what shows of the weights
//   numbers        half floats, and numbers as sentences have them

import "./strict_inflate.mjs";
import { readFileSync, readSync } from "node:fs";
import { frameBox } from "../../python/mua/web/bounds.js";
import { cameraOf, camerasOf, framing, sees } from "../../python/mua/web/camera.js";
import { framesAt, sample, window } from "../../python/mua/web/clip.js";
import { coarserTexture, textureOf } from "../../python/mua/web/coarser.js";
import { readComponents } from "../../python/mua/web/components.js";
import { describe } from "../../python/mua/web/descriptor.js";
import { Download } from "../../python/mua/web/download.js";
import { orderOf } from "../../python/mua/web/early.js";
import { byVertex, halfOf, reachOf, shorts } from "../../python/mua/web/expressing.js";
import { general, scientific, shortest } from "../../python/mua/web/format/numbers.js";
import { read, readStage } from "../../python/mua/web/format/read.js";
import { Stages } from "../../python/mua/web/format/stages.js";
import { expanded, half } from "../../python/mua/web/format/tensors.js";
import { FrameBudget } from "../../python/mua/web/frame_budget.js";
import { handleOf } from "../../python/mua/web/handle.js";
import { chooseLevels, splatCorners, texelPixels } from "../../python/mua/web/level_choice.js";
import { Levels } from "../../python/mua/web/levels.js";
import { matchExpressions } from "../../python/mua/web/names/match.js";
import { groundHeight, shadowArea } from "../../python/mua/web/overlays.js";
import { boxAround } from "../../python/mua/web/placement.js";
import { Playback } from "../../python/mua/web/playback.js";
import { outward } from "../../python/mua/web/pose.js";
import { texelTiles, texelWords, upsamplingTaps } from "../../python/mua/web/prepare.js";
import { rolesOf } from "../../python/mua/web/retarget/joint_names.js";
import { readClip } from "../../python/mua/web/retarget/read.js";
import { follow } from "../../python/mua/web/retarget/rig.js";
import { heldBack } from "../../python/mua/web/rules.js";
import { DecodeSchedule } from "../../python/mua/web/schedule.js";
import { skinning, world } from "../../python/mua/web/skeleton.js";
import { surfaceMesh } from "../../python/mua/web/surface_mesh.js";

const [what, ...given] = process.argv.slice(2);
const say = (value) => process.stdout.write(`${JSON.stringify(value)}\n`);
const list = (values) => Array.from(values);

const ARRIVED = 5; // steps in which a mutant arrives

function bytes(file) {
  const content = readFileSync(file);
  const { buffer, byteOffset, length } = content;
  return length === buffer.byteLength ? buffer : buffer.slice(byteOffset, byteOffset + length); // small ones share memory
}

/** So many bytes of the standard input; fewer at its end. */
function came(count) {
  const found = new Uint8Array(count);
  for (let at = 0, got = 1; got && at < count; at += got) {
    got = readSync(0, found, at, count - at);
    if (!got) return found.subarray(0, at);
  }
  return found;
}

/** Bytes that this process takes, or at most has taken; maxRSS counts the parent that forked it. */
const status = (name) =>
  1024 * Number(new RegExp(`${name}:\\s*(\\d+) kB`).exec(readFileSync("/proc/self/status", "utf8"))[1]);
const peak = () => status("VmHWM");

async function answer(content) {
  try {
    await read(content);
    return ["ok"];
  } catch (error) {
    if (error.name !== "AvatarError") throw error;
    return [error.code, error.field, error.message];
  }
}

function values(avatar, frames) {
  const { skeleton, encoding, clips, texels, wavelet, geometry, surface } = avatar;
  const { rate } = encoding;
  const posed = frames.map((frame) => sample(skeleton, clips[0], frame, rate));
  const described = frames.map((frame) => describe(skeleton, encoding, window(skeleton, clips[0], frame, encoding)));
  return {
    frames: framesAt(clips[0], rate),
    rotations: posed.map((pose) => list(pose.rotations)),
    translations: posed.map((pose) => list(pose.translations)),
    descriptors: described.map(list),
    components: described.map((one) => list(readComponents(encoding, one).held)),
    outside: described.map((one) => readComponents(encoding, one).outside),
    joints: posed.map((pose) => list(skinning(skeleton, world(skeleton, pose)))),
    boxes: posed.map((pose) => frameBox(avatar, pose)),
    ground: groundHeight(avatar, clips[0]),
    shadow: shadowArea(list(avatar.bounds), -0.25),
    texels: list(texelWords(texels)),
    tiles: list(texelTiles(texels)),
    upsampling: [0, 1, 2, 3].map((levels) => upsamplingTaps(wavelet.recLo, levels)),
    halved: [1, 2].map((coarser) => upsamplingTaps(wavelet.recLo, 2, coarser)),
    counts: new Levels(avatar).counts,
    length: texels.length,
    staticOffset: list(expanded(geometry.staticOffset)),
    surface: surface && Object.values(surfaceMesh(texels, surface)).map(list),
  };
}

/** What expressions move, at every level, and their weights at frames of the first clip. */
function expressed(avatar, frames) {
  const { skeleton, encoding, template, expressions, clips } = avatar;
  const lists = (one) => Object.fromEntries(Object.entries(one).map(([name, values]) => [name, list(values)]));
  const targets = byVertex(avatar.targets);
  let texture = textureOf(avatar);
  const textures = [texture, ...avatar.texels.levels.map(() => (texture = coarserTexture(avatar, texture)))];
  const packed = [targets.expressions, targets.changes.map(halfOf)].map((numbers) => list(shorts(numbers)));
  const { triangles, ...reach } = reachOf(targets.vertices, template.faces);
  const tiles = textures.map((texture) => list(texelTiles(texture, triangles)));
  const weights = frames.map((frame) => list(sample(skeleton, clips[0], frame, encoding.rate).expressions));
  const { rules } = avatar.targets;
  const shown = weights.map((given) => list(rules ? heldBack(rules, Float32Array.from(given)) : given));
  return { names: expressions, targets: lists(targets), packed, reach: lists(reach), tiles, weights, shown };
}

/** What plays after each change. */
function played(avatar, changes) {
  const handle = handleOf(avatar, { remove() {}, outside: () => 0 });
  handle.place = [10, 20, 30];
  const playback = new Playback(() => handle.clips);
  playback.begin(0);
  return changes.map(([name, value]) => {
    if (name === "advance") playback.advance(value);
    else playback[name] = value;
    const { clip, time } = playback;
    const [frame, following] = [playback.frameOf(avatar), playback.followingOf(avatar)];
    return { clip, time, frame, following, box: boxAround([{ avatar, handle }], playback) };
  });
}

/** The coarser levels, one after the other. */
function levels(avatar) {
  let texture = textureOf(avatar);
  return Array.from({ length: avatar.texels.levels.length }, () => {
    texture = coarserTexture(avatar, texture);
    const { size, texels, triangles, barycentrics, statics } = texture;
    const lists = { texels, triangles, barycentrics, words: texelWords(texture), ...statics };
    return { size, ...Object.fromEntries(Object.entries(lists).map(([name, values]) => [name, list(values)])) };
  });
}

/** Whether a camera sees small boxes all around it, and one before its near plane. */
function seen(camera) {
  const places = [-12, -3, -0.5, 0, 0.5, 3, 12];
  const boxes = places.flatMap((x) => places.flatMap((y) => places.map((z) => [x, y, z, x + 0.5, y + 0.5, z + 0.5])));
  const before = camera.position.map((at, axis) => at - (camera.near / 2) * camera.view[8 + axis]);
  boxes.push([-1, 1].flatMap((side) => before.map((at) => at + (side * camera.near) / 8)));
  return boxes.map((box) => sees(camera, box));
}

function views(box) {
  const state = { azimuth: 0.4, elevation: 0.2, fov: 0.6 };
  const { target, distance } = framing(box, state, [96, 128]);
  const camera = cameraOf({ ...state, target, distance }, [96, 128]);
  const eyes = camerasOf({ ...state, target, distance }, true, [193, 128]); // an odd pixel is no eye's
  const texel = texelPixels(0.01, box, [camera]).texel;
  const around = [-0.1, 0.1].flatMap((aside) => camera.position.map((at) => at + aside)); // a box that the camera is in
  const { distance: within, texel: texelWithin } = texelPixels(0.01, around, [camera]);
  const near = { within, texelWithin };
  return {
    target,
    distance,
    ...camera,
    texel,
    ...near,
    seen: seen(camera),
    eyes,
    texelOfEyes: texelPixels(0.01, box, eyes).texel,
    fewest: [[camera], eyes].map((cameras) => {
      let [more, fewest] = [1, 2 ** 30]; // one more than are too few, and one that is enough
      while (more < fewest) {
        const half = Math.floor((more + fewest) / 2);
        if (splatCorners([box, around], half, cameras) === 3) fewest = half;
        else more = half + 1;
      }
      return fewest;
    }),
  };
}

/** What a file that arrives in steps shows before all of it is there. */
async function stages(content, step) {
  const arriving = new Uint8Array(content.byteLength);
  const known = new Stages(arriving.buffer);
  const found = [];
  for (let got = 0; got <= content.byteLength; got += step) {
    arriving.set(new Uint8Array(content, 0, got));
    const end = known.reached(got);
    if (!end) continue;
    try {
      const { clips, surface, texels, geometry, expressions, targets } = await readStage(arriving.buffer, end);
      const sum = ({ data }) => data.reduce((all, byte) => all + byte, 0);
      const { llMean, llBasis, staticOffset } = geometry;
      const [mean, low, details, fixed] = [llMean, llBasis, geometry.details[0].h, staticOffset].map(sum);
      const face = { expressions, weights: list(clips[0].expressions ?? []), moved: targets.vertices.length };
      const shown = { clips: clips.length, surface, texels: texels.texels.length, mean, low, details, fixed, face };
      found.push({ end, got, ...shown });
    } catch (error) {
      if (error.name !== "AvatarError") throw error;
      found.push({ end, got, code: error.code, field: error.field });
    }
  }
  return found;
}

/** What reading a file takes, so many times. */
async function measured(file, runs) {
  const [before, seconds, waited] = [status("VmRSS"), [], []];
  let taken = 0;
  for (let run = 0; run < runs; run++) {
    const [start, began] = [process.cpuUsage(), performance.now()];
    await read(bytes(file));
    waited.push((performance.now() - began) / 1e3);
    const { user, system } = process.cpuUsage(start);
    seconds.push((user + system) / 1e6);
    taken ||= peak() - before;
  }
  return [seconds, waited, taken];
}

/** Whether the rest is expected soon, after each 100 ms. */
function soon(total, bytes) {
  const download = new Download("http://localhost/a.muaavatar");
  download.begin(new Response(null, { headers: { "content-length": total } }), 0);
  return bytes.map((count, i) => {
    const now = 100 * (i + 1);
    if (count) download.add(new Uint8Array(count), now);
    return download.soon(now);
  });
}

/** The steps of each displayed frame. */
function turns(lines) {
  const schedule = new DecodeSchedule();
  const named = (decode) => (decode ? `${decode.frame}@${decode.level}` : "-");
  return lines.map((line) => {
    const [number, parts, gone, ...rest] = line.split(" ").map(Number);
    for (const key of rest.splice(0, gone)) schedule.forget(key);
    const asks = new Map();
    for (let left = rest.shift(); left > 0; left--) {
      const [key, due, following, level, rank, spread, mayLag] = rest.splice(0, 7);
      const [now, next] = [due, following].map((frame) => ({ clip: "walk", frame }));
      asks.set(key, { due: now, following: next, level, rank, spread: spread > 0, mayLag: mayLag > 0 });
    }
    const steps = schedule.plan(asks, number, parts);
    return Array.from(steps, ([key, one]) =>
      [`${key}:${named(one.whole)}`, one.finish, Number(one.show), named(one.begin), one.parts].join(),
    ).join(" ");
  });
}

/** What the frame after each may hold. */
function budgeted(lines) {
  const budget = new FrameBudget();
  return lines.map((line) => {
    const [taken, most, exact, avatars, ...splats] = line.split(" ").map(Number);
    budget.measure(taken, { most, exact: exact > 0, avatars, splats: splats[0] < 0 ? null : splats });
    return `${budget.parts} ${budget.splats ?? -1}`;
  });
}

/** An avatar's skeleton as a file of JSON has it: names, parents, root, local rotations and translations. */
function skeletonOf(file) {
  const { rotations, translations, ...named } = JSON.parse(readFileSync(file, "utf8"));
  return {
    ...named,
    parents: Int32Array.from(named.parents),
    bindRotations: Float64Array.from(rotations.flat()),
    bindTranslations: Float64Array.from(translations.flat()),
  };
}

/** The clip that a motion's file becomes on a skeleton. */
async function retargeted(skeleton, file, options) {
  const avatar = { skeleton, encoding: { rate: options.rate ?? 30 }, expressions: options.expressions ?? [] };
  const source = new File([readFileSync(file)], file.split("/").pop());
  try {
    const { clip, notes } = await readClip(source, avatar, options);
    const [rotations, translations, expressions] = [clip.rotations, clip.translations, clip.expressions ?? []].map(
      list,
    );
    return { name: clip.name, frames: clip.frames, rotations, translations, expressions, notes };
  } catch (error) {
    if (error.name !== "AvatarError") throw error;
    return { message: error.message };
  }
}

/** Poses of a rig, in the world, on a skeleton. */
function followed(skeleton, { poses, ...rig }) {
  const wide = (rotations) => list(outward(rotations.flat()));
  const turn = follow({ skeleton }, { ...rig, rotations: wide(rig.rotations), positions: rig.positions.flat() });
  return poses.map(({ rotations, positions }) => {
    const found = turn(wide(rotations), positions.flat());
    return { rotations: list(found.rotations), translations: list(found.translations) };
  });
}

const linesOf = (file) => readFileSync(file, "utf8").trimEnd().split("\n");

if (what === "roles")
  say(
    JSON.parse(readFileSync(given[0], "utf8")).map(({ parents, ...named }) =>
      rolesOf({ ...named, parents: Int32Array.from(parents) }),
    ),
  );
if (what === "rules")
  for (const [rules, weights] of JSON.parse(readFileSync(given[0])))
    say(list(heldBack(Int32Array.from(rules), Float32Array.from(weights))));
if (what === "names")
  for (const [names, source] of JSON.parse(readFileSync(given[0]))) say(list(matchExpressions(names, source)));
if (what === "retarget") say(await retargeted(skeletonOf(given[0]), given[1], JSON.parse(given[2] ?? "{}")));
if (what === "live") say(followed(skeletonOf(given[0]), JSON.parse(readFileSync(given[1], "utf8"))));
if (what === "turns") say(turns(linesOf(given[0])));
if (what === "budget") say(budgeted(linesOf(given[0])));
if (what === "measured") say(await measured(given[0], Number(given[1])));
if (what === "soon") say(soon(...given.slice(0, 1), given.slice(1).map(Number)));
if (what === "stages") for (const one of await stages(bytes(given[0]), Number(given[1]))) say(one);
if (what === "answers") for (const file of given) say(await answer(bytes(file)));
if (what === "mutants") {
  for (let head = came(4); head.length === 4; head = came(4)) {
    const content = came(new DataView(head.buffer).getUint32(0, true)).buffer;
    await stages(content, Math.ceil(content.byteLength / ARRIVED));
    say([...(await answer(content)).slice(0, 2), peak()]);
  }
}
if (what === "truncated") {
  const content = bytes(given[0]);
  for (let length = 0; length < content.byteLength; length += Number(given[1]))
    say(await answer(content.slice(0, length)));
}
if (what === "values") say(values(await read(bytes(given[0])), given.slice(1).map(Number)));
if (what === "expressions") say(expressed(await read(bytes(given[0])), given.slice(1).map(Number)));
if (what === "played") say(played(await read(bytes(given[0])), JSON.parse(given[1])));
if (what === "levels") say(levels(await read(bytes(given[0]))));
if (what === "choices")
  say(JSON.parse(readFileSync(given[0])).map(({ avatars, budget }) => chooseLevels(avatars, budget)));
if (what === "views") say(views(given.map(Number)));
if (what === "order") say(list(orderOf(Uint16Array.from(JSON.parse(readFileSync(given[0]))))));
if (what === "halves") say(Array.from({ length: 0x7c00 }, (_, bits) => half(bits)));
if (what === "numbers")
  say(
    given
      .map(Number)
      .map((n) => [
        ...(Number.isFinite(n) ? [general(n, 4), general(n, 6), scientific(n)] : ["", "", ""]),
        shortest(n),
      ]),
  );
