// Numbers in sentences as Python writes them, so that every reader tells of a fault in the same words.

/** A number with so many significant digits, without trailing zeros: Python's `.6g`. */
export function general(/** @type {number} */ value, /** @type {number} */ digits) {
  if (!Number.isFinite(value)) return shortest(value);
  const [mantissa, exponent] = value.toExponential(digits - 1).split("e");
  const power = Number(exponent);
  if (power < -4 || power >= digits) return `${trimmed(mantissa)}e${signed(power)}`;
  return trimmed(value.toFixed(Math.max(digits - 1 - power, 0)));
}

/** A number of two digits and its power of ten: Python's `.1e`. */
export function scientific(/** @type {number} */ value) {
  const [mantissa, exponent] = value.toExponential(1).split("e");
  return `${mantissa}e${signed(Number(exponent))}`;
}

/** The shortest digits that give the same number again: Python's repr. */
export function shortest(/** @type {number} */ value) {
  if (!Number.isFinite(value)) return String(value).replace("Infinity", "inf").toLowerCase();
  const size = Math.abs(value);
  if (size && (size < 1e-4 || size >= 1e16)) {
    const [mantissa, exponent] = value.toExponential().split("e");
    return `${mantissa}e${signed(Number(exponent))}`;
  }
  return Number.isInteger(value) ? value.toFixed(1) : String(value);
}

const trimmed = (/** @type {string} */ text) => (text.includes(".") ? text.replace(/\.?0+$/, "") : text);
const signed = (/** @type {number} */ power) => `${power < 0 ? "-" : "+"}${String(Math.abs(power)).padStart(2, "0")}`;
