// The levels of detail at which a player shows avatars: the one that was asked for, or those that their distances ask for.
// Reference: python/mua/player/levels.py.

import { chooseLevels, texelPixels } from "./level_choice.js";
import { world } from "./skeleton.js";

/** @typedef {import("./format/read.js").Avatar} Avatar */
/** @typedef {{levels: Levels, pose: import("./skeleton.js").Pose, place: number[]}} Standing an avatar where it is to be drawn */

/** The sizes of an avatar's levels, texels along a side, the finest first. */
export const sizesOf = (/** @type {Avatar} */ avatar) =>
  Array.from({ length: avatar.texels.levels.length + 1 }, (_, level) => avatar.texels.size / 2 ** level);

/** The levels of one avatar, and the one that it was last shown at. */
export class Levels {
  constructor(/** @type {Avatar} */ avatar) {
    this.avatar = avatar;
    this.sizes = sizesOf(avatar);
    this.counts = [avatar.texels, ...avatar.texels.levels].map(({ texels }) => texels.length);
    this.length = avatar.texels.length;
    this.shown = 0;
  }

  /** Its box in the world, metres. @param {import("./skeleton.js").Pose} pose @param {number[]} place */
  box(pose, place) {
    const { skeleton, bounds } = this.avatar;
    const root = world(skeleton, pose).places.subarray(3 * skeleton.root);
    return Array.from(bounds, (value, i) => value + root[i % 3] + place[i % 3]);
  }

  /** What the eyes see of it. @param {import("./skeleton.js").Pose} pose @param {number[]} place @param {import("./camera.js").Camera[]} cameras */
  seen(pose, place, cameras) {
    return { ...texelPixels(this.length, this.box(pose, place), cameras), counts: this.counts, shown: this.shown };
  }
}

/**
 * The level of each for the next picture, 0 being the finest. @param {Standing[]} standing
 * @param {{level: import("./player.js").Level, budget: number | null}} wanted @param {import("./camera.js").Camera[]} cameras
 */
export function levelsOf(standing, { level, budget }, cameras) {
  const chosen =
    level === "auto"
      ? chooseLevels(
          standing.map(({ levels, pose, place }) => levels.seen(pose, place, cameras)),
          budget,
        )
      : standing.map(({ levels }) => (typeof level === "number" ? Math.max(levels.sizes.indexOf(level), 0) : 0));
  standing.forEach(({ levels }, i) => (levels.shown = chosen[i]));
  return chosen;
}
