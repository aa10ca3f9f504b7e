// From a window of poses to channels: the dispatches of a decode, a plain list in the order of the kernels, in parts that
// displayed frames can share. Reference: python/mua/player/channels.py.

import { wholeWords } from "./buffers.js";
import { kernelsOf, kernelWithRoom } from "./kernel.js";
import { upsamplingTaps } from "./prepare.js";
import { BlendDetail, BlendLl } from "./wgsl/blend_subbands.js";
import { InverseDwt, UpsampleTexels } from "./wgsl/inverse_dwt.js";
import { MlpMatmul, MlpMatmulTransposed } from "./wgsl/mlp_matmul.js";

/** @typedef {import("./buffers.js").AvatarBuffers} AvatarBuffers */
/** @typedef {import("./device.js").Device} Device */
/** @typedef {import("./format/read.js").Avatar} Avatar */
/** @typedef {import("./buffers.js").BranchLevel} BranchLevel */
/** @typedef {import("./buffers.js").LevelBuffers} LevelBuffers */
/** @typedef {ReturnType<AvatarBuffers["branch"]>} Branch */
/** @typedef {ReturnType<AvatarBuffers["mlp"]>} Mlp */
/**
 * @typedef {object} ChannelSet what a decode makes, and of what
 * @property {LevelBuffers} level of detail
 * @property {GPUBuffer} components [K] of the descriptor, as the networks read them
 * @property {number} outside share of the pose that training did not show
 * @property {GPUBuffer} mesh [V, 3] canonical vertices
 * @property {GPUBuffer} texelChannels [6, N, 4] halves; holds the finest level
 * @property {GPUBuffer} weights [E] of expressions
 * @property {boolean} expressive whether one of them is not 0
 */

export const FLOAT = 4; // bytes
const [LAYER_ROWS, MESH_COLUMNS] = [8, 64]; // outputs of a group of MlpMatmul and of MlpMatmulTransposed
const LL_PAIRS = 64; // texels that share a word, of a group of BlendLl
const DETAIL_TILE = 24; // texels along a side of a group of BlendDetail
const TEXEL_TILE = 16; // texels along a side of a group of UpsampleTexels
const COARSE_TILE = 16; // samples along a side that a group of InverseDwt doubles
const [ROWS, BATCH] = [6, 4]; // of texel_channels, and channels of each
export const TEXEL_CHANNELS = 2 * ROWS * BATCH; // bytes
export const PARTS = 4; // of a decode, which take about as long each
export const KERNELS = { BlendDetail, MlpMatmul, MlpMatmulTransposed, BlendLl };

/** Groups of `size` that hold `count`. */
export const groups = (/** @type {number} */ count, /** @type {number} */ size) => Math.ceil(count / size);

/** Words of a plane of half floats; each row fills whole words. */
const planeBytes = (/** @type {number} */ size) => FLOAT * size * groups(size, 2);

/** InverseDwt, whose groups share the rows of ll that filters of so many taps need, low- and high-pass. @param {Device} device @param {number} taps */
export function synthesis(device, taps) {
  const rows = COARSE_TILE + taps / 2 - 1;
  return kernelWithRoom(device, InverseDwt, "filtered", rows * COARSE_TILE);
}

/** UpsampleTexels, BendTexels or LightTexels, whose groups share the samples of ll that a tile of texels needs. @param {Device} device @param {{factor: number, reach: number}} upsampling */
export function upsampler(device, { factor, reach }, shader = UpsampleTexels) {
  const samples = groups(TEXEL_TILE - 1, factor) + reach;
  return kernelWithRoom(device, shader, "upsampled", samples * TEXEL_TILE);
}

/** The kernels that depend on the avatar, for its finest level. @param {Device} device @param {Avatar} avatar @param {{BendTexels: import("./shader.js").Shader, LightTexels: import("./shader.js").Shader} | null} face of one with expressions */
export function kernelsFor(device, { wavelet, geometry, appearance }, face) {
  const upsamplings = [geometry, appearance].map(({ details }) =>
    upsamplingTaps(wavelet.recLo, wavelet.levels - details.length),
  );
  const ways = [[UpsampleTexels, UpsampleTexels], ...(face ? [[face.BendTexels, face.LightTexels]] : [])];
  const all = ways.flatMap((way) => way.map((shader, branch) => upsampler(device, upsamplings[branch], shader)));
  return [synthesis(device, wholeWords(wavelet.recLo).length), ...all];
}

