// Motion of glTF, GLB, VRM and VRMA files: the skeleton that an animation moves, its frames, and its tracks of expressions.
// References: python/mua/characters/gltf/animation.py; VRMC_vrm_animation-1.0 of https://github.com/vrm-c/vrm-specification.

import { AvatarError } from "../error.js";
import { multiply, normalized, rotate, slerp } from "../rotation.js";
import { Document } from "./gltf_document.js";
import { rolesOf } from "./joint_names.js";
import { WORDS } from "./joint_words.js";
import { localOf } from "./source.js";
import { fromColumns, minus, plus, quaternion, turns, unit, vector } from "./vectors.js";

/** @typedef {import("./gltf_document.js").Json} Json */
/** @typedef {import("./source.js").Motion} Motion */
/** @typedef {{node: number, path: string, width: number, times: Float64Array, values: Float64Array, kind: string}} Track */
/** @typedef {{turned: Float64Array, at: Float64Array, scales: Float64Array}} World nodes in the world: [N, 4], [N, 3] metres, [N, 3] */

const RATE = 30; // frames per second that clips of a file are sampled at
/** @type {Record<string, number>} */
const WIDTHS = { translation: 3, rotation: 4, scale: 3 };
const VRM = ["VRM", "VRMC_vrm", "VRMC_vrm_animation"];

/** The motion of a file. @param {ArrayBuffer} content @param {(uri: string) => Promise<ArrayBuffer>} beside bytes of another file of it @param {string} [animation] its name; the first that moves a joint if left out @returns {Promise<Motion>} */
export async function readGltf(content, beside, animation) {
  const document = await Document.open(content, beside);
  const { tracks, name } = chosen(document, animation);
  const joints = jointsOf(document, tracks);
  const parents = Int32Array.from(joints, (node) => joints.indexOf(document.nearest(document.parents[node], joints)));
  const names = uniqueNames(joints.map((node) => document.nodes[node].name ?? `node${node}`));
  const starts = tracks.map(({ times }) => times[0]);
  const ends = tracks.map(({ times }) => times[times.length - 1]);
  const [start, end] = [Math.min(...starts), Math.max(...ends)];
  const frames = Math.floor((end - start) * RATE + 1e-3) + 1;
  const posed = Array.from({ length: frames }, (_, frame) => {
    const world = worldOf(document, locals(document, tracks, start + frame / RATE));
    return localOf(parents, ...picked(world, joints));
  });
  const bind = localOf(parents, ...bindOf(document, joints));
  const bones = { names, parents, root: 0, bindRotations: bind.rotations, bindTranslations: bind.translations };
  const stated = statedOf(document, joints, names);
  bones.root = rolesOf(bones, stated).hips[0];
  const [rotations, translations] = /** @type {const} */ (["rotations", "translations"]).map((part) => {
    const width = posed[0][part].length;
    const all = new Float64Array(width * frames);
    for (const [frame, pose] of posed.entries()) all.set(pose[part], width * frame);
    return all;
  });
  const times = Array.from({ length: frames }, (_, frame) => start + frame / RATE);
  const expressions = expressionsOf(document, tracks, times);
  return { bones, rate: RATE, frames, rotations, translations, stated, expressions, notes: otherNotes(document, name) };
}

/** The tracks of an animation by name, else of the first that moves a joint. @param {Document} document @param {string | undefined} wanted */
function chosen(document, wanted) {
  /** @type {Json[]} */
  const animations = document.json.animations ?? [];
  const names = animations.map(({ name }, i) => name ?? `animation${i}`);
  const kept = wanted === undefined ? [...names.keys()] : [names.indexOf(wanted)].filter((i) => i >= 0);
  for (const i of kept) {
    const tracks = tracksOf(document, animations[i], `animations[${i}]`);
    if (tracks.some(({ path }) => path === "rotation" || path === "translation")) return { tracks, name: names[i] };
  }
  const listed = names.length ? `, only ${names.join(", ")}` : "";
  throw new AvatarError(
    wanted === undefined
      ? "no animation of it moves a joint."
      : `it has no animation "${wanted}" that moves a joint${listed}.`,
  );
}

/** A sentence on animations that are not taken. @param {Document} document @param {string} name */
function otherNotes(document, name) {
  const count = document.json.animations.length;
  return count > 1 ? [`The file holds ${count} animations; "${name}" is taken, others by the option animation.`] : [];
}

