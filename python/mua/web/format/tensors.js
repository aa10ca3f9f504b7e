// The Tensor of the file: shape, element type, bytes, and one scale for each row where the type is I8. What is uploaded
// stays in its stored type. Reference: python/mua/asset/tensors.py.

import { LARGEST, MAX_RANK } from "./limits.js";
import { general } from "./numbers.js";
import { fault } from "./parser.js";

/** @typedef {import("./parser.js").Tree} Tree */

/**
 * @typedef {object} Stored a tensor as it stands in the file
 * @property {number[]} shape
 * @property {"F32" | "F16" | "I8" | "I32"} type
 * @property {Uint8Array} data
 * @property {Float32Array | undefined} scale of each row of I8
 */

export const MAX_BYTES = 2 ** 31 - 1;
/** @type {Record<string, number>} */
export const SIZES = { F32: 4, F16: 2, I8: 1, I32: 4 };
const HALF_MAGNITUDE = 0x7fff;
const HALF_INFINITY = 0x7c00;

const product = (/** @type {number[]} */ sides) => sides.reduce((all, side) => all * side, 1);
const listed = (/** @type {number[]} */ sides) => `[${sides.join(", ")}]`;

/** The shape of a tensor that a file could hold. @returns {number[]} */
export function sides(/** @type {Tree} */ tensor, /** @type {string} */ path) {
  const shape = Array.from(/** @type {Uint32Array} */ (tensor.shape));
  if (shape.length < 1 || shape.length > MAX_RANK)
    throw fault("shape", `${path}.shape`, `${shape.length} dimensions, expected 1 to ${MAX_RANK}`);
  if (product(shape.map((side) => Math.max(side, 1))) > MAX_BYTES)
    throw fault("shape", `${path}.shape`, `the sides ${listed(shape)} multiply to more than a file can hold`);
  return shape;
}

/** The fault of a tensor of another number of scales than it has equal rows. */
export const unfit = (
  /** @type {number} */ rows,
  /** @type {string} */ type,
  /** @type {number[]} */ shape,
  /** @type {string} */ path,
) => fault("shape", `${path}.scale`, `${rows} scales do not fit ${type} ${listed(shape)}`);

/** A tensor whose shape, bytes and scales agree. @returns {Stored} */
function stored(/** @type {Tree} */ tensor, /** @type {string} */ path) {
  const shape = sides(tensor, path);
  const type = /** @type {Stored["type"]} */ (tensor.type);
  const { data } = tensor;
  if (product(shape) * SIZES[type] !== data.length)
    throw fault("shape", `${path}.data`, `${data.length} bytes do not fill ${type} ${listed(shape)}`);
  const rows = tensor.scale?.length ?? 0;
  if ((type === "I8") !== rows > 0 || (rows && product(shape) % rows)) throw unfit(rows, type, shape, path);
  return { shape, type, data, scale: tensor.scale };
}

function checkShape(/** @type {number[]} */ found, /** @type {string} */ path, /** @type {(number | null)[]} */ shape) {
  if (found.length === shape.length && shape.every((side, i) => side === null || side === found[i])) return;
  const expected = shape.map((side) => side ?? "any").join(", ");
  throw fault("shape", `${path}.shape`, `${listed(found)}, expected [${expected}]`);
}

/**
 * Whole numbers of `shape` (null: any length) from `low` to below `high`.
 * @param {Tree} tensor @param {string} path @param {(number | null)[]} shape @param {number} low @param {number} high
 */
export function indices(tensor, path, shape, low, high) {
  const found = stored(tensor, path);
  checkShape(found.shape, path, shape);
  if (found.type !== "I32") throw fault("type", path, `element type ${found.type}, expected I32`);
  const values = words(found, Int32Array);
  const wrong = values.find((index) => index < low || index >= high);
  if (wrong !== undefined) throw fault("range", path, `index ${wrong} lies outside ${low} to ${high - 1}`);
  return values;
}

