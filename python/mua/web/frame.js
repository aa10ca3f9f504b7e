// One frame of an avatar: the dispatches from a window of poses to channels and posed vertices, a plain list in the order
// of the kernels. Reference: python/mua/player/frame.py.

import { describe } from "./descriptor.js";
import { kernelsOf } from "./kernel.js";
import { dualFromRigid, dualMultiply, dualTransform } from "./rotation.js";
import { skinning, world } from "./skeleton.js";
import { BlendDetail, BlendLl } from "./wgsl/blend_subbands.js";
import { BlendVertices } from "./wgsl/dq_skinning.js";
import { InverseDwt, UpsampleTexels } from "./wgsl/inverse_dwt.js";
import { MlpMatmul, MlpMatmulTransposed } from "./wgsl/mlp_matmul.js";

/** @typedef {import("./buffers.js").AvatarBuffers} AvatarBuffers */
/** @typedef {import("./skeleton.js").Pose} Pose */
/** @typedef {ReturnType<AvatarBuffers["branch"]>} Branch */
/** @typedef {ReturnType<AvatarBuffers["mlp"]>} Mlp */

export const FLOAT = 4; // bytes
const [LAYER_ROWS, MESH_COLUMNS] = [8, 64]; // outputs of a group of MlpMatmul and of MlpMatmulTransposed
const LL_TEXELS = 64; // of a group of BlendLl
const DETAIL_TILE = 24; // texels along a side of a group of BlendDetail
const COARSE_TILE = 16; // samples along a side that a group of InverseDwt doubles
const [ROWS, BATCH] = [6, 4]; // of texel_channels, and channels of each
const SKINNED = 64; // vertices of a group of BlendVertices
export const KERNELS = {
  MlpMatmul,
  MlpMatmulTransposed,
  BlendLl,
  BlendDetail,
  InverseDwt,
  UpsampleTexels,
  BlendVertices,
};

/** Groups of `size` that hold `count`. */
export const groups = (/** @type {number} */ count, /** @type {number} */ size) => Math.ceil(count / size);

/** The buffers between the kernels, sized once and reused by every frame. */
export class AvatarFrame {
  constructor(/** @type {AvatarBuffers} */ buffers) {
    const { avatar, geometry, appearance, coarseMlp, memory } = buffers;
    this.buffers = buffers;
    this.device = memory.device;
    this.splatCount = avatar.texels.texels.length;
    this.vertexCount = avatar.coarse.vertices;
    this.bounds = Array.from(avatar.bounds); // world box of the last decode, lowest then highest corner, metres
    this.places = new Float64Array(); // [J, 3] of the last decode, metres
    this.kernels = kernelsOf(this.device, KERNELS);
    const branches = [geometry, appearance];
    const layers = [...coarseMlp, ...branches.flatMap((branch) => branch.mlp)];
    const activations = FLOAT * Math.max(...layers.map((layer) => layer.outputs));
    const texture =
      FLOAT * Math.max(...branches.map((b) => b.channels * (avatar.texels.size / b.upsampling.factor) ** 2));
    const details = branches.flatMap((b) => b.details.map((band) => 3 * b.channels * band.size ** 2));
    this.descriptor = memory.buffer(FLOAT * avatar.encoding.width, "descriptor");
    this.activations = [0, 1].map((i) => memory.buffer(activations, `activations ${i}`));
    this.mesh = memory.buffer(FLOAT * 3 * this.vertexCount, "mesh"); // [V, 3] canonical vertices
    this.details = memory.buffer(FLOAT * Math.max(0, ...details), "details");
    this.textures = [texture, texture / 4].map((bytes, i) => memory.buffer(bytes, `texture ${i}`)); // finest with details, its ll
    this.texelChannels = memory.buffer(2 * ROWS * BATCH * this.splatCount, "texel_channels"); // [6, N, 4] halves
    this.joints = memory.buffer(FLOAT * 8 * avatar.skeleton.names.length, "joints"); // [J, 8]
    this.vertexDq = memory.buffer(FLOAT * 8 * this.vertexCount, "vertex_dq"); // [V, 8]
  }

  /**
   * Append the dispatches from a window of poses to channels and posed vertices.
   * What depends on the pose alone is written to the device at once: submit before the next decode.
   * @param {GPUComputePassEncoder} pass
   * @param {Pose[]} window newest first
   * @param {number[]} place where the avatar's space lies in the world, metres
   */
  decode(pass, window, place) {
    this.writePose(window, place);
    this.coarse(pass);
    this.branch(pass, this.buffers.geometry, 0);
    this.branch(pass, this.buffers.appearance, ROWS / 2);
    this.pose(pass);
  }

