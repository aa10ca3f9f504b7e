// Which part of which decode a displayed frame makes, so that none has to make all of it: the poses of a clip that come next
// are known, and are decoded part by part before they are due. Reference: python/mua/player/schedule.py.

import { PARTS } from "./channels.js";

/** @typedef {import("./frame.js").AvatarFrame} AvatarFrame */
/** @typedef {import("./skeleton.js").Pose} Pose */
/** @typedef {{clip: string, frame: number}} Moment */
/** @typedef {Moment & {level: number}} Made a moment at a level of detail */
/** @typedef {(moment: Moment) => Pose[]} Window newest pose first */

const same = (/** @type {Moment | null} */ a, /** @type {Moment} */ b) => a?.clip === b.clip && a.frame === b.frame;

/** Which decode of an avatar is shown, and which one is being made. */
export class DecodeSchedule {
  constructor(/** @type {AvatarFrame} */ frame) {
    this.frame = frame;
    /** @type {Made | null} */
    this.shown = null;
    /** @type {Made | null} */
    this.coming = null; // begun, and not shown
  }

  /**
   * Append what one displayed frame decodes; whether other channels are shown than before. Where nothing is to be decoded
   * ahead, `following` is `due`. A frame that must complete what is due does no more.
   * @param {GPUComputePassEncoder} pass @param {{due: Moment, following: Moment, level: number}} asked @param {Window} window
   */
  record(pass, { due, following, level }, window) {
    const ahead = !same(due, following);
    const made = ahead ? [this.shown, this.coming].find((one) => same(one, due)) : null;
    const wanted = made ?? { ...due, level };
    const changed = !same(this.shown, wanted) || this.shown?.level !== wanted.level;
    const taken = changed ? this.show(pass, wanted, window) : 0;
    if (ahead && taken === 0) this.lookAhead(pass, { ...following, level }, window);
    return changed;
  }

  /** Show what is due; how many parts that took. @param {GPUComputePassEncoder} pass @param {Made} wanted @param {Window} window */
  show(pass, wanted, window) {
    let taken = PARTS;
    if (same(this.coming, wanted) && this.coming?.level === wanted.level) {
      taken = this.frame.partsLeft;
      for (let part = 0; part < taken; part++) this.frame.advance(pass);
      this.frame.show();
    } else this.frame.decode(pass, window(wanted), wanted.level);
    [this.shown, this.coming] = [wanted, null];
    return taken;
  }

  /** @param {GPUComputePassEncoder} pass @param {Made} wanted @param {Window} window */
  lookAhead(pass, wanted, window) {
    if (!same(this.coming, wanted)) {
      this.frame.begin(window(wanted), wanted.level);
      this.coming = wanted;
    }
    if (this.frame.partsLeft > 0) this.frame.advance(pass);
  }
}