/** @param {Document} document @param {Json} animation @param {string} where @returns {Track[]} */
function tracksOf(document, animation, where) {
  /** @type {Track[]} */
  const tracks = [];
  for (const [c, channel] of (animation.channels ?? []).entries()) {
    const { node, path } = channel.target ?? {};
    if (!document.nodes[node] || !(WIDTHS[path] || path === "weights")) continue;
    const sampler = animation.samplers?.[channel.sampler];
    const at = `${where}.channels[${c}]`;
    if (!sampler) throw document.fault(`${at}.sampler is ${channel.sampler}, expected one of its samplers`);
    const kind = sampler.interpolation ?? "LINEAR";
    const times = document.reals(sampler.input, `${at}: its input`);
    const values = document.reals(sampler.output, `${at}: its output`);
    const keys = times.length * (kind === "CUBICSPLINE" ? 3 : 1);
    const width = WIDTHS[path] ?? values.length / keys;
    if (!times.length || values.length !== keys * width || !Number.isInteger(width))
      throw document.fault(`${at}: its output holds ${values.length} numbers for ${times.length} keys of ${path}`);
    if (times.some((time, i) => i > 0 && !(time > times[i - 1])))
      throw document.fault(`${at}: its input holds times that do not increase`);
    tracks.push({ node, path, width, times, values, kind });
  }
  return tracks;
}

/** The value of a track at a time; glTF 2.0, appendix C. Times outside the keys hold the nearest. @returns {number[]} */
function valueAt(/** @type {Track} */ { path, width, times, values, kind }, /** @type {number} */ time) {
  const last = times.length - 1;
  let key = 0;
  while (key < last && times[key + 1] <= time) key += 1;
  const next = Math.min(key + 1, last);
  const span = times[next] - times[key];
  const t = span > 0 ? Math.min(Math.max((time - times[key]) / span, 0), 1) : 0;
  const cubic = kind === "CUBICSPLINE";
  const part = (/** @type {number} */ one, /** @type {number} */ which) =>
    Array.from(values.subarray((cubic ? 3 * one + which : one) * width, ((cubic ? 3 * one + which : one) + 1) * width));
  if (kind === "STEP") return part(key, 0);
  if (!cubic) {
    const [a, b] = [part(key, 0), part(next, 0)];
    if (path === "rotation") return fromGltf(slerp(normalized(toOurs(a)), normalized(toOurs(b)), t));
    return a.map((value, i) => value + t * (b[i] - value));
  }
  const [value, out, into, after] = [part(key, 1), part(key, 2), part(next, 0), part(next, 1)];
  const [t2, t3] = [t * t, t * t * t];
  return value.map(
    (_, i) =>
      (2 * t3 - 3 * t2 + 1) * value[i] +
      span * (t3 - 2 * t2 + t) * out[i] +
      (3 * t2 - 2 * t3) * after[i] +
      span * (t3 - t2) * into[i],
  );
}

const toOurs = (/** @type {ArrayLike<number>} */ q) => [q[3], q[0], q[1], q[2]];
const fromGltf = (/** @type {ArrayLike<number>} */ q) => [q[1], q[2], q[3], q[0]];

/** What nodes are in their parents at a time, or at rest. @param {Document} document @param {Track[]} tracks @param {number} time */
function locals(document, tracks, time) {
  const found = document.rest.map((node) => ({ ...node }));
  for (const track of tracks) {
    if (!WIDTHS[track.path]) continue;
    const value = valueAt(track, time);
    if (track.path === "rotation") found[track.node].rotation = /** @type {number[]} */ (normalized(toOurs(value)));
    else if (track.path === "scale") found[track.node].scale = value;
    else found[track.node].translation = value;
  }
  return found;
}