  writePose(/** @type {Pose[]} */ window, /** @type {number[]} */ place) {
    const { device } = this;
    const { avatar } = this.buffers;
    const { skeleton, encoding, bounds } = avatar;
    device.write(this.descriptor, describe(skeleton, encoding, window));
    const posed = world(skeleton, window[0]);
    const moved = dualFromRigid([1, 0, 0, 0], place);
    const local = skinning(skeleton, posed);
    const joints = new Float32Array(local.length);
    for (let at = 0; at < local.length; at += 8) joints.set(dualMultiply(moved, local, 0, at), at);
    device.write(this.joints, joints);
    this.places = posed.places;
    for (let at = 0; at < posed.places.length; at += 3) this.places.set(dualTransform(moved, posed.places, 0, at), at);
    const root = 3 * skeleton.root;
    this.bounds = Array.from(bounds, (value, i) => value + this.places[root + (i % 3)]);
  }

  /** What the MLP makes of the descriptor; good until the next MLP. */
  mlp(/** @type {GPUComputePassEncoder} */ pass, /** @type {Mlp} */ mlp) {
    let x = this.descriptor;
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

  coarse(/** @type {GPUComputePassEncoder} */ pass) {
    const { coarseMlp, mesh } = this.buffers;
    const x = this.mlp(pass, coarseMlp);
    this.layer(pass, this.kernels.MlpMatmulTransposed, mesh, { x, y: this.mesh }, MESH_COLUMNS, false);
  }

  /** Coefficients, LL, level by level as long as there are details; then the valid texels to `texelChannels`. */
  branch(/** @type {GPUComputePassEncoder} */ pass, /** @type {Branch} */ branch, /** @type {number} */ firstRow) {
    const alpha = this.mlp(pass, branch.mlp);
    const { texels, wavelet } = this.buffers.avatar;
    const { textures } = this;
    const levels = branch.details.length;
    let size = texels.size / 2 ** wavelet.levels;
    this.blendLow(pass, branch, alpha, size, textures[levels % 2]);
    let offset = branch.channels * branch.rank;
    branch.details.forEach((band, level) => {
      const [ll, fine] = [textures[(levels - level) % 2], textures[(levels - level - 1) % 2]];
      this.blendBand(pass, branch, band, alpha, offset, size);
      this.synthesise(pass, branch, ll, fine, size);
      offset += branch.channels * band.rank;
      size *= 2;
    });
    this.upsample(pass, branch, size, firstRow);
  }

  /** @param {GPUComputePassEncoder} pass @param {Branch} branch @param {GPUBuffer} alpha @param {number} size @param {GPUBuffer} blended */
  blendLow(pass, branch, alpha, size, blended) {
    this.kernels.BlendLl.dispatch(
      pass,
      [groups(size * size, LL_TEXELS), branch.channels, 1],
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

  /** One level, from planes of `size` to twice that. @param {GPUComputePassEncoder} pass @param {Branch} branch @param {GPUBuffer} ll @param {GPUBuffer} fine @param {number} size */
  synthesise(pass, branch, ll, fine, size) {
    const { recLo: rec_lo, recHi: rec_hi, avatar } = this.buffers;
    const tiles = groups(size, COARSE_TILE);
    this.kernels.InverseDwt.dispatch(
      pass,
      [tiles, tiles, branch.channels],
      { ll, details: this.details, rec_lo, rec_hi, fine },
      { channels: branch.channels, size, taps: avatar.wavelet.recLo.length },
    );
  }

  /** All levels without details, from planes of `size`, and the static offset, at the valid texels. @param {GPUComputePassEncoder} pass @param {Branch} branch @param {number} size @param {number} firstRow */
  upsample(pass, branch, size, firstRow) {
    const { tileCount, tiles, tileRows } = this.buffers;
    const { taps, factor, reach, delay } = branch.upsampling;
    this.kernels.UpsampleTexels.dispatch(
      pass,
      [tileCount, 1, groups(branch.channels, BATCH)],
      {
        ll: this.textures[0],
        upsampling: taps,
        tiles: tiles,
        tile_rows: tileRows,
        static_offset: branch.staticOffset.words,
        texel_channels: this.texelChannels,
      },
      {
        static_offset_layout: branch.staticOffset.layout,
        channels: branch.channels,
        size,
        factor,
        reach,
        delay,
        texel_count: this.splatCount,
        first_row: firstRow,
      },
    );
  }

  pose(/** @type {GPUComputePassEncoder} */ pass) {
    const { skinIndices, skinWeights } = this.buffers;
    this.kernels.BlendVertices.dispatch(
      pass,
      [groups(this.vertexCount, SKINNED), 1, 1],
      {
        joints: this.joints,
        indices: skinIndices,
        weights: skinWeights,
        vertex_dq: this.vertexDq,
      },
      { vertex_count: this.vertexCount },
    );
  }
}
