// A FlatBuffer as a tree of plain objects, by the generated layout; no byte of it is trusted. A vector of numbers is a
// view of the file. Reference: python/mua/asset/flatbuffer.py, with the same checks in the same order.

import { AvatarError } from "../error.js";
import { ENUMS, IDENTIFIER, ROOT, TABLES } from "./layout.js";
import { MAJOR } from "./limits.js";

/** @typedef {Record<string, any>} Tree */
/** @typedef {{name: string, kind: string, vector?: boolean, required?: boolean, align?: number}} Field */

/** @type {Record<string, number>} */
const WIDTHS = { bool: 1, ubyte: 1, ushort: 2, uint: 4, float: 4, double: 8 };
/** @type {Record<string, new (content: ArrayBufferLike, at: number, count: number) => ArrayBufferView>} */
const VIEWS = { bool: Uint8Array, ubyte: Uint8Array, uint: Uint32Array, float: Float32Array, double: Float64Array };
const TEXT = new TextDecoder("utf-8", { fatal: true, ignoreBOM: true });
const CONTROL = /\p{Cc}/u; // what a terminal would obey
const CONTROL_IN_NOTES = /(?![\t\n])\p{Cc}/u; // but tabs and line feeds

export const AGAIN = "download or copy it again";

/** An error of a file: what is wrong with which field, and its code. */
export function fault(/** @type {string} */ code, /** @type {string} */ field, /** @type {string} */ sentence) {
  return new AvatarError(field ? `${field}: ${sentence}` : sentence, { code, field });
}

/** An error of a value that no file may have. */
export const refuse = (/** @type {string} */ field, /** @type {string} */ sentence) => fault("value", field, sentence);

/**
 * The root table of a file, every offset, length, alignment and string checked.
 * @param {ArrayBuffer} content
 * @returns {{tree: Tree, crcAt: number | undefined}} where the checksum stands, too
 */
export function parse(content) {
  const bytes = new Uint8Array(content);
  if (bytes.length < 8) throw cut(bytes.length, 8);
  if (String.fromCharCode(...bytes.subarray(4, 8)) !== IDENTIFIER)
    throw fault("identifier", "", `the file is no .muaavatar: bytes 4 to 7 are not ${IDENTIFIER}`);
  const version = new Parser(content).rootScalar("version_major");
  if (version !== MAJOR) {
    const sentence = `format version ${version}, expected ${MAJOR}: update mua where the file is newer`;
    throw fault("version", "version_major", sentence);
  }
  const parser = new Parser(content);
  const tree = parser.table(ROOT, 0, "");
  return { tree, crcAt: parser.crcAt };
}

function cut(/** @type {number} */ size, /** @type {number} */ needed) {
  const sentence = `the file has ${size} bytes and needs at least ${needed}: it is cut short or damaged; ${AGAIN}`;
  return fault("truncated", "", sentence);
}

const byOffset = (/** @type {Field} */ field) => Boolean(field.vector) || !(widthOf(field.kind) > 0);

/** Bytes of a scalar; 0 of what is reached through an offset. */
function widthOf(/** @type {string} */ kind) {
  return kind in ENUMS ? 1 : (WIDTHS[kind] ?? 0);
}

/** Walks a file. Tables and vectors may not overlap: else a small file could name one part a million times. */
class Parser {
  constructor(/** @type {ArrayBuffer} */ content) {
    this.content = content;
    this.view = new DataView(content);
    this.left = content.byteLength; // bytes that no table or vector has claimed yet
    this.stated = 0; // bytes that the file says it has; 0 where it does not
    /** @type {number | undefined} */
    this.crcAt = undefined;
  }

  /** One scalar of the root table, read before the rest is trusted. */
  rootScalar(/** @type {string} */ name) {
    const at = this.positions(ROOT, this.follow(0, ""), "")[name];
    const field = /** @type {Field} */ (TABLES[ROOT].find((one) => one.name === name));
    return at ? this.scalar(field, at, name) : 0;
  }

  /** The table that the offset at byte `at` points to. @returns {Tree} */
  table(/** @type {string} */ table, /** @type {number} */ at, /** @type {string} */ path) {
    const positions = this.positions(table, this.follow(at, path), path);
    if (table === ROOT) {
      this.crcAt = positions.crc32;
      if (positions.stages) this.stated = this.lastWord(positions.stages);
    }
    /** @type {Tree} */
    const tree = {};
    for (const field of TABLES[table]) {
      const name = path ? `${path}.${field.name}` : field.name;
      if (field.name in positions) tree[field.name] = this.value(field, positions[field.name], name);
      else if (field.required) throw fault("missing", name, "the field is required and absent");
      else if (!byOffset(field))
        tree[field.name] = field.kind in ENUMS ? ENUMS[field.kind][0] : field.kind === "bool" ? false : 0;
    }
    return tree;
  }

