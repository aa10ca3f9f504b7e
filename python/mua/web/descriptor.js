// The motion descriptor: a window of poses in numbers. Reference: python/mua/pose/descriptor.py, and
// section 3 of schemas/README.md.

import { conjugate, multiply, rotate, sixNumbers } from "./rotation.js";

/** @typedef {import("./skeleton.js").Pose} Pose */
/** @typedef {import("./format/rig.js").Skeleton} Skeleton */
/** @typedef {import("./format/read.js").Encoding} Encoding */

/** The descriptor [k D] of one window, newest pose first. */
export function describe(
  /** @type {Skeleton} */ skeleton,
  /** @type {Encoding} */ encoding,
  /** @type {Pose[]} */ window,
) {
  const bind = rootWorld(skeleton, { rotations: skeleton.bindRotations, translations: skeleton.bindTranslations });
  const roots = window.map((pose) => rootWorld(skeleton, pose));
  const turns = roots.map((root) => multiply(root.rotation, conjugate(bind.rotation)));
  const back = conjugate(encoding.heading ? headingOf(turns[0]) : [1, 0, 0, 0]);
  const numbers = window.flatMap((pose, age) => [
    ...rotate(
      back,
      roots[age].place.map((value, axis) => value - roots[0].place[axis]),
    ),
    ...sixNumbers(multiply(back, turns[age])),
    ...jointNumbers(skeleton, encoding, pose),
  ]);
  return Float64Array.from(numbers);
}

/** Local rotations and translations of the encoded joints. */
function jointNumbers(/** @type {Skeleton} */ skeleton, /** @type {Encoding} */ encoding, /** @type {Pose} */ pose) {
  const turns = Array.from(encoding.joints).flatMap((joint) => sixNumbers(pose.rotations, 4 * joint));
  const moves = Array.from(encoding.translated).flatMap((joint) =>
    [0, 1, 2].map((axis) => pose.translations[3 * joint + axis] - skeleton.bindTranslations[3 * joint + axis]),
  );
  return [...turns, ...moves];
}

/** The twist of a rotation about Y; none where it has none. */
function headingOf(/** @type {number[]} */ turn) {
  const length = Math.hypot(turn[0], turn[2]);
  return length < Math.sqrt(Number.EPSILON) ? [1, 0, 0, 0] : [turn[0] / length, 0, turn[2] / length, 0];
}

/** Rotation and place in the world of the root joint alone. */
function rootWorld(/** @type {Skeleton} */ { parents, root }, /** @type {Pose} */ pose) {
  let rotation = Array.from(pose.rotations.subarray(4 * root, 4 * root + 4));
  let place = Array.from(pose.translations.subarray(3 * root, 3 * root + 3));
  for (let joint = parents[root]; joint >= 0; joint = parents[joint]) {
    rotation = multiply(pose.rotations, rotation, 4 * joint, 0);
    const moved = rotate(pose.rotations, place, 4 * joint, 0);
    place = moved.map((value, axis) => pose.translations[3 * joint + axis] + value);
  }
  return { rotation, place };
}