/** The buffers between the kernels of a decode, sized once: parts read what the one before left in them. */
export class ChannelDecoder {
  constructor(/** @type {AvatarBuffers} */ buffers) {
    const { avatar, geometry, appearance, coarseMlp, memory } = buffers;
    this.buffers = buffers;
    this.kernels = { ...kernelsOf(memory.device, KERNELS), InverseDwt: synthesis(memory.device, buffers.taps) };
    const branches = [geometry, appearance];
    const layers = [...coarseMlp, ...branches.flatMap((branch) => branch.mlp)];
    const activations = FLOAT * Math.max(...layers.map((layer) => layer.outputs));
    const low = avatar.texels.size / 2 ** avatar.wavelet.levels;
    const texture = (/** @type {Branch} */ branch, /** @type {number} */ before) =>
      branch.channels * planeBytes(Math.floor((low * 2 ** branch.details.length) / 2 ** before));
    const details = branches.flatMap(({ channels, details }) =>
      details.map((band) => 3 * channels * planeBytes(band.size)),
    );
    this.activations = [0, 1].map((i) => memory.buffer(activations, `activations ${i}`));
    this.details = memory.buffer(Math.max(0, ...details), "details");
    // the finest texture with details, and its ll
    this.textures = [0, 1].map((i) => memory.buffer(Math.max(...branches.map((b) => texture(b, i))), `texture ${i}`));
  }

  /** Append one of PARTS, in their order: from the components in `channels` to their results there. @param {GPUComputePassEncoder} pass @param {ChannelSet} channels @param {number} part */
  part(pass, channels, part) {
    const { geometry, appearance } = this.buffers;
    const { level } = channels;
    if (part === 0) this.blend(pass, geometry, channels);
    if (part === 1) {
      this.coarse(pass, channels);
      if (channels.expressive) this.buffers.expressing?.dispatch(pass, channels);
      this.texels(pass, geometry, level.geometry, channels, 0);
    }
    if (part === 2) this.blend(pass, appearance, channels);
    if (part === 3) this.texels(pass, appearance, level.appearance, channels, ROWS / 2);
  }

  /** Output of the MLP for the components; the next MLP overwrites it. */
  mlp(/** @type {GPUComputePassEncoder} */ pass, /** @type {Mlp} */ mlp, /** @type {GPUBuffer} */ components) {
    let x = components;
    mlp.forEach((layer, i) => {
      const y = this.activations[i % 2];
      this.layer(pass, this.kernels.MlpMatmul, layer, { x, y }, LAYER_ROWS, i < mlp.length - 1);
      x = y;
    });
    return x;
  }

  /**
   * One fully connected layer, or the basis of the mesh as one.
   * @param {GPUComputePassEncoder} pass @param {import("./kernel.js").Kernel} kernel @param {Mlp[0]} layer
   * @param {{x: GPUBuffer, y: GPUBuffer}} through @param {number} outputs of a group @param {boolean} relu
   */
  layer(pass, kernel, layer, through, outputs, relu) {
    kernel.dispatch(
      pass,
      [groups(layer.outputs, outputs), 1, 1],
      { weight: layer.weight.words, bias: layer.bias.words, ...through },
      {
        weight_layout: layer.weight.layout,
        bias_layout: layer.bias.layout,
        inputs: layer.inputs,
        outputs: layer.outputs,
        relu: Number(relu),
      },
    );
  }

  coarse(/** @type {GPUComputePassEncoder} */ pass, /** @type {ChannelSet} */ channels) {
    const { coarseMlp, mesh } = this.buffers;
    const x = this.mlp(pass, coarseMlp, channels.components);
    this.layer(pass, this.kernels.MlpMatmulTransposed, mesh, { x, y: channels.mesh }, MESH_COLUMNS, false);
  }

  /** Coefficients, LL, and level by level up to the finest details. @param {GPUComputePassEncoder} pass @param {Branch} branch @param {ChannelSet} channels */
  blend(pass, branch, channels) {
    const alpha = this.mlp(pass, branch.mlp, channels.components);
    this.blendLow(pass, branch, alpha, this.size(0), this.textures[branch.details.length % 2]);
    let offset = branch.channels * branch.rank;
    branch.details.forEach((band, level) => {
      if (level > 0) this.synthesise(pass, branch, level - 1);
      this.blendBand(pass, branch, band, alpha, offset, this.size(level));
      offset += branch.channels * band.rank;
    });
  }

