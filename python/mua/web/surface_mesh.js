// All triangles over the texels, and those about each texel, by which its normal is found when it is posed. References:
// python/mua/rig/surface.py, python/mua/player/surface.py, section 8 of schemas/README.md.

import { blocks, blockTriangles } from "./surface.js";

/** @typedef {import("./surface.js").TexelGrid} TexelGrid */

const END = -1; // of a strip

/** Triangles [T, 3] of strips: each corner after the first two makes one with the edge that the last one left. */
function stripTriangles(/** @type {Int32Array} */ strips) {
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
