// A pose before the motion: many libraries begin each clip with one frame of the T-pose. Reference:
// python/mua/motion/leading_pose.py.

import { world } from "../skeleton.js";
import { length, minus, vector } from "./vectors.js";

/** @typedef {import("./source.js").Motion} Motion */

const [FEWEST, MOST] = [8, 60]; // frames of a clip in which a first one can stand apart; those that are looked at
const FASTEST = 3; // metres a second, the mean of all joints: no motion begins so for one frame alone
const APART = 4; // times the largest step between the frames after it

/** The motion without its first frame, where the body jumps from that one to the next as nowhere after it. @param {Motion} motion @returns {Motion} */
export function withoutLeadingPose(motion) {
  const { bones, rate, frames, rotations, translations, expressions } = motion;
  if (frames < FEWEST) return motion;
  const [wide, count] = [bones.names.length, expressions.names.length];
  const places = Array.from({ length: Math.min(frames, MOST) }, (_, frame) => placesOf(motion, frame));
  const [first, ...others] = places.slice(1).map((at, frame) => step(places[frame], at, wide));
  if (first * rate < FASTEST || first < APART * Math.max(...others)) return motion;
  return {
    ...motion,
    frames: frames - 1,
    rotations: rotations.subarray(4 * wide),
    translations: translations.subarray(3 * wide),
    expressions: { ...expressions, weights: expressions.weights.subarray(count) },
    notes: [...motion.notes, "The first frame, a pose apart from the motion, is left out."],
  };
}

/** Where the joints are in a frame. @param {Motion} motion @param {number} frame */
function placesOf({ bones, rotations, translations }, frame) {
  const [first, last] = [frame * bones.names.length, (frame + 1) * bones.names.length];
  const pose = {
    rotations: rotations.subarray(4 * first, 4 * last),
    translations: translations.subarray(3 * first, 3 * last),
  };
  return world(bones, pose).places;
}

/** How far the joints go from one frame to the next, metres in the mean. @param {Float64Array} from @param {Float64Array} to @param {number} joints */
function step(from, to, joints) {
  let sum = 0;
  for (let joint = 0; joint < joints; joint++) sum += length(minus(vector(to, joint), vector(from, joint)));
  return sum / joints;
}
