// A body's place: the path of its hips, scaled to its legs, with feet on the floor. References: python/mua/motion/floor.py,
// contacts.py and detached.py, which say what is done and why.

import { conjugate, multiply, rotate } from "../rotation.js";
import { world } from "../skeleton.js";
import { ancestors, SIDES } from "./joint_names.js";
import { bodyTurn } from "./rest.js";
import { length, mean, minus, plus, quantile, quaternion, times, turns, vector } from "./vectors.js";

/** @typedef {import("./vectors.js").Vector} Vector */
/** @typedef {import("./rest.js").Rest} Rest */
/** @typedef {import("../skeleton.js").Pose} Pose */
/** @typedef {ReturnType<typeof world>} Posed joints in the world */

const GOING = 0.2; // legs per second of the hips above standing feet from which these show how far a step carries
const LIKELY = 1.5; // times the ratio of the legs: paces beyond it come from feet that do not stand
const LOWEST = 0.25; // of the leg: a clip higher above the floor than this never stands and stays where it is
const LOW = 0.06; // of the leg: how far above its lowest a standing point may be
const SLOW = 0.35; // legs per second along the floor: faster points do not stand
const ON_FLOOR = 0.1; // of the height: a rest pose whose lowest joint is this near to 0 stands on the floor
const UNDER = 0.25; // of the height: how far below its lowest joint the soles of a figure without toes may be
const STANDING = 0.05; // quantile over frames of a point's height that counts as standing
const SHORTEST = 0.1; // seconds: a shorter contact is a passing foot
const SOLES = ["foot", "toe"];
const CARRIED_BY = [
  ["spine", "hips"],
  ...[
    ["forearm", "upper_arm"],
    ["hand", "forearm"],
    ["shin", "thigh"],
    ["foot", "shin"],
  ].flatMap(([part, limb]) => SIDES.map((side) => [`${side} ${part}`, `${side} ${limb}`])),
];

/** Let poses of the target, their hips still in place, go along the source's path. @param {Rest} rest @param {Pose[]} poses @param {Posed[]} source @param {number} rate frames per second */
export function place(rest, poses, source, rate) {
  const { scale, leg } = legScale(rest);
  const hips = hipJoints(rest);
  if (!hips.length) return;
  const standing = poses.map((pose) => world(rest.target, attach(rest, copyOf(pose))).places);
  const froms = hips.map((joint) => rest.chain(joint)[0]);
  const path = source.map(({ places }) => middleOf(places, froms));
  const pace = paceOf(rest, standing, source, { path, hips, rate, scale, leg });
  for (const [frame, pose] of poses.entries()) {
    const to = path[frame].map((value, axis) => value * (axis === 1 ? scale : pace));
    move(rest, pose, minus(to, middleOf(standing[frame], hips)));
  }
  const placed = poses.map((pose) => world(rest.target, attach(rest, copyOf(pose))));
  const lift = footed(rest) ? liftOf(rest, placed, source, { rate, scale, leg }) : liftOfLegs(rest, placed);
  for (const pose of poses) {
    move(rest, pose, [0, lift, 0]);
    attach(rest, pose);
  }
}

/** Let one pose of the target stand where the source does, at rest where it rests: without knowing what comes. @param {Rest} rest @param {Pose} pose @param {Posed} source */
export function placeOne(rest, pose, source) {
  const hips = hipJoints(rest);
  const froms = hips.map((joint) => rest.chain(joint)[0]);
  if (hips.length) {
    const gone = times(minus(middleOf(source.places, froms), middleOf(rest.sourceAt, froms)), legScale(rest).scale);
    const at = middleOf(world(rest.target, attach(rest, copyOf(pose))).places, hips);
    move(rest, pose, minus(plus(middleOf(rest.targetAt, hips), gone), at));
  }
  attach(rest, pose);
}

const copyOf = (/** @type {Pose} */ pose) => ({ ...pose, translations: Float64Array.from(pose.translations) });
const middleOf = (/** @type {Float64Array} */ at, /** @type {number[]} */ joints) =>
  mean(joints.map((joint) => vector(at, joint)));

/** Both hip joints, else the hips. */
function hipJoints(/** @type {Rest} */ rest) {
  const legs = SIDES.map((side) => rest.joint(`${side} thigh`)).filter((joint) => joint >= 0);
  return legs.length === 2 ? legs : [rest.joint("hips")].filter((joint) => joint >= 0);
}

const footed = (/** @type {Rest} */ rest) =>
  SIDES.some((side) => SOLES.some((part) => rest.joint(`${side} ${part}`) >= 0));

/** Move the joint that carries the whole body, its root or hips above it, so far in the world. @param {Rest} rest @param {Pose} pose @param {Vector} shift */
function move(rest, pose, shift) {
  const { root } = rest.target;
  const { hips, spine = [] } = rest.matches.roles;
  const above = ancestors(rest.target, root);
  const mover = [...hips, ...spine].reduce((top, joint) => (above.includes(joint) ? Math.min(top, joint) : top), root);
  const parent = rest.target.parents[mover];
  const local = parent < 0 ? shift : rotate(conjugate(quaternion(world(rest.target, pose).rotations, parent)), shift);
  for (let axis = 0; axis < 3; axis++) pose.translations[3 * mover + axis] += local[axis];
}