/** Nodes in the world; scales along other axes than a joint's own are taken along these. @param {Document} document @param {import("./gltf_document.js").Local[]} nodes @returns {World} */
function worldOf(document, nodes) {
  const [turned, at, scales] = [4, 3, 3].map((width) => new Float64Array(width * nodes.length));
  for (const node of document.order) {
    const { rotation, translation, scale } = nodes[node];
    const parent = document.parents[node];
    const above = parent < 0 ? [1, 0, 0, 0] : quaternion(turned, parent);
    const size = parent < 0 ? [1, 1, 1] : vector(scales, parent);
    const moved = rotate(
      above,
      translation.map((value, axis) => value * size[axis]),
    );
    turned.set(multiply(above, rotation), 4 * node);
    at.set(parent < 0 ? moved : plus(vector(at, parent), moved), 3 * node);
    scales.set(
      scale.map((value, axis) => value * size[axis]),
      3 * node,
    );
  }
  return { turned, at, scales };
}

/** Rotations and places of some nodes. @param {Pick<World, "turned" | "at">} world @param {number[]} joints @returns {[Float64Array, Float64Array]} */
function picked({ turned, at }, joints) {
  return [
    Float64Array.from(joints.flatMap((node) => quaternion(turned, node))),
    Float64Array.from(joints.flatMap((node) => vector(at, node))),
  ];
}

/** The joints, parents first: those of the skins and what an animation moves above them; without skins, all nodes of the tree that is moved most. @param {Document} document @param {Track[]} tracks */
function jointsOf(document, tracks) {
  const moved = [...new Set(tracks.filter(({ path }) => WIDTHS[path]).map(({ node }) => node))];
  const skinned = new Set((document.json.skins ?? []).flatMap((/** @type {Json} */ skin) => skin.joints ?? []));
  const top = (/** @type {number} */ node) => document.upwards(node).at(-1);
  if (skinned.size) {
    const above = new Set([...skinned].flatMap((node) => document.upwards(node)));
    return document.order.filter((node) => skinned.has(node) || (above.has(node) && moved.includes(node)));
  }
  const tops = moved.map(top);
  const count = (/** @type {number | undefined} */ one) => tops.filter((other) => other === one).length;
  const most = tops.toSorted((a, b) => count(b) - count(a))[0];
  return document.order.filter((node) => top(node) === most);
}

/** Joints in the bind pose: as skins bound them, from their topmost joint as it rests; else at rest. @param {Document} document @param {number[]} joints @returns {[Float64Array, Float64Array]} */
function bindOf(document, joints) {
  const world = worldOf(document, document.rest);
  const bound = { turned: Float64Array.from(world.turned), at: Float64Array.from(world.at) };
  for (const [s, skin] of (document.json.skins ?? []).entries()) {
    if (skin.inverseBindMatrices === undefined) continue;
    const matrices = document.reals(skin.inverseBindMatrices, `skins[${s}].inverseBindMatrices`);
    /** @type {number[]} */
    const bones = skin.joints ?? [];
    if (matrices.length < 16 * bones.length)
      throw document.fault(`skins[${s}].inverseBindMatrices holds too few matrices for ${bones.length} joints`);
    const top = /** @type {number} */ (document.order.find((node) => bones.includes(node)));
    const first = affine(matrices, bones.indexOf(top));
    const [turn, place, scale] = [quaternion(world.turned, top), vector(world.at, top), vector(world.scales, top)];
    for (const [i, node] of bones.entries()) {
      const { columns, offset } = relative(first, affine(matrices, i));
      const [x, y, z] = columns.map(unit);
      bound.turned.set(turns(turn, fromColumns([x, y, z])), 4 * node);
      const moved = rotate(
        turn,
        offset.map((value, axis) => value * scale[axis]),
      );
      bound.at.set(plus(place, moved), 3 * node);
    }
  }
  return picked(bound, joints);
}

/** @typedef {{columns: number[][], offset: number[]}} Affine */

/** @returns {Affine} */
function affine(/** @type {Float64Array} */ matrices, /** @type {number} */ at) {
  const column = (/** @type {number} */ i) => Array.from(matrices.subarray(16 * at + 4 * i, 16 * at + 4 * i + 3));
  return { columns: [0, 1, 2].map(column), offset: column(3) };
}

