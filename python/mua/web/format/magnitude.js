// How large the numbers may become that a file decodes to: refused where single precision would not hold their squares.
// Reference: python/mua/asset/magnitude.py.

import { MAGNITUDE } from "./limits.js";
import { refuse } from "./parser.js";
import { expanded, largest } from "./tensors.js";

/** @typedef {import("./model.js").Branch} Branch */
/** @typedef {import("./model.js").Layer} Layer */
/** @typedef {import("./model.js").Wavelet} Wavelet */

/** @param {{ranges: Float32Array, margins: Float32Array}} components @param {Wavelet} wavelet @param {import("./model.js").Coarse} coarse @param {{geometry: Branch, appearance: Branch}} branches */
export function checkMagnitude({ ranges, margins }, wavelet, coarse, { geometry, appearance }) {
  const inputs = most(ranges) + most(margins);
  const weight = network(coarse.mlp, inputs, "coarse.mlp");
  check("coarse", largest(coarse.mean) + coarse.basis.shape[0] * weight * largest(coarse.basis));
  checkTexture(geometry, wavelet, inputs, "geometry");
  checkTexture(appearance, wavelet, inputs, "appearance");
}

function network(/** @type {Layer[]} */ mlp, /** @type {number} */ inputs, /** @type {string} */ path) {
  let found = inputs;
  for (const { weight, bias, inputs: width, outputs } of mlp) {
    const values = expanded(weight);
    let rows = 0;
    for (let row = 0; row < outputs; row++) {
      let sum = 0;
      for (let i = row * width; i < (row + 1) * width; i++) sum += Math.abs(values[i]);
      rows = Math.max(rows, sum);
    }
    found = rows * found + largest(bias);
    check(path, found);
  }
  return found;
}

/** @param {Branch} branch @param {Wavelet} wavelet @param {number} inputs @param {string} path */
function checkTexture(branch, { recLo, recHi, levels }, inputs, path) {
  const [low, high] = [recLo, recHi].map((taps) => taps.reduce((sum, tap) => sum + Math.abs(tap), 0));
  const coefficient = network(branch.mlp, inputs, `${path}.mlp`);
  let found = largest(branch.llMean) + branch.rank * coefficient * largest(branch.llBasis);
  for (let level = 0; level < levels; level++) {
    found *= low * low;
    const band = branch.details[level];
    if (!band) continue;
    const detail = largest(band.mean) + band.rank * coefficient * largest(band.h) * largest(band.w);
    found += (2 * low + high) * high * detail;
  }
  check(path, found);
}

const most = (/** @type {Float32Array} */ values) =>
  values.reduce((found, value) => Math.max(found, Math.abs(value)), 0);

function check(/** @type {string} */ path, /** @type {number} */ reached) {
  if (!(reached <= MAGNITUDE)) throw refuse(path, "the numbers that follow from it may exceed 4.6e+18");
}
