// A file for the network before all of it is there: its stages, each of which shows more. Reference: section 11.1 of
// schemas/README.md.

import { STAGES } from "./limits.js";
import { fault, parse } from "./parser.js";

/** @typedef {import("./parser.js").Tree} Tree */

const HEAD = 2 ** 18; // bytes of a file, among which its tables are sought
/** Which stages of a file have arrived; its bytes are written into `content`, zeros until then. */
export class Stages {
  constructor(/** @type {ArrayBuffer} */ content) {
    this.content = content;
    /** @type {number[] | null} */
    this.ends = null; // bytes from the start; null until the tables are there
    this.shown = -1;
    this.sought = 0; // bytes that were there when the tables were sought last
  }

  /** The end of the newest stage that the first `got` bytes hold and that was not reported before; 0 where there is none. */
  reached(/** @type {number} */ got) {
    if (!this.ends && this.sought < HEAD) {
      this.ends = endsOf(this.content, got);
      this.sought = got;
    }
    const stage = this.ends?.findLastIndex((end) => end <= got) ?? -1;
    if (stage <= this.shown || got >= this.content.byteLength) return 0;
    this.shown = stage;
    return this.ends?.[stage] ?? 0;
  }
}

/** Where the stages of a file end, of which `got` bytes are there; null while its tables are not, or where it has none. */
function endsOf(/** @type {ArrayBuffer} */ content, /** @type {number} */ got) {
  try {
    const { tree } = parse(content);
    const ends = /** @type {Uint32Array | undefined} */ (tree.stages);
    if (!ends || ends.length !== STAGES || ends.byteOffset + ends.byteLength > got) return null;
    return Array.from(ends.subarray(0, STAGES - 1));
  } catch {
    return null; // reading the whole file says what is wrong
  }
}

/**
 * Leave out of a tree what its first `end` bytes do not hold and nothing needs: clips, the surface, and all texels where any
 * of them are missing; expressions then move nothing. A file has the mean mesh and its first clip in its first stage.
 * @param {Tree} tree @param {number} end
 */
export function leaveOut(tree, end) {
  const there = (/** @type {Tree | undefined} */ tensor) => !tensor || isThere(tensor, end);
  const { texels } = tree;
  delete tree.surface;
  tree.clips = /** @type {Tree[]} */ (tree.clips).filter((clip) =>
    [clip.rotations, clip.translation, clip.translations, clip.expressions].every(there),
  );
  if (!tree.clips.length) throw fault("truncated", "clips", "none is there yet");
  if (tree.expressions) tree.expressions = partOf(tree.expressions, there);
  const held = [texels.texels, texels.triangles, texels.barycentrics, texels.listed];
  const levels = /** @type {Tree[]} */ (texels.levels);
  if (held.every(there) && levels.every(({ blocks }) => isThere({ data: blocks }, end))) return;
  const [indices, barycentrics] = [empty("I32", 0), empty("F32", 0, 2)];
  tree.texels = { ...texels, texels: indices, triangles: indices, barycentrics, levels: levels.map(() => NO_BLOCKS) };
  delete tree.texels.listed;
  delete tree.texels.one_sided;
  for (const branch of [tree.geometry, tree.appearance])
    branch.static_offset = empty("F32", branch.static_offset.shape[0], 0);
}

/** Expressions as they are, or their names alone where what they move is missing. @param {Tree} expressions @param {(tensor: Tree) => boolean} there */
function partOf({ names, ...moves }, there) {
  if (Object.values(moves).every(there)) return { names, ...moves };
  const starts = { ...empty("I32", names.length + 1), data: new Uint8Array(4 * (names.length + 1)) };
  return { names, starts, vertices: empty("I32", 0), offsets: empty("F32", 0, 3) };
}

const NO_BLOCKS = { blocks: new Uint8Array() };

export const isThere = (/** @type {Tree} */ { data }, /** @type {number} */ end) =>
  data.byteOffset + data.length <= end;

/** A tensor without elements. */
function empty(/** @type {string} */ type, /** @type {number[]} */ ...shape) {
  return { type, shape: Uint32Array.from(shape), packing: "Plain", data: new Uint8Array() };
}
