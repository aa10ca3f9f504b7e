// What the kernels read of a file that it does not hold in that form. References: python/mua/kernels/inverse_dwt.py and
// splat_project.py.

const TILE = 16; // texels along a side
export const TILE_WORDS = 2 * (1 + TILE);
const LARGEST_BARYCENTRIC = 65535;
const ONE_SIDED = 2 ** 31; // beside the triangle of a texel that is not drawn from behind

/** Where texels lie on the mesh, [N, 2] words: the triangle, whether one-sided, two barycentrics of 16 bits each. */
export function texelWords(
  /** @type {{triangles: Int32Array, barycentrics: Float32Array, oneSided: Uint8Array}} */ texels,
) {
  const { triangles, barycentrics } = texels;
  const words = new Uint32Array(2 * triangles.length);
  for (let i = 0; i < triangles.length; i++) {
    const [first, second] = [0, 1].map((k) => toEven(barycentrics[2 * i + k] * LARGEST_BARYCENTRIC));
    words[2 * i] = triangles[i] + (isOneSided(texels, i) ? ONE_SIDED : 0);
    words[2 * i + 1] = (first | (second << 16)) >>> 0;
  }
  return words;
}

/** Whether a texel is not drawn from behind. */
export const isOneSided = (/** @type {{oneSided: Uint8Array}} */ { oneSided }, /** @type {number} */ texel) =>
  (oneSided[texel >> 3] >> (texel & 7)) & 1;

/** The nearest whole number, the even one of two. */
function toEven(/** @type {number} */ value) {
  const below = Math.floor(value);
  const above = value - below > 0.5 || (value - below === 0.5 && below % 2 === 1);
  return above ? below + 1 : below;
}

/**
 * Tiles of 16 x 16 texels that hold a valid one, ascending: column and row of each; and of each of its rows the place in
 * `texels` of the first that it holds, and its columns as bits, from bit 16 on those in reach of expressions.
 * @param {{texels: Int32Array, size: number, triangles: Int32Array}} texels @param {Uint8Array} [reached] triangles
 */
export function texelTiles({ texels, size, triangles }, reached) {
  const across = Math.ceil(size / TILE);
  const slots = new Int32Array(across * across).fill(-1);
  for (const texel of texels) slots[tileOf(texel, size, across)] = 0;
  const held = Array.from(slots.keys()).filter((tile) => slots[tile] === 0);
  const tiles = new Uint32Array(TILE_WORDS * held.length);
  held.forEach((tile, slot) => {
    slots[tile] = slot;
    tiles.set([tile % across, Math.floor(tile / across)], TILE_WORDS * slot);
  });
  texels.forEach((texel, place) => {
    const line = TILE_WORDS * slots[tileOf(texel, size, across)] + 2 * (1 + (Math.floor(texel / size) % TILE));
    if (!tiles[line + 1]) tiles[line] = place;
    tiles[line + 1] |= (reached?.[triangles[place]] ? 0x10001 : 1) << ((texel % size) % TILE);
  });
  return tiles;
}

function tileOf(/** @type {number} */ texel, /** @type {number} */ size, /** @type {number} */ across) {
  return Math.floor(Math.floor(texel / size) / TILE) * across + Math.floor((texel % size) / TILE);
}

/**
 * The filter [reach, factor] that so many levels of low-pass synthesis are together, and its delay.
 * @param {Float64Array} recLo @param {number} levels @param {number} [coarser] times that two texels become one
 */
export function upsamplingTaps(recLo, levels, coarser = 0) {
  let taps = [1];
  for (let level = 0; level < levels; level++) {
    const wider = new Array(2 * (taps.length - 1) + recLo.length).fill(0);
    taps.forEach((tap, i) => recLo.forEach((other, k) => (wider[2 * i + k] += tap * other)));
    taps = wider;
  }
  let delay = (2 ** levels - 1) * (recLo.length / 2 - 1);
  for (let level = 0; level < coarser; level++) {
    const even = [...(delay % 2 ? [0] : []), ...taps, ...((taps.length + delay) % 2 ? [0] : [])];
    taps = even.flatMap((tap, i) => (i % 2 ? [] : [(tap + even[i + 1]) / 2]));
    delay = Math.floor((delay + 1) / 2);
  }
  const factor = 2 ** (levels - coarser);
  const used = taps.flatMap((tap, i) => (tap ? [i] : []));
  const first = used.length ? Math.min(used[0], delay) : 0;
  const last = used.length ? used[used.length - 1] : 0;
  const reach = Math.ceil((last + 1 - first) / factor);
  const padded = new Array(reach * factor).fill(0);
  taps.slice(first, last + 1).forEach((tap, i) => (padded[i] = tap));
  return { taps: padded, factor, reach, delay: delay - first };
}

/**
 * The first two barycentrics [N, 2] of each texel's centre in its triangle, from UV alone, as every reader computes them;
 * NaN where a triangle has no area. Reference: python/mua/rig/texel_map.py.
 * @param {{uv: Float32Array, uvFaces: Int32Array}} template @param {number} size @param {Int32Array} texels @param {Int32Array} triangles
 */
export function centreBarycentrics({ uv, uvFaces }, size, texels, triangles) {
  const found = new Float32Array(2 * texels.length);
  for (let e = 0; e < texels.length; e++) {
    const [column, row] = [(texels[e] % size) + 0.5, Math.floor(texels[e] / size) + 0.5];
    const [a, b, c] = [0, 1, 2].map((corner) => 2 * uvFaces[3 * triangles[e] + corner]);
    const [ax, ay] = [uv[a] * size - column, uv[a + 1] * size - row];
    const [bx, by] = [uv[b] * size - column, uv[b + 1] * size - row];
    const [cx, cy] = [uv[c] * size - column, uv[c + 1] * size - row];
    const [one, two, three] = [bx * cy - by * cx, cx * ay - cy * ax, ax * by - ay * bx];
    const whole = one + two + three || NaN;
    found[2 * e] = Math.min(Math.max(one / whole, 0), 1);
    found[2 * e + 1] = Math.min(Math.max(two / whole, 0), 1 - found[2 * e]);
  }
  return found;
}
