// What avatars play and how far they are in it: one clip by name and one time for all of them.

import { framesAt } from "./clip.js";

/** @typedef {import("./player.js").PlaybackEvent["type"]} Happened */
/** @typedef {import("./player.js").ClipInfo} ClipInfo */
/** @typedef {import("./format/read.js").Avatar} Avatar */
/** @typedef {import("./clip.js").Clip} Clip */

const LONGEST_STEP = 0.25; // seconds by which one picture may move the time: a hidden tab does not catch up
const SLACK = 1e-6; // frames by which rounding may place a time before its frame

export class Playback {
  speed = 1;
  /** Seconds of the clip from one picture to the next, as it plays. */
  step = 0;
  /** @type {string | null} */
  #chosen = null;
  #seconds = 0;
  #before = 0; // when time last went on, milliseconds
  #playing = true;
  #ended = false; // and was not moved since
  #clips;
  #told;

  /** @param {() => readonly ClipInfo[]} clips those that may be chosen @param {(what: Happened) => void} [told] hears when playing begins or ends and when a clip starts over */
  constructor(clips, told = () => {}) {
    this.#clips = clips;
    this.#told = told;
  }

  get playing() {
    return this.#playing;
  }

  set playing(playing) {
    if (playing === this.#playing) return;
    if (playing && this.#ended) this.time = this.speed < 0 ? this.#last : 0;
    this.#playing = playing;
    this.#told(playing ? "play" : "pause");
  }

  get clips() {
    return this.#clips();
  }

  /** What was chosen; the first clip where there is none of that name. */
  get clip() {
    return this.clips.find(({ name }) => name === this.#chosen)?.name ?? this.clips[0]?.name ?? null;
  }

  set clip(name) {
    if (name !== this.clip) this.time = 0;
    this.#chosen = name;
  }

  get time() {
    return this.#seconds;
  }

  set time(seconds) {
    const length = this.#info?.seconds ?? 0;
    this.#seconds = length > 0 && Number.isFinite(seconds) ? ((seconds % length) + length) % length : 0;
    this.#ended = false;
  }

  get #info() {
    return this.clips.find(({ name }) => name === this.clip);
  }

  /** When the last frame begins, seconds. */
  get #last() {
    const { seconds, frames } = this.#info ?? { seconds: 0, frames: 1 };
    return seconds - seconds / frames;
  }

  /** Go on from a time of the display or the headset, milliseconds. */
  begin(/** @type {number} */ now) {
    this.#before = now;
  }

  /** Play on until a time of the display or the headset, milliseconds. */
  advance(/** @type {number} */ now) {
    const passed = Math.min(Math.max(now - this.#before, 0) / 1000, LONGEST_STEP);
    this.#before = now;
    this.step = passed * this.speed;
    if (this.playing) this.#go(this.#seconds + this.step);
  }

  #go(/** @type {number} */ to) {
    const { seconds, frames, loop = true } = this.#info ?? { seconds: 0, frames: 1 };
    const beyond = frames > 1 && (to < 0 || to >= seconds);
    this.time = to;
    if (beyond && loop) this.#told("loop");
    if (!beyond || loop) return;
    this.time = to < 0 ? 0 : this.#last;
    this.#playing = false;
    this.#ended = true;
    this.#told("end");
  }

  /** What an avatar plays: the clip that was chosen, else its first one; without clips it stands in its bind pose. */
  clipOf(/** @type {Avatar} */ avatar) {
    return avatar.clips.find(({ name }) => name === this.clip) ?? avatar.clips[0] ?? stillClip(avatar);
  }

  frameOf(/** @type {Avatar} */ avatar) {
    const { rate } = avatar.encoding;
    return Math.floor(this.#seconds * rate + SLACK) % framesAt(this.clipOf(avatar), rate);
  }

  /** The frame that plays next; the present one where the clip rests or skips frames. */
  followingOf(/** @type {Avatar} */ avatar) {
    const { rate } = avatar.encoding;
    const [frame, step] = [this.frameOf(avatar), this.step * rate];
    return this.playing && step > 0 && step < 1 ? (frame + 1) % framesAt(this.clipOf(avatar), rate) : frame;
  }
}

/** One frame of the bind pose. @returns {Clip} */
export function stillClip(/** @type {Avatar} */ { skeleton, encoding }) {
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
