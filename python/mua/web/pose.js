// What a page says of poses and learns of a skeleton, checked. Its quaternions are x, y, z, w, as in three.js, glTF and WebXR.

import { AvatarError } from "./error.js";
import { normalized } from "./rotation.js";

/** @typedef {import("./retarget/types.js").JointNumbers} JointNumbers */
/** @typedef {import("./format/read.js").Avatar} Avatar */
/** @typedef {import("./skeleton.js").Pose} Pose */

const SHOWN = 6; // names in a sentence

/** What a page learns of a skeleton. @returns {import("./player.js").SkeletonInfo} */
export function skeletonInfo(
  /** @type {Avatar["skeleton"]} */ { names, parents, root, bindRotations, bindTranslations },
) {
  const translations = Float32Array.from(bindTranslations);
  return { names: [...names], parents: [...parents], root, rotations: outward(bindRotations), translations };
}

/** Quaternions as a page has them. */
export function outward(/** @type {ArrayLike<number>} */ ours) {
  return Float32Array.from(ours, (_, i) => ours[i % 4 < 3 ? i + 1 : i - 3]);
}

/** Quaternions of a page as ours, of unit length. */
export function inward(/** @type {ArrayLike<number>} */ theirs) {
  const ours = Float64Array.from(theirs, (_, i) => theirs[i % 4 ? i - 1 : i + 3]);
  for (let at = 0; at < ours.length; at += 4) normalized(ours, at);
  return ours;
}

/** The pose that a page gives. @param {Avatar} avatar @param {import("./player.js").PoseInput} given @returns {Pose} */
export function poseFrom({ skeleton, expressions }, given) {
  if (typeof given !== "object") throw fault(`expected rotations, translations or expressions, found ${given}`);
  const { rotations, translations, expressions: weights } = given;
  const { names, bindRotations, bindTranslations } = skeleton;
  const turned = spread("rotations", rotations, names, outward(bindRotations));
  const moved = spread("translations", translations, names, Float64Array.from(bindTranslations));
  const still = names.findIndex((_, joint) => !turned.slice(4 * joint, 4 * joint + 4).some(Boolean));
  if (still >= 0) throw fault(`rotations: ${names[still]} is 0 0 0 0, expected a rotation`);
  const pose = { rotations: inward(turned), translations: Float64Array.from(moved) };
  if (!weights) return pose;
  checkNumbers("expressions", weights, expressions.length, `one of each expression of the avatar`);
  return { ...pose, expressions: Float32Array.from(weights, held) };
}

/** A pose with the weights that a page has set. @param {Pose} pose @param {Float32Array | null} weights @returns {Pose} */
export function weighted(pose, weights) {
  if (!weights) return pose;
  const own = (/** @type {number} */ i) => pose.expressions?.[i] ?? 0;
  return { ...pose, expressions: weights.map((weight, i) => held(Number.isNaN(weight) ? own(i) : weight)) };
}

const held = (/** @type {number} */ weight) => Math.min(Math.max(weight, 0), 1);
const fault = (/** @type {string} */ sentence) => new AvatarError(`setPose: ${sentence}.`);

/** Names in a sentence. */
export const listed = (/** @type {string[]} */ names) =>
  names.length > SHOWN ? `${names.slice(0, SHOWN).join(", ")}, ... ${names.length} in all` : names.join(", ") || "none";

/** Numbers of all joints: as they are given, or by name over those of the bind pose. @param {string} field @param {JointNumbers | undefined} given @param {string[]} names @param {Float32Array | Float64Array} bind */
function spread(field, given, names, bind) {
  const width = bind.length / names.length;
  if (given === undefined || given === null) return bind;
  if (typeof given !== "object") throw fault(`${field}: expected numbers, of all joints or by name, found ${given}`);
  if (typeof (/** @type {ArrayLike<number>} */ (given).length) === "number") {
    checkNumbers(
      field,
      /** @type {ArrayLike<number>} */ (given),
      bind.length,
      `${width} of each of ${names.length} joints`,
    );
    return Float64Array.from(/** @type {ArrayLike<number>} */ (given));
  }
  const found = Float64Array.from(bind);
  for (const [name, numbers] of Object.entries(given)) {
    const joint = names.indexOf(name);
    if (joint < 0) throw fault(`${field}: the avatar has no joint "${name}", only ${listed(names)}`);
    checkNumbers(`${field}: ${name}`, numbers, width, field === "rotations" ? "x, y, z, w" : "x, y, z");
    found.set(numbers, width * joint);
  }
  return found;
}

/** @param {string} field @param {ArrayLike<number>} numbers @param {number} count @param {string} expected */
function checkNumbers(field, numbers, count, expected) {
  if (numbers?.length !== count)
    throw fault(`${field} holds ${numbers?.length ?? "no"} numbers, expected ${count}: ${expected}`);
  const wrong = Array.from(numbers).find((value) => !Number.isFinite(value));
  if (wrong !== undefined) throw fault(`${field}: expected finite numbers, found ${wrong}`);
}
