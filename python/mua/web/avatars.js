// A player's avatars: what they play, and what a page sets of them.

import { AvatarError, unfetched } from "./error.js";
import { clipsOf } from "./handle.js";
import { LivePose } from "./live.js";
import { Playback } from "./playback.js";
import { poseFrom, weighted } from "./pose.js";

/** @typedef {import("./player.js").AvatarHandle} AvatarHandle */
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
 * @property {import("./names/face.js").Face | null} face takes what the page sets of expressions; null where there are none
 * @property {Float32Array | null} weights of expressions that the page has set
 * @property {Float32Array | null} taken those of them that pictures show
 * @property {number} since when, milliseconds
 * @property {number} changes of these and of clips, which tell decodes apart
 * @property {Clip[]} added by the page
 * @property {number} asked clips so far
 */

const UNNAMED = "setExpressions: expected weights by name";
const FACELESS = "setExpressions: the avatar has no expressions.";

/** What a player does with its avatars before it draws them. */
export class Avatars {
  constructor() {
    /** @type {Entry[]} */
    this.entries = [];
    this.playback = new Playback(
      () => this.clips,
      (type) => this.entries.length && this.onplayback?.({ type, clip: this.clip, time: this.time }),
    );
    /** @type {((event: import("./player.js").PlaybackEvent) => void) | null} */
    this.onplayback = null;
    /** @type {(() => void) | null} */
    this.onchange = null;
  }

  /** @param {AvatarHandle} handle @returns {Entry | undefined} */
  entryOf(handle) {
    return this.entries.find((one) => one.handle === handle);
  }

  remove(/** @type {AvatarHandle} */ handle) {
    this.entries = this.entries.filter((one) => one.handle !== handle);
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
    if (given && typeof given !== "object") throw new AvatarError(`${UNNAMED}, found ${given}.`);
    if (!entry.face && Object.keys(given ?? {}).length) throw new AvatarError(FACELESS);
    const weights = entry.face?.set(given) ?? null;
    if (String(weights) === String(entry.weights)) return;
    entry.weights = weights;
    entry.fresh = true;
    this.onchange?.();
  }

  /** @type {import("./handle.js").Asks["playClip"]} */
  async playClip(handle, source, options) {
    const { playClip } = await import("./retarget/play.js").catch(unfetched("playClip"));
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
    const { follow } = await import("./retarget/rig.js").catch(unfetched("retarget"));
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

  /** Whether a picture shows exactly what is asked for; else changes may wait for the avatar's next frame. */
  get exact() {
    return true;
  }

  /** Whether pictures change by themselves. */
  get moving() {
    return this.playing || this.entries.some((entry) => entry.weights !== entry.taken || posing(entry));
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
}

/** Whether the window of poses that a page sets still changes. */
function posing(/** @type {Entry} */ { pose, live, fresh }) {
  return pose !== null && (fresh || !live?.settled);
}
