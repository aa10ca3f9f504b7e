// What the page's device holds of the avatars of one player, and the pictures that it draws of them. A lost device's renderer is
// left behind and another one made.

import { AvatarBuffers } from "./buffers.js";
import { camerasOf, sees } from "./camera.js";
import { KERNELS as DECODING, kernelsFor } from "./channels.js";
import { sample, window } from "./clip.js";
import { Decodes, rankOf } from "./decodes.js";
import { Memory } from "./device.js";
import { readOrder, writeOrder } from "./early.js";
import { AvatarError, unfetched } from "./error.js";
import { AvatarFrame } from "./frame.js";
import { MILLISECONDS } from "./frame_budget.js";
import { areCompiled, kernelsOf } from "./kernel.js";
import { Levels, levelsOf } from "./levels.js";
import { Overlays } from "./overlays.js";
import { weighted } from "./pose.js";
import { COLOR, DEPTH, Scene } from "./scene.js";
import { giveBack, takeDevice } from "./shared.js";
import { PROJECTING, reach, SORTING, SplatFrame } from "./splats.js";
import { Timing } from "./timing.js";
import { BlendVertices } from "./wgsl/dq_skinning.js";

/** @typedef {import("./format/read.js").Avatar} Avatar */
/** @typedef {import("./clip.js").Clip} Clip */
/** @typedef {import("./live.js").LivePose} LivePose */
/** @typedef {{memory: Memory, frame: AvatarFrame, overlays: Overlays, levels: Levels, decoded: import("./skeleton.js").Pose | null, standing: string}} Slot an avatar on the device, the newest pose of its last decode, and how it stands */
/**
 * @typedef {object} Posed what a picture shows of one
 * @property {Slot} slot
 * @property {Clip} clip
 * @property {number} frame of the clip, or the number of a window
 * @property {number} following to be decoded before it is due
 * @property {LivePose | null} live where a page sets the pose, in place of the clip
 * @property {Float32Array | null} weights of expressions that a page has set
 * @property {string} stamp changes with what a page sets
 * @property {boolean} spread whether a decode may come later than its frame
 * @property {boolean} mayLag whether it may where the avatar is alone
 * @property {number[]} place
 * @property {number} ground
 */
/** @typedef {{compile: () => Promise<void>}} Compiled */
/** @typedef {{camera: import("./player.js").CameraState, stereo: boolean, show: import("./player.js").Show, level: import("./player.js").Level, budget: number | null, frameBudget: number | null}} Look */

export const AWAY = "The graphics device is away; try again in a moment.";
const POSED = "\0"; // no clip's name

export class Renderer {
  /** @returns {Promise<Renderer>} */
  static async open(
    /** @type {HTMLCanvasElement} */ canvas,
    /** @type {import("./player.js").PlayerOptions} */ options,
  ) {
    const device = await takeDevice(options);
    try {
      return new Renderer(device, canvas, options);
    } catch (error) {
      giveBack(device);
      throw error;
    }
  }

  constructor(
    /** @type {import("./device.js").Device} */ device,
    /** @type {HTMLCanvasElement} */ canvas,
    /** @type {import("./player.js").PlayerOptions} */ options,
  ) {
    const context = /** @type {GPUCanvasContext | null} */ (/** @type {unknown} */ (canvas.getContext("webgpu")));
    if (!context) throw new AvatarError("The canvas is in use for something else; the player needs one of its own.");
    this.device = device;
    this.canvas = canvas;
    this.context = context;
    context.configure({ device: device.gpu, format: COLOR, alphaMode: "premultiplied" });
    this.scene = new Scene(device, options.background ?? [0, 0, 0, 0]);
    this.decodes = new Decodes();
    this.timing = new Timing(device, (milliseconds) => this.decodes.time(milliseconds));
    /** @type {import("./camera.js").Camera[]} */
    this.cameras = []; // of the last picture
    this.shared = new Memory(device); // the splats of all avatars
    this.decoding = compiled(kernelsOf(device, { ...DECODING, BlendVertices }));
    // What comes later is compiled later: the first frame is decoded meanwhile.
    this.projecting = this.decoding.then(() =>
      compiled({ ...kernelsOf(device, PROJECTING), splats: this.scene.splats }),
    );
    this.projecting.catch(() => {}); // whoever adds an avatar or draws it gets the error
    /** @type {Promise<unknown> | null} */
    this.sorting = null; // once the first picture is there
    this.ready = false; // to draw at once
    this.closed = new AbortController();
    /** @type {Slot[]} */
    this.slots = [];
    /** @type {SplatFrame | null} */
    this.splats = null;
  }

