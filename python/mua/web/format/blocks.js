// The blocks of 2 x 2 texels that become the texels of a coarser level. Reference: section 9 of schemas/README.md.

import { fault, refuse } from "./parser.js";

/** @typedef {{size: number, texels: Int32Array}} Texels row * size + column of each, ascending */
/** @typedef {{texels: Int32Array, finer: Int32Array, codes: Uint8Array}} Blocks as texels [B], what they hold [B, 4], -1 for none */

/** What a texel is to its block: counted, its rotation too, gives it its place on the mesh. */
export const [MEMBER, TURNED, CHIEF] = [1, 2, 3];

export const kindOf = (/** @type {number} */ code, /** @type {number} */ corner) => (code >> (2 * corner)) & 3;

/** The blocks of every coarser level, each with one chief among its valid texels. @param {import("./parser.js").Tree[]} trees @param {Texels} texels */
export function readLevels(trees, { size, texels }) {
  return trees.map(({ blocks: codes }, i) => {
    const path = `texels.levels[${i}].blocks`;
    const level = { ...blocksOf(size >> i, texels), codes };
    if (codes.length !== level.texels.length)
      throw fault("shape", path, `${codes.length} bytes, expected ${level.texels.length}`);
    const wrong = codes.findIndex((/** @type {number} */ _, /** @type {number} */ block) => !isSound(level, block));
    if (wrong >= 0) throw refuse(path, `block ${wrong} has not one chief, or a member that is no valid texel`);
    texels = level.texels;
    return level;
  });
}

function isSound(/** @type {Blocks} */ { finer, codes }, /** @type {number} */ block) {
  const kinds = [0, 1, 2, 3].map((corner) => kindOf(codes[block], corner));
  const chiefs = kinds.filter((kind) => kind === CHIEF).length;
  return chiefs === 1 && kinds.every((kind, corner) => !kind || finer[4 * block + corner] >= 0);
}

function blocksOf(/** @type {number} */ size, /** @type {Int32Array} */ texels) {
  const numberOf = (/** @type {number} */ texel) =>
    (Math.floor(texel / size) >> 1) * (size >> 1) + ((texel % size) >> 1);
  const places = new Int32Array((size >> 1) ** 2).fill(-1);
  for (const texel of texels) places[numberOf(texel)] = 0;
  let count = 0;
  const numbers = new Int32Array(texels.length);
  places.forEach((place, number) => {
    if (place < 0) return;
    numbers[count] = number;
    places[number] = count++;
  });
  const finer = new Int32Array(4 * count).fill(-1);
  texels.forEach((texel, i) => {
    finer[4 * places[numberOf(texel)] + 2 * (Math.floor(texel / size) % 2) + ((texel % size) % 2)] = i;
  });
  return { texels: numbers.slice(0, count), finer };
}
