// Which expressions hold others back, and which are switches. Reference: python/mua/pose/expression_rules.py.

const KINDS = [0, 1, 2]; // blinks, looks, mouths
const OF_KIND = 3;
const SWITCH = 1 << 6;

/** The weights that show, as rules [E] hold them back. @param {Int32Array} rules @param {Float32Array} weights @returns {Float32Array} */
export function heldBack(rules, weights) {
  const role = (/** @type {number} */ e, /** @type {number} */ kind) => (rules[e] >> (2 * kind)) & OF_KIND;
  const own = Array.from(weights, (weight, e) => (rules[e] & SWITCH ? Number(weight > 0.5) : weight));
  const held = KINDS.map((kind) => {
    const amounts = own.map((weight, e) => [0, Number(weight > 0), weight, 0][role(e, kind)]);
    return Math.min(
      amounts.reduce((sum, amount) => sum + amount, 0),
      1,
    );
  });
  return weights.map((_, e) => {
    const amounts = KINDS.filter((kind) => role(e, kind) === OF_KIND).map((kind) => held[kind]);
    if (rules[e] & SWITCH) return amounts.some(Boolean) ? 0 : own[e];
    return amounts.reduce((weight, amount) => weight * (1 - amount), own[e]);
  });
}
