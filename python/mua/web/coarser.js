// Coarser levels of an avatar's texture: 2 x 2 texels become one, again and again, as the file says which. References:
// python/mua/avatar/coarser.py, section 9 of schemas/README.md.

import { CHIEF, kindOf, MEMBER, TURNED } from "./format/blocks.js";
import { GROWTH } from "./format/limits.js";
import { expanded } from "./format/tensors.js";
import { isOneSided } from "./prepare.js";

/** @typedef {import("./format/read.js").Avatar} Avatar */
/** @typedef {import("./format/blocks.js").Blocks} Blocks */
/** @typedef {{geometry: Float32Array, appearance: Float32Array}} Statics [11, N] and [12, N] */
/** @typedef {{size: number, texels: Int32Array, triangles: Int32Array, barycentrics: Float32Array, oneSided: Uint8Array, levels: Blocks[], statics: Statics}} Texture */

/** The finest level. @returns {Texture} */
export function textureOf(/** @type {Avatar} */ { texels, geometry, appearance }) {
  const statics = { geometry: expanded(geometry.staticOffset), appearance: expanded(appearance.staticOffset) };
  return { ...texels, statics };
}

/** The next level. @returns {Texture} */
export function coarserTexture(/** @type {Avatar} */ avatar, /** @type {Texture} */ texture) {
  const [blocks, ...levels] = texture.levels;
  const [chiefs, members] = [gathered(blocks, CHIEF).flat(), gathered(blocks, MEMBER)];
  const taken = (/** @type {number} */ width, /** @type {Int32Array | Float32Array} */ from) =>
    chiefs.flatMap((texel) => Array.from(from.subarray(width * texel, width * (texel + 1))));
  const count = texture.texels.length;
  return {
    size: texture.size / 2,
    texels: blocks.texels,
    triangles: Int32Array.from(taken(1, texture.triangles)),
    barycentrics: Float32Array.from(taken(2, texture.barycentrics)),
    oneSided: oneSidedBlocks(texture, members),
    levels,
    statics: {
      geometry: geometryOf(texture.statics.geometry, pointsOf(avatar, texture), blocks, count),
      appearance: Float32Array.from(means(texture.statics.appearance, members, count)),
    },
  };
}

/** The texels of each block that are at least of a kind. */
function gathered(/** @type {Blocks} */ { finer, codes }, /** @type {number} */ kind) {
  return Array.from(codes, (code, block) =>
    [0, 1, 2, 3].filter((corner) => kindOf(code, corner) >= kind).map((corner) => finer[4 * block + corner]),
  );
}

/** A bit for each block: whether all its members are one-sided. @param {Texture} texture @param {number[][]} members */
function oneSidedBlocks(texture, members) {
  const bits = new Uint8Array(Math.ceil(members.length / 8));
  members.forEach((held, block) => {
    if (held.every((member) => isOneSided(texture, member))) bits[block >> 3] |= 1 << (block & 7);
  });
  return bits;
}

/** Static offsets of geometry: means, of rotations that are nearly alike, about the chief's place, and larger. @param {Float32Array} statics @param {Float64Array} points @param {Blocks} blocks @param {number} count */
function geometryOf(statics, points, blocks, count) {
  const members = gathered(blocks, MEMBER);
  const found = means(statics, members, count);
  const moved = means(points, members, count);
  found.set(means(statics.subarray(3 * count, 7 * count), gathered(blocks, TURNED), count), 3 * members.length);
  gathered(blocks, CHIEF).forEach(([chief], block) => {
    for (let axis = 0; axis < 3; axis++) {
      found[axis * members.length + block] += moved[axis * members.length + block] - points[axis * count + chief];
      found[(7 + axis) * members.length + block] += (Math.log(GROWTH) * Math.log2(members[block].length)) / 2;
    }
  });
  return Float32Array.from(found);
}

/** Where the texels lie on the mean canonical mesh, [3, N] metres. */
function pointsOf(
  /** @type {Avatar} */ { coarse, template },
  /** @type {Texture} */ { texels, triangles, barycentrics },
) {
  const count = texels.length;
  const points = new Float64Array(3 * count);
  for (let texel = 0; texel < count; texel++) {
    const [a, b] = [barycentrics[2 * texel], barycentrics[2 * texel + 1]];
    const shares = [a, b, Math.max(Math.fround(1 - Math.fround(a + b)), 0)];
    for (let axis = 0; axis < 3; axis++)
      points[axis * count + texel] = shares.reduce(
        (sum, share, corner) => sum + share * coarse.places[3 * template.faces[3 * triangles[texel] + corner] + axis],
        0,
      );
  }
  return points;
}

/** Means [c, B] over the members of blocks of values [c, N]. @param {Float32Array | Float64Array} values @param {number[][]} members @param {number} count */
function means(values, members, count) {
  const channels = values.length / Math.max(count, 1);
  const found = new Float64Array(channels * members.length);
  members.forEach((held, block) => {
    for (let channel = 0; channel < channels; channel++)
      found[channel * members.length + block] =
        held.reduce((sum, member) => sum + values[channel * count + member], 0) / held.length;
  });
  return found;
}
