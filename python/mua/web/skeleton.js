// Joints in the world, and what carries the bind pose there. Reference: python/mua/pose/skeleton.py.

import { conjugate, dualFromRigid, dualMultiply, multiply, rotate } from "./rotation.js";

/** @typedef {{parents: Int32Array, bindRotations: Float64Array, bindTranslations: Float64Array}} Bones */
/** @typedef {{rotations: Float64Array, translations: Float64Array, expressions?: Float32Array}} Pose local, [J, 4] unit and [J, 3] metres; weights [E] of the avatar's expressions, all 0 where left out */

/** Joint-to-world rotations [J, 4] and positions [J, 3]: forward kinematics. */
export function world(/** @type {Bones} */ skeleton, /** @type {Pose} */ pose) {
  const { parents } = skeleton;
  const rotations = Float64Array.from(pose.rotations);
  const places = Float64Array.from(pose.translations);
  for (let joint = 0; joint < parents.length; joint++) {
    const parent = parents[joint];
    if (parent < 0) continue;
    rotations.set(multiply(rotations, pose.rotations, 4 * parent, 4 * joint), 4 * joint);
    const moved = rotate(rotations, pose.translations, 4 * parent, 3 * joint);
    for (let axis = 0; axis < 3; axis++) places[3 * joint + axis] = places[3 * parent + axis] + moved[axis];
  }
  return { rotations, places };
}

/** Dual quaternions [J, 8] from the bind pose's world to each joint's own space. */
export function bindInverse(/** @type {Bones} */ skeleton) {
  const bind = { rotations: skeleton.bindRotations, translations: skeleton.bindTranslations };
  const { rotations, places } = world(skeleton, bind);
  const inverse = new Float64Array(2 * rotations.length);
  for (let joint = 0; joint < skeleton.parents.length; joint++) {
    const dual = dualFromRigid(rotations, places, 4 * joint, 3 * joint);
    inverse.set([...conjugate(dual), ...conjugate(dual, 4)], 8 * joint);
  }
  return inverse;
}

/**
 * Dual quaternions [J, 8] that carry points of the bind pose to the posed world.
 * @param {Bones & {inverse: Float64Array}} skeleton
 * @param {{rotations: Float64Array, places: Float64Array}} posed as `world` gives it
 */
export function skinning(skeleton, { rotations, places }) {
  const joints = new Float64Array(skeleton.inverse.length);
  for (let joint = 0; joint < skeleton.parents.length; joint++) {
    const dual = dualFromRigid(rotations, places, 4 * joint, 3 * joint);
    joints.set(dualMultiply(dual, skeleton.inverse, 0, 8 * joint), 8 * joint);
  }
  return joints;
}
