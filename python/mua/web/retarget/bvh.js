// BVH: a hierarchy of offsets and Euler channels, then a row of numbers for each frame. Reference: python/mua/motion/bvh.py,
// which says how units and the axis that is up are told.

import { AvatarError } from "../error.js";
import { multiply, rotate } from "../rotation.js";
import { world } from "../skeleton.js";
import { rolesOf } from "./joint_names.js";
import { aboutAxis, length, mean, minus, plus, quaternion, turns, vector } from "./vectors.js";

/** @typedef {import("./vectors.js").Vector} Vector */
/** @typedef {import("./source.js").Bones} Bones */
/** @typedef {import("./source.js").Motion} Motion */
/** @typedef {{name: string, parent: number, offset: Vector, channels: string[]}} Node */

const UNITS = [1, 0.01, 0.001, 0.1, 0.0254]; // metres per unit, the likeliest first
const PERSON_SPAN = [1.7, 3.2]; // metres along the bones from fingertip to toe, child to giant
const TYPICAL_SPAN = 2.35;
const HELD = 1e-4; // of the span: a joint whose place in its parent changes by less keeps the mean
const SLOWEST = 5; // seconds between frames; more are frames per second or milliseconds in their place
const WHOLE_RATE = 1e-3; // relative: 0.033333 s means 30 frames per second
const MOST = 0.5; // share of frames with heads above feet along Z or X, rather than Y, from which on it is up
const ON_HEAD = 0.9; // of the frames that have heads below feet: more than any handstand is of its clip
const CHANNELS = ["xposition", "yposition", "zposition", "xrotation", "yrotation", "zrotation"];

const fault = (/** @type {string} */ sentence) => new AvatarError(sentence);