  /**
   * The finest level with details; then the valid texels to `channels`.
   * @param {GPUComputePassEncoder} pass @param {Branch} branch @param {BranchLevel} shown @param {ChannelSet} channels
   * @param {number} firstRow
   */
  texels(pass, branch, shown, channels, firstRow) {
    const levels = branch.details.length;
    if (levels > 0) this.synthesise(pass, branch, levels - 1);
    this.upsample(pass, branch, shown, channels, this.size(levels), firstRow);
  }

  /** Samples along a side of LL, or of what so many levels made of it. */
  size(/** @type {number} */ level) {
    const { texels, wavelet } = this.buffers.avatar;
    return texels.size / 2 ** (wavelet.levels - level);
  }

  /** @param {GPUComputePassEncoder} pass @param {Branch} branch @param {GPUBuffer} alpha @param {number} size @param {GPUBuffer} blended */
  blendLow(pass, branch, alpha, size, blended) {
    this.kernels.BlendLl.dispatch(
      pass,
      [groups(size * groups(size, 2), LL_PAIRS), branch.channels, 1],
      { mean: branch.llMean.words, basis: branch.llBasis.words, alpha, blended },
      {
        mean_layout: branch.llMean.layout,
        basis_layout: branch.llBasis.layout,
        channels: branch.channels,
        rank: branch.rank,
        size,
        alpha_offset: 0,
      },
    );
  }

  /** @param {GPUComputePassEncoder} pass @param {Branch} branch @param {Branch["details"][0]} band @param {GPUBuffer} alpha @param {number} alphaOffset @param {number} size */
  blendBand(pass, branch, band, alpha, alphaOffset, size) {
    const tiles = groups(size, DETAIL_TILE);
    this.kernels.BlendDetail.dispatch(
      pass,
      [tiles, tiles, 3 * branch.channels],
      { mean: band.mean.words, h: band.h.words, w: band.w.words, alpha, blended: this.details },
      {
        mean_layout: band.mean.layout,
        h_layout: band.h.layout,
        w_layout: band.w.layout,
        channels: branch.channels,
        rank: band.rank,
        size,
        alpha_offset: alphaOffset,
      },
    );
  }

  /** One level with its details, to planes of twice the size. @param {GPUComputePassEncoder} pass @param {Branch} branch @param {number} level */
  synthesise(pass, branch, level) {
    const { recLo: rec_lo, recHi: rec_hi, taps } = this.buffers;
    const [size, finest] = [this.size(level), branch.details.length];
    const [ll, fine] = [0, 1].map((done) => this.textures[(finest - level - done) % 2]);
    const tiles = groups(size, COARSE_TILE);
    this.kernels.InverseDwt.dispatch(
      pass,
      [tiles, tiles, branch.channels],
      { ll, details: this.details, rec_lo, rec_hi, fine },
      { channels: branch.channels, size, taps },
    );
  }

  /**
   * All levels without details, from planes of `size`, and the static offset, at the valid texels; those in reach of
   * expressions bend with geometry, and are lit with appearance.
   * @param {GPUComputePassEncoder} pass @param {Branch} branch @param {BranchLevel} shown @param {ChannelSet} channels
   * @param {number} size @param {number} firstRow
   */
  upsample(pass, branch, shown, channels, size, firstRow) {
    const { level } = channels;
    const { taps, factor, reach, delay } = shown.upsampling;
    const { device } = this.buffers.memory;
    const expressing = channels.expressive ? this.buffers.expressing : null;
    const buffers = {
      ll: this.textures[0],
      upsampling: taps,
      tiles: level.tiles,
      static_offset: shown.staticOffset.words,
      texel_channels: channels.texelChannels,
    };
    const constants = {
      static_offset_layout: shown.staticOffset.layout,
      channels: branch.channels,
      size,
      factor,
      reach,
      delay,
      texel_count: level.splatCount,
    };
    if (expressing) {
      const isGeometry = firstRow === 0;
      const bends = { faces: this.buffers.faces, texels: level.texels, vertex_bends: expressing.buffers.vertex_bends };
      const kernel = upsampler(device, shown.upsampling, isGeometry ? expressing.bender : expressing.lighter);
      kernel.dispatch(pass, [level.tileCount, 1, 1], isGeometry ? { ...buffers, ...bends } : buffers, constants);
      return;
    }
    const [kernel, batches] = [upsampler(device, shown.upsampling), groups(branch.channels, BATCH)];
    kernel.dispatch(pass, [level.tileCount, 1, batches], buffers, { ...constants, first_row: firstRow });
  }
}
