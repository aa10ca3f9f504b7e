// A player: what is looked at, the loop that draws its avatars, and what it does when the device is lost.

import { Avatars } from "./avatars.js";
import { camerasOf, FOV, framing } from "./camera.js";
import { nextFrame, windowOf } from "./display.js";
import { AvatarError, asAvatarError } from "./error.js";
import { described, handleOf } from "./handle.js";
import { load } from "./load.js";
import { fetchAnatomy, isThereFor } from "./overlays.js";
import { boxAround, gone, groundOf } from "./placement.js";
import { ProgressiveLoad } from "./progressive.js";
import { AWAY, Renderer } from "./renderer.js";
import { offersVR } from "./webxr.js";

/** @typedef {import("./avatars.js").Entry} Entry */
/** @typedef {import("./player.js").AvatarHandle} AvatarHandle */
/** @typedef {import("./player.js").PlayerOptions} PlayerOptions */
/** @typedef {import("./format/read.js").Avatar} Avatar */

const STUMBLE = 2000; // milliseconds; a device that is lost again so soon is given up
const DISPOSED = "The player was disposed of; create another one.";
const EMPTY = "There is no picture of 0 x 0 pixels; give the canvas a width and a height.";
const TWICE = "The graphics device was lost twice at once; reload the page to try again.";

/** Draws its avatars. */
export class Engine extends Avatars {
  /** @returns {Promise<Engine>} */
  static async create(/** @type {HTMLCanvasElement} */ canvas, /** @type {PlayerOptions} */ options) {
    const engine = new Engine(canvas, options);
    engine.renderer = await engine.opened();
    void engine.awaitHeadset().catch(() => {}); // entering says what is wrong
    return engine;
  }

  constructor(/** @type {HTMLCanvasElement} */ canvas, /** @type {PlayerOptions} */ options) {
    super();
    this.canvas = canvas;
    this.options = options;
    /** @type {Renderer | null} */
    this.renderer = null; // while a lost device is being replaced
    /** @type {WeakSet<Renderer>} */
    this.lost = new WeakSet(); // those whose device was lost before they drew
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
    /** @type {((error: AvatarError) => void) | null} */
    this.onerror = null;
    this.request = 0; // of the next picture; 0 where the loop stands
    this.window = windowOf(canvas); // whose frames are drawn
    this.drawn = ""; // what the canvas shows
    /** @type {Promise<void> | null} */
    this.early = null; // a picture that is being drawn while kernels are still being compiled, or what is fetched for it
    /** @type {import("./vr.js").VR | null} */
    this.room = null; // once a headset is asked for
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
    if (this.disposed) throw new AvatarError(DISPOSED);
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

  /** What draws its avatars. @throws {AvatarError} where there is nothing that does */
  get drawing() {
    if (!this.renderer) throw new AvatarError(this.disposed ? DISPOSED : AWAY);
    return this.renderer;
  }

  /** Show an avatar, in the place of a part of it where that is shown. @param {Avatar} avatar @param {Entry | null} part @param {boolean} whole @returns {Promise<Entry>} */
  async put(avatar, part, whole) {
    const renderer = this.drawing;
    const { slot, face } = await this.prepared(avatar, renderer);
    if (this.drawing !== renderer) throw new AvatarError(AWAY); // lost meanwhile
    const entry = part ?? this.entry(avatar, slot);
    if (!part) this.entries.push(entry);
    else if (this.entries.includes(part)) renderer.replace(part.slot, slot);
    else renderer.remove(slot); // its part was taken away meanwhile
    Object.assign(entry, { avatar, slot, grounds: new Map(), face: entry.face ?? face });
    Object.assign(entry.handle, described(avatar), { whole });
    if (entry.added.length) this.addClips(entry);
    if (!part && this.entries.length === 1) this.frameAll();
    this.drawn = "";
    return entry;
  }

  /** Upload an avatar, while what takes its names is fetched. @param {Avatar} avatar @param {Renderer} renderer */
  async prepared(avatar, renderer) {
    const naming = faceOf(avatar);
    naming.catch(() => {}); // where the device cannot hold the avatar
    const slot = await renderer.add(avatar);
    try {
      return { slot, face: await naming };
    } catch (error) {
      renderer.remove(slot);
      throw error;
    }
  }

  /** @returns {Entry} */
  entry(/** @type {Avatar} */ avatar, /** @type {import("./renderer.js").Slot} */ slot) {
    const posed = { pose: null, live: null, fresh: false, changes: 0, added: [], asked: 0 };
    const expressed = { face: null, weights: null, taken: null, since: -Infinity };
    return { avatar, slot, grounds: new Map(), handle: handleOf(avatar, this), ...posed, ...expressed };
  }

  /** Whether a picture shows exactly what is asked for, else the next frame is decoded ahead. */
  get exact() {
    return this.show.geometry || !(this.request || this.vr);
  }

  /** How far outside of training the pose is that is shown of an avatar, 0 to 1. */
  outside(/** @type {AvatarHandle} */ handle) {
    return this.entryOf(handle)?.slot.frame.outside ?? 0;
  }

  remove(/** @type {AvatarHandle} */ handle) {
    const entry = this.entryOf(handle);
    if (!entry) return;
    super.remove(handle);
    this.renderer?.remove(entry.slot);
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
    if (!isThereFor(this.show)) await this.fetchShown();
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

  /** Fetch what draws all that is shown; where it does not come, that is shown no more. */
  async fetchShown() {
    const missing = (/** @type {unknown} */ error) => {
      Object.assign(this.show, { geometry: false, skeleton: false });
      this.tell(asAvatarError(error, "Geometry and skeleton cannot be shown"));
    };
    this.early = fetchAnatomy()
      .catch(missing)
      .finally(() => (this.early = null));
    await this.early;
  }

  async screenshot() {
    if (!this.canvas.width || !this.canvas.height) throw new AvatarError(EMPTY);
    if (!isThereFor(this.show)) await this.fetchShown();
    await this.drawing.compile();
    this.takePoses(performance.now(), true);
    return this.drawing.picture(this.posed(), this.look);
  }

  start() {
    if (this.request || this.disposed) return;
    this.playback.begin(performance.now());
    this.drawn = "";
    this.await();
  }

  /** Ask for the next frame of the window that the canvas is in. */
  await() {
    this.window = windowOf(this.canvas);
    this.request = nextFrame(this.window, (now) => this.step(now));
  }

  stop() {
    this.window.cancelAnimationFrame(this.request);
    this.request = 0;
  }

  /** One turn of the loop, which draws where anything changed. */
  step(/** @type {number} */ now) {
    this.await();
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
    if (!isThereFor(this.show)) return void this.fetchShown();
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
    return Boolean(this.room?.headset);
  }

  /** Fetch what shows avatars in a headset where there is one: the browser may forget a click that waits for the network. */
  async awaitHeadset() {
    if (await offersVR()) await import("./vr.js");
  }

  async enterVR() {
    const { VR } = await import("./vr.js");
    this.room ??= new VR(this);
    await this.room.enter();
  }

  leaveVR() {
    this.room?.leave();
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

/** What takes weights of expressions by name; null where an avatar has none. */
async function faceOf(/** @type {Avatar} */ { expressions }) {
  if (!expressions.length) return null;
  const { Face } = await import("./names/face.js");
  return new Face(expressions);
}
