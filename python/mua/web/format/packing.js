// Tensors as a file for the network holds them, deflated: their bytes in planes, all first bytes of the elements and then all
// second ones; or halves as the multiples of their row's scale that they are. Reference: python/mua/asset/packing.py.

import { ROOT, TABLES } from "./layout.js";
import { LARGEST_STEP, LEAST_STEP, UNPACKED_ROOM, UNPACKED_TIMES } from "./limits.js";
import { general } from "./numbers.js";
import { fault } from "./parser.js";
import { isThere } from "./stages.js";
import { SIZES, sides, unfit } from "./tensors.js";

const NUMBERS = 2 ** 16; // that may stand for a multiple of a scale
const LEAST_NORMAL = 2 ** -14; // of halves
const BIAS_DIFFERENCE = (127 - 15) << 10;
const SIGN = 0x8000;

/** @typedef {import("./parser.js").Tree} Tree */

/**
 * Unpack the packed tensors of a file of `size` bytes, in place. What a tensor gives is known from its shape, and what all
 * of them give is refused before any is unpacked. Those that end beyond `end` are zeros of their shape.
 * @param {Tree} tree @param {number} size @param {number} [end]
 */
export async function unpack(tree, size, end = size) {
  const held = [...tensors(tree, ROOT, "")].filter(([, tensor]) => tensor.packing !== "Plain" || !isThere(tensor, end));
  const most = UNPACKED_TIMES * size + UNPACKED_ROOM;
  let all = 0;
  for (const [path, tensor] of held) {
    all += claimed(tensor, path);
    if (all > most) {
      const sentence = `the file's packed tensors claim more than ${most} bytes, too many for ${size} bytes`;
      throw fault("value", `${path}.data`, sentence);
    }
  }
  const room = new Uint8Array(Math.max(0, ...held.map(([path, tensor]) => claimed(tensor, path)))); // for one at a time
  /** @type {Map<number, Uint16Array>} */
  const known = new Map(); // halves of every step, by the scale
  for (const [path, tensor] of held) {
    const scales = tensor.packing === "Steps" ? scalesOf(tensor, path) : undefined;
    const planes = room.subarray(0, claimed(tensor, path));
    if (isThere(tensor, end)) await inflate(tensor.data, planes, path);
    else planes.fill(0);
    tensor.data = scales ? halves(planes, scales, known) : interleaved(planes, SIZES[tensor.type]);
    if (scales) tensor.scale = undefined;
    tensor.packing = "Plain";
  }
}

/** Bytes of a tensor's elements, by its shape. */
function claimed(/** @type {Tree} */ tensor, /** @type {string} */ path) {
  const count = sides(tensor, path).reduce((all, side) => all * side, 1);
  return count * SIZES[tensor.type];
}

/** The paths and tensors of a tree, in the schema's order. @returns {Generator<[string, Tree]>} */
function* tensors(/** @type {Tree} */ tree, /** @type {string} */ table, /** @type {string} */ path) {
  for (const { name, kind, vector } of TABLES[table]) {
    if (!(kind in TABLES) || !(name in tree)) continue;
    const place = path ? `${path}.${name}` : name;
    const parts = vector ? tree[name] : [tree[name]];
    for (const [i, part] of parts.entries()) {
      const at = vector ? `${place}[${i}]` : place;
      if (kind === "Tensor") yield [at, part];
      else yield* tensors(part, kind, at);
    }
  }
}

/** Make the bytes of `found` from a stream; not much more is made of it. */
async function inflate(
  /** @type {Uint8Array<ArrayBuffer>} */ stream,
  /** @type {Uint8Array} */ found,
  /** @type {string} */ path,
) {
  const count = found.length;
  if (!count) return; // not every language notices that an empty stream is damaged
  const reader = new Blob([stream]).stream().pipeThrough(new DecompressionStream("deflate-raw")).getReader();
  let [got, whole] = [0, true];
  try {
    for (let part = await reader.read(); !part.done; part = await reader.read()) {
      if (got + part.value.length > count) {
        got = Infinity;
        break;
      }
      found.set(part.value, got);
      got += part.value.length;
    }
  } catch {
    if (got < count) throw fault("packed", `${path}.data`, "the bytes are no deflate stream: the file is damaged");
    whole = false; // it does not end, or bytes follow it
  }
  reader.cancel().catch(() => {}); // what is left of it does not matter
  if (got === count && whole) return;
  if (got === count)
    throw fault("packed", `${path}.data`, "the stream does not end with its bytes: the file is damaged");
  const given = got > count ? `more than ${count}` : got;
  throw fault("packed", `${path}.data`, `the stream gives ${given} bytes, expected ${count}`);
}

/** Of halves that are packed as steps: powers of two, one for each of as many equal rows. @returns {Float32Array} */
function scalesOf(/** @type {Tree} */ tensor, /** @type {string} */ path) {
  if (tensor.type !== "F16")
    throw fault("type", path, `element type ${tensor.type}, expected F16 of what is packed as steps`);
  const scales = tensor.scale ?? new Float32Array(0);
  if (!scales.length || (claimed(tensor, path) / SIZES.F16) % scales.length)
    throw unfit(scales.length, tensor.type, sides(tensor, path), path);
  const isScale = (/** @type {number} */ scale) =>
    scale >= LEAST_STEP && scale <= LARGEST_STEP && Number.isInteger(Math.log2(scale));
  const wrong = scales.find((/** @type {number} */ scale) => !isScale(scale));
  if (wrong !== undefined)
    throw fault("value", `${path}.scale`, `${general(wrong, 6)}, expected a power of two from 2^-24 to 1`);
  return scales;
}

/** Bytes of halves from two planes of their steps, one row for each scale. */
function halves(
  /** @type {Uint8Array} */ planes,
  /** @type {Float32Array} */ scales,
  /** @type {Map<number, Uint16Array>} */ known,
) {
  const found = new Uint16Array(planes.length / 2);
  const row = found.length / scales.length;
  for (let i = 0; i < scales.length; i++) {
    if (!known.has(scales[i])) known.set(scales[i], multiples(scales[i]));
    const steps = /** @type {Uint16Array} */ (known.get(scales[i]));
    for (let at = i * row; at < (i + 1) * row; at++) found[at] = steps[planes[at] | (planes[at + found.length] << 8)];
  }
  return new Uint8Array(found.buffer);
}

/** The halves nearest to 0, -1, 1, -2, 2 and so on, times a scale. */
function multiples(/** @type {number} */ scale) {
  const sizes = new Float32Array(NUMBERS);
  for (let i = 0; i < NUMBERS; i++) sizes[i] = ((i + 1) >> 1) * scale;
  const bits = new Uint32Array(sizes.buffer);
  const found = new Uint16Array(NUMBERS);
  for (let i = 0; i < NUMBERS; i++) {
    const rounded = ((bits[i] + 0xfff + ((bits[i] >> 13) & 1)) >> 13) - BIAS_DIFFERENCE;
    found[i] = (sizes[i] < LEAST_NORMAL ? sizes[i] / LEAST_STEP : rounded) | (i % 2 ? SIGN : 0);
  }
  return found;
}

/** Elements of so many bytes from planes of their first bytes, their second ones and so on. */
function interleaved(/** @type {Uint8Array} */ planes, /** @type {number} */ width) {
  if (width === 1) return planes.slice();
  const data = new Uint8Array(planes.length);
  const count = planes.length / width;
  for (let plane = 0; plane < width; plane++)
    for (let i = 0; i < count; i++) data[width * i + plane] = planes[plane * count + i];
  return data;
}
