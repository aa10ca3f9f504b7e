// Skeleton, template, texels and surface of a file, checked. Reference: python/mua/asset/read_rig.py.

import { centreBarycentrics } from "../prepare.js";
import { normalized } from "../rotation.js";
import { bindInverse } from "../skeleton.js";
import { blocks, blockTriangles } from "../surface.js";
import { readLevels } from "./blocks.js";
import { BARYCENTRIC_SLACK, BIND_BOUND, LARGEST, MAX_INFLUENCES, UNIT_BOUND, WEIGHT_BOUND } from "./limits.js";
import { general, scientific, shortest } from "./numbers.js";
import { fault, refuse } from "./parser.js";
import { indices, reals } from "./tensors.js";

/** @typedef {import("./parser.js").Tree} Tree */

const DUAL_NUMBERS = 8; // of a dual quaternion
const END = -1; // of a strip

/** @typedef {ReturnType<typeof readSkeleton>} Skeleton */

export function readSkeleton(/** @type {Tree} */ tree) {
  /** @type {string[]} */
  const names = tree.names;
  const count = names.length;
  const parents = indices(tree.parents, "skeleton.parents", [count], -1, count);
  const late = parents.findIndex((parent, joint) => parent >= joint);
  if (late >= 0) throw refuse("skeleton.parents", `joint ${late} stands before its parent ${parents[late]}`);
  const root = /** @type {number} */ (tree.root);
  if (root >= count) throw refuse("skeleton.root", `${root}, but there are ${count} joints`);
  const { values: turned } = unit(tree.bind_rotations, "skeleton.bind_rotations", [count, 4]);
  const bindRotations = Float64Array.from(turned);
  for (let at = 0; at < bindRotations.length; at += 4) normalized(bindRotations, at);
  const bindTranslations = Float64Array.from(
    reals(tree.bind_translations, "skeleton.bind_translations", [count, 3]).values,
  );
  const stated = reals(tree.bind_inverse, "skeleton.bind_inverse", [count, 8]).values;
  const skeleton = { names, parents, root, bindRotations, bindTranslations };
  const inverse = bindInverse(skeleton);
  const gap = bindGap(stated, inverse);
  if (gap > BIND_BOUND)
    throw refuse("skeleton.bind_inverse", `differs by ${scientific(gap)} from the inverse of the bind pose`);
  return { ...skeleton, inverse, translated: translated(tree, "skeleton.translated", count, root) };
}

/** How far dual quaternions are from those stated, each of which may have the opposite sign. */
function bindGap(/** @type {Float32Array} */ stated, /** @type {Float64Array} */ inverse) {
  let most = 0;
  for (let at = 0; at < inverse.length; at += DUAL_NUMBERS) {
    const [same, opposite] = [1, -1].map((sign) =>
      inverse
        .subarray(at, at + DUAL_NUMBERS)
        .reduce((gap, value, i) => Math.max(gap, Math.abs(stated[at + i] - sign * value)), 0),
    );
    most = Math.max(most, Math.min(same, opposite));
  }
  return most;
}

/** Unit quaternions [..., 4] as stored. @param {Tree} tensor @param {string} path @param {(number | null)[]} shape */
export function unit(tensor, path, shape) {
  const found = reals(tensor, path, shape);
  let worst = 1;
  for (let at = 0; at < found.values.length; at += 4) {
    const length = Math.hypot(found.values[at], found.values[at + 1], found.values[at + 2], found.values[at + 3]);
    if (Math.abs(length - 1) > Math.abs(worst - 1)) worst = length;
  }
  if (Math.abs(worst - 1) > UNIT_BOUND) throw refuse(path, `a quaternion of length ${general(worst, 4)}, expected 1`);
  return found;
}

/** Joints beside the root that move in their parents; none where the table names none. */
export function translated(
  /** @type {Tree} */ tree,
  /** @type {string} */ path,
  /** @type {number} */ count,
  /** @type {number} */ root,
) {
  return tree.translated ? besideRoot(tree.translated, path, count, root) : new Int32Array();
}

/** Ascending joints without the root. */
export function besideRoot(
  /** @type {Tree} */ tensor,
  /** @type {string} */ path,
  /** @type {number} */ count,
  /** @type {number} */ root,
) {
  const joints = indices(tensor, path, [null], 0, count);
  if (!ascend(joints) || joints.includes(root)) throw refuse(path, "joints must ascend and leave out the root");
  return joints;
}

/** @typedef {ReturnType<typeof readTemplate>} Template */

export function readTemplate(/** @type {Tree} */ tree, /** @type {number} */ count, /** @type {number} */ joints) {
  const uv = reals(tree.uv, "template.uv", [null, 2]);
  const faces = indices(tree.faces, "template.faces", [null, 3], 0, count);
  const uvFaces = indices(tree.uv_faces, "template.uv_faces", [faces.length / 3, 3], 0, uv.shape[0]);
  const weights = reals(tree.skin_weights, "template.skin_weights", [count, MAX_INFLUENCES]).values;
  checkWeights(weights, count);
  const skinIndices = indices(tree.skin_indices, "template.skin_indices", [count, MAX_INFLUENCES], 0, joints);
  return { faces, uv: uv.values, uvFaces, skinIndices, skinWeights: weights };
}