  /** Upload an avatar, so that it can be decoded. @returns {Promise<Slot>} @throws {AvatarError} where the device cannot hold it */
  async add(/** @type {Avatar} */ avatar) {
    const expressing = avatar.expressions.length ? await import("./expressing.js") : null;
    await expressing?.fetchRules(avatar);
    if (this.destroyed) throw new AvatarError(AWAY); // lost meanwhile
    const needed = [
      ...kernelsFor(this.device, avatar, expressing),
      ...Object.values(kernelsOf(this.device, expressing?.KERNELS ?? {})),
    ];
    const kernels = Promise.all([this.decoding, compiled(needed)]);
    kernels.catch(() => {}); // where the device cannot hold it
    const slot = await this.upload(avatar, expressing?.Expressing);
    try {
      await kernels;
    } catch (error) {
      this.remove(slot);
      throw error;
    }
    if (areCompiled(this.device, SORTING)) await this.compile(); // for another player of the page
    return slot;
  }

  /** @param {Avatar} avatar @param {typeof import("./expressing.js").Expressing} [Expressing] @returns {Promise<Slot>} */
  async upload(avatar, Expressing) {
    const { gpu } = this.device;
    const memory = new Memory(this.device);
    gpu.pushErrorScope("out-of-memory");
    /** @type {Slot | null} */
    let slot = null;
    try {
      const frame = new AvatarFrame(new AvatarBuffers(memory, avatar, Expressing));
      const overlays = new Overlays(memory, frame, { color: COLOR, depth: DEPTH });
      slot = { memory, frame, overlays, levels: new Levels(avatar), decoded: null, standing: "" };
      this.rearrange([...this.slots, slot]);
    } finally {
      const lacking = await gpu.popErrorScope();
      if (lacking || !slot) memory.free();
      if (lacking) {
        this.rearrange(this.slots.filter((one) => one !== slot));
        // biome-ignore lint/correctness/noUnsafeFinally: too little memory is the cause of whatever failed before
        throw new AvatarError(`${avatar.name}: the graphics device has too little free memory for this avatar.`);
      }
    }
    return slot;
  }

  /** Put an avatar that was added into the place of another one, which goes. */
  replace(/** @type {Slot} */ old, /** @type {Slot} */ slot) {
    this.rearrange(this.slots.filter((one) => one !== slot).map((one) => (one === old ? slot : one)));
    this.free(old);
  }

  remove(/** @type {Slot} */ slot) {
    this.rearrange(this.slots.filter((one) => one !== slot));
    this.free(slot);
  }

  free(/** @type {Slot} */ slot) {
    this.decodes.schedule.forget(slot);
    slot.memory.free();
  }

  /** Room for the splats of all avatars that are there from now on. */
  rearrange(/** @type {Slot[]} */ slots) {
    const shared = new Memory(this.device);
    try {
      const frames = slots.map((slot) => slot.frame);
      const splats = slots.length ? new SplatFrame(shared, frames) : null;
      this.shared.free();
      [this.shared, this.splats, this.slots] = [shared, splats, slots];
    } catch (error) {
      shared.free();
      throw error;
    }
  }

  /** Compile what was left for after the first picture. */
  async compile() {
    await this.projecting;
    this.sorting ??= compiled(kernelsOf(this.device, SORTING));
    await this.sorting;
    this.ready = true;
  }

