// Poses of a clip at the rate of an avatar's encoding. References: python/mua/pose/resample.py and section 2 of
// schemas/README.md.

import { normalized, slerp } from "./rotation.js";

/** @typedef {import("./format/read.js").Clip} Clip */
/** @typedef {import("./format/rig.js").Skeleton} Skeleton */
/** @typedef {import("./skeleton.js").Pose} Pose */

const LAST_FRAME_SLACK = 1e-6; // frames by which rounding may place the end of a clip before its last sample

/** How many frames a clip has at `rate` frames per second. */
export function framesAt(/** @type {Clip} */ clip, /** @type {number} */ rate) {
  return Math.floor(((clip.frames - 1) / clip.rate) * rate + LAST_FRAME_SLACK) + 1;
}

/** The pose of one frame of a clip at `rate` frames per second. @returns {Pose} */
export function sample(
  /** @type {Skeleton} */ skeleton,
  /** @type {Clip} */ clip,
  /** @type {number} */ frame,
  /** @type {number} */ rate,
) {
  const last = clip.frames - 1;
  const at = rate === clip.rate ? frame : Math.min(frame * (clip.rate / rate), last);
  const before = Math.floor(at);
  const t = at - before;
  const first = stored(skeleton, clip, before);
  return rate === clip.rate ? first : between(first, stored(skeleton, clip, Math.min(before + 1, last)), t);
}

/** The poses of the window that ends at a frame, newest first; before its first frame a clip is held still. */
export function window(
  /** @type {Skeleton} */ skeleton,
  /** @type {Clip} */ clip,
  /** @type {number} */ frame,
  /** @type {{rate: number, window: number}} */ encoding,
) {
  const ages = Array.from({ length: encoding.window }, (_, age) => age);
  return ages.map((age) => sample(skeleton, clip, Math.max(frame - age, 0), encoding.rate));
}

/** A pose as the file holds it. @returns {Pose} */
function stored(/** @type {Skeleton} */ skeleton, /** @type {Clip} */ clip, /** @type {number} */ frame) {
  const joints = skeleton.names.length;
  const rotations = Float64Array.from(clip.rotations.subarray(4 * joints * frame, 4 * joints * (frame + 1)));
  for (let at = 0; at < rotations.length; at += 4) normalized(rotations, at);
  const translations = Float64Array.from(skeleton.bindTranslations);
  translations.set(clip.translation.subarray(3 * frame, 3 * frame + 3), 3 * skeleton.root);
  skeleton.translated.forEach((joint, i) => {
    const from = 3 * (skeleton.translated.length * frame + i);
    if (clip.translations.length) translations.set(clip.translations.subarray(from, from + 3), 3 * joint);
  });
  return { rotations, translations };
}

/** @returns {Pose} */
function between(/** @type {Pose} */ a, /** @type {Pose} */ b, /** @type {number} */ t) {
  const rotations = new Float64Array(a.rotations.length);
  for (let at = 0; at < rotations.length; at += 4) rotations.set(slerp(a.rotations, b.rotations, t, at, at), at);
  return { rotations, translations: a.translations.map((value, i) => value + t * (b.translations[i] - value)) };
}