/** Put joints that do not hang on what carries them in a body where that ends: hands and feet of rigs for IK. @param {Rest} rest @param {Pose} pose */
function attach(rest, pose) {
  rest.attached ??= attachments(rest);
  for (const [joint, limb] of rest.attached) {
    const { rotations, places } = world(rest.target, pose);
    const since = turns(quaternion(rotations, limb), conjugate(quaternion(rest.targetTurned, limb)));
    const offset = rotate(since, minus(vector(rest.targetAt, joint), vector(rest.targetAt, limb)));
    let wanted = plus(vector(places, limb), offset);
    const parent = rest.target.parents[joint];
    if (parent >= 0) wanted = rotate(conjugate(quaternion(rotations, parent)), minus(wanted, vector(places, parent)));
    pose.translations.set(wanted, 3 * joint);
  }
  return pose;
}

/** Joints of the target, each with the limb that carries it in a body though it does not hang on it. */
function attachments(/** @type {Rest} */ rest) {
  const pairs = [...CARRIED_BY.map((roles) => roles.map((role) => rest.joint(role))), ...detached(rest)];
  const above = (/** @type {number} */ joint) => ancestors(rest.target, joint);
  return pairs.filter(
    ([joint, limb]) => joint >= 0 && limb >= 0 && !above(joint).includes(limb) && !above(limb).includes(joint),
  );
}

/** The topmost joints of the target that nothing moves and that hang on no moved joint, each with the joint of the trunk nearest to it. @returns {[number, number][]} */
export function detached(/** @type {Rest} */ { target, targetAt, matches: { chains, roles } }) {
  const trunk = ["hips", "spine"].flatMap((role) => roles[role] ?? []).filter((joint) => chains.has(joint));
  if (!trunk.length) return [];
  const carrying = new Set([...chains.keys()].flatMap((joint) => ancestors(target, joint)));
  return Array.from(target.parents.keys()).flatMap((joint) => {
    const parent = target.parents[joint];
    const moved = chains.has(joint) || carrying.has(joint) || !carrying.has(parent);
    if (moved || [parent, ...ancestors(target, parent)].some((above) => chains.has(above))) return [];
    const apart = trunk.map((one) => length(minus(vector(targetAt, one), vector(targetAt, joint))));
    return [[joint, trunk[apart.indexOf(Math.min(...apart))]]];
  });
}

/** Target size over source size, and the target's leg in metres: by the legs, else by all matched bones. */
function legScale(/** @type {Rest} */ rest) {
  let lengths = [0, 0];
  for (const side of SIDES) {
    const chain = ["thigh", "shin", "foot"].map((part) => rest.places(`${side} ${part}`));
    if (chain.every((both) => both !== null))
      lengths = lengths.map(
        (sum, i) => sum + length(minus(chain[1][i], chain[0][i])) + length(minus(chain[2][i], chain[1][i])),
      );
  }
  if (!lengths.every(Boolean)) lengths = allBones(rest);
  return lengths.every(Boolean) ? { scale: lengths[0] / lengths[1], leg: lengths[0] / 2 } : { scale: 1, leg: 1 };
}

function allBones(/** @type {Rest} */ { target, targetAt, sourceAt, matches: { chains } }) {
  const total = [0, 0];
  for (const [joint, [first]] of chains) {
    const parent = target.parents[joint];
    const above = chains.get(parent);
    if (!above) continue;
    total[0] += length(minus(vector(targetAt, joint), vector(targetAt, parent)));
    total[1] += length(minus(vector(sourceAt, first), vector(sourceAt, above[0])));
  }
  return total;
}

/** How much farther along the floor the target's hips go than the source's, so that standing feet stand. @param {Rest} rest @param {Float64Array[]} standing [T, 3] by frame @param {Posed[]} source @param {{path: Vector[], hips: number[], rate: number, scale: number, leg: number}} of */
function paceOf(rest, standing, source, { path, hips, rate, scale, leg }) {
  const soles = SIDES.flatMap((side) => SOLES.map((part) => rest.begins(`${side} ${part}`))).filter(
    (pair) => pair !== null,
  );
  if (!soles.length || source.length < 2) return scale;
  let [count, squares, products] = [0, 0, 0];
  for (const [joint, from] of soles) {
    const points = source.map(({ places }) => vector(places, from));
    const theirs = gradient(points.map((point, frame) => minus(point, path[frame])));
    const ours = gradient(standing.map((at) => minus(vector(at, joint), middleOf(at, hips))));
    for (const [frame, stands] of planted(points, rate, leg / scale).entries()) {
      if (!stands) continue;
      count += 1;
      for (const axis of [0, 2]) {
        squares += theirs[frame][axis] ** 2;
        products += theirs[frame][axis] * ours[frame][axis];
      }
    }
  }
  if (squares <= count * ((GOING * leg) / scale / rate) ** 2) return scale;
  const pace = products / squares;
  return pace > scale / LIKELY && pace < scale * LIKELY ? pace : scale;
}