/**
 * A tensor of reals of `shape`, finite and at most LARGEST, in its stored type.
 * @param {Tree} tensor @param {string} path @param {(number | null)[]} shape
 */
export function realTensor(tensor, path, shape) {
  const found = stored(tensor, path);
  checkShape(found.shape, path, shape);
  if (found.type === "I32") throw fault("type", path, "element type I32, expected F32, F16 or I8");
  const worst = farthest(found);
  if (Number.isNaN(worst)) throw fault("finite", path, "a value is not finite");
  if (Math.abs(worst) > LARGEST) throw fault("value", path, `${general(worst, 6)}, expected -${LARGEST} to ${LARGEST}`);
  return found;
}

/** The same, expanded: row-major float32. @param {Tree} tensor @param {string} path @param {(number | null)[]} shape */
export function reals(tensor, path, shape) {
  const found = realTensor(tensor, path, shape);
  return { shape: found.shape, values: expanded(found) };
}

/** A tensor of at least one component or rank along a side. @param {Tree} tensor @param {string} path @param {(number | null)[]} shape @param {number} side */
export function someTensor(tensor, path, shape, side) {
  const found = realTensor(tensor, path, shape);
  if (!found.shape[side]) throw fault("shape", `${path}.shape`, `side ${side} is 0, expected 1 or more`);
  return found;
}

/** The largest magnitude of finite values; 0 of none. */
export function largest(/** @type {Stored} */ found) {
  let most = 0;
  if (found.type === "F16") {
    for (const bits of words(found, Uint16Array)) most = Math.max(most, bits & HALF_MAGNITUDE);
    return half(most);
  }
  for (const value of expanded(found)) most = Math.max(most, Math.abs(value));
  return most;
}

/** The value of the largest magnitude; NaN where one is not finite. */
function farthest(/** @type {Stored} */ found) {
  if (found.type === "F16") {
    let most = 0;
    for (const half of words(found, Uint16Array)) most = Math.max(most, half & HALF_MAGNITUDE);
    return most >= HALF_INFINITY ? NaN : 0; // no half is above LARGEST
  }
  if (found.type === "I8" && found.scale?.every((scale) => Math.abs(scale) <= LARGEST / 128)) return 0;
  const values = expanded(found);
  let worst = 0;
  for (let i = 0; i < values.length; i++) {
    if (!Number.isFinite(values[i])) return NaN;
    if (Math.abs(values[i]) > Math.abs(worst)) worst = values[i];
  }
  return (found.scale?.every(Number.isFinite) ?? true) ? worst : NaN;
}

/** The elements as float32. */
export function expanded(/** @type {Stored} */ found) {
  if (found.type === "F32") return words(found, Float32Array);
  if (found.type === "F16") return Float32Array.from(words(found, Uint16Array), half);
  const stored = words(found, Int8Array);
  const scale = /** @type {Float32Array} */ (found.scale);
  const [values, row] = [new Float32Array(stored.length), stored.length / scale.length];
  for (let r = 0; r < scale.length; r++) for (let i = r * row; i < (r + 1) * row; i++) values[i] = stored[i] * scale[r];
  return values;
}

/** The value of a half float's bits. */
export function half(/** @type {number} */ bits) {
  const exponent = (bits >> 10) & 31;
  const fraction = bits & 1023;
  const size = exponent ? 2 ** (exponent - 15) * (1 + fraction / 1024) : fraction * 2 ** -24;
  return bits & 0x8000 ? -size : size;
}

/**
 * @template {ArrayBufferView} T
 * @param {Stored} found
 * @param {{new (content: ArrayBufferLike, at: number, count: number): T, BYTES_PER_ELEMENT: number}} kind
 */
function words(found, kind) {
  return new kind(found.data.buffer, found.data.byteOffset, found.data.length / kind.BYTES_PER_ELEMENT);
}