/** Each vertex's weights are 0 or more, sum to 1, and begin with the largest. */
function checkWeights(/** @type {Float32Array} */ weights, /** @type {number} */ count) {
  let [worst, sumOfWorst, negative, rising] = [0, 1, false, -1];
  for (let vertex = 0; vertex < count; vertex++) {
    let sum = 0;
    for (let at = MAX_INFLUENCES * vertex; at < MAX_INFLUENCES * (vertex + 1); at++) {
      sum += weights[at];
      negative ||= weights[at] < 0;
      if (rising < 0 && at % MAX_INFLUENCES && weights[at] > weights[at - 1]) rising = vertex;
    }
    if (Math.abs(sum - 1) > Math.abs(sumOfWorst - 1)) [worst, sumOfWorst] = [vertex, sum];
  }
  const field = "template.skin_weights";
  if (negative || Math.abs(sumOfWorst - 1) > WEIGHT_BOUND)
    throw refuse(field, `weights of vertex ${worst} sum to ${general(sumOfWorst, 4)} or one is negative`);
  if (rising >= 0) throw refuse(field, `weights of vertex ${rising} do not begin with the largest`);
}

/** @typedef {ReturnType<typeof readTexels>} Texels */

export function readTexels(/** @type {Tree} */ tree, /** @type {Template} */ template) {
  const size = /** @type {number} */ (tree.size);
  const texels = indices(tree.texels, "texels.texels", [null], 0, size * size);
  if (!ascend(texels)) throw refuse("texels.texels", "texels must ascend");
  const triangles = indices(tree.triangles, "texels.triangles", [texels.length], 0, template.faces.length / 3);
  const barycentrics = readBarycentrics(tree, template, texels, triangles);
  let least = 0;
  for (let at = 0; at < barycentrics.length; at += 2) {
    const third = 1 - Math.fround(barycentrics[at] + barycentrics[at + 1]);
    least = Math.min(least, barycentrics[at], barycentrics[at + 1], third);
  }
  if (least < -BARYCENTRIC_SLACK) throw refuse("texels.barycentrics", `${general(least, 3)}, expected 0 to 1`);
  const oneSided = readOneSided(tree.one_sided, texels.length);
  const length = /** @type {number} */ (tree.length);
  if (!(length >= 0 && length <= LARGEST))
    throw refuse("texels.length", `${shortest(length)}, expected 0 to ${LARGEST}`);
  const levels = readLevels(tree.levels, { size, texels });
  const held = barycentrics.map((share) => Math.max(share, 0));
  return { size, texels, triangles, barycentrics: held, oneSided, length, levels };
}

/** A bit for each texel, the lowest of a byte first: not drawn from behind. None where the file has none. @param {Uint8Array | undefined} content @param {number} count */
function readOneSided(content, count) {
  const expected = Math.ceil(count / 8);
  if (content && content.length !== expected)
    throw fault("shape", "texels.one_sided", `${content.length} bytes, expected ${expected}`);
  return content ?? new Uint8Array(expected);
}

/** [N, 2] as stored, or computed where only those of the listed texels are. @param {Tree} tree @param {Template} template @param {Int32Array} texels @param {Int32Array} triangles */
function readBarycentrics(tree, template, texels, triangles) {
  if (!tree.listed) return reals(tree.barycentrics, "texels.barycentrics", [texels.length, 2]).values;
  const listed = indices(tree.listed, "texels.listed", [null], 0, texels.length);
  if (!ascend(listed)) throw refuse("texels.listed", "texels must ascend");
  const stored = reals(tree.barycentrics, "texels.barycentrics", [listed.length, 2]).values;
  const found = centreBarycentrics(template, tree.size, texels, triangles);
  listed.forEach((texel, i) => found.set(stored.subarray(2 * i, 2 * i + 2), 2 * texel));
  if (found.some(Number.isNaN))
    throw refuse("texels.listed", "a texel is not listed, but its triangle has no area in UV");
  return found;
}

const ascend = (/** @type {Int32Array} */ values) => values.every((value, i) => i === 0 || value > values[i - 1]);

/** @typedef {NonNullable<ReturnType<typeof readSurface>>} SurfaceCode */

export function readSurface(/** @type {Tree | undefined} */ tree, /** @type {Texels} */ texels) {
  if (!tree) return null;
  const runs = /** @type {Uint8Array} */ (tree.runs);
  const corners = blocks(texels);
  const codes = runs.reduce((count, run) => count + (run >> 4) + 1, 0);
  if (codes !== corners.length / 4)
    throw fault("shape", "surface.runs", `${codes} codes, expected ${corners.length / 4}`);
  if (blockTriangles(corners, runs).some((corner) => corner < 0))
    throw refuse("surface.runs", "a triangle has a corner that is no valid texel");
  return { runs, strips: indices(tree.strips, "surface.strips", [null], END, 2 * texels.texels.length) };
}
