// Motion as a file holds it, on the file's own skeleton.

import { conjugate, multiply, rotate } from "../rotation.js";
import { minus, quaternion, vector } from "./vectors.js";

/** @typedef {{names: string[], parents: Int32Array, root: number, bindRotations: Float64Array, bindTranslations: Float64Array}} Bones rigid joints, parents first; local, in the bind pose */
/** @typedef {{names: string[], weights: Float32Array}} Expressions weights [F, E] of named expressions */
/**
 * @typedef {object} Motion
 * @property {Bones} bones
 * @property {number} rate frames per second
 * @property {number} frames
 * @property {Float64Array} rotations [F, J, 4] local
 * @property {Float64Array} translations [F, J, 3] local, metres
 * @property {Record<string, string>} stated joint to role, where the file itself says it
 * @property {Expressions} expressions
 * @property {string[]} notes decisions of the reader that a user should know
 */

/** Local rotations [J, 4] and translations [J, 3] of joints in the world. @param {ArrayLike<number>} parents @param {Float64Array} turned [J, 4] @param {Float64Array} at [J, 3] @returns {import("../skeleton.js").Pose} */
export function localOf(parents, turned, at) {
  const [rotations, translations] = [Float64Array.from(turned), Float64Array.from(at)];
  for (let joint = 0; joint < parents.length; joint++) {
    const parent = parents[joint];
    if (parent < 0) continue;
    const back = conjugate(turned, 4 * parent);
    rotations.set(multiply(back, quaternion(turned, joint)), 4 * joint);
    translations.set(rotate(back, minus(vector(at, joint), vector(at, parent))), 3 * joint);
  }
  return { rotations, translations };
}