  /** Draw on to the canvas what takes no more kernels than are compiled first. @param {Posed[]} posed @param {Look} look */
  async drawEarly(posed, look) {
    const { device, canvas } = this;
    const { width, height } = canvas;
    const cameras = camerasOf(look.camera, look.stereo, [width, height]);
    this.compute((pass) => this.pose(pass, posed, look, cameras));
    await this.projecting;
    const { splats } = this;
    if (this.destroyed) return;
    if (!splats) return this.draw(posed, look);
    this.compute((pass) => splats.projectAll(pass, cameras));
    const order = await readOrder(device, splats);
    // What has changed meanwhile is drawn again by whoever changed it.
    if (!order || this.splats !== splats || canvas.width !== width || canvas.height !== height) return;
    writeOrder(device, splats, order);
    const encoder = device.gpu.createCommandEncoder();
    const overlays = posed.map(({ slot }) => slot.overlays);
    this.scene.draw(encoder, this.context.getCurrentTexture(), { frame: splats, overlays, cameras, show: look.show });
    this.send(encoder);
    await device.gpu.queue.onSubmittedWorkDone();
    void this.compile().catch(() => {}); // the processor goes on sorting
  }

  /** Draw on to the canvas. */
  draw(/** @type {Posed[]} */ posed, /** @type {Look} */ look) {
    this.submit(this.context.getCurrentTexture(), posed, look);
  }

  /** The picture as a PNG. @returns {Promise<Blob>} */
  async picture(/** @type {Posed[]} */ posed, /** @type {Look} */ look) {
    const memory = new Memory(this.device);
    const { width, height } = this.canvas;
    const target = memory.texture([width, height], COLOR, GPUTextureUsage.COPY_SRC);
    this.submit(target, posed, look);
    try {
      const { readPicture } = await import("./picture.js").catch(unfetched("screenshot"));
      return await readPicture(this.device, target);
    } finally {
      memory.free();
    }
  }

  /** Draw on to a texture; seen by the camera of `look`, or by eyes that are given, side by side. @param {GPUTexture} target @param {Posed[]} posed @param {Look} look @param {import("./camera.js").Camera[]} [eyes] */
  submit(target, posed, look, eyes) {
    const { device, timing, splats } = this;
    const cameras = eyes ?? camerasOf(look.camera, look.stereo, [target.width, target.height]);
    const encoder = device.gpu.createCommandEncoder();
    const decode = encoder.beginComputePass({ label: "decode", timestampWrites: timing.of("decode") });
    this.pose(decode, posed, look, cameras);
    decode.end();
    if (splats) {
      const pass = encoder.beginComputePass({ label: "sort", timestampWrites: timing.of("sort") });
      splats.sort(pass, cameras);
      pass.end();
    }
    const overlays = posed.map(({ slot }) => slot.overlays);
    this.scene.draw(encoder, target, { frame: splats, overlays, cameras, show: look.show }, timing.of("draw"));
    const then = timing.end(encoder);
    this.send(encoder);
    then();
  }

  /** Take the time of a frame of the display or the headset, milliseconds, where the device keeps none. */
  displays(/** @type {number} */ now) {
    if (!this.timing.queries) this.decodes.display(now);
  }

  /** Decode a part of what comes next, where the picture stays. */
  lookAhead(/** @type {Posed[]} */ posed) {
    const levels = posed.map(({ slot }) => slot.levels.shown);
    const changed = this.compute((pass) => this.decode(pass, posed, levels, this.cameras));
    for (const slot of changed) slot.standing = ""; // which the next picture poses
  }

  /** Submit a pass of its own. @template Made @param {(pass: GPUComputePassEncoder) => Made} record @returns {Made} */
  compute(record) {
    const encoder = this.device.gpu.createCommandEncoder();
    const pass = encoder.beginComputePass();
    const made = record(pass);
    pass.end();
    this.send(encoder);
    return made;
  }

  send(/** @type {GPUCommandEncoder} */ encoder) {
    this.device.uniforms.upload();
    this.device.gpu.queue.submit([encoder.finish()]);
  }

