// Principal components of the motion descriptor, limited to the range of training: the input of the networks. Reference:
// python/mua/pose/components.py, and sections 3.5 to 3.7 of schemas/README.md.

/** @typedef {import("./format/read.js").Encoding} Encoding */

/**
 * What the networks read [K] of a descriptor, and how far outside of training it is: the share of the pose that training
 * did not show, 0 to 1.
 * @param {Encoding} encoding @param {Float64Array} descriptor [D]
 */
export function readComponents({ mean, scale, directions, ranges, margins }, descriptor) {
  const normal = descriptor.map((value, i) => (value - mean[i]) / scale[i]);
  const count = margins.length;
  const found = new Float64Array(count);
  for (let k = 0, at = 0; k < count; k++)
    for (let i = 0; i < normal.length; i++) found[k] += directions[at++] * normal[i];
  const held = found.map((value, k) => hold(value, ranges[k], ranges[count + k], margins[k]));
  const whole = length(found);
  return { held, outside: whole > 0 ? length(found.map((value, k) => value - held[k])) / whole : 0 };
}

const length = (/** @type {Float64Array} */ values) => Math.sqrt(values.reduce((sum, value) => sum + value * value, 0));

/** A component as it is within its range; beyond, it approaches the margin and never exceeds it. */
function hold(
  /** @type {number} */ value,
  /** @type {number} */ low,
  /** @type {number} */ high,
  /** @type {number} */ margin,
) {
  const nearest = Math.min(Math.max(value, low), high);
  const beyond = Math.abs(value - nearest);
  return beyond > 0 ? nearest + (Math.sign(value - nearest) * beyond * margin) / (beyond + margin) : value;
}
