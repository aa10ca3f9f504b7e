// Wavelet, networks and subbands of a file, checked; what the device reads stays as it is stored.
// Reference: python/mua/asset/read_model.py.

import { LARGEST_TAP, MAX_TAPS } from "./limits.js";
import { general } from "./numbers.js";
import { fault, refuse } from "./parser.js";
import { reals, realTensor, someTensor } from "./tensors.js";

/** @typedef {import("./parser.js").Tree} Tree */
/** @typedef {import("./tensors.js").Stored} Stored */
/** @typedef {{weight: Stored, bias: Stored, inputs: number, outputs: number}} Layer */
/** @typedef {{mean: Stored, h: Stored, w: Stored, rank: number, size: number}} Detail */
/**
 * @typedef {object} Branch geometry or appearance
 * @property {Layer[]} mlp
 * @property {Stored} llMean
 * @property {Stored} llBasis
 * @property {Detail[]} details coarse first
 * @property {Stored} staticOffset
 * @property {number} channels
 * @property {number} rank of LL
 */

/** @typedef {ReturnType<typeof readWavelet>} Wavelet */

export function readWavelet(/** @type {Tree} */ tree) {
  const {
    levels,
    rec_lo: low,
    rec_hi: high,
  } = /** @type {{levels: number, rec_lo: Float64Array, rec_hi: Float64Array}} */ (/** @type {unknown} */ (tree));
  if (low.length !== high.length || low.length % 2 || low.length < 2 || low.length > MAX_TAPS)
    throw refuse(
      "wavelet.rec_lo",
      `${low.length} and ${high.length} taps, expected an even number of each, 2 to ${MAX_TAPS}`,
    );
  const taps = [...low, ...high];
  if (!taps.every(Number.isFinite)) throw fault("finite", "wavelet.rec_lo", "a value is not finite");
  const largest = Math.max(...taps.map(Math.abs));
  if (largest > LARGEST_TAP)
    throw refuse("wavelet.rec_lo", `a tap of ${general(largest, 4)}, expected -${LARGEST_TAP} to ${LARGEST_TAP}`);
  return { name: /** @type {string} */ (tree.name), levels, recLo: low, recHi: high };
}

/** @typedef {ReturnType<typeof readCoarse>} Coarse */

export function readCoarse(/** @type {Tree} */ tree, /** @type {number} */ inputs) {
  const mean = realTensor(tree.mean, "coarse.mean", [null, 3]);
  const vertices = mean.shape[0];
  const basis = someTensor(tree.basis, "coarse.basis", [null, vertices, 3], 0);
  const mlp = readMlp(tree.mlp, "coarse.mlp", inputs, basis.shape[0]);
  return { mlp, mean, basis, vertices, places: reals(tree.mean, "coarse.mean", [null, 3]).values };
}

/** @returns {Layer[]} */
function readMlp(
  /** @type {Tree[]} */ layers,
  /** @type {string} */ path,
  /** @type {number} */ first,
  /** @type {number} */ last,
) {
  let width = first;
  const mlp = layers.map((layer, i) => {
    const inputs = width;
    const weight = realTensor(layer.weight, `${path}[${i}].weight`, [null, inputs]);
    width = weight.shape[0];
    return { weight, bias: realTensor(layer.bias, `${path}[${i}].bias`, [width]), inputs, outputs: width };
  });
  if (!mlp.length || width !== last)
    throw fault("shape", path, `${mlp.length} layers with ${width} outputs, expected ${last}`);
  return mlp;
}

/**
 * One branch over `count` texels with LL of `size`, driven by so many components.
 * @param {Tree} tree @param {string} path @param {number} channels
 * @param {{count: number, inputs: number, size: number}} of
 * @returns {Branch}
 */
export function readBranch(tree, path, channels, { count, inputs, size }) {
  const llBasis = someTensor(tree.ll_basis, `${path}.ll_basis`, [channels, null, size, size], 1);
  const details = /** @type {Tree[]} */ (tree.details).map((band, i) =>
    readDetail(band, `${path}.details[${i}]`, channels, size * 2 ** i),
  );
  const rank = llBasis.shape[1];
  const outputs = channels * details.reduce((all, band) => all + band.rank, rank);
  return {
    mlp: readMlp(tree.mlp, `${path}.mlp`, inputs, outputs),
    llMean: realTensor(tree.ll_mean, `${path}.ll_mean`, [channels, size, size]),
    llBasis,
    details,
    staticOffset: realTensor(tree.static_offset, `${path}.static_offset`, [channels, count]),
    channels,
    rank,
  };
}

/** @returns {Detail} */
function readDetail(
  /** @type {Tree} */ tree,
  /** @type {string} */ path,
  /** @type {number} */ channels,
  /** @type {number} */ size,
) {
  const h = someTensor(tree.h, `${path}.h`, [3, channels, null, size], 2);
  const mean = realTensor(tree.mean, `${path}.mean`, [3, channels, size, size]);
  return { mean, h, w: realTensor(tree.w, `${path}.w`, h.shape), rank: h.shape[2], size };
}
