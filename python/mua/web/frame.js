// One frame of an avatar: from a window of poses to channels and posed vertices. A decode is made at once, or part by part in
// several displayed frames beside the channels that are shown meanwhile. Reference: python/mua/player/frame.py.

import { ChannelDecoder, FLOAT, groups, PARTS, TEXEL_CHANNELS } from "./channels.js";
import { readComponents } from "./components.js";
import { describe } from "./descriptor.js";
import { kernelsOf } from "./kernel.js";
import { dualFromRigid, dualMultiply, dualTransform } from "./rotation.js";
import { skinning, world } from "./skeleton.js";
import { BlendVertices } from "./wgsl/dq_skinning.js";

/** @typedef {import("./buffers.js").AvatarBuffers} AvatarBuffers */
/** @typedef {import("./channels.js").ChannelSet} ChannelSet */
/** @typedef {import("./skeleton.js").Pose} Pose */

const SKINNED = 64; // vertices of a group of BlendVertices

/** The channels that are shown and, where a decode is spread, those that are made meanwhile. */
export class AvatarFrame {
  constructor(/** @type {AvatarBuffers} */ buffers) {
    const { avatar, memory } = buffers;
    this.buffers = buffers;
    this.device = memory.device;
    this.vertexCount = avatar.coarse.vertices;
    this.bounds = Array.from(avatar.bounds); // world box of the last pose, lowest then highest corner, metres
    this.places = new Float64Array(); // [J, 3] of the last pose, metres
    this.joints = memory.buffer(FLOAT * 8 * avatar.skeleton.names.length, "joints"); // [J, 8]
    this.vertexDq = memory.buffer(FLOAT * 8 * this.vertexCount, "vertex_dq"); // [V, 8]
    this.decoder = new ChannelDecoder(buffers);
    this.kernels = kernelsOf(this.device, { BlendVertices });
    this.shown = this.createChannels();
    /** @type {ChannelSet | null} */
    this.hidden = null; // made when a decode is first begun
    this.decoded = PARTS; // parts of the decode into `hidden`
  }

  /** @returns {ChannelSet} */
  createChannels() {
    const { memory, avatar } = this.buffers;
    const level = this.buffers.level(0);
    return {
      level,
      components: memory.buffer(FLOAT * avatar.encoding.margins.length, "components"),
      outside: 0,
      mesh: memory.buffer(FLOAT * 3 * this.vertexCount, "mesh"),
      texelChannels: memory.buffer(TEXEL_CHANNELS * level.splatCount, "texel_channels"),
      weights: memory.buffer(FLOAT * avatar.expressions.length, "weights"),
      expressive: false,
    };
  }

  /** Level of the decode that is shown; the buffers have room for the finest. */
  get splatCount() {
    return this.shown.level.splatCount;
  }

  /** How far outside of training the pose is that is shown, 0 to 1. */
  get outside() {
    return this.shown.outside;
  }

  /** Parts of the decode that was begun and is not shown. */
  get partsLeft() {
    return PARTS - this.decoded;
  }

  /**
   * Append all parts of a decode, whose channels are shown from then on; one that was begun is given up.
   * Components and weights are written to the device at once: submit before the next decode.
   * @param {GPUComputePassEncoder} pass @param {Pose[]} window newest first @param {number} level of detail, 0 being the finest
   */
  decode(pass, window, level) {
    this.decoded = PARTS;
    this.take(this.shown, window, level);
    for (let part = 0; part < PARTS; part++) this.decoder.part(pass, this.shown, part);
  }

  /** Take the window of a decode that is made part by part beside what is shown, in place of one begun before. */
  begin(/** @type {Pose[]} */ window, /** @type {number} */ level) {
    this.hidden ??= this.createChannels();
    this.take(this.hidden, window, level);
    this.decoded = 0;
  }

  /** Append the next part of the decode that was begun. */
  advance(/** @type {GPUComputePassEncoder} */ pass) {
    if (this.hidden) this.decoder.part(pass, this.hidden, this.decoded);
    this.decoded += 1;
  }

  /** Show the decode that was begun, all of whose parts have been appended. */
  show() {
    if (this.hidden) [this.shown, this.hidden] = [this.hidden, this.shown];
  }

  take(/** @type {ChannelSet} */ channels, /** @type {Pose[]} */ window, /** @type {number} */ level) {
    const { skeleton, encoding } = this.buffers.avatar;
    channels.level = this.buffers.level(level);
    const { held, outside } = readComponents(encoding, describe(skeleton, encoding, window));
    channels.outside = outside;
    this.device.write(channels.components, Float32Array.from(held));
    const [{ expressions }] = window;
    const shown = expressions && this.buffers.expressing?.shown(expressions);
    channels.expressive = shown?.some((weight) => weight !== 0) ?? false;
    if (shown && channels.expressive) this.device.write(channels.weights, shown);
  }

  /**
   * Append what moves the decoded avatar into a pose. @param {GPUComputePassEncoder} pass @param {Pose} pose
   * @param {number[]} place where the avatar's space lies in the world, metres
   */
  repose(pass, pose, place) {
    this.writePose(pose, place);
    const { skinIndices: indices, skinWeights: weights } = this.buffers;
    this.kernels.BlendVertices.dispatch(
      pass,
      [groups(this.vertexCount, SKINNED), 1, 1],
      { joints: this.joints, indices, weights, vertex_dq: this.vertexDq },
      { vertex_count: this.vertexCount },
    );
  }

  writePose(/** @type {Pose} */ pose, /** @type {number[]} */ place) {
    const { skeleton, bounds } = this.buffers.avatar;
    const posed = world(skeleton, pose);
    const moved = dualFromRigid([1, 0, 0, 0], place);
    const local = skinning(skeleton, posed);
    const joints = new Float32Array(local.length);
    for (let at = 0; at < local.length; at += 8) joints.set(dualMultiply(moved, local, 0, at), at);
    this.device.write(this.joints, joints);
    this.places = posed.places;
    for (let at = 0; at < posed.places.length; at += 3) this.places.set(dualTransform(moved, posed.places, 0, at), at);
    const root = 3 * skeleton.root;
    this.bounds = Array.from(bounds, (value, i) => value + this.places[root + (i % 3)]);
  }
}
