// Motion of one skeleton on another, by what every bone does in the world. Reference: python/mua/motion/retarget.py, of motion
// whose rest pose shows a body; feet are not held in place.

import { framesAt, sample } from "../clip.js";
import { headingOf } from "../descriptor.js";
import { AvatarError } from "../error.js";
import { conjugate, multiply, normalized, rotate } from "../rotation.js";
import { world } from "../skeleton.js";
import { stands, trunkOf } from "./body.js";
import { detached, place, placeOne } from "./floor.js";
import { matchJoints } from "./match.js";
import { bodyTurn, calibrations, Rest } from "./rest.js";
import { localOf } from "./source.js";
import { degrees, IDENTITY, quantile, quaternion, turns } from "./vectors.js";

/** @typedef {import("./source.js").Bones} Bones */
/** @typedef {import("./source.js").Motion} Motion */
/** @typedef {import("../format/read.js").Avatar} Avatar */
/** @typedef {import("../clip.js").Clip} Clip */
/** @typedef {import("../skeleton.js").Pose} Pose */
/** @typedef {ReturnType<typeof world>} Posed */

const SAME = 1e-4; // metres by which joints of one and the same skeleton may lie apart
const TURNED = 45; // degrees between where hips or chest are and where their joint's turn since rest would have them
const NO_BODY =
  "its rest pose shows no body that stands, so that a page cannot tell how its joints lie; bake the clip into the avatar (mua-bake --motion).";

/** A clip of an avatar, at the avatar's own rate, and notes worth telling. @param {Motion} motion @param {Avatar} avatar @param {Record<string, string>} mapping joint of the avatar to joint of the motion @param {typeof import("../names/match.js") | null} names fetched where both have expressions @returns {{clip: Omit<Clip, "name">, notes: string[]}} */
export function retarget(motion, { skeleton, encoding, expressions }, mapping, names) {
  const { rate } = encoding;
  const poses = sampled(motion, rate);
  const weights = names ? weightsOf(motion, expressions, poses.length, rate, names) : undefined;
  if (sameJoints(motion.bones, skeleton)) return { clip: clipOf(skeleton, poses, rate, weights), notes: motion.notes };
  const matches = matchJoints(motion.bones, skeleton, mapping, motion.stated);
  const rest = new Rest(motion.bones, skeleton, matches);
  const source = poses.map((pose) => world(motion.bones, pose));
  if (!stands(rest.sourcePlaces()) || turnedOtherwise(rest, source)) throw new AvatarError(NO_BODY);
  const follow = follower(rest);
  const found = source.map(follow.turned);
  place(rest, found, source.map(follow.faced), rate);
  return { clip: clipOf(skeleton, found, rate, weights), notes: [...motion.notes, ...leftOut(rest)] };
}

/** What turns poses of one skeleton, in the world, into those of an avatar, as they come. @param {Bones} bones @param {Avatar} avatar @param {Record<string, string>} mapping @returns {(turned: ArrayLike<number>, at: ArrayLike<number>) => Pose} */
export function retargeter(bones, { skeleton }, mapping) {
  const rest = new Rest(bones, skeleton, matchJoints(bones, skeleton, mapping, {}));
  if (!stands(rest.sourcePlaces())) throw new AvatarError(`The skeleton cannot be followed: ${NO_BODY}`);
  const follow = follower(rest);
  return (turned, at) => {
    const source = { rotations: Float64Array.from(turned), places: Float64Array.from(at) };
    const pose = follow.turned(source);
    placeOne(rest, pose, follow.faced(source));
    return pose;
  };
}

/** The poses of a motion at another rate. @param {Motion} motion @param {number} rate @returns {Pose[]} */
function sampled(motion, rate) {
  const translated = Int32Array.from(motion.bones.names.keys());
  const clip = {
    ...motion,
    name: "",
    translation: new Float64Array(3 * motion.frames),
    translated,
    expressions: undefined,
  };
  const bones = { ...motion.bones, translated };
  return Array.from({ length: framesAt(clip, rate) }, (_, frame) => sample(bones, clip, frame, rate));
}

/** Whether motion on one skeleton is motion on the other as it stands. */
function sameJoints(/** @type {Bones} */ a, /** @type {Bones} */ b) {
  const equal = (/** @type {ArrayLike<string | number>} */ one, /** @type {ArrayLike<string | number>} */ other) =>
    one.length === other.length && Array.from(one).every((value, i) => value === other[i]);
  if (!equal(a.names, b.names) || !equal(a.parents, b.parents) || a.root !== b.root) return false;
  return a.bindTranslations.every((value, i) => Math.abs(value - b.bindTranslations[i]) < SAME);
}

