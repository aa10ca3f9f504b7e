// State of a player, the loop that draws it, and what it does when the device is lost.

import { Arrival } from "./arrival.js";
import { camerasOf, framing, FOV } from "./camera.js";
import { framesAt, sample } from "./clip.js";
import { AvatarError } from "./error.js";
import { sizesOf } from "./levels.js";
import { load } from "./load.js";
import { groundHeight } from "./overlays.js";
import { Renderer } from "./renderer.js";
import { world } from "./skeleton.js";
import { VR } from "./vr.js";

/** @typedef {import("./player.js").AvatarHandle} AvatarHandle */
/** @typedef {import("./player.js").ClipInfo} ClipInfo */
/** @typedef {import("./player.js").PlayerOptions} PlayerOptions */
/** @typedef {import("./format/read.js").Avatar} Avatar */
/** @typedef {import("./format/read.js").Clip} Clip */
/** @typedef {{avatar: Avatar, handle: AvatarHandle, slot: import("./renderer.js").Slot, grounds: Map<string, number>}} Entry */

const STUMBLE = 2000; // milliseconds; a device that is lost again so soon is given up
const AWAY = "The graphics device is away; try again in a moment.";
const LONGEST_STEP = 0.25; // seconds by which one picture may move the time: a hidden tab does not catch up

export class Engine {
  /** @returns {Promise<Engine>} */
  static async create(/** @type {HTMLCanvasElement} */ canvas, /** @type {PlayerOptions} */ options) {
    const engine = new Engine(canvas, options);
    engine.renderer = await engine.opened();
    return engine;
  }

  constructor(/** @type {HTMLCanvasElement} */ canvas, /** @type {PlayerOptions} */ options) {
    this.canvas = canvas;
    this.options = options;
    /** @type {Renderer | null} */
    this.renderer = null; // while a lost device is being replaced
    /** @type {Entry[]} */
    this.entries = [];
    /** @type {import("./player.js").CameraState} */
    this.camera = { azimuth: 0, elevation: 0, distance: 3.5, target: [0, 1, 0], fov: FOV };
    /** @type {import("./player.js").Show} */
    this.show = { splats: true, geometry: false, mesh: false, skeleton: false, shadow: true };
    /** @type {import("./player.js").Level} */
    this.level = "auto";
    /** @type {number | null} */
    this.budget = null;
    this.follow = false;
    this.stereo = false;
    this.playing = true;
    this.speed = 1;
    this.frameStep = 0; // seconds of the clip from one picture to the next, as it plays
    /** @type {((error: AvatarError) => void) | null} */
    this.onerror = null;
    /** @type {string | null} */
    this.chosen = null;
    this.seconds = 0;
    this.request = 0; // of the next picture; 0 where the loop stands
    this.before = 0; // time of the last step, milliseconds
    this.drawn = ""; // what the canvas shows
    this.room = new VR(this);
    /** @type {((vr: boolean) => void) | null} */
    this.onvr = null;
    this.disposed = false;
  }

  /** A renderer whose device, where it is lost, is replaced. */
  async opened() {
    const renderer = await Renderer.open(this.canvas, this.options);
    const since = performance.now();
    renderer.device.gpu.lost.then(({ reason }) => {
      if (reason !== "destroyed" && !this.disposed && this.renderer === renderer)
        this.recover(performance.now() - since);
    });
    renderer.device.gpu.onuncapturederror = ({ error }) =>
      this.tell(new AvatarError(`The graphics device refused: ${error.message}`));
    return renderer;
  }

  /** Open another device and upload all avatars again. */
  async recover(/** @type {number} */ lasted) {
    this.leaveVR(); // it draws on the lost device
    this.renderer = null;
    this.drawn = "";
    try {
      if (lasted < STUMBLE)
        throw new AvatarError("The graphics device was lost twice at once; reload the page to try again.");
      const renderer = await this.opened();
      for (const entry of this.entries) entry.slot = await renderer.add(entry.avatar);
      this.renderer = renderer;
      this.drawNow();
    } catch (error) {
      this.stop();
      this.tell(asAvatarError(error, "The graphics device was lost and did not come back"));
    }
  }

