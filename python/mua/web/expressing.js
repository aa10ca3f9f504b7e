// The expressions of an avatar on the device, and what they do after a decode: they move vertices, and bend the texels in their
// reach along. Fetched for avatars that have some. References: python/mua/player/channels.py, python/mua/kernels/expressions.py.

import { FLOAT, groups } from "./channels.js";
import { kernelsOf } from "./kernel.js";
import { BendTexels, BendTriangles, BendVertices, SumTargets } from "./wgsl/expressions.js";

/** @typedef {import("./device.js").Memory} Memory */
/** @typedef {import("./channels.js").ChannelSet} ChannelSet */
/** @typedef {import("./format/read.js").Avatar} Avatar */

const EXPRESSED = 64; // vertices, triangles or texels of a group
const BEND = 48; // bytes of a bent triangle or vertex
/** @type {typeof import("./rules.js").heldBack | null} */
let heldBack = null; // fetched for avatars that have rules
export const KERNELS = { SumTargets, BendTriangles, BendVertices, BendTexels };

/** Fetch what else the expressions of an avatar need. */
export async function fetchRules(/** @type {Avatar} */ { targets }) {
  if (targets.rules) ({ heldBack } = await import("./rules.js"));
}

export class Expressing {
  constructor(/** @type {Memory} */ memory, /** @type {Avatar} */ avatar) {
    const targets = byVertex(avatar.targets);
    const reach = reachOf(targets.vertices, avatar.template.faces, new Int32Array());
    this.memory = memory;
    this.avatar = avatar;
    this.moving = targets.vertices;
    this.triangleCount = reach.corners.length / 3;
    this.bentCount = reach.vertices.length;
    this.buffers = {
      vertices: memory.buffer(targets.vertices, "expressions.vertices"),
      starts: memory.buffer(targets.starts, "expressions.starts"),
      expressions: memory.buffer(targets.expressions, "expressions.vertices"),
      changes: memory.buffer(targets.changes, "expressions.offsets"),
      corners: memory.buffer(reach.corners, "expressions.vertices"),
      bentVertices: memory.buffer(reach.vertices, "expressions.vertices"),
      starStarts: memory.buffer(reach.starts, "expressions.vertices"),
      stars: memory.buffer(reach.stars, "expressions.vertices"),
      moved: memory.buffer(FLOAT * 4 * avatar.coarse.vertices, "moved"), // [V, 4], 0 where none moves a vertex
      triangle_bends: memory.buffer(BEND * this.triangleCount, "triangle_bends"),
      vertex_bends: memory.buffer(BEND * this.bentCount, "vertex_bends"),
    };
  }

  /** The weights [E] that show of those that a clip and a page set. */
  shown(/** @type {Float32Array} */ weights) {
    const { rules } = this.avatar.targets;
    return rules && heldBack ? heldBack(rules, weights) : weights;
  }

  /** Texels of a level that expressions may bend, [K, 2] with the place of their triangle. */
  reached(/** @type {Int32Array} */ triangles) {
    const { texels } = reachOf(this.moving, this.avatar.template.faces, triangles);
    return { buffer: this.memory.buffer(texels, "expressions.vertices"), count: texels.length / 2 };
  }

  /** Append what the weights in `channels` do to the mesh and the texels there. @param {GPUComputePassEncoder} pass @param {ChannelSet} channels */
  dispatch(pass, { level: { reached, splatCount, texels }, weights, mesh, texelChannels }) {
    if (!reached) return;
    const { vertices, starts, expressions, changes, corners, bentVertices, starStarts, stars } = this.buffers;
    const { moved, triangle_bends, vertex_bends } = this.buffers;
    const kernels = kernelsOf(this.memory.device, KERNELS);
    kernels.SumTargets.dispatch(
      pass,
      [groups(this.moving.length, EXPRESSED), 1, 1],
      { vertices, starts, expressions, changes, weights, moved, mesh },
      { vertex_count: this.moving.length },
    );
    kernels.BendTriangles.dispatch(
      pass,
      [groups(this.triangleCount, EXPRESSED), 1, 1],
      { vertices: bentVertices, corners, moved, mesh, triangle_bends },
      { triangle_count: this.triangleCount },
    );
    kernels.BendVertices.dispatch(
      pass,
      [groups(this.bentCount, EXPRESSED), 1, 1],
      { starts: starStarts, stars, triangle_bends, vertex_bends },
      { vertex_count: this.bentCount },
    );
    kernels.BendTexels.dispatch(
      pass,
      [groups(reached.count, EXPRESSED), 1, 1],
      {
        ...{ reached: reached.buffer, texels, corners, vertices: bentVertices, moved },
        ...{ vertex_bends, texel_channels: texelChannels },
      },
      { texel_count: reached.count, splat_count: splatCount },
    );
  }
}

