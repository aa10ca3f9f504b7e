// Boxes around a posed avatar, from its skinned template: no texel needs to be decoded for them. Reference:
// python/mua/rig/bounds.py.

import { dualTransform } from "./rotation.js";
import { skinning, world } from "./skeleton.js";

/** @typedef {import("./format/read.js").Avatar} Avatar */

const MARGIN = 0.06; // of the figure's size, that cloth may leave the skinned template
const INFLUENCES = 8; // joints of a vertex

/** Lowest and highest corner of the avatar in a pose, in its own space, metres. */
export function frameBox(/** @type {Avatar} */ avatar, /** @type {import("./skeleton.js").Pose} */ pose) {
  const joints = skinning(avatar.skeleton, world(avatar.skeleton, pose));
  const box = [Infinity, Infinity, Infinity, -Infinity, -Infinity, -Infinity];
  for (let vertex = 0; vertex < avatar.coarse.vertices; vertex++) {
    const place = dualTransform(blended(avatar, joints, vertex), avatar.coarse.places, 0, 3 * vertex);
    for (let axis = 0; axis < 3; axis++) {
      box[axis] = Math.min(box[axis], place[axis]);
      box[3 + axis] = Math.max(box[3 + axis], place[axis]);
    }
  }
  const around = margin(avatar);
  return box.map((value, i) => value + (i < 3 ? -around : around));
}

/** How far boxes reach beyond the skinned template, metres. */
export function margin(/** @type {Avatar} */ { coarse: { places } }) {
  const sides = [0, 1, 2].map((axis) => {
    const along = places.filter((_, i) => i % 3 === axis);
    return along.reduce((a, b) => Math.max(a, b), -Infinity) - along.reduce((a, b) => Math.min(a, b), Infinity);
  });
  return MARGIN * Math.max(...sides);
}

/** The dual quaternion of a vertex, as dq_skinning.compute blends it. */
function blended(/** @type {Avatar} */ { template }, /** @type {Float64Array} */ joints, /** @type {number} */ vertex) {
  const sum = new Array(8).fill(0);
  const reference = 8 * template.skinIndices[INFLUENCES * vertex];
  for (let at = INFLUENCES * vertex; at < INFLUENCES * (vertex + 1); at++) {
    const from = 8 * template.skinIndices[at];
    let dot = 0;
    for (let i = 0; i < 4; i++) dot += joints[from + i] * joints[reference + i];
    const weight = dot < 0 ? -template.skinWeights[at] : template.skinWeights[at];
    for (let i = 0; i < 8; i++) sum[i] += weight * joints[from + i];
  }
  const norm = Math.hypot(sum[0], sum[1], sum[2], sum[3]) || Number.MIN_VALUE;
  return sum.map((value) => value / norm);
}