  tell(/** @type {AvatarError} */ error) {
    if (this.onerror) this.onerror(error);
    else console.error(error);
  }

  /** @returns {Promise<AvatarHandle>} */
  async load(
    /** @type {string | ArrayBuffer | File} */ source,
    /** @type {import("./player.js").LoadOptions} */ { onProgress = () => {}, onPart = () => {} } = {},
  ) {
    const arrival = new Arrival(this, onPart);
    try {
      const avatar = await load(source, onProgress, (part) => arrival.show(part));
      onProgress(0.9, "Preparing the graphics device");
      const handle = await arrival.complete(avatar);
      onProgress(1, "Ready");
      return handle;
    } catch (error) {
      await arrival.fail();
      throw error;
    }
  }

  /** Show an avatar, in the place of a part of it where that is shown. @param {Avatar} avatar @param {Entry | null} part @param {boolean} whole @returns {Promise<Entry>} */
  async put(avatar, part, whole) {
    const { renderer } = this;
    if (!renderer) throw new AvatarError(AWAY);
    const slot = await renderer.add(avatar);
    if (this.renderer !== renderer) throw new AvatarError(AWAY); // lost meanwhile
    const entry = part ?? { avatar, slot, grounds: new Map(), handle: this.handleOf(avatar) };
    if (!part) this.entries.push(entry);
    else if (this.entries.includes(part)) renderer.replace(part.slot, slot);
    else renderer.remove(slot); // its part was taken away meanwhile
    Object.assign(entry, { avatar, slot, grounds: new Map() });
    Object.assign(entry.handle, described(avatar), { whole });
    if (!part && this.entries.length === 1) this.frameAll();
    this.drawn = "";
    return entry;
  }

  /** @returns {AvatarHandle} */
  handleOf(/** @type {Avatar} */ avatar) {
    /** @type {AvatarHandle} */
    const handle = {
      ...described(avatar),
      whole: false,
      place: [0, 0, 0],
      remove: () => this.remove(handle),
    };
    return handle;
  }

  remove(/** @type {AvatarHandle} */ handle) {
    const entry = this.entries.find((one) => one.handle === handle);
    if (!entry) return;
    this.entries = this.entries.filter((one) => one !== entry);
    this.renderer?.remove(entry.slot);
  }

  get avatars() {
    return this.entries.map((entry) => entry.handle);
  }

  get clips() {
    return this.entries[0]?.handle.clips ?? [];
  }

  get clip() {
    return this.clips.find(({ name }) => name === this.chosen)?.name ?? this.clips[0]?.name ?? null;
  }

  set clip(name) {
    if (name !== this.clip) this.seconds = 0;
    this.chosen = name;
  }

  get time() {
    return this.seconds;
  }

  set time(seconds) {
    const { seconds: length } = this.clips.find(({ name }) => name === this.clip) ?? { seconds: 0 };
    this.seconds = length > 0 && Number.isFinite(seconds) ? ((seconds % length) + length) % length : 0;
  }

  get milliseconds() {
    return this.renderer?.timing.milliseconds ?? {};
  }

  get adapter() {
    return this.renderer?.device.name ?? "";
  }

  get bytes() {
    return this.renderer?.bytes ?? 0;
  }

  frameAll(/** @type {readonly AvatarHandle[] | undefined} */ chosen = undefined) {
    const shown = this.entries.filter(({ handle }) => chosen?.includes(handle) ?? true);
    if (!shown.length) return;
    const box = this.box(shown);
    Object.assign(this.camera, framing(box, this.camera, camerasOf(this.camera, this.stereo, this.screen)[0].screen));
    const followed = this.followed();
    this.camera.target = /** @type {[number, number, number]} */ (this.camera.target.map((at, i) => at - followed[i]));
  }

