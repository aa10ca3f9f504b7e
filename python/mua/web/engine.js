// A player: its avatars and what is looked at, the loop that draws them, and what it does when the device is lost.

import { camerasOf, FOV, framing } from "./camera.js";
import { AvatarError } from "./error.js";
import { clipsOf, described, handleOf } from "./handle.js";
import { LivePose } from "./live.js";
import { load } from "./load.js";
import { boxAround, gone, groundOf } from "./placement.js";
import { Playback } from "./playback.js";
import { poseFrom, weighted, weightsFrom } from "./pose.js";
import { ProgressiveLoad } from "./progressive.js";
import { Renderer } from "./renderer.js";
import { VR } from "./vr.js";

/** @typedef {import("./player.js").AvatarHandle} AvatarHandle */
/** @typedef {import("./player.js").PlayerOptions} PlayerOptions */
/** @typedef {import("./format/read.js").Avatar} Avatar */
/** @typedef {import("./clip.js").Clip} Clip */
/**
 * @typedef {object} Entry
 * @property {Avatar} avatar
 * @property {AvatarHandle} handle
 * @property {import("./renderer.js").Slot} slot
 * @property {Map<string, number>} grounds by what it plays
 * @property {import("./skeleton.js").Pose | null} pose that the page has set
 * @property {LivePose | null} live and what is decoded of it
 * @property {boolean} fresh whether it has set something since
 * @property {Float32Array | null} weights of expressions that the page has set
 * @property {Float32Array | null} taken those of them that pictures show
 * @property {number} since when, milliseconds
 * @property {number} changes of these and of clips, which tell decodes apart
 * @property {Clip[]} added by the page
 * @property {number} asked clips so far
 */

