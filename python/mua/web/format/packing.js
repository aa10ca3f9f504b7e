// Tensors as a file for the network holds them: their bytes in planes, all first bytes of the elements and then all second
// ones, and deflated. Reference: python/mua/asset/packing.py.

import { ROOT, TABLES } from "./layout.js";
import { UNPACKED_ROOM, UNPACKED_TIMES } from "./limits.js";
import { fault } from "./parser.js";
import { isThere } from "./stages.js";
import { SIZES, sides } from "./tensors.js";

/** @typedef {import("./parser.js").Tree} Tree */

/**
 * Unpack the packed tensors of a file of `size` bytes, in place. What a tensor gives is known from its shape, and what all
 * of them give is refused before any is unpacked. Those that end beyond `end` are zeros of their shape.
 * @param {Tree} tree @param {number} size @param {number} [end]
 */
export async function unpack(tree, size, end = size) {
  const held = [...tensors(tree, ROOT, "")].filter(
    ([, tensor]) => tensor.packing === "Deflate" || !isThere(tensor, end),
  );
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
  for (const [path, tensor] of held) {
    const planes = room.subarray(0, claimed(tensor, path));
    if (isThere(tensor, end)) await inflate(tensor.data, planes, path);
    else planes.fill(0);
    tensor.data = interleaved(planes, SIZES[tensor.type]);
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

/** Elements of so many bytes from planes of their first bytes, their second ones and so on. */
function interleaved(/** @type {Uint8Array} */ planes, /** @type {number} */ width) {
  if (width === 1) return planes.slice();
  const data = new Uint8Array(planes.length);
  const count = planes.length / width;
  for (let plane = 0; plane < width; plane++)
    for (let i = 0; i < count; i++) data[width * i + plane] = planes[plane * count + i];
  return data;
}
