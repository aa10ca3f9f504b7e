// An avatar's tensors on the device, in the type in which the file stores them. Reference: python/mua/player/buffers.py.

import { coarserTexture, textureOf } from "./coarser.js";
import { TILE_WORDS, texelTiles, texelWords, upsamplingTaps } from "./prepare.js";

/** @typedef {import("./device.js").Memory} Memory */
/** @typedef {import("./format/read.js").Avatar} Avatar */
/** @typedef {import("./format/model.js").Branch} Branch */
/** @typedef {import("./format/tensors.js").Stored} Stored */
/** @typedef {{size: number, texels: Int32Array, triangles: Int32Array, barycentrics: Float32Array, oneSided: Uint8Array}} Texels */
/** @typedef {{taps: GPUBuffer, factor: number, reach: number, delay: number}} Upsampling */
/** @typedef {{upsampling: Upsampling, staticOffset: StoredBuffer}} BranchLevel what is geometry's or appearance's alone of a level */
/**
 * @typedef {object} LevelBuffers the texels of one level of detail
 * @property {number} number 0 is the finest
 * @property {number} size texels along a side
 * @property {number} splatCount
 * @property {GPUBuffer} texels where they lie on the mesh
 * @property {number} tileCount
 * @property {GPUBuffer} tiles
 * @property {BranchLevel} geometry
 * @property {BranchLevel} appearance
 */
/** @typedef {{words: GPUBuffer, layout: number[]}} StoredBuffer as the kernels' stored() reads it */

const ELEMENT_TYPES = ["F32", "F16", "I8"];

/** The filter padded to twice an odd number of taps, so that a thread of InverseDwt writes whole words. */
export const wholeWords = (/** @type {ArrayLike<number>} */ taps) =>
  Float32Array.from(taps.length % 4 ? Array.from(taps) : [0, ...Array.from(taps), 0]);

/** Everything of a file that does not change from frame to frame. */
export class AvatarBuffers {
  /** @param {Memory} memory @param {Avatar} avatar @param {typeof import("./expressing.js").Expressing} [Expressing] of an avatar with expressions */
  constructor(memory, avatar, Expressing) {
    const { coarse, wavelet, template, texels } = avatar;
    this.memory = memory;
    this.avatar = avatar;
    this.coarseMlp = this.mlp(coarse.mlp, "coarse.mlp");
    const [weight, bias] = [this.stored(coarse.basis, "coarse.basis"), this.stored(coarse.mean, "coarse.mean")];
    this.mesh = { weight, bias, inputs: coarse.basis.shape[0], outputs: 3 * coarse.vertices };
    this.geometry = this.branch(avatar.geometry, "geometry");
    this.appearance = this.branch(avatar.appearance, "appearance");
    this.recLo = memory.buffer(wholeWords(wavelet.recLo), "wavelet.rec_lo");
    this.recHi = memory.buffer(wholeWords(wavelet.recHi), "wavelet.rec_hi");
    this.taps = wholeWords(wavelet.recLo).length;
    this.faces = memory.buffer(template.faces, "template.faces");
    this.skinIndices = memory.buffer(template.skinIndices, "template.skin_indices");
    this.skinWeights = memory.buffer(template.skinWeights, "template.skin_weights");
    this.expressing = Expressing ? new Expressing(memory, avatar) : null;
    const statics = { geometry: avatar.geometry.staticOffset, appearance: avatar.appearance.staticOffset };
    /** @type {LevelBuffers[]} */
    this.levels = [this.levelOf(texels, statics, 0)];
    /** @type {import("./coarser.js").Texture | null} */
    this.coarser = null; // what the coarsest level so far was made of
  }

  /** A level of detail, at most the coarsest of the avatar; made when it is first asked for. @returns {LevelBuffers} */
  level(/** @type {number} */ number) {
    while (this.levels.length <= number) {
      this.coarser = coarserTexture(this.avatar, this.coarser ?? textureOf(this.avatar));
      this.levels.push(this.levelOf(this.coarser, this.coarser.statics, this.levels.length));
    }
    return this.levels[number];
  }

  /** @returns {LevelBuffers} */
  levelOf(
    /** @type {Texels} */ texels,
    /** @type {{geometry: Stored | Float32Array, appearance: Stored | Float32Array}} */ statics,
    /** @type {number} */ number,
  ) {
    const tiles = texelTiles(texels, this.expressing?.reached);
    return {
      number,
      size: texels.size,
      splatCount: texels.texels.length,
      texels: this.memory.buffer(texelWords(texels), "texels"),
      tileCount: tiles.length / TILE_WORDS,
      tiles: this.memory.buffer(tiles, "texels.texels"),
      geometry: this.branchLevel("geometry", statics.geometry, number),
      appearance: this.branchLevel("appearance", statics.appearance, number),
    };
  }

  /** @returns {BranchLevel} */
  branchLevel(
    /** @type {"geometry" | "appearance"} */ name,
    /** @type {Stored | Float32Array} */ values,
    /** @type {number} */ number,
  ) {
    const { wavelet } = this.avatar;
    const { taps, ...rest } = upsamplingTaps(wavelet.recLo, wavelet.levels - this.avatar[name].details.length, number);
    const label = `${name}.static_offset`;
    return {
      upsampling: { ...rest, taps: this.memory.buffer(Float32Array.from(taps), "wavelet.rec_lo") },
      staticOffset:
        values instanceof Float32Array
          ? { words: this.memory.buffer(values, label), layout: [ELEMENT_TYPES.indexOf("F32"), 1, 0] }
          : this.stored(values, label),
    };
  }

  /** @returns {StoredBuffer} */
  stored(/** @type {Stored} */ tensor, /** @type {string} */ label) {
    const type = ELEMENT_TYPES.indexOf(tensor.type);
    if (!tensor.scale) return { words: this.memory.buffer(tensor.data, label), layout: [type, 1, 0] };
    const words = Math.ceil(tensor.data.length / 4);
    const content = new Uint8Array(4 * words + tensor.scale.byteLength);
    content.set(tensor.data);
    new Float32Array(content.buffer, 4 * words).set(tensor.scale);
    const perScale = Math.max(tensor.data.length / tensor.scale.length, 1);
    return { words: this.memory.buffer(content, label), layout: [type, perScale, words] };
  }

  mlp(/** @type {import("./format/model.js").Layer[]} */ layers, /** @type {string} */ path) {
    return layers.map((layer, i) => ({
      weight: this.stored(layer.weight, `${path}[${i}].weight`),
      bias: this.stored(layer.bias, `${path}[${i}].bias`),
      inputs: layer.inputs,
      outputs: layer.outputs,
    }));
  }

  branch(/** @type {Branch} */ branch, /** @type {string} */ name) {
    return {
      mlp: this.mlp(branch.mlp, `${name}.mlp`),
      llMean: this.stored(branch.llMean, `${name}.ll_mean`),
      llBasis: this.stored(branch.llBasis, `${name}.ll_basis`),
      details: branch.details.map((band, i) => ({
        mean: this.stored(band.mean, `${name}.details[${i}].mean`),
        h: this.stored(band.h, `${name}.details[${i}].h`),
        w: this.stored(band.w, `${name}.details[${i}].w`),
        rank: band.rank,
        size: band.size,
      })),
      channels: branch.channels,
      rank: branch.rank,
    };
  }
}
