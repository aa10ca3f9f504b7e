// Two skeletons at rest, and how each joint of one lies in the joint that moves it by what both rest poses show. Reference:
// python/mua/motion/rest_alignment.py, which says what is done and why.

import { conjugate, rotate } from "../rotation.js";
import { world } from "../skeleton.js";
import { SIDES } from "./joint_names.js";
import {
  between,
  cross,
  dot,
  fromColumns,
  IDENTITY,
  length,
  middle,
  minus,
  nearestAxis,
  quaternion,
  turns,
  unit,
  vector,
  Y,
} from "./vectors.js";

/** @typedef {import("./vectors.js").Vector} Vector */
/** @typedef {import("./vectors.js").Quaternion} Quaternion */
/** @typedef {import("./source.js").Bones} Bones */
/** @typedef {[Vector, Vector]} Both on target and source */

/** @type {Record<string, string>} */
const LIMBS = { upper_arm: "forearm", forearm: "hand", thigh: "shin", shin: "foot" }; // bones aligned: where they end
const CLEARLY = 10; // times nearer to the shin's plane than to the vertical one: a foot that rolls with its leg

export const bindOf = (/** @type {Bones} */ { bindRotations, bindTranslations }) => ({
  rotations: bindRotations,
  translations: bindTranslations,
});

/** Both skeletons at rest in the world, and which source joints move which target joints. */
export class Rest {
  constructor(
    /** @type {Bones} */ source,
    /** @type {Bones} */ target,
    /** @type {import("./match.js").Matches} */ matches,
  ) {
    this.source = source;
    this.target = target;
    this.matches = matches;
    const [from, to] = [source, target].map((bones) => world(bones, bindOf(bones)));
    this.sourceTurned = from.rotations; // [S, 4]
    this.targetTurned = to.rotations; // [T, 4]
    this.sourceAt = from.places; // [S, 3] metres
    this.targetAt = to.places; // [T, 3] metres
    /** @type {number[][] | null} */
    this.attached = null; // joints that hang on nothing that carries them in a body, as floor.js finds them
  }

  /** The first matched target joint of a role; -1 for none. */
  joint(/** @type {string} */ role) {
    return this.matches.roles[role]?.find((joint) => this.matches.chains.has(joint)) ?? -1;
  }

  /** The source joints that move a target joint. */
  chain(/** @type {number} */ joint) {
    return /** @type {[number, number]} */ (this.matches.chains.get(joint));
  }

  /** The target and the source joint where a role begins. @returns {[number, number] | null} */
  begins(/** @type {string} */ role) {
    const joint = this.joint(role);
    return joint < 0 ? null : [joint, this.chain(joint)[0]];
  }

  /** Where joints of both are. @param {[number, number] | null} joints @returns {Both | null} */
  both(joints) {
    return joints && [vector(this.targetAt, joints[0]), vector(this.sourceAt, joints[1])];
  }

  places(/** @type {string} */ role) {
    return this.both(this.begins(role));
  }

  /** Where the matched roles begin on the source, by places [S, 3] of its joints. */
  sourcePlaces(/** @type {Float64Array} */ at = this.sourceAt) {
    const found = Object.keys(this.matches.roles).map((role) => /** @type {const} */ ([role, this.begins(role)]));
    return Object.fromEntries(found.flatMap(([role, joints]) => (joints ? [[role, vector(at, joints[1])]] : [])));
  }

  /** The joints of both where a bone ends: those of role `end`, else where its chain goes on. @returns {[number, number] | null} */
  ends(/** @type {string} */ role, /** @type {string} */ end) {
    const { roles, sourceRoles } = this.matches;
    const target = next(this.target, this.targetAt, roles, role, end);
    const source = next(this.source, this.sourceAt, sourceRoles, role, end);
    return this.begins(end) ?? (target === undefined || source === undefined ? null : [target, source]);
  }

  /** Two roles of left and right, from which `made` makes something for both. @param {string} part @param {(left: Vector, right: Vector) => Vector} made @returns {Both | null} */
  sides(part, made) {
    const [left, right] = SIDES.map((side) => this.places(`${side} ${part}`));
    return left && right && [made(left[0], right[0]), made(left[1], right[1])];
  }
}

/** The joint of role `end`; where there is none, as in arms that end in fingers, the next of the longest chain. @param {Bones} bones @param {Float64Array} at @param {import("./match.js").Roles} roles @param {string} role @param {string} end @returns {number | undefined} */
function next(bones, at, roles, role, end) {
  if (roles[end] || !roles[role]) return roles[end]?.[0];
  return longestTail(bones, at, /** @type {number} */ (roles[role].at(-1)))[1];
}

/** The chain of joints from one on that is longest along its bones. @param {Bones} bones @param {Float64Array} at @param {number} joint @returns {number[]} */
function longestTail(bones, at, joint) {
  const far = (/** @type {number[]} */ tail) =>
    tail.reduce((sum, one, i) => sum + length(minus(vector(at, one), vector(at, i ? tail[i - 1] : joint))), 0);
  let longest = /** @type {number[]} */ ([]);
  for (const child of childrenOf(bones, joint)) {
    const tail = longestTail(bones, at, child);
    if (!longest.length || far(tail) > far(longest)) longest = tail;
  }
  return [joint, ...longest];
}

export function childrenOf(/** @type {Bones} */ { parents }, /** @type {number} */ joint) {
  return Array.from(parents.keys()).filter((one) => parents[one] === joint);
}

