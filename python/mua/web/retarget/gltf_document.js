// A glTF document as motion needs it: its nodes and the numbers of its accessors, checked.

import { AvatarError } from "../error.js";
import { normalized } from "../rotation.js";
import { fromColumns, length, times } from "./vectors.js";

/** @typedef {Record<string, any>} Json */
/** @typedef {{rotation: number[], translation: number[], scale: number[]}} Local w, x, y, z; metres; factors */

const GLB = 0x46546c67;
const [JSON_CHUNK, BINARY_CHUNK] = [0x4e4f534a, 0x004e4942];
/** @type {Record<string, number>} */
const WIDTHS = { SCALAR: 1, VEC2: 2, VEC3: 3, VEC4: 4, MAT4: 16 };
/** @type {Record<number, {size: number, most: number, read: (view: DataView, at: number) => number}>} */
const COMPONENTS = {
  5120: { size: 1, most: 127, read: (view, at) => view.getInt8(at) },
  5121: { size: 1, most: 255, read: (view, at) => view.getUint8(at) },
  5122: { size: 2, most: 32767, read: (view, at) => view.getInt16(at, true) },
  5123: { size: 2, most: 65535, read: (view, at) => view.getUint16(at, true) },
  5126: { size: 4, most: 1, read: (view, at) => view.getFloat32(at, true) },
};

export class Document {
  /** @param {ArrayBuffer} content @param {(uri: string) => Promise<ArrayBuffer>} beside @returns {Promise<Document>} */
  static async open(content, beside) {
    const { json, binary } = chunks(content);
    const buffers = await Promise.all(
      (json.buffers ?? []).map((/** @type {Json} */ { uri }, /** @type {number} */ i) =>
        uri ? bytesOf(uri, beside) : (i === 0 && binary) || new ArrayBuffer(0),
      ),
    );
    return new Document(json, buffers);
  }

  constructor(/** @type {Json} */ json, /** @type {ArrayBuffer[]} */ buffers) {
    this.json = json;
    this.buffers = buffers;
    /** @type {Json[]} */
    this.nodes = json.nodes ?? [];
    this.parents = new Int32Array(this.nodes.length).fill(-1);
    for (const [node, { children = [] }] of this.nodes.entries())
      for (const child of children) {
        if (!this.nodes[child] || this.parents[child] >= 0)
          throw this.fault(`nodes[${node}].children holds ${child}, expected a node that is no other's child`);
        this.parents[child] = node;
      }
    /** @type {number[]} */
    this.order = []; // of nodes, parents first
    const waiting = [...this.nodes.keys()].filter((node) => this.parents[node] < 0).toReversed();
    for (let node = waiting.pop(); node !== undefined; node = waiting.pop()) {
      this.order.push(node);
      waiting.push(...(this.nodes[node].children ?? []).toReversed());
    }
    if (this.order.length < this.nodes.length) throw this.fault("a node is its own ancestor");
    this.rest = this.nodes.map((node, i) => this.local(node, `nodes[${i}]`));
  }

  fault(/** @type {string} */ sentence) {
    return new AvatarError(`${sentence}.`);
  }

  /** A node in its parent at rest. @returns {Local} */
  local(/** @type {Json} */ node, /** @type {string} */ where) {
    const numbers = (/** @type {string} */ field, /** @type {number[]} */ otherwise) => {
      const values = node[field] ?? otherwise;
      if (!Array.isArray(values) || values.length !== otherwise.length || !values.every(Number.isFinite))
        throw this.fault(`${where}.${field}: expected ${otherwise.length} finite numbers`);
      return /** @type {number[]} */ (values);
    };
    if (node.matrix) {
      const matrix = numbers("matrix", new Array(16).fill(0));
      const [x, y, z, translation] = [0, 4, 8, 12].map((at) => matrix.slice(at, at + 3));
      const scale = [x, y, z].map(length);
      const [along, up, out] = [x, y, z].map((column, i) => times(column, 1 / (scale[i] || 1)));
      return { rotation: fromColumns([along, up, out]), translation, scale };
    }
    const [qx, qy, qz, qw] = numbers("rotation", [0, 0, 0, 1]);
    if (!Math.hypot(qx, qy, qz, qw)) throw this.fault(`${where}.rotation: expected a unit quaternion`);
    const rotation = /** @type {number[]} */ (normalized([qw, qx, qy, qz]));
    return { rotation, translation: numbers("translation", [0, 0, 0]), scale: numbers("scale", [1, 1, 1]) };
  }