/**
 * The entries of expressions in the order in which a thread for each vertex that they move reads them: starts[m] to
 * starts[m + 1] - 1 move vertices[m], both ascending, by changes [P, 4], an offset and a gain. @param {import("./format/expressions.js").Targets} targets
 */
export function byVertex({ starts, vertices, offsets, gains }) {
  const next = new Uint32Array(vertices.reduce((most, vertex) => Math.max(most, vertex), -1) + 2);
  for (const vertex of vertices) next[vertex + 1]++;
  for (let vertex = 1; vertex < next.length; vertex++) next[vertex] += next[vertex - 1];
  const moved = Uint32Array.from(next.keys()).filter((vertex) => next[vertex] < next[vertex + 1]);
  const found = {
    vertices: moved,
    starts: Uint32Array.from([...moved, next.length - 1], (vertex) => next[vertex]),
    expressions: new Uint32Array(vertices.length),
    changes: new Float32Array(4 * vertices.length),
  };
  for (let expression = 0; expression < starts.length - 1; expression++)
    for (let entry = starts[expression]; entry < starts[expression + 1]; entry++) {
      const place = next[vertices[entry]]++;
      found.expressions[place] = expression;
      found.changes.set([...offsets.subarray(3 * entry, 3 * entry + 3), gains[entry]], 4 * place);
    }
  return found;
}

/**
 * What moving vertices may bend: the triangles with a corner beside them, as places of their corners [T, 3] among the
 * vertices [B] that these are; where each vertex' triangles begin [B + 1] in a list [3 T] of all; and the texels on them with
 * the place [K, 2] of their triangle. @param {Uint32Array} moving @param {Int32Array} faces @param {Int32Array} triangles of texels
 */
export function reachOf(moving, faces, triangles) {
  const beside = new Set(facesAt(faces, new Set(moving)).flatMap((face) => cornersOf(faces, face)));
  const held = facesAt(faces, beside);
  const vertices = Uint32Array.from(new Set(held.flatMap((face) => cornersOf(faces, face)))).sort();
  const placeOf = new Map(Array.from(vertices, (vertex, place) => [vertex, place]));
  const corners = Uint32Array.from(
    held.flatMap((face) => cornersOf(faces, face).map((vertex) => placeOf.get(vertex) ?? 0)),
  );
  const places = new Int32Array(faces.length / 3).fill(-1);
  held.forEach((face, place) => (places[face] = place));
  /** @type {number[]} */
  const texels = [];
  triangles.forEach((triangle, texel) => places[triangle] >= 0 && texels.push(texel, places[triangle]));
  return { vertices, corners, ...starsOf(corners, vertices.length), texels: Uint32Array.from(texels) };
}

/** The faces, ascending, that have a corner among vertices. @param {Int32Array} faces @param {Set<number>} vertices */
const facesAt = (faces, vertices) =>
  Array.from({ length: faces.length / 3 }, (_, face) => face).filter((face) =>
    cornersOf(faces, face).some((vertex) => vertices.has(vertex)),
  );

const cornersOf = (/** @type {Int32Array} */ faces, /** @type {number} */ face) =>
  Array.from(faces.subarray(3 * face, 3 * face + 3));

/** The triangles about each vertex, ascending: starts [B + 1] into a list [3 T] of all. @param {Uint32Array} corners @param {number} vertices */
function starsOf(corners, vertices) {
  const next = new Uint32Array(vertices + 1);
  for (const corner of corners) next[corner + 1]++;
  for (let vertex = 1; vertex <= vertices; vertex++) next[vertex] += next[vertex - 1];
  const starts = next.slice();
  const stars = new Uint32Array(corners.length);
  corners.forEach((corner, place) => (stars[next[corner]++] = Math.floor(place / 3)));
  return { starts, stars };
}
