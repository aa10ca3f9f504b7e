// The pose that a page sets, and the window of poses that an avatar is decoded from meanwhile. Reference: AvatarPose.cs of
// unity-package/Runtime, whose poses come from transforms.

import { PARTS } from "./channels.js";
import { ALONE } from "./schedule.js";

/** @typedef {import("./skeleton.js").Pose} Pose */

const SLACK = 1e-6; // frames; a time that was a frame's own stays in it
const LONGEST_GAP = 4; // frames without a pose, in the middle of motion, after which the window starts anew
const LONGEST_LAG = 1.1; // frames in which a late window is shown; displayed frames vary a little
let windows = 0; // of all avatars so far: numbers tell them apart

export class LivePose {
  /** The window of this moment. */
  due = 0;
  /** Counts the poses that differ from the one before. */
  version = 0;
  /** Whether a decode that takes some displayed frames is late by no more than a frame of the avatar. */
  mayLag = false;
  /** @type {Pose[]} newest first, at the avatar's rate */
  window = [];
  #newest = 0; // seconds; of the window's newest pose
  #sampled = 0; // seconds
  #rested = 0; // newest poses of the window that are the present one

  /** @param {{window: number, rate: number}} encoding @param {Pose} pose the first, which fills the window @param {number} seconds */
  constructor({ window, rate }, pose, seconds) {
    this.frames = window;
    this.rate = rate;
    this.first = this.current = pose;
    this.#sampled = seconds;
    this.#fill(seconds);
  }

  /** Whether the window holds the present pose alone, so that nothing changes any more. */
  get settled() {
    return this.#rested === this.frames;
  }

  /** Take the pose of a moment; the window takes one in each frame of the avatar's rate. */
  sample(/** @type {Pose} */ pose, /** @type {number} */ seconds) {
    const same = equal(pose, this.current);
    // A pose that rests is held until now, however long nothing was drawn.
    if (this.settled) this.#newest = same ? seconds : Math.max(this.#newest, seconds - 1 / this.rate);
    if (!same) {
      this.#rested = 0;
      this.version += 1;
    }
    this.current = pose;
    const age = (seconds - this.#newest) * this.rate;
    this.mayLag = (PARTS / ALONE) * (seconds - this.#sampled) * this.rate <= LONGEST_LAG;
    this.#sampled = seconds;
    if (this.settled) return;
    if (age < 0 || age > LONGEST_GAP) this.#fill(seconds);
    else if (age >= 1 - SLACK) this.#push(Math.floor(age + SLACK) / this.rate);
  }

  #fill(/** @type {number} */ seconds) {
    this.window = new Array(this.frames).fill(this.current);
    this.#rested = this.frames;
    this.#newest = seconds;
    this.due = ++windows;
  }

  #push(/** @type {number} */ passed) {
    this.window = [this.current, ...this.window.slice(0, -1)];
    this.#rested += 1;
    this.#newest += passed;
    this.due = ++windows;
  }
}

function equal(/** @type {Pose} */ a, /** @type {Pose} */ b) {
  const same = (/** @type {ArrayLike<number>} */ one = [], /** @type {ArrayLike<number>} */ other = []) =>
    one.length === other.length && Array.from(one).every((value, i) => value === other[i]);
  const { rotations, translations, expressions } = a;
  return same(rotations, b.rotations) && same(translations, b.translations) && same(expressions, b.expressions);
}