  /** Decode what is due, or a part of what comes next, and bring it to the pose in which it is shown. @param {GPUComputePassEncoder} pass @param {Posed[]} posed @param {Look} look @param {import("./camera.js").Camera[]} cameras */
  pose(pass, posed, look, cameras) {
    const poses = posed.map(poseOf);
    const standing = posed.map(({ slot, place }, i) => ({ levels: slot.levels, pose: poses[i], place }));
    const levels = look.show.geometry ? posed.map(() => 0) : levelsOf(standing, this.limited(look), cameras);
    this.cameras = cameras;
    const changed = this.decode(pass, posed, levels, cameras);
    for (const [i, one] of posed.entries()) {
      const { slot, frame, place, ground } = one;
      const { standing } = slot;
      slot.standing = [nameOf(one), one.live?.version, frame, ...place, ground].join();
      if (!changed.has(slot) && slot.standing === standing) continue;
      slot.frame.repose(pass, poses[i], place);
      slot.overlays.pose(ground + place[1]);
    }
    const shown = posed.reduce((sum, { slot }) => sum + slot.frame.splatCount, 0);
    const finest = posed.reduce((sum, { slot }) => sum + slot.levels.counts[0], 0);
    const limits = look.frameBudget !== null && look.level === "auto";
    const most = look.frameBudget ?? MILLISECONDS;
    this.decodes.measured = { most, avatars: posed.length, splats: limits ? [shown, finest] : null };
  }

  /** Append what a displayed frame decodes of the avatars in view; those of which other channels are shown. @param {GPUComputePassEncoder} pass @param {Posed[]} posed @param {number[]} levels @param {import("./camera.js").Camera[]} cameras */
  decode(pass, posed, levels, cameras) {
    const asked = posed.map((one, i) => {
      const { slot, frame, following, place, mayLag } = one;
      const [due, next] = [frame, following].map((at) => ({ clip: nameOf(one), frame: at }));
      const spread = one.spread && slot.decoded !== null;
      const ask = { due, following: next, level: levels[i], rank: 0, spread, mayLag };
      let seen = true;
      if (posed.length > 1 && ask.spread) {
        const box = slot.levels.box(poseOf(one), place);
        seen = cameras.some((camera) => sees(camera, reach(box)));
        ask.rank = rankOf(slot, poseOf(one), box, cameras);
      }
      return { slot, ask, seen, window: windowOf(one) };
    });
    return this.decodes.record(
      pass,
      asked.filter(({ seen }) => seen),
    );
  }

  /** A look with the splats that the device has been found to have time for. @param {Look} look @returns {Look} */
  limited(look) {
    const { splats } = this.decodes.budget;
    if (look.frameBudget === null || splats === null) return look;
    return { ...look, budget: Math.min(look.budget ?? Infinity, splats) };
  }

  get destroyed() {
    return this.closed.signal.aborted;
  }

  /** Bytes of the device's buffers that hold these avatars. */
  get bytes() {
    return [this.shared, ...this.slots.map(({ memory }) => memory)].reduce((sum, { bytes }) => sum + bytes, 0);
  }

  destroy() {
    this.closed.abort();
    for (const slot of this.slots) slot.memory.free();
    this.rearrange([]);
    this.scene.free();
    this.timing.free();
    this.context.unconfigure();
    giveBack(this.device);
  }
}

function compiled(/** @type {Record<string, Compiled> | Compiled[]} */ parts) {
  return Promise.all(Object.values(parts).map((one) => one.compile()));
}

/** The pose in which an avatar is shown. @returns {import("./skeleton.js").Pose} */
function poseOf(/** @type {Posed} */ { slot, clip, frame, live, weights }) {
  const { skeleton, encoding } = slot.frame.buffers.avatar;
  return live?.current ?? weighted(sample(skeleton, clip, frame, encoding.rate), weights);
}

/** The poses that end at a moment of what is shown. @returns {import("./decodes.js").Window} */
function windowOf(/** @type {Posed} */ { slot, clip, live, weights }) {
  const { skeleton, encoding } = slot.frame.buffers.avatar;
  return ({ frame }) => live?.window ?? window(skeleton, clip, frame, encoding).map((pose) => weighted(pose, weights));
}

/** What tells frames of a clip from those of others, and from windows that a page sets. */
function nameOf(/** @type {Posed} */ { clip, live, stamp }) {
  return live ? POSED : `${clip.name}${stamp}`;
}
