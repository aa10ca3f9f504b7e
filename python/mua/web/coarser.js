// Coarser levels of an avatar's texture: every 2 x 2 texels become one, again and again. References: python/mua/avatar/coarser.py,
// section 9 of schemas/README.md.

import { expanded } from "./format/tensors.js";
import { isOneSided } from "./prepare.js";

/** @typedef {import("./format/read.js").Avatar} Avatar */
/** @typedef {{geometry: Float32Array, appearance: Float32Array}} Statics [11, N] and [12, N] */
/** @typedef {{size: number, texels: Int32Array, triangles: Int32Array, barycentrics: Float32Array, oneSided: Uint8Array, statics: Statics}} Texture */
/** @typedef {{kept: Int32Array, members: Int32Array}} Blocks the texel [B] that gives each block its place, and its members [B, 4] */

const STATIC_LEVELS = 2; // at most
const MOST_TAPS = 32; // of a wavelet that has coarser levels
const REACH = 6; // texels: what lies farther apart in space belongs to other surfaces
const GROWTH = 1.85; // of the standard deviations where one splat stands for four
const TURN = 1; // between quaternions: what is turned farther has no part in a mean rotation

/** The coarsest level that an avatar has, 0 where it has but one. */
export function coarsest(/** @type {Avatar} */ { wavelet, geometry, appearance }) {
  const details = Math.max(geometry.details.length, appearance.details.length);
  return wavelet.recLo.length > MOST_TAPS ? 0 : Math.min(STATIC_LEVELS, wavelet.levels - details);
}

/** Splats of each level, the finest first. @returns {number[]} */
export function levelCounts(/** @type {Avatar} */ avatar) {
  let { size, texels } = avatar.texels;
  const counts = [texels.length];
  for (let level = 0; level < coarsest(avatar); level++, size /= 2) {
    const blocks = new Uint8Array((size / 2) ** 2);
    for (const texel of texels) blocks[blockOf(texel, size)] = 1;
    texels = new Int32Array(texels.length);
    let count = 0;
    blocks.forEach((there, block) => there && (texels[count++] = block));
    texels = texels.subarray(0, count);
    counts.push(count);
  }
  return counts;
}

/** The side of one of `count` texels on the surface, metres: of all of the template in equal parts. */
export function texelLength(/** @type {Avatar} */ { coarse, template }, /** @type {number} */ count) {
  const { places } = coarse;
  let area = 0;
  for (let at = 0; at < template.faces.length; at += 3) {
    const [a, b, c] = [0, 1, 2].map((corner) => 3 * template.faces[at + corner]);
    const [x, y, z] = [0, 1, 2].map((axis) => places[b + axis] - places[a + axis]);
    const [u, v, w] = [0, 1, 2].map((axis) => places[c + axis] - places[a + axis]);
    area += Math.hypot(y * w - z * v, z * u - x * w, x * v - y * u) / 2;
  }
  return count ? Math.sqrt(area / count) : 0;
}

/** The finest level. @returns {Texture} */
export function textureOf(/** @type {Avatar} */ { texels, geometry, appearance }) {
  const statics = { geometry: expanded(geometry.staticOffset), appearance: expanded(appearance.staticOffset) };
  return { ...texels, statics };
}

/** The next level. @returns {Texture} */
export function coarserTexture(/** @type {Avatar} */ avatar, /** @type {Texture} */ texture) {
  const count = texture.texels.length;
  const points = pointsOf(avatar, texture);
  const places = points.map((value, i) => value + texture.statics.geometry[i]); // the first three channels are an offset
  const blocks = blocksOf(texture, places, REACH * texelLength(avatar, count));
  const { kept } = blocks;
  const taken = (/** @type {number} */ width, /** @type {Int32Array | Float32Array} */ from) =>
    Array.from(kept).flatMap((texel) => Array.from(from.subarray(width * texel, width * (texel + 1))));
  const half = texture.size / 2;
  return {
    size: half,
    texels: kept.map((texel) => blockOf(texture.texels[texel], texture.size)),
    triangles: Int32Array.from(taken(1, texture.triangles)),
    barycentrics: Float32Array.from(taken(2, texture.barycentrics)),
    oneSided: oneSidedBlocks(texture, blocks),
    statics: {
      geometry: geometryOf(texture.statics.geometry, points, blocks, count),
      appearance: means(texture.statics.appearance, blocks.members, count),
    },
  };
}