  /** Byte positions of the fields that the table at `start` holds. */
  positions(/** @type {string} */ table, /** @type {number} */ start, /** @type {string} */ path) {
    const vtable = start - this.number("getInt32", 4, start, path);
    const size = this.number("getUint16", 2, vtable, path);
    const inline = this.number("getUint16", 2, vtable + 2, path);
    if (size < 4 || size % 2 || vtable % 2 || inline < 4)
      throw fault("offset", path, `the table's description at byte ${vtable} is malformed`);
    this.within(vtable, size, path);
    this.within(start, inline, path);
    this.claim(inline, path);
    /** @type {Record<string, number>} */
    const positions = {};
    for (const [slot, field] of TABLES[table].entries()) {
      if (4 + 2 * slot >= size) break;
      const offset = this.number("getUint16", 2, vtable + 4 + 2 * slot, path);
      const width = byOffset(field) ? 4 : widthOf(field.kind);
      if (offset && (offset < 4 || offset + width > inline || (start + offset) % width)) {
        const name = path ? `${path}.${field.name}` : field.name;
        throw fault("offset", name, `offset ${offset} lies outside its table of ${inline} bytes`);
      }
      if (offset) positions[field.name] = start + offset;
    }
    return positions;
  }

  /** @returns {any} */
  value(/** @type {Field} */ field, /** @type {number} */ at, /** @type {string} */ path) {
    if (!byOffset(field)) return this.scalar(field, at, path);
    if (!field.vector) return this.one(field.kind, at, path);
    const width = widthOf(field.kind);
    const [start, count] = this.vector(at, path, width || 4);
    if (!width) return Array.from({ length: count }, (_, i) => this.one(field.kind, start + 4 * i, `${path}[${i}]`));
    if (start % Math.max(field.align ?? 0, width))
      throw fault("offset", path, `the data at byte ${start} is not aligned`);
    return new VIEWS[field.kind](this.content, start, count);
  }

  /** @returns {any} */
  scalar(/** @type {Field} */ field, /** @type {number} */ at, /** @type {string} */ path) {
    const { view } = this;
    if (field.kind === "ushort") return view.getUint16(at, true);
    if (field.kind === "uint") return view.getUint32(at, true);
    if (field.kind === "float") return view.getFloat32(at, true);
    const value = view.getUint8(at);
    if (!(field.kind in ENUMS)) return field.kind === "bool" ? value !== 0 : value;
    const known = ENUMS[field.kind];
    if (value >= known.length)
      throw fault("enum", path, `value ${value} is unknown, expected one of ${known.join(", ")}`);
    return known[value];
  }

  /** @returns {any} */
  one(/** @type {string} */ kind, /** @type {number} */ at, /** @type {string} */ path) {
    if (kind !== "string") return this.table(kind, at, path);
    const [start, count] = this.vector(at, path, 1);
    let text;
    try {
      text = TEXT.decode(new Uint8Array(this.content, start, count));
    } catch {
      throw fault("text", path, "the text is not UTF-8");
    }
    const control = text.match(path === "notes" ? CONTROL_IN_NOTES : CONTROL)?.[0];
    if (control === undefined) return text;
    const code = control.charCodeAt(0).toString(16).toUpperCase().padStart(4, "0");
    throw fault("text", path, `the text holds the control character U+${code}`);
  }

  vector(/** @type {number} */ at, /** @type {string} */ path, /** @type {number} */ width) {
    const start = this.follow(at, path);
    const count = this.number("getUint32", 4, start, path);
    this.within(start + 4, count * width, path);
    this.claim(4 + count * width, path);
    return [start + 4, count];
  }

  claim(/** @type {number} */ size, /** @type {string} */ path) {
    this.left -= size;
    if (this.left < 0) throw fault("offset", path, "parts of the file overlap");
  }

  follow(/** @type {number} */ at, /** @type {string} */ path) {
    const start = at + this.number("getUint32", 4, at, path);
    if (start % 4) throw fault("offset", path, `the offset at byte ${at} points to unaligned byte ${start}`);
    this.within(start, 4, path);
    return start;
  }

  number(
    /** @type {"getInt32" | "getUint16" | "getUint32"} */ read,
    /** @type {number} */ width,
    /** @type {number} */ at,
    /** @type {string} */ path,
  ) {
    this.within(at, width, path);
    return this.view[read](at, true);
  }

  /** The last number of the vector that the offset at byte `at` points to; 0 where the file does not hold it. */
  lastWord(/** @type {number} */ at) {
    const peek = (/** @type {number} */ from) =>
      from + 4 <= this.content.byteLength ? this.view.getUint32(from, true) : 0;
    const start = at + peek(at);
    return peek(start + 4 * peek(start));
  }

  within(/** @type {number} */ at, /** @type {number} */ size, /** @type {string} */ path) {
    const length = this.content.byteLength;
    if (at < 0) throw fault("truncated", path, "an offset leads before the first byte of the file");
    if (at + size > length) throw cut(length, Math.max(at + size, this.stated));
  }
}
