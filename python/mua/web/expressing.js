// The expressions of an avatar on the device, and what they do in a decode: they move vertices, and bend the texels in their
// reach along. Fetched for avatars that have some. References: python/mua/player/channels.py, python/mua/kernels/expressions.py.

import { FLOAT, groups } from "./channels.js";
import { kernelsOf } from "./kernel.js";
import { BendTexels, BendTriangles, BendVertices, LightTexels, SumTargets } from "./wgsl/expressions.js";

/** @typedef {import("./device.js").Memory} Memory */
/** @typedef {import("./channels.js").ChannelSet} ChannelSet */
/** @typedef {import("./format/read.js").Avatar} Avatar */

const EXPRESSED = 64; // vertices or triangles of a group
const BEND = 24; // bytes of a bent triangle or vertex
/** @type {typeof import("./rules.js").heldBack | null} */
let heldBack = null; // fetched for avatars that have rules
export const KERNELS = { SumTargets, BendTriangles, BendVertices };
export { BendTexels, LightTexels };

/** Fetch what else the expressions of an avatar need. */
export async function fetchRules(/** @type {Avatar} */ { targets }) {
  if (targets.rules) ({ heldBack } = await import("./rules.js"));
}

export class Expressing {
  constructor(/** @type {Memory} */ memory, /** @type {Avatar} */ avatar) {
    const targets = byVertex(avatar.targets);
    const reach = reachOf(targets.vertices, avatar.template.faces);
    this.memory = memory;
    this.rules = avatar.targets.rules;
    this.bender = BendTexels;
    this.lighter = LightTexels;
    this.reached = reach.triangles;
    this.moving = targets.vertices;
    this.triangleCount = reach.corners.length / 3;
    this.bentCount = reach.vertices.length;
    this.buffers = {
      vertices: memory.buffer(targets.vertices, "expressions.vertices"),
      starts: memory.buffer(targets.starts, "expressions.starts"),
      expressions: memory.buffer(shorts(targets.expressions), "expressions.vertices"),
      changes: memory.buffer(shorts(targets.changes.map(halfOf)), "expressions.offsets"),
      corners: memory.buffer(reach.corners, "expressions.vertices"),
      bentVertices: memory.buffer(reach.vertices, "expressions.vertices"),
      starStarts: memory.buffer(reach.starts, "expressions.vertices"),
      stars: memory.buffer(reach.stars, "expressions.vertices"),
      moved: memory.buffer(FLOAT * 4 * avatar.coarse.vertices, "moved"), // [V, 4], 0 where none moves a vertex
      triangle_bends: memory.buffer(BEND * this.triangleCount, "triangle_bends"),
      vertex_bends: memory.buffer(BEND * avatar.coarse.vertices, "vertex_bends"), // of those in reach
    };
  }

  /** The weights [E] that show of those that a clip and a page set. */
  shown(/** @type {Float32Array} */ weights) {
    return this.rules && heldBack ? heldBack(this.rules, weights) : weights;
  }

  /** Append what the weights in `channels` do to the mesh, and how vertices bend then. @param {GPUComputePassEncoder} pass @param {ChannelSet} channels */
  dispatch(pass, { weights, mesh }) {
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
      { corners, moved, mesh, triangle_bends },
      { triangle_count: this.triangleCount },
    );
    kernels.BendVertices.dispatch(
      pass,
      [groups(this.bentCount, EXPRESSED), 1, 1],
      { vertices: bentVertices, starts: starStarts, stars, moved, triangle_bends, vertex_bends },
      { vertex_count: this.bentCount },
    );
  }
}

/** Numbers of 16 bits, two to a word. @param {ArrayLike<number>} numbers */
export function shorts(numbers) {
  const all = new Uint16Array(2 * Math.ceil(numbers.length / 2));
  all.set(numbers);
  return new Uint32Array(all.buffer);
}

const single = new Float32Array(1);
const bits = new Uint32Array(single.buffer);
const [SIGN, LEAST_NORMAL, HALF] = [0x8000, 113 << 23, 0x3f000000]; // a half's sign; bits of 2^-14 and of 0.5

/** The half float nearest to a number of at most 65,504, ties to even, as its bits. */
export function halfOf(/** @type {number} */ value) {
  const sign = value < 0 || Object.is(value, -0) ? SIGN : 0;
  single[0] = Math.abs(value);
  if (bits[0] >= LEAST_NORMAL) return sign | (((bits[0] + 0xfff + ((bits[0] >> 13) & 1)) >> 13) - (112 << 10));
  single[0] += 0.5; // whose last bit is a subnormal's
  return sign | (bits[0] - HALF);
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
 * What moving vertices may bend: the triangles with a corner beside them, as flags [F] and as their corners [T, 3]; the
 * vertices [B] that these are; and where each vertex' triangles begin [B + 1] in a list [3 T] of all.
 * @param {Uint32Array} moving @param {Int32Array} faces
 */
export function reachOf(moving, faces) {
  const beside = new Set(facesAt(faces, new Set(moving)).flatMap((face) => cornersOf(faces, face)));
  const held = facesAt(faces, beside);
  const corners = Uint32Array.from(held.flatMap((face) => cornersOf(faces, face)));
  const vertices = Uint32Array.from(new Set(corners)).sort();
  const placeOf = new Map(Array.from(vertices, (vertex, place) => [vertex, place]));
  const triangles = new Uint8Array(faces.length / 3);
  for (const face of held) triangles[face] = 1;
  const places = corners.map((vertex) => placeOf.get(vertex) ?? 0);
  return { triangles, corners, vertices, ...starsOf(places, vertices.length) };
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
