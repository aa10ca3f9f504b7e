// How large the numbers may become that a file decodes to: refused where single precision would not hold their squares.
// Reference: python/mua/asset/magnitude.py.

import { MAGNITUDE } from "./limits.js";
import { refuse } from "./parser.js";
import { expanded, largest } from "./tensors.js";

/** @typedef {import("./model.js").Branch} Branch */
/** @typedef {import("./model.js").Layer} Layer */
/** @typedef {import("./model.js").Wavelet} Wavelet */
/** @typedef {import("./model.js").Coarse} Coarse */
/** @typedef {import("./tensors.js").Stored} Stored */
/** @typedef {{largest: (tensor: Stored) => number, largestRow: (layer: Layer) => number}} Measure */

/** @type {Measure} */
const EXACT = { largest, largestRow };

/** At least as much, which takes less time. @type {Measure} */
const QUICK = {
  largest: (tensor) =>
    tensor.type === "I8" ? 128 * most(/** @type {Float32Array} */ (tensor.scale)) : largest(tensor),
  largestRow: ({ weight, inputs }) => inputs * QUICK.largest(weight),
};

/** @param {{ranges: Float32Array, margins: Float32Array}} components @param {Wavelet} wavelet @param {Coarse} coarse @param {{geometry: Branch, appearance: Branch}} branches */
export function checkMagnitude({ ranges, margins }, wavelet, coarse, branches) {
  const inputs = most(ranges) + most(margins);
  const path = excess(inputs, wavelet, coarse, branches, QUICK) && excess(inputs, wavelet, coarse, branches, EXACT);
  if (path) throw refuse(path, "the numbers that follow from it may exceed 4.6e+18");
}

/** The first field from which too large numbers follow. @param {number} inputs @param {Wavelet} wavelet @param {Coarse} coarse @param {Record<string, Branch>} branches @param {Measure} measure */
function excess(inputs, wavelet, coarse, branches, measure) {
  const weight = network(coarse.mlp, inputs, measure);
  if (exceeds(weight)) return "coarse.mlp";
  const mesh = coarse.basis.shape[0] * weight * measure.largest(coarse.basis);
  if (exceeds(measure.largest(coarse.mean) + mesh)) return "coarse";
  for (const path of ["geometry", "appearance"]) {
    const coefficient = network(branches[path].mlp, inputs, measure);
    if (exceeds(coefficient)) return `${path}.mlp`;
    if (exceeds(texture(branches[path], wavelet, coefficient, measure))) return path;
  }
  return undefined;
}

/** What comes out of the layers; infinite where it is too large after any of them. @param {Layer[]} mlp @param {number} inputs @param {Measure} measure */
function network(mlp, inputs, measure) {
  let found = inputs;
  for (const layer of mlp) {
    found = measure.largestRow(layer) * found + measure.largest(layer.bias);
    if (exceeds(found)) return Infinity;
  }
  return found;
}

/** The largest sum of magnitudes in a row of weights. */
function largestRow(/** @type {Layer} */ { weight, inputs, outputs }) {
  const values = expanded(weight);
  let found = 0;
  for (let row = 0; row < outputs; row++) {
    let sum = 0;
    for (let i = row * inputs; i < (row + 1) * inputs; i++) sum += Math.abs(values[i]);
    found = Math.max(found, sum);
  }
  return found;
}

/** @param {Branch} branch @param {Wavelet} wavelet @param {number} coefficient @param {Measure} measure */
function texture(branch, { recLo, recHi, levels }, coefficient, measure) {
  const [low, high] = [recLo, recHi].map((taps) => taps.reduce((sum, tap) => sum + Math.abs(tap), 0));
  let found = measure.largest(branch.llMean) + branch.rank * coefficient * measure.largest(branch.llBasis);
  for (let level = 0; level < levels; level++) {
    found *= low * low;
    const band = branch.details[level];
    if (!band) continue;
    const product = measure.largest(band.h) * measure.largest(band.w);
    found += (2 * low + high) * high * (measure.largest(band.mean) + band.rank * coefficient * product);
  }
  return found;
}

const most = (/** @type {Float32Array} */ values) =>
  values.reduce((found, value) => Math.max(found, Math.abs(value)), 0);

const exceeds = (/** @type {number} */ reached) => !(reached <= MAGNITUDE);
