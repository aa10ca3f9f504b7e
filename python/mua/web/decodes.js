// The decodes of all avatars of a player: what the schedule asks for, within what the device has been found to have time for.
// Reference: python/mua/player/schedule.py, of one avatar.

import { FrameBudget, MILLISECONDS } from "./frame_budget.js";
import { texelPixels } from "./level_choice.js";
import { largestTurn } from "./rotation.js";
import { DecodeSchedule } from "./schedule.js";

/** @typedef {import("./renderer.js").Slot} Slot */
/** @typedef {import("./skeleton.js").Pose} Pose */
/** @typedef {import("./schedule.js").Ask} Ask */
/** @typedef {(moment: import("./schedule.js").Moment) => Pose[]} Window newest pose first */
/** @typedef {{slot: Slot, ask: Ask, window: Window}} Asked */

const LONGEST_FRAME = 250; // milliseconds; what took longer was held up by something else

export class Decodes {
  constructor() {
    /** @type {DecodeSchedule<Slot>} */
    this.schedule = new DecodeSchedule();
    this.budget = new FrameBudget();
    this.displayed = 0; // frames
    this.before = 0; // milliseconds of the last one
    /** @type {Omit<import("./frame_budget.js").Measured, "exact">} */
    this.measured = { most: MILLISECONDS, avatars: 0, splats: null };
  }

  /** Append what a displayed frame decodes; the avatars of which other channels are shown. @param {GPUComputePassEncoder} pass @param {Asked[]} asked those in view @returns {Set<Slot>} */
  record(pass, asked) {
    this.displayed += 1;
    const asks = new Map(asked.map(({ slot, ask }) => [slot, ask]));
    const steps = this.schedule.plan(asks, this.displayed, this.budget.parts);
    const changed = new Set();
    for (const { slot, window } of asked) {
      const { whole, finish, show, begin, parts } = /** @type {import("./schedule.js").Steps} */ (steps.get(slot));
      const { frame } = slot;
      if (whole) frame.decode(pass, posesOf(slot, window(whole)), whole.level);
      for (let part = 0; part < finish; part++) frame.advance(pass);
      if (show) frame.show();
      if (begin) frame.begin(posesOf(slot, window(begin)), begin.level);
      for (let part = 0; part < parts; part++) frame.advance(pass);
      if (whole || show) changed.add(slot);
    }
    return changed;
  }

  /** Take when a frame is displayed, milliseconds, where the device keeps no time. */
  display(/** @type {number} */ now) {
    const taken = now - this.before;
    this.before = now;
    if (taken < LONGEST_FRAME) this.budget.measure(taken, { ...this.measured, exact: false });
  }

  /** Take how long the device worked on a picture. */
  time(/** @type {number} */ milliseconds) {
    this.budget.measure(milliseconds, { ...this.measured, exact: true });
  }
}

/** The poses that an avatar is decoded from, the newest of which it keeps. @param {Slot} slot @param {Pose[]} poses */
function posesOf(slot, poses) {
  slot.decoded = poses[0];
  return poses;
}

/** How large an avatar is before the eyes, and how much its pose changed since the last decode: pixels times radians. @param {Slot} slot @param {Pose} pose @param {number[]} box @param {import("./camera.js").Camera[]} cameras */
export function rankOf({ decoded }, pose, box, cameras) {
  return decoded
    ? texelPixels(box[4] - box[1], box, cameras).texel * largestTurn(pose.rotations, decoded.rotations)
    : 0;
}
