// What the page's device holds of the avatars of one player, and the pictures that it draws of them. A lost device's renderer is
// left behind and another one made.

import { AvatarBuffers } from "./buffers.js";
import { camerasOf } from "./camera.js";
import { KERNELS as DECODING, kernelsFor } from "./channels.js";
import { window } from "./clip.js";
import { Memory } from "./device.js";
import { readOrder, writeOrder } from "./early.js";
import { AvatarError } from "./error.js";
import { AvatarFrame } from "./frame.js";
import { areCompiled, kernelsOf } from "./kernel.js";
import { Levels, levelsOf } from "./levels.js";
import { Overlays } from "./overlays.js";
import { readPicture } from "./picture.js";
import { COLOR, DEPTH, Scene } from "./scene.js";
import { DecodeSchedule } from "./schedule.js";
import { giveBack, takeDevice } from "./shared.js";
import { PROJECTING, SORTING, SplatFrame } from "./splats.js";
import { Timing } from "./timing.js";
import { BlendVertices } from "./wgsl/dq_skinning.js";

/** @typedef {import("./format/read.js").Avatar} Avatar */
/** @typedef {import("./format/read.js").Clip} Clip */
/** @typedef {{memory: Memory, frame: AvatarFrame, overlays: Overlays, schedule: DecodeSchedule, levels: Levels, standing: string}} Slot an avatar on the device, and where it stands */
/** @typedef {{slot: Slot, clip: Clip, frame: number, following: number, place: number[], ground: number}} Posed what a picture shows of one */
/** @typedef {{compile: () => Promise<void>}} Compiled */
/** @typedef {{camera: import("./player.js").CameraState, stereo: boolean, show: import("./player.js").Show, level: import("./player.js").Level, budget: number | null}} Look */

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
    this.timing = new Timing(device);
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
    const kernels = Promise.all([this.decoding, compiled(kernelsFor(this.device, avatar))]);
    kernels.catch(() => {}); // where the device cannot hold it
    const slot = await this.upload(avatar);
    try {
      await kernels;
    } catch (error) {
      this.remove(slot);
      throw error;
    }
    if (areCompiled(this.device, SORTING)) await this.compile(); // for another player of the page
    return slot;
  }

  /** @returns {Promise<Slot>} */
  async upload(/** @type {Avatar} */ avatar) {
    const { gpu } = this.device;
    const memory = new Memory(this.device);
    gpu.pushErrorScope("out-of-memory");
    /** @type {Slot | null} */
    let slot = null;
    try {
      const frame = new AvatarFrame(new AvatarBuffers(memory, avatar));
      const overlays = new Overlays(memory, frame, { color: COLOR, depth: DEPTH });
      slot = { memory, frame, overlays, schedule: new DecodeSchedule(frame), levels: new Levels(avatar), standing: "" };
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
    old.memory.free();
  }

  remove(/** @type {Slot} */ slot) {
    this.rearrange(this.slots.filter((one) => one !== slot));
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

  /** Decode a part of what comes next, where the picture stays. */
  lookAhead(/** @type {Posed[]} */ posed) {
    this.compute((pass) => {
      for (const one of posed) {
        const { schedule, levels } = one.slot;
        if (schedule.shown && schedule.shown.frame === one.frame)
          schedule.record(pass, asked(one, levels.shown), windowOf(one));
      }
    });
  }

  /** Submit a pass of its own. */
  compute(/** @type {(pass: GPUComputePassEncoder) => void} */ record) {
    const encoder = this.device.gpu.createCommandEncoder();
    const pass = encoder.beginComputePass();
    record(pass);
    pass.end();
    this.send(encoder);
  }

  send(/** @type {GPUCommandEncoder} */ encoder) {
    this.device.uniforms.upload();
    this.device.gpu.queue.submit([encoder.finish()]);
  }

  /** Bring what is due to the pose in which it is shown, and decode a part of what comes next. @param {GPUComputePassEncoder} pass @param {Posed[]} posed @param {Look} look @param {import("./camera.js").Camera[]} cameras */
  pose(pass, posed, look, cameras) {
    const windows = posed.map(windowOf);
    const poses = posed.map((one, i) => windows[i]({ clip: one.clip.name, frame: one.frame })[0]);
    const standing = posed.map(({ slot, place }, i) => ({ levels: slot.levels, pose: poses[i], place }));
    const levels = look.show.geometry ? posed.map(() => 0) : levelsOf(standing, look, cameras);
    for (const [i, one] of posed.entries()) {
      const { schedule, frame, overlays, standing } = one.slot;
      const changed = schedule.record(pass, asked(one, levels[i]), windows[i]);
      one.slot.standing = [...one.place, one.ground].join();
      if (!changed && one.slot.standing === standing) continue;
      frame.repose(pass, poses[i], one.place);
      overlays.pose(one.ground + one.place[1]);
    }
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

function asked(/** @type {Posed} */ { clip, frame, following }, /** @type {number} */ level) {
  return { due: { clip: clip.name, frame }, following: { clip: clip.name, frame: following }, level };
}

/** The poses that end at a moment of what is shown. @returns {import("./schedule.js").Window} */
function windowOf(/** @type {Posed} */ { slot, clip }) {
  const { skeleton, encoding } = slot.frame.buffers.avatar;
  return ({ frame }) => window(skeleton, clip, frame, encoding);
}