/** A bit for each block: whether all its members are one-sided. @param {Texture} texture @param {Blocks} blocks */
function oneSidedBlocks(texture, { kept, members }) {
  const bits = new Uint8Array(Math.ceil(kept.length / 8));
  for (let block = 0; block < kept.length; block++) {
    const held = members.subarray(4 * block, 4 * block + 4).filter((member) => member >= 0);
    if (held.every((member) => isOneSided(texture, member))) bits[block >> 3] |= 1 << (block & 7);
  }
  return bits;
}

/** Static offsets of geometry: means, of rotations that are nearly alike, about the kept texel's place, and larger. @param {Float32Array} statics @param {Float64Array} points @param {Blocks} blocks @param {number} count */
function geometryOf(statics, points, { kept, members }, count) {
  const found = means(statics, members, count);
  const moved = means(points, members, count);
  const turned = means(statics.subarray(3 * count, 7 * count), turnedAlike(statics, members, kept, count), count);
  const blocks = kept.length;
  found.set(turned, 3 * blocks);
  for (let block = 0; block < blocks; block++) {
    const held = members.subarray(4 * block, 4 * block + 4).filter((member) => member >= 0).length;
    for (let axis = 0; axis < 3; axis++) {
      found[axis * blocks + block] += moved[axis * blocks + block] - points[axis * count + kept[block]];
      found[(7 + axis) * blocks + block] += (Math.log(GROWTH) * Math.log2(held)) / 2;
    }
  }
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
    const shares = [a, b, Math.max(1 - Math.fround(a + b), 0)];
    for (let axis = 0; axis < 3; axis++)
      points[axis * count + texel] = shares.reduce(
        (sum, share, corner) => sum + share * coarse.places[3 * template.faces[3 * triangles[texel] + corner] + axis],
        0,
      );
  }
  return points;
}

const blockOf = (/** @type {number} */ texel, /** @type {number} */ size) =>
  (Math.floor(texel / size) >> 1) * (size / 2) + ((texel % size) >> 1);

/**
 * Blocks of 2 x 2: the texel that has most others within reach, the first of equals, and the members within its reach.
 * @param {Texture} texture @param {Float64Array} places [3, N] @param {number} reach metres @returns {Blocks}
 */
function blocksOf({ size, texels }, places, reach) {
  const slots = new Int32Array(size * size).fill(-1); // [blocks, 4]
  texels.forEach((texel, i) => {
    const row = Math.floor(texel / size);
    slots[4 * blockOf(texel, size) + 2 * (row % 2) + ((texel % size) % 2)] = i;
  });
  const count = texels.length;
  const near = (/** @type {number} */ a, /** @type {number} */ b) =>
    a >= 0 && b >= 0 && Math.hypot(...[0, 1, 2].map((k) => places[k * count + a] - places[k * count + b])) <= reach;
  /** @type {number[]} */
  const kept = [];
  /** @type {number[]} */
  const members = [];
  for (let at = 0; at < slots.length; at += 4) {
    const four = Array.from(slots.subarray(at, at + 4));
    if (four.every((texel) => texel < 0)) continue;
    const others = four.map((a) => four.filter((b) => near(a, b)).length);
    const chief = four[others.indexOf(Math.max(...others))];
    kept.push(chief);
    members.push(...four.map((texel) => (near(chief, texel) ? texel : -1)));
  }
  return { kept: Int32Array.from(kept), members: Int32Array.from(members) };
}

/** Those of the members that are turned nearly as the one that is kept. @param {Float32Array} statics @param {Int32Array} members @param {Int32Array} kept @param {number} count */
function turnedAlike(statics, members, kept, count) {
  const apart = (/** @type {number} */ a, /** @type {number} */ b) =>
    Math.hypot(...[3, 4, 5, 6].map((channel) => statics[channel * count + a] - statics[channel * count + b]));
  return members.map((member, i) => (member >= 0 && apart(member, kept[i >> 2]) <= TURN ? member : -1));
}

/** Means [c, B] over the members of blocks of values [c, N]. @param {Float32Array | Float64Array} values @param {Int32Array} members @param {number} count */
function means(values, members, count) {
  const [channels, blocks] = [values.length / Math.max(count, 1), members.length / 4];
  const found = new Float32Array(channels * blocks);
  for (let block = 0; block < blocks; block++) {
    const held = members.subarray(4 * block, 4 * block + 4).filter((member) => member >= 0);
    for (let channel = 0; channel < channels; channel++)
      found[channel * blocks + block] =
        held.reduce((sum, member) => sum + values[channel * count + member], 0) / Math.max(held.length, 1);
  }
  return found;
}
