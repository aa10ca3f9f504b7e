// An avatar's tensors on the device, in the type in which the file stores them. Reference: python/mua/player/buffers.py.

import { texelTiles, texelWords, upsamplingTaps } from "./prepare.js";

/** @typedef {import("./device.js").Memory} Memory */
/** @typedef {import("./format/read.js").Avatar} Avatar */
/** @typedef {import("./format/model.js").Branch} Branch */
/** @typedef {import("./format/tensors.js").Stored} Stored */
/** @typedef {{words: GPUBuffer, layout: number[]}} StoredBuffer as the kernels' stored() reads it */

const ELEMENT_TYPES = ["F32", "F16", "I8"];

/** Everything of a file that does not change from frame to frame. */
export class AvatarBuffers {
  constructor(/** @type {Memory} */ memory, /** @type {Avatar} */ avatar) {
    const { coarse, wavelet, template, texels } = avatar;
    this.memory = memory;
    this.avatar = avatar;
    this.coarseMlp = this.mlp(coarse.mlp, "coarse.mlp");
    const [weight, bias] = [this.stored(coarse.basis, "coarse.basis"), this.stored(coarse.mean, "coarse.mean")];
    this.mesh = { weight, bias, inputs: coarse.basis.shape[0], outputs: 3 * coarse.vertices };
    this.geometry = this.branch(avatar.geometry, "geometry");
    this.appearance = this.branch(avatar.appearance, "appearance");
    this.recLo = memory.buffer(Float32Array.from(wavelet.recLo), "wavelet.rec_lo");
    this.recHi = memory.buffer(Float32Array.from(wavelet.recHi), "wavelet.rec_hi");
    this.faces = memory.buffer(template.faces, "template.faces");
    this.texels = memory.buffer(texelWords(texels), "texels");
    this.skinIndices = memory.buffer(template.skinIndices, "template.skin_indices");
    this.skinWeights = memory.buffer(template.skinWeights, "template.skin_weights");
    const { tiles, rows } = texelTiles(texels);
    this.tileCount = tiles.length;
    this.tiles = memory.buffer(tiles, "texels.texels");
    this.tileRows = memory.buffer(rows, "texels.texels");
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
    const { levels, recLo } = this.avatar.wavelet;
    const upsampling = upsamplingTaps(recLo, levels - branch.details.length);
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
      upsampling: { ...upsampling, taps: this.memory.buffer(Float32Array.from(upsampling.taps), "wavelet.rec_lo") },
      staticOffset: this.stored(branch.staticOffset, `${name}.static_offset`),
      channels: branch.channels,
      rank: branch.rank,
    };
  }
}