/** @returns {Motion} @throws {AvatarError} for a broken hierarchy, an unknown channel, a wrong number of values, no frames, no numbers */
export function readBvh(/** @type {string} */ text) {
  const lines = text.split(/\r\n|\r|\n/).filter((line) => !/^\s*(#|\/\/|;)/.test(line));
  const at = lines.findIndex((line) => /^\s*motion\s*$/i.test(line));
  if (at < 0) throw fault("expected a line MOTION after the hierarchy, found none.");
  const nodes = readHierarchy(lines.slice(0, at));
  const width = nodes.reduce((sum, { channels }) => sum + channels.length, 0);
  const { rate, rows } = readFrames(lines.slice(at + 1), width);
  return assembled(nodes, rate, rows);
}

/** @returns {Node[]} parents before children */
function readHierarchy(/** @type {string[]} */ lines) {
  const statements = lines
    .join("\n")
    .replace(/[{}]/g, "\n$&\n")
    .split("\n")
    .map((line) => line.trim().split(/\s+/))
    .filter(([word]) => word);
  if (statements[0]?.[0].toLowerCase() !== "hierarchy") throw fault("expected HIERARCHY in the first line.");
  /** @type {Node[]} */
  const nodes = [];
  /** @type {number[]} */
  const open = [];
  for (const [word, ...values] of statements.slice(1)) {
    const keyword = word.toLowerCase();
    const node = nodes[open.at(-1) ?? -1];
    if (
      ["root", "joint", "end"].includes(keyword) &&
      (keyword === "root") === !nodes.length &&
      !node === !nodes.length
    ) {
      const name = keyword === "end" ? `${node.name}_end` : values.join(" ");
      nodes.push({ name, parent: open.at(-1) ?? -1, offset: [0, 0, 0], channels: [] });
    } else if (keyword === "{" && nodes.length && !open.includes(nodes.length - 1)) open.push(nodes.length - 1);
    else if (keyword === "}" && node) open.pop();
    else if (keyword === "offset" && node) node.offset = offsetOf(node, values);
    else if (keyword === "channels" && node) node.channels = channelsOf(node, values);
    else
      throw fault(`HIERARCHY: expected a joint, OFFSET, CHANNELS or a brace, found "${[word, ...values].join(" ")}".`);
  }
  if (open.length || !nodes.length) throw fault(`HIERARCHY: ${open.length} braces are not closed before MOTION.`);
  return nodes;
}

function offsetOf(/** @type {Node} */ { name }, /** @type {string[]} */ values) {
  const offset = numbers(`OFFSET of ${name}`, values);
  if (offset.length !== 3) throw fault(`OFFSET of ${name}: expected 3 numbers, found ${offset.length}.`);
  return offset;
}

function channelsOf(/** @type {Node} */ { name }, /** @type {string[]} */ [count, ...given]) {
  const channels = given.map((channel) => channel.toLowerCase());
  const unknown = channels.find((channel) => !CHANNELS.includes(channel));
  if (count !== String(channels.length)) throw fault(`CHANNELS of ${name}: expected a count and as many names.`);
  if (unknown) throw fault(`CHANNELS of ${name}: expected Xposition .. Zrotation, found "${unknown}".`);
  return channels;
}

/** @param {string[]} lines @param {number} width values in a frame */
function readFrames(lines, width) {
  const rows = lines.filter((line) => line.trim());
  const count = header(rows[0], "Frames");
  const time = header(rows[1], "Frame Time");
  if (!(count >= 1 && Number.isInteger(count))) throw fault(`Frames: expected at least 1 frame, found ${count}.`);
  if (!(time > 0 && time <= SLOWEST))
    throw fault(`Frame Time: expected seconds above 0 and up to ${SLOWEST}, found ${time}.`);
  const words = rows.slice(2).join(" ").split(/\s+/).filter(Boolean);
  const values = numbers("MOTION", words);
  const whole = rows.length > 2 && rows.slice(2).every((row) => row.trim().split(/\s+/).length === width);
  if (!whole && values.length !== count * width)
    throw fault(`MOTION: expected ${count} frames of ${width} values, found ${values.length} values.`);
  const rounded = Math.max(Math.round(1 / time), 1);
  const rate = Math.abs(1 / time - rounded) < WHOLE_RATE * rounded ? rounded : 1 / time;
  const frames = width ? values.length / width : count;
  return { rate, rows: Array.from({ length: frames }, (_, i) => values.slice(i * width, (i + 1) * width)) };
}

function header(/** @type {string} */ row = "", /** @type {string} */ label) {
  const found = new RegExp(`^\\s*${label.replace(" ", "\\s+")}\\s*:(.*)$`, "i").exec(row);
  if (!found) throw fault(`MOTION: expected "${label}:" and a number, found "${row.trim().slice(0, 40)}".`);
  const values = numbers(label, found[1].trim().split(/\s+/));
  if (values.length !== 1) throw fault(`${label}: expected one number, found "${found[1].trim()}".`);
  return values[0];
}

/** Commas are decimal points, as some languages write them, unless there are points too. */
function numbers(/** @type {string} */ field, /** @type {string[]} */ words) {
  const text = words.join(" ");
  const split = text.includes(",")
    ? text.replaceAll(",", text.includes(".") || text.includes(", ") ? " " : ".").split(/\s+/)
    : words;
  return split.filter(Boolean).map((word) => {
    const value = Number(word);
    if (!Number.isFinite(value)) throw fault(`${field}: expected finite numbers, found "${word}".`);
    return value;
  });
}

/** @returns {Motion} */
function assembled(/** @type {Node[]} */ nodes, /** @type {number} */ rate, /** @type {number[][]} */ rows) {
  const span = spanOf(nodes);
  const scale = unitOf(span);
  const names = nodes.map(({ name }) => name);
  const parents = Int32Array.from(nodes, ({ parent }) => parent);
  const { rotations, positions } = decoded(nodes, rows);
  const moves = nodes.map((_, joint) => extent(positions, joint));
  const root = movingRoot({ names, parents, root: 0 }, moves);
  const rest = nodes.map(({ offset }, joint) => {
    if (joint === root || isAbove(parents, joint, root)) return offset;
    const place = mean(positions.map((frame) => frame[joint]));
    if (moves[joint] <= HELD * span) for (const frame of positions) frame[joint] = place;
    return place;
  });
  const translations = Float64Array.from(positions.flat(2), (value) => scale * value);
  const bindTranslations = Float64Array.from(rest.flat(), (value) => scale * value);
  const bindRotations = Float64Array.from(nodes.flatMap(() => [1, 0, 0, 0]));
  const bones = { names, parents, root, bindRotations, bindTranslations };
  const motion = { bones, rate, frames: rows.length, rotations, translations };
  const turned = otherUp(motion);
  if (turned) turnWorld(motion, turned.turn);
  return {
    ...motion,
    stated: {},
    expressions: { names: [], weights: new Float32Array() },
    notes: turned ? [turned.note] : [],
  };
}

/** Local rotations [F, J, 4], and positions [F][J] in file units. @param {Node[]} nodes @param {number[][]} rows */
function decoded(nodes, rows) {
  const rotations = new Float64Array(4 * nodes.length * rows.length);
  const positions = rows.map((row, frame) => {
    let column = 0;
    return nodes.map(({ offset, channels }, joint) => {
      const place = [...offset];
      let turn = [1, 0, 0, 0];
      for (const channel of channels) {
        const axis = "xyz".indexOf(channel[0]);
        if (channel.endsWith("position")) place[axis] = row[column];
        else turn = multiply(turn, aboutAxis(axis, (Math.PI / 180) * row[column]));
        column += 1;
      }
      rotations.set(turn, 4 * (nodes.length * frame + joint));
      return place;
    });
  });
  addOffsets(nodes, positions);
  return { rotations, positions };
}

/** Below the root, positions add to the offset where those of most joints come nearer to zero than to it. @param {Node[]} nodes @param {Vector[][]} positions */
function addOffsets(nodes, positions) {
  const moving = [...nodes.keys()].filter((joint) => {
    const { parent, offset, channels } = nodes[joint];
    return parent >= 0 && offset.some(Boolean) && channels.some((channel) => channel.endsWith("position"));
  });
  const nearest = (/** @type {number} */ joint, /** @type {Vector} */ to) =>
    positions.reduce((least, frame) => Math.min(least, length(minus(frame[joint], to))), Infinity);
  const added = moving.filter((joint) => nearest(joint, [0, 0, 0]) < nearest(joint, nodes[joint].offset));
  if (2 * added.length <= moving.length) return;
  for (const frame of positions) for (const joint of moving) frame[joint] = plus(frame[joint], nodes[joint].offset);
}

/** How far a joint moves along the axis along which it moves most. */
function extent(/** @type {Vector[][]} */ positions, /** @type {number} */ joint) {
  const sides = [0, 1, 2].map((axis) => {
    const [low, high] = positions.reduce(
      ([least, most], frame) => [Math.min(least, frame[joint][axis]), Math.max(most, frame[joint][axis])],
      [Infinity, -Infinity],
    );
    return high - low;
  });
  return Math.max(...sides);
}

function isAbove(/** @type {Int32Array} */ parents, /** @type {number} */ joint, /** @type {number} */ below) {
  let above = parents[below];
  while (above > joint) above = parents[above];
  return above === joint;
}

/** The joint that carries the motion's translation: the hips, else the first below the ROOT that moves. @param {import("./joint_names.js").Named} skeleton @param {number[]} moves */
function movingRoot(skeleton, moves) {
  const hips = rolesOf(skeleton).hips[0];
  let root = 0;
  while (!moves[root] && skeleton.parents.filter((parent) => parent === root).length === 1) root += 1;
  return hips === 0 && moves[root] ? root : hips;
}

/** The longest way along bones between two ends: a measure of size that no pose changes. */
function spanOf(/** @type {Node[]} */ nodes) {
  const deepest = nodes.map(() => 0);
  let span = 0;
  for (let joint = nodes.length - 1; joint > 0; joint--) {
    const { parent, offset } = nodes[joint];
    const reach = deepest[joint] + length(offset);
    span = Math.max(span, deepest[parent] + reach);
    deepest[parent] = Math.max(deepest[parent], reach);
  }
  return span;
}

/** Metres per unit that make a span a person's, or come nearest to it. */
function unitOf(/** @type {number} */ span) {
  if (span <= 0) return 1;
  const away = (/** @type {number} */ unit) => Math.abs(Math.log((span * unit) / TYPICAL_SPAN));
  const fits = UNITS.find((unit) => PERSON_SPAN[0] <= span * unit && span * unit <= PERSON_SPAN[1]);
  return fits ?? UNITS.toSorted((a, b) => away(a) - away(b))[0];
}

/** @typedef {Pick<Motion, "bones" | "frames" | "rotations" | "translations">} Turnable */

/** What turns the world to Y up, by how heads or hips are above feet; null where it is. */
function otherUp(/** @type {Turnable} */ { bones, frames, rotations, translations }) {
  const named = rolesOf(bones);
  const feet = [...(named["left foot"] ?? []), ...(named["right foot"] ?? [])];
  if (!feet.length) return null;
  const above = (named.head ?? named.hips)[0];
  const joints = bones.names.length;
  const wayUp = (/** @type {import("../skeleton.js").Pose} */ pose) => {
    const { places } = world(bones, pose);
    return minus(vector(places, above), mean(feet.map((foot) => vector(places, foot))));
  };
  const ways = Array.from({ length: frames }, (_, i) =>
    wayUp({
      rotations: rotations.subarray(4 * joints * i, 4 * joints * (i + 1)),
      translations: translations.subarray(3 * joints * i, 3 * joints * (i + 1)),
    }),
  );
  const share = (/** @type {(way: Vector) => boolean} */ holds) => ways.filter(holds).length / frames;
  const middle = mean(ways);
  const alongX = (/** @type {Vector} */ [x, y, z]) => x > Math.max(Math.abs(y), Math.abs(z));
  const atRest = wayUp({ rotations: bones.bindRotations, translations: bones.bindTranslations });
  if (alongX(atRest) && share(alongX) > MOST)
    return { turn: aboutAxis(2, Math.PI / 2), note: "X is up; turned to Y up." };
  if (share(([, y, z]) => z > Math.abs(y)) > MOST)
    return { turn: aboutAxis(0, -Math.PI / 2), note: "Z is up; turned to Y up." };
  const upsideDown = share(([, y]) => y < 0) > ON_HEAD && -middle[1] > Math.abs(middle[2]);
  return upsideDown ? { turn: aboutAxis(0, Math.PI), note: "Y is down; turned to Y up." } : null;
}

function turnWorld(/** @type {Turnable} */ { bones, frames, rotations, translations }, /** @type {number[]} */ turn) {
  const joints = bones.names.length;
  const all = [
    { turned: bones.bindRotations, at: bones.bindTranslations, from: 0 },
    ...Array.from({ length: frames }, (_, i) => ({ turned: rotations, at: translations, from: joints * i })),
  ];
  for (const { turned, at, from } of all)
    for (const [joint, parent] of bones.parents.entries()) {
      if (parent >= 0) continue;
      turned.set(turns(turn, quaternion(turned, from + joint)), 4 * (from + joint));
      at.set(rotate(turn, vector(at, from + joint)), 3 * (from + joint));
    }
}
