// The motion descriptor: a window of poses in numbers. Reference: python/mua/pose/descriptor.py, and
// section 3 of schemas/README.md.

import { conjugate, multiply, rotate, sixNumbers } from "./rotation.js";
import { world } from "./skeleton.js";

/** @typedef {import("./skeleton.js").Pose} Pose */
/** @typedef {import("./format/rig.js").Skeleton} Skeleton */
/** @typedef {import("./format/read.js").Encoding} Encoding */

/** The descriptor [D] of one window, newest pose first. */
export function describe(
  /** @type {Skeleton} */ skeleton,
  /** @type {Encoding} */ encoding,
  /** @type {Pose[]} */ window,
) {
  const { root, inverse } = skeleton;
  const posed = window.map((pose) => world(skeleton, pose));
  const turn = (/** @type {number} */ age, /** @type {number} */ joint) =>
    multiply(posed[age].rotations, inverse, 4 * joint, 8 * joint); // in the world, relative to the bind pose
  const back = conjugate(encoding.heading ? headingOf(turn(0, root)) : [1, 0, 0, 0]);
  const place = (/** @type {number} */ age) => posed[age].places.subarray(3 * root, 3 * root + 3);
  const frames = window.flatMap((pose, age) => [
    ...rotate(
      back,
      Array.from(place(age), (value, axis) => value - place(0)[axis]),
    ),
    ...sixNumbers(multiply(back, turn(age, root))),
    ...jointNumbers(skeleton, encoding, pose),
  ]);
  const turned = Array.from(encoding.joints).flatMap((joint) => sixNumbers(multiply(back, turn(0, joint))));
  return Float64Array.from([...turned, ...frames]);
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
export function headingOf(/** @type {number[]} */ turn) {
  const length = Math.hypot(turn[0], turn[2]);
  return length < Math.sqrt(Number.EPSILON) ? [1, 0, 0, 0] : [turn[0] / length, 0, turn[2] / length, 0];
}