  /** How far the camera has gone with the first avatar since its clip began, metres; along the ground. */
  followed() {
    const [first] = this.entries;
    const clip = first && this.clipOf(first.avatar);
    if (!this.follow || !clip) return [0, 0, 0];
    const { skeleton, encoding } = first.avatar;
    const [now, start] = [this.frameOf(first.avatar, clip), 0].map((frame) =>
      world(skeleton, sample(skeleton, clip, frame, encoding.rate)).places.subarray(3 * skeleton.root),
    );
    return [now[0] - start[0], 0, now[2] - start[2]];
  }

  /** @returns {import("./renderer.js").Look} */
  get look() {
    const followed = this.followed();
    const target = /** @type {[number, number, number]} */ (this.camera.target.map((at, i) => at + followed[i]));
    const { show, level, budget, stereo } = this;
    return { camera: { ...this.camera, target }, stereo, show, level, budget };
  }

  /** @returns {[number, number]} */
  get screen() {
    return [Math.max(this.canvas.width, 1), Math.max(this.canvas.height, 1)];
  }

  /** World box of avatars in the present frame: lowest then highest corner, metres. */
  box(entries = this.entries) {
    const boxes = entries.map((entry) => this.boxOf(entry));
    return [0, 1, 2, 3, 4, 5].map((i) => (i < 3 ? Math.min : Math.max)(...boxes.map((one) => one[i])));
  }

  /** World box of an avatar in the present frame. */
  boxOf(/** @type {Entry} */ { avatar, handle }) {
    const { skeleton, encoding } = avatar;
    const clip = this.clipOf(avatar);
    const pose = clip
      ? sample(skeleton, clip, this.frameOf(avatar, clip), encoding.rate)
      : { rotations: skeleton.bindRotations, translations: skeleton.bindTranslations };
    const { places } = world(skeleton, pose);
    const root = 3 * skeleton.root;
    return Array.from(avatar.bounds, (value, i) => value + places[root + (i % 3)] + handle.place[i % 3]);
  }

  /** What an avatar plays: the clip that was chosen, its first one where it has none of that name. */
  clipOf(/** @type {Avatar} */ avatar) {
    return avatar.clips.find(({ name }) => name === this.clip) ?? avatar.clips[0];
  }

  frameOf(/** @type {Avatar} */ { encoding }, /** @type {Clip} */ clip) {
    return Math.floor(this.seconds * encoding.rate + 1e-6) % framesAt(clip, encoding.rate);
  }

  /** What a picture shows now; an avatar without clips stands in its bind pose. @returns {import("./renderer.js").Posed[]} */
  posed() {
    return this.entries.map((entry) => {
      const { avatar, slot, handle } = entry;
      const clip = this.clipOf(avatar) ?? stillClip(avatar);
      const ground = this.show.shadow ? this.groundOf(entry) : 0;
      const frame = this.frameOf(avatar, clip);
      return { slot, clip, frame, following: this.followingOf(avatar, clip, frame), place: [...handle.place], ground };
    });
  }

  /** Height on which an avatar stands in what it plays, metres. */
  groundOf(/** @type {Entry} */ { avatar, grounds }) {
    const clip = this.clipOf(avatar) ?? stillClip(avatar);
    const ground = grounds.get(clip.name) ?? groundHeight(avatar, clip);
    grounds.set(clip.name, ground);
    return ground;
  }

  /** The frame to decode ahead; this one where the clip rests or skips frames, or what is shown must be exact. */
  followingOf(/** @type {Avatar} */ { encoding }, /** @type {Clip} */ clip, /** @type {number} */ frame) {
    const step = this.frameStep * encoding.rate;
    const ahead = (this.request || this.vr) && this.playing && !this.show.geometry && step > 0 && step < 1;
    return ahead ? (frame + 1) % framesAt(clip, encoding.rate) : frame;
  }

  async draw() {
    this.drawNow();
    await this.renderer?.device.gpu.queue.onSubmittedWorkDone();
  }