/** What turns the target as the source is turned, its hips still in place. */
function follower(/** @type {Rest} */ rest) {
  const { target, targetTurned } = rest;
  const upright = bodyTurn(rest);
  const facing = conjugate(headingOf(upright)); // from where the source faces to where the target does
  const bound = calibrations(rest, upright);
  const carried = detached(rest);
  for (const [joint, turn] of bound) bound.set(joint, turns(turn, quaternion(targetTurned, joint)));
  const turned = (/** @type {Posed} */ source) => {
    const world = new Float64Array(4 * target.names.length);
    for (const [joint, parent] of target.parents.entries()) {
      const turn = bound.get(joint);
      const above = parent < 0 ? IDENTITY : quaternion(world, parent);
      const moved = turn
        ? turns(facing, quaternion(source.rotations, rest.chain(joint)[1]), turn)
        : multiply(above, target.bindRotations, 0, 4 * joint);
      world.set(moved, 4 * joint);
    }
    const { rotations } = localOf(target.parents, world, new Float64Array(3 * target.names.length));
    for (const [joint, carrier] of carried) {
      const since = turns(quaternion(world, carrier), conjugate(quaternion(targetTurned, carrier)));
      const above = quaternion(world, target.parents[joint]);
      rotations.set(turns(conjugate(above), since, quaternion(targetTurned, joint)), 4 * joint);
    }
    for (let at = 0; at < rotations.length; at += 4) normalized(rotations, at);
    return { rotations, translations: Float64Array.from(target.bindTranslations) };
  };
  const faced = (/** @type {Posed} */ { rotations, places }) => {
    const moved = new Float64Array(places.length);
    for (let at = 0; at < places.length; at += 3) moved.set(rotate(facing, places, 0, at), at);
    return { rotations, places: moved };
  };
  return { turned, faced };
}

/** Whether hips or chest of the source do not turn with their joint from where the rest pose has them. @param {Rest} rest @param {Posed[]} source */
function turnedOtherwise(rest, source) {
  const trunk = trunkOf(rest.sourcePlaces());
  const chest = rest.matches.roles.spine?.at(-1) ?? -1;
  if (!trunk) return false;
  const hips = rest.begins("hips")?.[1] ?? -1;
  const joints = { hips, chest: rest.matches.chains.has(chest) ? rest.chain(chest)[1] : -1 };
  return /** @type {const} */ (["hips", "chest"]).some((part) => {
    const joint = joints[part];
    const apart = source.flatMap(({ rotations, places }) => {
      const seen = trunkOf(rest.sourcePlaces(places));
      if (joint < 0 || !seen) return [];
      const since = turns(quaternion(rotations, joint), conjugate(quaternion(rest.sourceTurned, joint)));
      return [degrees(rotate(since, trunk[part]), seen[part])];
    });
    return apart.length > 0 && quantile(apart, 0.5) > TURNED;
  });
}

/** Weights [F, E] of an avatar's expressions, in frames of another rate; none where the motion moves none of them. @param {Motion} motion @param {string[]} names @param {number} frames @param {number} rate @param {typeof import("../names/match.js")} matching */
function weightsOf(motion, names, frames, rate, { matchExpressions, weighted }) {
  const { expressions } = motion;
  const width = expressions.names.length;
  const matrix = matchExpressions(names, expressions.names);
  const left = expressions.names.filter((_, i) => !names.some((_, row) => matrix[row * width + i])).length;
  if (left) motion.notes.push(`${left} of the motion's ${width} expressions move none of the avatar's.`);
  if (left === width) return undefined;
  const found = new Float32Array(frames * names.length);
  for (let frame = 0; frame < frames; frame++) {
    const at = Math.min(frame * (motion.rate / rate), motion.frames - 1);
    const before = Math.floor(at);
    const after = Math.min(before + 1, motion.frames - 1);
    const [a, b] = [before, after].map((one) =>
      weighted(matrix, expressions.weights.subarray(one * width, (one + 1) * width)),
    );
    for (const [i, weight] of a.entries()) found[frame * names.length + i] = weight + (at - before) * (b[i] - weight);
  }
  return found;
}

/** @param {Bones} bones @param {Pose[]} poses @param {number} rate @param {Float32Array | undefined} expressions @returns {Omit<Clip, "name">} */
function clipOf(bones, poses, rate, expressions) {
  const joints = bones.names.length;
  const [rotations, translations] = [4, 3].map((width) => new Float32Array(width * joints * poses.length));
  for (const [frame, pose] of poses.entries()) {
    rotations.set(pose.rotations, 4 * joints * frame);
    translations.set(pose.translations, 3 * joints * frame);
  }
  const translation = new Float32Array(3 * poses.length); // that of the root is among the others
  const translated = Int32Array.from(bones.names.keys());
  return { rate, frames: poses.length, rotations, translation, translations, translated, expressions };
}

/** @returns {string[]} */
function leftOut(/** @type {Rest} */ { target, matches: { chains } }) {
  const count = target.names.length;
  const left = count - chains.size;
  return left ? [`${left} of ${count} joints match no joint of the motion and keep their bind rotation.`] : [];
}
