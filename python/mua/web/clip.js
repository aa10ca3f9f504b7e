// Poses of a clip at the rate of an avatar's encoding. References: python/mua/pose/resample.py and section 2 of
// schemas/README.md.

import { normalized, slerp } from "./rotation.js";

/** @typedef {Float32Array | Float64Array} Reals */
/**
 * @typedef {object} Clip
 * @property {string} name
 * @property {number} rate frames per second
 * @property {number} frames
 * @property {Reals} rotations [F, J, 4] local
 * @property {Reals} translation [F, 3] of the root joint, local
 * @property {Reals} translations [F, K, 3] of joints that are translated beside it
 * @property {Int32Array} [translated] these joints, of a clip that a page loaded; else those of the skeleton
 * @property {Float32Array} [expressions] weights [F, E]
 * @property {boolean} [loop] whether it starts over at its end, as it does if left out
 */
/** @typedef {{names: string[], root: number, bindTranslations: Float64Array, translated: Int32Array}} Joints */
/** @typedef {import("./skeleton.js").Pose} Pose */

const LAST_FRAME_SLACK = 1e-6; // frames by which rounding may place the end of a clip before its last sample

/** How many frames a clip has at `rate` frames per second. */
export function framesAt(/** @type {Clip} */ clip, /** @type {number} */ rate) {
  return Math.floor(((clip.frames - 1) / clip.rate) * rate + LAST_FRAME_SLACK) + 1;
}

/** The pose of one frame of a clip at `rate` frames per second. @returns {Pose} */
export function sample(
  /** @type {Joints} */ skeleton,
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
  /** @type {Joints} */ skeleton,
  /** @type {Clip} */ clip,
  /** @type {number} */ frame,
  /** @type {{rate: number, window: number}} */ encoding,
) {
  const ages = Array.from({ length: encoding.window }, (_, age) => age);
  return ages.map((age) => sample(skeleton, clip, Math.max(frame - age, 0), encoding.rate));
}

/** A pose as the file holds it. @returns {Pose} */
function stored(/** @type {Joints} */ skeleton, /** @type {Clip} */ clip, /** @type {number} */ frame) {
  const joints = skeleton.names.length;
  const rotations = Float64Array.from(clip.rotations.subarray(4 * joints * frame, 4 * joints * (frame + 1)));
  for (let at = 0; at < rotations.length; at += 4) normalized(rotations, at);
  const translations = Float64Array.from(skeleton.bindTranslations);
  translations.set(clip.translation.subarray(3 * frame, 3 * frame + 3), 3 * skeleton.root);
  const translated = clip.translated ?? skeleton.translated;
  translated.forEach((joint, i) => {
    const from = 3 * (translated.length * frame + i);
    if (clip.translations.length) translations.set(clip.translations.subarray(from, from + 3), 3 * joint);
  });
  const count = clip.expressions ? clip.expressions.length / clip.frames : 0;
  return { rotations, translations, expressions: clip.expressions?.slice(count * frame, count * (frame + 1)) };
}

/** @returns {Pose} */
function between(/** @type {Pose} */ a, /** @type {Pose} */ b, /** @type {number} */ t) {
  const rotations = new Float64Array(a.rotations.length);
  for (let at = 0; at < rotations.length; at += 4) rotations.set(slerp(a.rotations, b.rotations, t, at, at), at);
  const mixed = (/** @type {any} */ from, /** @type {any} */ to) =>
    from?.map((/** @type {number} */ value, /** @type {number} */ i) => value + t * (to[i] - value));
  return {
    rotations,
    translations: mixed(a.translations, b.translations),
    expressions: mixed(a.expressions, b.expressions),
  };
}