  drawNow() {
    if (this.vr) return; // it draws the next picture
    if (this.renderer && this.canvas.width && this.canvas.height) this.renderer.draw(this.posed(), this.look);
  }

  async screenshot() {
    if (!this.renderer) throw new AvatarError(AWAY);
    return this.renderer.picture(this.posed(), this.look);
  }

  start() {
    if (this.request || this.disposed) return;
    this.before = performance.now();
    this.drawn = "";
    this.request = requestAnimationFrame((now) => this.step(now));
  }

  stop() {
    cancelAnimationFrame(this.request);
    this.request = 0;
  }

  /** One turn of the loop, which draws where anything changed. */
  step(/** @type {number} */ now) {
    this.request = requestAnimationFrame((next) => this.step(next));
    if (this.vr) return;
    this.advance(now);
    const frames = this.entries.map(({ avatar, handle }) => {
      const clip = this.clipOf(avatar);
      return [handle.name, clip?.name, clip && this.frameOf(avatar, clip), handle.place];
    });
    const wanted = JSON.stringify([this.look, this.screen, frames]);
    if (!this.renderer) return;
    try {
      if (wanted !== this.drawn) this.drawNow();
      else if (this.playing) this.renderer.lookAhead(this.posed());
      this.drawn = wanted;
    } catch (error) {
      this.fail(error);
    }
  }

  /** Stop where a picture cannot be drawn, and say why. */
  fail(/** @type {unknown} */ error) {
    this.stop();
    this.tell(asAvatarError(error, "The avatar cannot be drawn"));
  }

  /** Play on until a time of the display or the headset, milliseconds. */
  advance(/** @type {number} */ now) {
    const passed = Math.min(Math.max(now - this.before, 0) / 1000, LONGEST_STEP);
    this.before = now;
    this.frameStep = passed * this.speed;
    if (this.playing) this.time += this.frameStep;
  }

  get vr() {
    return this.room.headset !== null;
  }

  async enterVR() {
    await this.room.enter();
  }

  leaveVR() {
    this.room.leave();
  }

  dispose() {
    if (this.disposed) return;
    this.stop();
    this.leaveVR();
    this.disposed = true;
    for (const { slot } of this.entries.splice(0)) slot.memory.free();
    this.renderer?.destroy();
    this.renderer = null;
  }
}

/** What a handle says of an avatar. */
function described(/** @type {Avatar} */ avatar) {
  const [low, high] = [avatar.bounds.slice(0, 3), avatar.bounds.slice(3)].map((corner) => Array.from(corner));
  const bounds = /** @type {import("./player.js").Box} */ ([low, high]);
  const { name, notes, texels } = avatar;
  return { name, notes, clips: clipsOf(avatar), bounds, splats: texels.texels.length, levels: sizesOf(avatar) };
}

/** @returns {ClipInfo[]} */
function clipsOf(/** @type {Avatar} */ { clips, encoding }) {
  return clips.map((clip) => {
    const frames = framesAt(clip, encoding.rate);
    return { name: clip.name, frames, seconds: frames / encoding.rate };
  });
}

/** One frame of the bind pose. @returns {Clip} */
function stillClip(/** @type {Avatar} */ { skeleton, encoding }) {
  const at = (/** @type {number} */ joint) => skeleton.bindTranslations.subarray(3 * joint, 3 * joint + 3);
  return {
    name: "",
    rate: encoding.rate,
    frames: 1,
    rotations: Float32Array.from(skeleton.bindRotations),
    translation: Float32Array.from(at(skeleton.root)),
    translations: Float32Array.from(Array.from(skeleton.translated).flatMap((joint) => [...at(joint)])),
  };
}

function asAvatarError(/** @type {unknown} */ error, /** @type {string} */ what) {
  return error instanceof AvatarError
    ? error
    : new AvatarError(`${what}: ${error instanceof Error ? error.message : error}`);
}