/** The product of a matrix and the inverse of another, whose columns are square to each other. @param {Affine} a @param {Affine} b @returns {Affine} */
function relative(a, b) {
  const sizes = b.columns.map((column) => column.reduce((sum, value) => sum + value * value, 0));
  const inverse = (/** @type {number[]} */ v) =>
    b.columns.map((column, i) => column.reduce((sum, value, axis) => sum + value * v[axis], 0) / sizes[i]);
  const apply = (/** @type {number[]} */ v) =>
    [0, 1, 2].map((axis) => v.reduce((sum, value, i) => sum + value * a.columns[i][axis], 0));
  const columns = [0, 1, 2].map((axis) => apply(inverse([0, 1, 2].map((i) => Number(i === axis)))));
  return { columns, offset: minus(a.offset, apply(inverse(b.offset))) };
}

/** The body part of each joint that a VRM file states. @param {Document} document @param {number[]} joints @param {string[]} names */
function statedOf({ json }, joints, names) {
  /** @type {Record<string, string>} */
  const stated = {};
  for (const extension of VRM) {
    const bones = json.extensions?.[extension]?.humanoid?.humanBones ?? {};
    const entries = Array.isArray(bones) ? bones.map((entry) => [entry.bone, entry]) : Object.entries(bones);
    for (const [bone, entry] of entries) {
      const joint = joints.indexOf(entry?.node);
      if (joint >= 0 && Object.hasOwn(WORDS.humanoid, bone)) stated[names[joint]] = WORDS.humanoid[bone];
    }
  }
  return stated;
}

/** The names, with a number after each that an earlier one took. */
function uniqueNames(/** @type {string[]} */ names) {
  return names.map((name, i) => {
    const before = names.slice(0, i).filter((other) => other === name).length;
    return before ? `${name}_${before + 1}` : name;
  });
}

/** Weights of VRM's gaze that looks where a track turns +Z: 1 at 90 degrees. Reference: python/mua/characters/gltf/vrm_look.py. @param {Track} track @param {number} time @returns {Record<string, number>} */
function gazeAt(track, time) {
  const [x, y, z] = rotate(normalized(toOurs(valueAt(track, time))), [0, 0, 1]);
  const [left, down] = [Math.atan2(x, z), Math.asin(Math.min(Math.max(-y, -1), 1))];
  const shares = Object.entries({ lookLeft: left, lookRight: -left, lookDown: down, lookUp: -down });
  return Object.fromEntries(shares.map(([name, angle]) => [name, Math.min(Math.max(angle / (Math.PI / 2), 0), 1)]));
}

/** The expressions of a morph target, with its value at weight 1: two for a coefficient of SMPL-X. Reference: python/mua/pose/signed_expressions.py. @param {string} name @returns {[string, number][]} */
function pairOf(name) {
  const [, coefficient] = /^(?:.*\.)?(Exp\d{3})$/.exec(name) ?? [];
  if (!coefficient) return [[name, 1]];
  return [
    [`${coefficient}+`, 5],
    [`${coefficient}-`, -5],
  ];
}

/** Weights of expressions: of VRMA the place along x of each one's node and the turn of its gaze, of meshes those of morph targets that have names. @param {Document} document @param {Track[]} tracks @param {number[]} times @returns {import("./source.js").Expressions} */
function expressionsOf(document, tracks, times) {
  /** @type {Map<string, (time: number) => number>} */
  const found = new Map();
  const { expressions, lookAt } = document.json.extensions?.VRMC_vrm_animation ?? {};
  const { preset = {}, custom = {} } = expressions ?? {};
  for (const [name, entry] of Object.entries({ ...preset, ...custom })) {
    const track = tracks.find(({ node, path }) => node === entry?.node && path === "translation");
    if (track) found.set(name, (time) => valueAt(track, time)[0]);
  }
  const looking = tracks.find(({ node, path }) => node === lookAt?.node && path === "rotation");
  if (looking)
    for (const name of Object.keys(gazeAt(looking, 0)))
      if (!found.has(name)) found.set(name, (time) => gazeAt(looking, time)[name]);
  for (const track of tracks) {
    if (track.path !== "weights") continue;
    const mesh = document.json.meshes?.[document.nodes[track.node].mesh];
    for (const [i, name] of (mesh?.extras?.targetNames ?? []).entries())
      for (const [own, unit] of i < track.width ? pairOf(name) : [])
        if (!found.has(own)) found.set(own, (time) => valueAt(track, time)[i] / unit);
  }
  const weights = times.flatMap((time) => Array.from(found.values(), (weight) => weight(time)));
  return { names: [...found.keys()], weights: Float32Array.from(weights) };
}