/** The rotation from the target's bind to the source's rest pose as whole bodies; none where it is unknown. @returns {Quaternion} */
export function bodyTurn(/** @type {Rest} */ rest) {
  const top = rest.places("head") ?? rest.places("neck") ?? rest.places("spine");
  const bottom = rest.sides("thigh", middle) ?? rest.places("hips");
  const across = rest.sides("thigh", minus) ?? rest.sides("upper_arm", minus) ?? rest.sides("shoulder", minus);
  if (!top || !bottom || !across) return IDENTITY;
  const ups = [0, 1].map((i) => nearestAxis(minus(top[i], bottom[i])));
  if (!ups.every((up, i) => length(cross(across[i], up)))) return IDENTITY;
  const [target, source] = ups.map((up, i) => {
    const forward = unit(cross(across[i], up));
    return fromColumns([cross(up, forward), up, forward]);
  });
  return turns(source, conjugate(target));
}

/** By matched target joint, the rotation from the target's bind world to the space of the source joint that moves it. @param {Rest} rest @param {Quaternion} upright as `bodyTurn` gives it @returns {Map<number, Quaternion>} */
export function calibrations(rest, upright) {
  const found = new Map();
  for (const [joint, turn] of alignments(rest, upright))
    found.set(joint, turns(conjugate(quaternion(rest.sourceTurned, rest.chain(joint)[1])), turn));
  return found;
}

/** What brings each matched target joint from bind to the source's rest, from the root outwards: each starts from that of the joint above. @param {Rest} rest @param {Quaternion} upright */
function alignments(rest, upright) {
  const { chains, roles } = rest.matches;
  /** @type {Map<number, Quaternion>} */
  const found = new Map();
  const parts = new Map(Object.entries(roles).flatMap(([role, joints]) => joints.map((joint) => [joint, role])));
  for (const joint of [...chains.keys()].toSorted((a, b) => a - b)) {
    let above = rest.target.parents[joint];
    while (above >= 0 && !found.has(above)) above = rest.target.parents[above];
    const base = found.get(above) ?? upright;
    const role = parts.get(joint) ?? "";
    const [side, part] = role.includes(" ") ? role.split(" ") : ["", role];
    let turn = base;
    if (part === "foot") turn = soleAlignment(rest, side, upright) ?? base;
    else if (part === "hand" && joint === rest.joint(role)) turn = palmAlignment(rest, side) ?? base;
    else if (LIMBS[part]) turn = boneAlignment(rest, role, `${side} ${LIMBS[part]}`, base) ?? base;
    found.set(joint, turn);
  }
  return found;
}

/** `base`, then the shortest rotation that lays the target's bone along the source's. @param {Rest} rest @param {string} role @param {string} end @param {Quaternion} base */
function boneAlignment(rest, role, end, base) {
  const [begins, ends] = [rest.places(role), rest.both(rest.ends(role, end))];
  if (!begins || !ends) return null;
  const [target, source] = begins.map((begin, i) => minus(ends[i], begin));
  if (!length(target) || !length(source)) return null;
  return turns(between(rotate(base, unit(target)), unit(source)), base);
}

/** The rotation between the level soles of target and source. @param {Rest} rest @param {string} side @param {Quaternion} upright */
function soleAlignment(rest, side, upright) {
  const [knee, ankle, ball] = ["shin", "foot", "toe"].map((part) => rest.places(`${side} ${part}`));
  const toe = rest.joint(`${side} toe`);
  if (!knee || !ankle || !ball || toe < 0) return null;
  const tips = [
    firstChild(rest.target, rest.targetAt, toe),
    firstChild(rest.source, rest.sourceAt, rest.chain(toe)[1]),
  ];
  const ups = [Y, nearestAxis(rotate(upright, Y))];
  const [target, source] = tips.map((tip, i) => soleFrame(knee[i], ankle[i], ball[i], tip, ups[i]));
  return target && source && turns(source, conjugate(target));
}

/** @param {Bones} bones @param {Float64Array} at @param {number} joint */
function firstChild(bones, at, joint) {
  const [child] = childrenOf(bones, joint);
  return child === undefined ? null : vector(at, child);
}

/** Left, up and forward of a sole at rest; null where toes point up or nowhere. @param {Vector} knee @param {Vector} ankle @param {Vector} ball @param {Vector | null} tip @param {Vector} up */
function soleFrame(knee, ankle, ball, tip, up) {
  const toes = tip ? minus(tip, ball) : minus(ball, ankle);
  const [level, rolled] = [up, minus(knee, ankle)].map((above) => unit(cross(above, toes)));
  if (!length(level) || !length(rolled)) return null;
  const foot = minus(ball, ankle);
  const left = CLEARLY * Math.abs(dot(rolled, foot)) < Math.abs(dot(level, foot)) ? rolled : level;
  const forward = unit(cross(left, up));
  return fromColumns([left, cross(forward, left), forward]);
}

/** The rotation between the palms of target and source, by where fingers begin. @param {Rest} rest @param {string} side */
function palmAlignment(rest, side) {
  const places = ["hand", "index", "middle", "pinky"].map((part) => rest.places(`${side} ${part}`));
  if (!places.every((both) => both !== null)) return null;
  const [target, source] = [0, 1].map((i) => palm(places.map((both) => both[i])));
  return target && source && turns(source, conjugate(target));
}

/** Along the fingers, across the hand and out of its back. */
function palm(/** @type {Vector[]} */ [wrist, index, middle, pinky]) {
  const fingers = unit(minus(middle, wrist));
  const out = unit(cross(fingers, minus(index, pinky)));
  return length(out) ? fromColumns([fingers, cross(out, fingers), out]) : null;
}
