// Triangles over 2 x 2 texels, as a file holds them. References: python/mua/rig/surface.py, section 8 of schemas/README.md.

/** @typedef {{size: number, texels: Int32Array}} TexelGrid */

const [FIRST, SECOND, RISING, TURNED] = [1, 2, 4, 8]; // bits of a block's code

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
