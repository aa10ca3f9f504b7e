// The expressions of an avatar on the device, and what they do after a decode: they move vertices, and bend the texels in their
// reach along. Fetched for avatars that have some. References: python/mua/player/channels.py, python/mua/kernels/expressions.py.

import { FLOAT, groups } from "./channels.js";
import { kernelsOf } from "./kernel.js";
import { BendTexels, BendTriangles, SumTargets } from "./wgsl/expressions.js";

/** @typedef {import("./device.js").Memory} Memory */
/** @typedef {import("./channels.js").ChannelSet} ChannelSet */
/** @typedef {import("./format/read.js").Avatar} Avatar */

const EXPRESSED = 64; // vertices, triangles or texels of a group
const BEND = 64; // bytes of a bent triangle
export const KERNELS = { SumTargets, BendTriangles, BendTexels };

export class Expressing {
  constructor(/** @type {Memory} */ memory, /** @type {Avatar} */ avatar, /** @type {GPUBuffer} */ faces) {
    const targets = byVertex(avatar.targets);
    const { triangles } = reachOf(targets.vertices, avatar.template.faces, new Int32Array());
    this.memory = memory;
    this.avatar = avatar;
    this.moving = targets.vertices;
    this.triangleCount = triangles.length;
    this.buffers = {
      faces,
      vertices: memory.buffer(targets.vertices, "expressions.vertices"),
      starts: memory.buffer(targets.starts, "expressions.starts"),
      expressions: memory.buffer(targets.expressions, "expressions.vertices"),
      offsets: memory.buffer(targets.offsets, "expressions.offsets"),
      triangles: memory.buffer(triangles, "expressions.vertices"),
      moved: memory.buffer(FLOAT * 3 * avatar.coarse.vertices, "moved"), // [V, 3], 0 where none moves a vertex
      bends: memory.buffer(BEND * triangles.length, "bends"),
    };
  }

  /** Texels of a level that expressions may bend, [K, 2] with the place of their triangle. */
  reached(/** @type {Int32Array} */ triangles) {
    const { texels } = reachOf(this.moving, this.avatar.template.faces, triangles);
    return { buffer: this.memory.buffer(texels, "expressions.vertices"), count: texels.length / 2 };
  }

  /** Append what the weights in `channels` do to the mesh and the texels there. @param {GPUComputePassEncoder} pass @param {ChannelSet} channels */
  dispatch(pass, { level: { reached, splatCount }, weights, mesh, texelChannels }) {
    if (!reached) return;
    const { faces, vertices, starts, expressions, offsets, triangles, moved, bends } = this.buffers;
    const kernels = kernelsOf(this.memory.device, KERNELS);
    kernels.SumTargets.dispatch(
      pass,
      [groups(this.moving.length, EXPRESSED), 1, 1],
      { vertices, starts, expressions, offsets, weights, moved, mesh },
      { vertex_count: this.moving.length },
    );
    kernels.BendTriangles.dispatch(
      pass,
      [groups(this.triangleCount, EXPRESSED), 1, 1],
      { triangles, faces, moved, mesh, bends },
      { triangle_count: this.triangleCount },
    );
    kernels.BendTexels.dispatch(
      pass,
      [groups(reached.count, EXPRESSED), 1, 1],
      { reached: reached.buffer, bends, texel_channels: texelChannels },
      { texel_count: reached.count, splat_count: splatCount },
    );
  }
}

/**
 * The entries of expressions in the order in which a thread for each vertex that they move reads them: starts[m] to
 * starts[m + 1] - 1 move vertices[m], both ascending. @param {import("./format/expressions.js").Targets} targets
 */
export function byVertex({ starts, vertices, offsets }) {
  const next = new Uint32Array(vertices.reduce((most, vertex) => Math.max(most, vertex), -1) + 2);
  for (const vertex of vertices) next[vertex + 1]++;
  for (let vertex = 1; vertex < next.length; vertex++) next[vertex] += next[vertex - 1];
  const moved = Uint32Array.from(next.keys()).filter((vertex) => next[vertex] < next[vertex + 1]);
  const found = {
    vertices: moved,
    starts: Uint32Array.from([...moved, next.length - 1], (vertex) => next[vertex]),
    expressions: new Uint32Array(vertices.length),
    offsets: new Float32Array(offsets.length),
  };
  for (let expression = 0; expression < starts.length - 1; expression++)
    for (let entry = starts[expression]; entry < starts[expression + 1]; entry++) {
      const place = next[vertices[entry]]++;
      found.expressions[place] = expression;
      found.offsets.set(offsets.subarray(3 * entry, 3 * entry + 3), 3 * place);
    }
  return found;
}

/** The triangles with a corner among the vertices, and the texels on them with the place [K, 2] of their triangle among these. @param {Uint32Array} vertices @param {Int32Array} faces @param {Int32Array} triangles of texels */
export function reachOf(vertices, faces, triangles) {
  const moves = new Set(vertices);
  const places = new Int32Array(faces.length / 3).fill(-1);
  /** @type {number[][]} */
  const [held, texels] = [[], []];
  for (let face = 0; face < places.length; face++)
    if (moves.has(faces[3 * face]) || moves.has(faces[3 * face + 1]) || moves.has(faces[3 * face + 2]))
      places[face] = held.push(face) - 1;
  triangles.forEach((triangle, texel) => places[triangle] >= 0 && texels.push(texel, places[triangle]));
  return { triangles: Uint32Array.from(held), texels: Uint32Array.from(texels) };
}
