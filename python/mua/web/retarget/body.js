// A body by the places of its roles: its trunk, and whether a rest pose is that of somebody who stands. Reference:
// python/mua/motion/trunk.py.

import { SIDES } from "./joint_names.js";
import { cross, degrees, dot, length, middle, minus, times, unit } from "./vectors.js";

/** @typedef {import("./vectors.js").Vector} Vector */
/** @typedef {Record<string, Vector>} Places where roles begin, metres */
/** @typedef {{up: Vector, hips: Vector, chest: Vector}} Trunk directions up, and left at the hips and at the shoulders */

const WIDE = 0.1; // of the way between the shoulders: collar bones that begin farther apart than this show left and right
const HANGING = 60; // degrees from straight down within which legs of a standing body point
const RAISED = 45; // degrees from straight up within which arms of a standing body do not point
const MIRRORED = 15; // degrees by which a limb may differ from the mirror image of the other
/** @type {Record<string, number>} */
const STRAIGHT = { shin: 20, forearm: 45 }; // degrees by which knees and elbows of a body at rest may bend
const POINTED = 20; // degrees between shin and foot below which the foot only continues the leg
/** @type {Record<string, string>} */
const ABOVE = { shin: "thigh", forearm: "upper_arm" };
const BONES = [
  ["thigh", "shin"],
  ["shin", "foot"],
  ["upper_arm", "forearm"],
  ["forearm", "hand"],
  ["foot", "toe"],
];

/** The trunk of a body; null where its places do not show it. @returns {Trunk | null} */
export function trunkOf(/** @type {Places} */ at) {
  const pair = (/** @type {string} */ part) => SIDES.map((side) => at[`${side} ${part}`]);
  const line = (/** @type {string} */ part) => (pair(part).every(Boolean) ? minus(pair(part)[0], pair(part)[1]) : null);
  const mid = (/** @type {string} */ part) => (pair(part).every(Boolean) ? middle(pair(part)[0], pair(part)[1]) : null);
  const bottom = mid("thigh") ?? at.hips;
  const top = mid("upper_arm") ?? mid("shoulder") ?? at.neck ?? at.head;
  const [legs, arms, collars] = ["thigh", "upper_arm", "shoulder"].map(line);
  const shoulders = arms && collars && length(collars) > WIDE * length(arms) ? collars : (arms ?? collars);
  const [hips, chest] = [legs ?? shoulders, shoulders ?? legs];
  if (!top || !bottom || !hips || !chest) return null;
  if (![minus(top, bottom), hips, chest].every(length)) return null;
  return { up: unit(minus(top, bottom)), hips: unit(hips), chest: unit(chest) };
}

/** Whether a body stands as figures are built: legs down and straight, arms not up, sides alike. */
export function stands(/** @type {Places} */ at) {
  const trunk = trunkOf(at);
  if (!trunk) return false;
  const down = times(trunk.up, -1);
  const across = unit(cross(trunk.up, cross(trunk.hips, trunk.up)));
  /** @type {Record<string, Vector>} */
  const bones = {};
  for (const [begin, end] of BONES)
    for (const side of SIDES) {
      const [from, to] = [at[`${side} ${begin}`], at[`${side} ${end}`]];
      if (from && to) bones[`${side} ${begin}`] = unit(minus(to, from));
    }
  return Object.entries(bones).every(([role, bone]) => {
    const [side, part] = role.split(" ");
    if ((part === "thigh" || part === "shin") && degrees(bone, down) > HANGING) return false;
    if (part === "upper_arm" && degrees(bone, trunk.up) < RAISED) return false;
    const shin = bones[`${side} shin`];
    if (part === "foot" && shin && degrees(bone, shin) < POINTED) return false;
    const above = bones[`${side} ${ABOVE[part]}`];
    if (above && degrees(bone, above) > STRAIGHT[part]) return false;
    const other = side === "left" && part !== "foot" ? bones[`right ${part}`] : null;
    return !other || degrees(bone, minus(other, times(across, 2 * dot(other, across)))) <= MIRRORED;
  });
}
