// The level of detail at which a player shows an avatar: the one that was asked for, or that its distance asks for.
// Reference: python/mua/player/levels.py.

import { chooseLevel, coarsest, texelLength, texelPixels } from "./coarser.js";
import { world } from "./skeleton.js";

/** @typedef {import("./format/read.js").Avatar} Avatar */

/** Of one avatar, from picture to picture. */
export class Levels {
  constructor(/** @type {Avatar} */ avatar) {
    this.avatar = avatar;
    this.sizes = Array.from({ length: coarsest(avatar) + 1 }, (_, level) => avatar.texels.size / 2 ** level);
    this.length = texelLength(avatar, avatar.texels.texels.length);
    this.shown = 0;
  }

  /**
   * The level for the next picture, 0 being the finest.
   * @param {import("./player.js").Level} wanted @param {import("./skeleton.js").Pose} pose @param {number[]} place
   * @param {import("./camera.js").Camera} camera
   */
  choose(wanted, pose, place, camera) {
    if (wanted === "auto") {
      const { skeleton, bounds } = this.avatar;
      const root = world(skeleton, pose).places.subarray(3 * skeleton.root);
      const box = Array.from(bounds, (value, i) => value + root[i % 3] + place[i % 3]);
      this.shown = chooseLevel(texelPixels(this.length, box, camera), this.sizes.length - 1, this.shown);
    } else this.shown = typeof wanted === "number" ? Math.max(this.sizes.indexOf(wanted), 0) : 0;
    return this.shown;
  }
}