/** Whether a point stands, frame by frame: low, slow and not for a moment alone. @param {Vector[]} points @param {number} rate @param {number} leg */
function planted(points, rate, leg) {
  const lowest = quantile(
    points.map((point) => point[1]),
    STANDING,
  );
  const steps = points.length > 1 ? gradient(points) : points.map(() => [0, 0, 0]);
  const stands = points.map(
    (point, frame) => point[1] - lowest < LOW * leg && Math.hypot(steps[frame][0], steps[frame][2]) * rate < SLOW * leg,
  );
  for (let begin = 0, end = 0; begin < stands.length; begin = end) {
    for (end = begin + 1; end < stands.length && stands[end] === stands[begin]; ) end += 1;
    if (end - begin < SHORTEST * rate) stands.fill(false, begin, end);
  }
  return stands;
}

/** The change of vectors from frame to frame: central differences, at both ends one-sided. @returns {Vector[]} */
function gradient(/** @type {Vector[]} */ points) {
  const last = points.length - 1;
  return points.map((_, frame) => {
    const [from, to] = [Math.max(frame - 1, 0), Math.min(frame + 1, last)];
    return times(minus(points[to], points[from]), 1 / (to - from));
  });
}

/** Metres by which to raise the target so that standing feet are as high as the source's. @param {Rest} rest @param {Posed[]} placed @param {Posed[]} source @param {{rate: number, scale: number, leg: number}} of */
function liftOf(rest, placed, source, { rate, scale, leg }) {
  const soles = SIDES.flatMap((side) => SOLES.map((part) => rest.joint(`${side} ${part}`))).filter(
    (joint) => joint >= 0,
  );
  const froms = soles.map((joint) => rest.chain(joint)[0]);
  const height = standingHeight(placed, rest.targetAt, soles) + floorOf(rest.targetAt, UNDER);
  const upright = standingUp(rest);
  const rise = scale * standingHeight(source, upright, froms);
  let expected = 0;
  if (floorOf(upright) === 0 || Math.abs(rise) < LOWEST * leg) {
    if (rise >= -LOWEST * leg) expected = rise; // below: a path that starts at the origin, not on the floor
  } else if (height > LOWEST * leg) {
    const lower = placed.map(({ places }) =>
      Math.min(...soles.map((j) => places[3 * j + 1] - rest.targetAt[3 * j + 1])),
    );
    const level = quantile(lower, 0.5) - quantile(lower, STANDING) < LOW * leg;
    expected = level && steps(placed, soles, rate, leg) ? 0 : height;
  }
  return expected - height;
}

/** Places of the source at rest, stood upright where it lies: files that turn only the root to another up axis. */
function standingUp(/** @type {Rest} */ rest) {
  const [turn, places] = [conjugate(bodyTurn(rest)), new Float64Array(rest.sourceAt.length)];
  for (let at = 0; at < places.length; at += 3) places.set(rotate(turn, rest.sourceAt, 0, at), at);
  return places;
}

/** Whether some joint stands at times and moves at others. @param {Posed[]} placed @param {number[]} joints @param {number} rate @param {number} leg */
function steps(placed, joints, rate, leg) {
  return joints.some((joint) => {
    const stands = planted(
      placed.map(({ places }) => vector(places, joint)),
      rate,
      leg,
    );
    return stands.includes(true) && stands.includes(false);
  });
}

/** How high above their places at rest feet stand: the lower foot's in the lowest frames. @param {Posed[]} posed @param {Float64Array} rest @param {number[]} joints */
function standingHeight(posed, rest, joints) {
  return quantile(
    posed.map(({ places }) => Math.min(...joints.map((joint) => places[3 * joint + 1] - rest[3 * joint + 1]))),
    STANDING,
  );
}

/** Height of the floor that a rest pose stands on: 0 where its lowest joint is near to it. */
function floorOf(/** @type {Float64Array} */ at, under = ON_FLOOR) {
  const heights = Array.from(at).filter((_, i) => i % 3 === 1);
  const [low, high] = [Math.min(...heights), Math.max(...heights)];
  return low > -ON_FLOOR * (high - low) && low < under * (high - low) ? 0 : low;
}

/** The same for a target without feet: its legs end on the floor, straight below them at rest. @param {Rest} rest @param {Posed[]} placed */
function liftOfLegs(rest, placed) {
  const floor = Math.min(floorOf(rest.targetAt), 0);
  const legs = SIDES.map(
    (side) => ["shin", "thigh"].map((part) => rest.joint(`${side} ${part}`)).find((j) => j >= 0) ?? -1,
  );
  const known = legs.filter((joint) => joint >= 0);
  if (!known.length) return 0;
  const lows = placed.map(({ rotations, places }) =>
    Math.min(
      ...known.map((joint) => {
        const since = multiply(rotations, conjugate(rest.targetTurned, 4 * joint), 4 * joint);
        return places[3 * joint + 1] + rotate(since, [0, floor - rest.targetAt[3 * joint + 1], 0])[1];
      }),
    ),
  );
  return floor - quantile(lows, STANDING);
}
