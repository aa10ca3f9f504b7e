// Expressions of a file and their weights in clips, checked. References: python/mua/asset/read_rig.py and read.py.

import { RULE_CODES } from "./limits.js";
import { refuse } from "./parser.js";
import { indices, MAX_BYTES, reals } from "./tensors.js";

/** @typedef {import("./parser.js").Tree} Tree */
/** @typedef {{starts: Int32Array, vertices: Int32Array, offsets: Float32Array, gains: Float32Array, rules: Int32Array | null}} Targets expression by expression: the entries starts[e] to starts[e + 1] - 1 are vertices [P] and how far weight 1 moves them [P, 3], metres, and how much brighter colours become there [P], as a share of them; rules [E] of ../rules.js */

/** Names of expressions and what each moves; none where the file has none. @param {Tree | undefined} tree @param {number} vertices of the template @returns {{names: string[], targets: Targets}} */
export function readExpressions(tree, vertices) {
  const none = {
    starts: new Int32Array(1),
    vertices: new Int32Array(),
    offsets: new Float32Array(),
    gains: new Float32Array(),
    rules: null,
  };
  if (!tree) return { names: [], targets: none };
  /** @type {string[]} */
  const names = tree.names;
  const wrong = names.findIndex((name, i) => !name || names.indexOf(name) < i);
  if (wrong >= 0) throw refuse(`expressions.names[${wrong}]`, `'${names[wrong]}' is empty or stands there twice`);
  const starts = indices(tree.starts, "expressions.starts", [names.length + 1], 0, MAX_BYTES);
  if (starts[0] || starts.some((start, i) => i > 0 && start < starts[i - 1]))
    throw refuse("expressions.starts", "the starts must begin with 0 and never fall");
  const moved = indices(tree.vertices, "expressions.vertices", [starts[names.length]], 0, vertices);
  const begins = new Set(starts);
  if (moved.some((vertex, i) => i > 0 && vertex <= moved[i - 1] && !begins.has(i)))
    throw refuse("expressions.vertices", "vertices must ascend within an expression");
  const offsets = reals(tree.offsets, "expressions.offsets", [moved.length, 3]).values;
  const gains = tree.gains
    ? reals(tree.gains, "expressions.gains", [moved.length]).values
    : new Float32Array(moved.length);
  const rules = tree.rules ? indices(tree.rules, "expressions.rules", [names.length], 0, RULE_CODES) : null;
  return { names, targets: { starts, vertices: moved, offsets, gains, rules } };
}

/** Weights [F, E] of a clip. @param {Tree} tensor @param {string} path @param {number[]} shape */
export function readWeights(tensor, path, shape) {
  const weights = reals(tensor, path, shape).values;
  if (weights.some((weight) => weight < 0 || weight > 1)) throw refuse(path, "a weight is not within 0 to 1");
  return weights;
}