  /** The node, its parent, and so on to the top. */
  upwards(/** @type {number} */ node) {
    const found = [];
    for (let above = node; above >= 0; above = this.parents[above]) found.push(above);
    return found;
  }

  /** The node itself or its nearest ancestor that is one of some; -1 for none. */
  nearest(/** @type {number} */ node, /** @type {number[]} */ among) {
    return this.upwards(node).find((above) => among.includes(above)) ?? -1;
  }

  /** All numbers of an accessor, one after the other. */
  reals(/** @type {number} */ index, /** @type {string} */ field) {
    const accessor = this.json.accessors?.[index];
    const component = COMPONENTS[accessor?.componentType];
    const width = WIDTHS[accessor?.type];
    if (!component || !width) throw this.fault(`${field}: expected an accessor of numbers, found ${index}`);
    const view = this.json.bufferViews?.[accessor.bufferView];
    if (accessor.sparse || !view) throw this.fault(`${field}: sparse accessors are not read`);
    if (view.extensions)
      throw this.fault(`${field}: compressed with ${Object.keys(view.extensions)}, which is not read`);
    const stride = view.byteStride ?? component.size * width;
    const from = (view.byteOffset ?? 0) + (accessor.byteOffset ?? 0);
    const buffer = this.buffers[view.buffer];
    const end = from + stride * (accessor.count - 1) + component.size * width;
    if (!(accessor.count >= 1 && from >= 0 && stride > 0 && buffer && end <= buffer.byteLength))
      throw this.fault(`${field}: its accessor lies outside of the file's ${buffer?.byteLength ?? 0} bytes`);
    const bytes = new DataView(buffer);
    const values = new Float64Array(accessor.count * width);
    for (let i = 0; i < values.length; i++) {
      const at = from + stride * Math.floor(i / width) + component.size * (i % width);
      values[i] = component.read(bytes, at);
      if (accessor.normalized) values[i] = Math.max(values[i] / component.most, -1);
      if (!Number.isFinite(values[i])) throw this.fault(`${field}: expected finite numbers`);
    }
    return values;
  }
}

/** The JSON of a .gltf or .glb, and the binary chunk of the latter. @returns {{json: Json, binary: ArrayBuffer | null}} */
function chunks(/** @type {ArrayBuffer} */ content) {
  const view = new DataView(content);
  if (content.byteLength < 12 || view.getUint32(0, true) !== GLB) return { json: parsed(content), binary: null };
  /** @type {{json: Json | null, binary: ArrayBuffer | null}} */
  const found = { json: null, binary: null };
  for (let at = 12; at + 8 <= content.byteLength; ) {
    const [size, kind] = [view.getUint32(at, true), view.getUint32(at + 4, true)];
    const chunk = content.slice(at + 8, at + 8 + size);
    if (kind === JSON_CHUNK) found.json ??= parsed(chunk);
    if (kind === BINARY_CHUNK) found.binary ??= chunk;
    at += 8 + size;
  }
  if (!found.json) throw new AvatarError("it holds no JSON, expected a glTF file.");
  return { json: found.json, binary: found.binary };
}

/** @returns {Json} */
function parsed(/** @type {ArrayBuffer} */ content) {
  try {
    const json = JSON.parse(new TextDecoder().decode(content));
    if (json && typeof json === "object") return json;
  } catch {
    // said below
  }
  throw new AvatarError("its JSON cannot be read, expected a glTF file.");
}

/** Bytes that a document names: in itself, or in a file beside it. @param {string} uri @param {(uri: string) => Promise<ArrayBuffer>} beside */
async function bytesOf(uri, beside) {
  if (!uri.startsWith("data:")) return beside(uri);
  const content = atob(uri.slice(uri.indexOf(",") + 1));
  return Uint8Array.from(content, (letter) => letter.charCodeAt(0)).buffer;
}
