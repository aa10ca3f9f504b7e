// What is known of an entry point beside its code, and how named constants become the bytes that it reads.

import { AvatarError } from "./error.js";

/** @typedef {{name: string, binding: number, read_only: boolean, scalar: string, stride: number}} BufferSlot */
/**
 * @typedef {object} Constant a member of the constant buffer
 * @property {string} name
 * @property {number} offset bytes
 * @property {string} scalar uint, int or float
 * @property {number[]} shape
 * @property {number[]} strides bytes from one value to the next along each axis
 * @property {boolean} used whether this entry point reads it
 */
/**
 * @typedef {object} Shader an entry point, as tools/gen_wgsl.py writes it
 * @property {string} stage comp, vert or frag
 * @property {string} entry
 * @property {BufferSlot[]} buffers
 * @property {Constant[]} constants
 * @property {number | null} constants_binding
 * @property {number[]} threads
 * @property {string} code
 */
/** @typedef {Record<string, number | ArrayLike<number>>} Values */

/** A shader whose groups hold so many elements of an array that they share, in place of the most that any avatar needs. @param {Shader} shader @param {string} array @param {number} count @returns {Shader} */
export function withRoom(shader, array, count) {
  const declared = new RegExp(`(var<workgroup>${array}_\\d+:array<.*,)(\\d+)`);
  const code = shader.code.replace(declared, (_, before, most) => `${before}${Math.min(count, Number(most))}`);
  return { ...shader, code };
}

/** The code of a shader, of which lines are another's: 4-7 stands for its lines 4 to 6, from 0. @param {string} code @param {{code: string}} other */
export function withLines(code, other) {
  const lines = other.code.split("\n");
  return code.replace(/^(\d+)-(\d+)$/gm, (_, first, end) => lines.slice(first, end).join("\n"));
}

const BLOCK = 16; // bytes, of which a constant buffer is a multiple

/** Bytes of an entry point's constant buffer. */
export function blockSize(/** @type {Shader} */ shader) {
  const ends = shader.constants.map((constant) => Math.max(...offsets(constant)) + 4);
  return Math.ceil(Math.max(0, ...ends) / BLOCK) * BLOCK;
}

/** Byte offsets of a constant's values, row-major. */
function offsets(/** @type {Constant} */ { offset, shape, strides }) {
  return shape.reduce(
    (found, side, axis) => found.flatMap((at) => Array.from({ length: side }, (_, i) => at + i * strides[axis])),
    [offset],
  );
}

/** Write named values where an entry point reads them. */
export class Packer {
  constructor(/** @type {Shader} */ shader) {
    this.name = shader.entry;
    this.size = blockSize(shader);
    this.places = new Map(shader.constants.map((constant) => [constant.name, { ...constant, at: offsets(constant) }]));
  }

  /** The `values` that the entry point declares; throws if one that it reads is missing or has another length. */
  pack(/** @type {DataView} */ view, /** @type {number} */ start, /** @type {Values} */ values) {
    for (const [name, { scalar, at, used }] of this.places) {
      const value = values[name];
      if (value === undefined && !used) continue;
      const list = typeof value === "number" ? [value] : value;
      if (list?.length !== at.length)
        throw new AvatarError(`kernel ${this.name}: constant ${name} is ${value}, expected ${at.length} numbers`);
      for (let i = 0; i < at.length; i++)
        if (scalar === "float") view.setFloat32(start + at[i], list[i], true);
        else view.setUint32(start + at[i], list[i], true);
    }
  }
}
