// State of a player and the loop that draws it.

import { AvatarError } from "./error.js";

/** @implements {import("./player.js").Player} */
export class Engine {
  /** @returns {Promise<import("./player.js").Player>} */
  static async create(/** @type {HTMLCanvasElement} */ canvas, /** @type {import("./player.js").PlayerOptions} */ options) {
    void canvas, options;
    throw new AvatarError("The browser player is not built yet.");
  }
}