const STUMBLE = 2000; // milliseconds; a device that is lost again so soon is given up
const TWICE = "The graphics device was lost twice at once; reload the page to try again.";
const AWAY = "The graphics device is away; try again in a moment.";

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
    /** @type {WeakSet<Renderer>} */
    this.lost = new WeakSet(); // those whose device was lost before they drew
    /** @type {Entry[]} */
    this.entries = [];
    /** @type {import("./player.js").CameraState} */
    this.camera = { azimuth: 0, elevation: 0, distance: 3.5, target: [0, 1, 0], fov: FOV };
    /** @type {import("./player.js").Show} */
    this.show = { splats: true, geometry: false, template: false, skeleton: false, shadow: true };
    /** @type {import("./player.js").Level} */
    this.level = "auto";
    /** @type {number | null} */
    this.budget = null;
    /** @type {number | null} */
    this.frameBudget = null;
    this.follow = false;
    this.stereo = false;
    this.playback = new Playback(
      () => this.clips,
      (type) => this.entries.length && this.onplayback?.({ type, clip: this.clip, time: this.time }),
    );
    /** @type {((event: import("./player.js").PlaybackEvent) => void) | null} */
    this.onplayback = null;
    /** @type {(() => void) | null} */
    this.onchange = null;
    /** @type {((error: AvatarError) => void) | null} */
    this.onerror = null;
    this.request = 0; // of the next picture; 0 where the loop stands
    this.drawn = ""; // what the canvas shows
    /** @type {Promise<void> | null} */
    this.early = null; // a picture that is being drawn while kernels are still being compiled
    this.room = new VR(this);
    /** @type {((vr: boolean) => void) | null} */
    this.onvr = null;
    this.disposed = false;
  }

  /** A renderer whose device, where it is lost, is replaced. */
  async opened() {
    const renderer = await Renderer.open(this.canvas, this.options);
    const {
      device,
      closed: { signal },
    } = renderer;
    const lost = (/** @type {string} */ reason) => {
      if (reason === "destroyed") return;
      if (this.renderer === renderer) this.recover(performance.now() - device.since);
      else this.lost.add(renderer); // recovering with it finds that out
    };
    device.whenLost(lost, signal);
    const refused = (/** @type {GPUUncapturedErrorEvent} */ { error }) =>
      this.tell(new AvatarError(`The graphics device refused: ${error.message}`));
    device.gpu.addEventListener("uncapturederror", refused, { signal });
    return renderer;
  }

  /** Open another device and upload all avatars again. */
  async recover(/** @type {number} */ lasted) {
    this.leaveVR(); // it draws on the lost device
    this.renderer = null;
    this.drawn = "";
    /** @type {Renderer | null} */
    let renderer = null;
    try {
      if (lasted < STUMBLE) throw new AvatarError(TWICE);
      renderer = await this.opened();
      const added = [];
      for (const entry of this.entries) added.push({ entry, slot: await renderer.add(entry.avatar) });
      await renderer.compile();
      if (this.disposed) return renderer.destroy();
      if (this.lost.has(renderer)) throw new AvatarError(TWICE);
      for (const { entry, slot } of added) {
        if (this.entries.includes(entry)) entry.slot = slot;
        else renderer.remove(slot); // its avatar was taken away meanwhile
      }
      this.renderer = renderer;
      this.drawNow();
    } catch (error) {
      if (this.renderer !== renderer) renderer?.destroy();
      this.stop();
      this.tell(asAvatarError(error, "The graphics device was lost and did not come back"));
    }
  }

  tell(/** @type {AvatarError} */ error) {
    if (this.disposed) return;
    if (this.onerror) this.onerror(error);
    else console.error(error);
  }

  /** @returns {Promise<AvatarHandle>} */
  async load(
    /** @type {string | ArrayBuffer | File} */ source,
    /** @type {import("./player.js").LoadOptions} */ { onProgress = () => {}, onPart = () => {}, signal } = {},
  ) {
    const progressive = new ProgressiveLoad(this, onPart);
    try {
      const avatar = await load(source, onProgress, (part) => progressive.show(part), signal);
      onProgress(0.9, "Preparing the graphics device");
      const handle = await progressive.complete(avatar);
      onProgress(1, "Ready");
      return handle;
    } catch (error) {
      await progressive.fail();
      throw error;
    }
  }

  /** Show an avatar, in the place of a part of it where that is shown. @param {Avatar} avatar @param {Entry | null} part @param {boolean} whole @returns {Promise<Entry>} */
  async put(avatar, part, whole) {
    const { renderer } = this;
    if (!renderer) throw new AvatarError(AWAY);
    const slot = await renderer.add(avatar);
    if (this.renderer !== renderer) throw new AvatarError(AWAY); // lost meanwhile
    const entry = part ?? this.entry(avatar, slot);
    if (!part) this.entries.push(entry);
    else if (this.entries.includes(part)) renderer.replace(part.slot, slot);
    else renderer.remove(slot); // its part was taken away meanwhile
    Object.assign(entry, { avatar, slot, grounds: new Map() });
    Object.assign(entry.handle, described(avatar), { whole });
    if (entry.added.length) this.addClips(entry);
    if (!part && this.entries.length === 1) this.frameAll();
    this.drawn = "";
    return entry;
  }

  /** @returns {Entry} */
  entry(/** @type {Avatar} */ avatar, /** @type {import("./renderer.js").Slot} */ slot) {
    const posed = { pose: null, live: null, fresh: false, changes: 0, added: [], asked: 0 };
    const expressed = { weights: null, taken: null, since: -Infinity };
    return { avatar, slot, grounds: new Map(), handle: handleOf(avatar, this), ...posed, ...expressed };
  }

  /** @type {import("./handle.js").Asks["setPose"]} */
  setPose(handle, given) {
    const entry = this.entryOf(handle);
    if (!entry) return;
    entry.pose = given && poseFrom(entry.avatar, given);
    if (!given) entry.live = null;
    entry.fresh = true;
    this.onchange?.();
  }

  /** @type {import("./handle.js").Asks["setExpressions"]} */
  setExpressions(handle, given) {
    const entry = this.entryOf(handle);
    if (!entry) return;
    const weights = given && weightsFrom(entry.avatar.expressions, entry.weights, given);
    if (String(weights) === String(entry.weights)) return;
    entry.weights = weights;
    entry.fresh = true;
    this.onchange?.();
  }

  /** @type {import("./handle.js").Asks["playClip"]} */
  async playClip(handle, source, options) {
    const { playClip } = await import("./retarget/play.js");
    return playClip(this, handle, source, options);
  }

  /** Let an avatar have the clips that a page has loaded, in place of its own of their names. */
  addClips(/** @type {Entry} */ { avatar, handle, added, grounds }) {
    const others = avatar.clips.filter((clip) => !added.some(({ name }) => name === clip.name));
    avatar.clips = [...others, ...added];
    handle.clips = clipsOf(avatar);
    grounds.clear();
  }

  /** @type {import("./handle.js").Asks["retarget"]} */
  async retarget(handle, rig, options) {
    const { follow } = await import("./retarget/rig.js");
    return follow(this.entryOf(handle)?.avatar, rig, options);
  }

  /** Take the poses and weights that pages have set, as of a time of the display or the headset, milliseconds. */
  takePoses(now = performance.now(), exact = this.exact) {
    for (const entry of this.entries) {
      this.takeWeights(entry, now, exact);
      entry.fresh = false;
      if (!entry.pose) continue;
      const pose = weighted(entry.pose, entry.weights);
      if (entry.live) entry.live.sample(pose, now / 1000);
      else entry.live = new LivePose(entry.avatar.encoding, pose, now / 1000);
    }
  }

  /** Take the weights of an avatar: each change is a decode, so that one after the other comes at most once in its frames. */
  takeWeights(/** @type {Entry} */ entry, /** @type {number} */ now, /** @type {boolean} */ exact) {
    const early = !exact && Math.abs(now - entry.since) * entry.avatar.encoding.rate < 1000;
    if (entry.weights === entry.taken || early) return;
    entry.taken = entry.weights;
    entry.since = now;
    entry.changes += 1;
  }

  /** Whether pictures change by themselves. */
  get moving() {
    return this.playing || this.entries.some((entry) => entry.weights !== entry.taken || posing(entry));
  }

  /** Whether a picture shows exactly what is asked for, else the next frame is decoded ahead. */
  get exact() {
    return this.show.geometry || !(this.request || this.vr);
  }

  /** @param {AvatarHandle} handle @returns {Entry | undefined} */
  entryOf(handle) {
    return this.entries.find((one) => one.handle === handle);
  }

  /** How far outside of training the pose is that is shown of an avatar, 0 to 1. */
  outside(/** @type {AvatarHandle} */ handle) {
    return this.entryOf(handle)?.slot.frame.outside ?? 0;
  }

  remove(/** @type {AvatarHandle} */ handle) {
    const entry = this.entryOf(handle);
    if (!entry) return;
    this.entries = this.entries.filter((one) => one !== entry);
    this.renderer?.remove(entry.slot);
  }

  get avatars() {
    return this.entries.map((entry) => entry.handle);
  }

  /** Those of the first avatar, and what pages have added to others. */
  get clips() {
    const [first, ...others] = this.entries;
    const found = [...(first?.handle.clips ?? [])];
    for (const { handle, added } of others)
      for (const clip of handle.clips)
        if (added.some(({ name }) => name === clip.name) && !found.some(({ name }) => name === clip.name))
          found.push(clip);
    return found;
  }

  get clip() {
    return this.playback.clip;
  }

  set clip(name) {
    this.playback.clip = name;
  }

  get time() {
    return this.playback.time;
  }

  set time(seconds) {
    this.playback.time = seconds;
  }

  get playing() {
    return this.playback.playing;
  }

  set playing(playing) {
    this.playback.playing = playing;
  }

  get speed() {
    return this.playback.speed;
  }

  set speed(speed) {
    this.playback.speed = speed;
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
    const box = boxAround(shown, this.playback);
    Object.assign(this.camera, framing(box, this.camera, camerasOf(this.camera, this.stereo, this.screen)[0].screen));
    const followed = this.followed();
    this.camera.target = /** @type {[number, number, number]} */ (this.camera.target.map((at, i) => at - followed[i]));
  }

  /** How far the camera has gone with the first avatar since its clip began, metres; along the ground. */
  followed() {
    const [first] = this.entries;
    return this.follow && first ? gone(first, this.playback) : [0, 0, 0];
  }

  /** @returns {import("./renderer.js").Look} */
  get look() {
    const followed = this.followed();
    const target = /** @type {[number, number, number]} */ (this.camera.target.map((at, i) => at + followed[i]));
    const { show, level, budget, frameBudget, stereo } = this;
    return { camera: { ...this.camera, target }, stereo, show, level, budget, frameBudget };
  }

  /** @returns {[number, number]} */
  get screen() {
    return [Math.max(this.canvas.width, 1), Math.max(this.canvas.height, 1)];
  }

  /** What a picture shows now. @returns {import("./renderer.js").Posed[]} */
  posed() {
    const { playback, exact } = this;
    return this.entries.map((entry) => {
      const { avatar, slot, handle, live, taken: weights } = entry;
      const frame = live?.due ?? playback.frameOf(avatar);
      const following = live || exact ? frame : playback.followingOf(avatar);
      const ground = this.show.shadow ? groundOf(entry, playback) : 0;
      const spread = !exact && (live ? !live.settled : playback.playing);
      const shown = { live, weights, stamp: entry.changes ? `\0${entry.changes}` : "", mayLag: live?.mayLag ?? false };
      return {
        slot,
        clip: playback.clipOf(avatar),
        frame,
        following,
        spread,
        place: [...handle.place],
        ground,
        ...shown,
      };
    });
  }

  async draw() {
    while (this.early) await this.early;
    this.takePoses();
    if (this.renderer?.ready) this.drawNow();
    else await this.drawEarly();
    await this.renderer?.device.gpu.queue.onSubmittedWorkDone();
  }

  drawNow() {
    if (this.vr) return; // it draws the next picture
    if (this.renderer && this.canvas.width && this.canvas.height) this.renderer.draw(this.posed(), this.look);
  }

  /** A picture that takes its time, while kernels are still being compiled; one after the other. */
  async drawEarly() {
    const { renderer, canvas } = this;
    if (this.vr || !renderer || !canvas.width || !canvas.height) return;
    this.early = renderer.drawEarly(this.posed(), this.look).finally(() => (this.early = null));
    await this.early;
  }

  async screenshot() {
    await this.renderer?.compile();
    if (!this.renderer) throw new AvatarError(AWAY);
    this.takePoses(performance.now(), true);
    return this.renderer.picture(this.posed(), this.look);
  }

  start() {
    if (this.request || this.disposed) return;
    this.playback.begin(performance.now());
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
    this.playback.advance(now);
    this.takePoses(now);
    this.renderer?.displays(now);
    const frames = this.entries.map(({ avatar, handle, live, changes }) => {
      const [clip, frame] = [this.playback.clipOf(avatar).name, this.playback.frameOf(avatar)];
      return [handle.name, ...(live ? [live.due, live.version] : [clip, frame]), changes, handle.place];
    });
    const wanted = JSON.stringify([this.look, this.screen, frames]);
    if (!this.renderer || this.early) return;
    try {
      if (wanted !== this.drawn && this.renderer.ready) this.drawNow();
      else if (wanted !== this.drawn) this.drawEarly().catch((error) => this.fail(error));
      else if (this.moving) this.renderer.lookAhead(this.posed());
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
    this.entries = [];
    this.renderer?.destroy();
    this.renderer = null;
  }
}

/** Whether the window of poses that a page sets still changes. */
function posing(/** @type {Entry} */ { pose, live, fresh }) {
  return pose !== null && (fresh || !live?.settled);
}

function asAvatarError(/** @type {unknown} */ error, /** @type {string} */ what) {
  return error instanceof AvatarError
    ? error
    : new AvatarError(`${what}: ${error instanceof Error ? error.message : error}`);
}
