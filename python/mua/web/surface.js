// Triangles over the texels, as a file holds them, and those about each texel, by which its normal is found when it is
// posed. References: python/mua/rig/surface.py, python/mua/player/surface.py, section 8 of schemas/README.md.

/** @typedef {{size: number, texels: Int32Array}} TexelGrid */

const [FIRST, SECOND, RISING, TURNED] = [1, 2, 4, 8]; // bits of a block's code
const END = -1; // of a strip

/** Corners [K, 4] of the 2 x 2 blocks of which at least three texels are valid: a, b over c, d, or -1. */
export function blocks(/** @type {TexelGrid} */ { size, texels }) {
  const found = new Int32Array(8 * texels.length); // a texel begins at most two
  let count = 0;
  let [below, belowLeft] = [0, 0]; // the first texel at or after the one below a block's left corner
  let last = -1;
  for (let i = 0; i < texels.length; i++) {
    const column = texels[i] % size;
    const starts = column > 0 && texels[i] - 1 > last && texels[i - 1] !== texels[i] - 1 ? [texels[i] - 1] : [];
    if (column < size - 1) starts.push(texels[i]);
    for (const start of starts) {
      last = start;
      while (below < texels.length && texels[below] < start + size) below++;
      belowLeft = below;
      const a = start === texels[i] ? i : -1;
      const next = a < 0 ? i : i + 1;
      const b = texels[next] === start + 1 ? next : -1;
      const c = texels[belowLeft] === start + size ? belowLeft : -1;
      const right = c < 0 ? belowLeft : belowLeft + 1;
      const d = texels[right] === start + size + 1 ? right : -1;
      if (Number(a >= 0) + Number(b >= 0) + Number(c >= 0) + Number(d >= 0) < 3) continue;
      found.set([a, b, c, d], count);
      count += 4;
    }
  }
  return found.slice(0, count);
}

/** Triangles [T, 3] of blocks, by the runs of their codes; -1 where one has a corner that is no valid texel. */
export function blockTriangles(/** @type {Int32Array} */ corners, /** @type {Uint8Array} */ runs) {
  const found = new Int32Array(1.5 * corners.length); // of two triangles a block
  let [at, count] = [0, 0];
  const add = (/** @type {number[]} */ triangle, /** @type {number} */ run) => {
    found.set(run & TURNED ? triangle.reverse() : triangle, count);
    count += 3;
  };
  for (const run of runs)
    for (let end = at + 4 * ((run >> 4) + 1); at < end; at += 4) {
      const [a, b, c, d] = [corners[at], corners[at + 1], corners[at + 2], corners[at + 3]];
      if (run & FIRST) add([a, b, run & RISING ? c : d], run);
      if (run & SECOND) add([run & RISING ? b : a, d, c], run);
    }
  return found.slice(0, count);
}

/** Triangles [T, 3] of strips: each corner after the first two makes one with the edge that the last one left. */
export function stripTriangles(/** @type {Int32Array} */ strips) {
  /** @type {number[]} */
  const found = [];
  /** @type {number[]} */
  let edge = [];
  for (const entry of strips) {
    const corner = entry >> 1;
    if (entry === END) edge = [];
    else if (edge.length < 2) edge.push(corner);
    else {
      found.push(edge[0], edge[1], corner);
      edge = entry & 1 ? [edge[0], corner] : [corner, edge[1]];
    }
  }
  return Int32Array.from(found);
}

/**
 * The triangles of a file's surface and, of each texel, the other two corners of those about it in turning order.
 * @param {TexelGrid} texels
 * @param {{runs: Uint8Array, strips: Int32Array}} surface
 */
export function surfaceMesh(texels, surface) {
  const parts = [blockTriangles(blocks(texels), surface.runs), stripTriangles(surface.strips)];
  const triangles = new Uint32Array(parts[0].length + parts[1].length);
  triangles.set(parts[0]);
  triangles.set(parts[1], parts[0].length);
  return { triangles, ...rings(triangles, texels.texels.length) };
}

/** The corners [3 T, 2] about each of `count` corners, and where those of each begin. */
function rings(/** @type {Uint32Array} */ triangles, /** @type {number} */ count) {
  const ringStarts = new Uint32Array(count + 1);
  for (const corner of triangles) ringStarts[corner + 1]++;
  for (let i = 0; i < count; i++) ringStarts[i + 1] += ringStarts[i];
  const next = ringStarts.slice();
  const ring = new Uint32Array(2 * triangles.length);
  for (let turn = 0; turn < 3; turn++)
    for (let at = 0; at < triangles.length; at += 3) {
      const place = 2 * next[triangles[at + turn]]++;
      ring[place] = triangles[at + ((turn + 1) % 3)];
      ring[place + 1] = triangles[at + ((turn + 2) % 3)];
    }
  return { ringStarts, ring };
}
