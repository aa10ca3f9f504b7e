// Where an element's avatars stand, and from where they are seen.

import { numberOf } from "./attributes.js";
import { turn, zoom } from "./view.js";

/** @typedef {import("./element.js").MuaAvatar} MuaAvatar */

const DEGREE = Math.PI / 180;
const GAP = 0.15; // metres between avatars that stand side by side

export class Stage {
  /** Metres from which all is seen. */
  framed = 1;
  #looked = -1; // which avatar is in the middle

  constructor(/** @type {MuaAvatar} */ avatar) {
    this.avatar = avatar;
  }

  /** Stand avatars side by side and show all of them. */
  arrange() {
    const { avatars } = this.avatar;
    const widths = avatars.map(({ bounds: [low, high] }) => high[0] - low[0] + GAP);
    let right = -widths.reduce((sum, width) => sum + width, 0) / 2;
    for (const [i, avatar] of avatars.entries()) {
      const [low, high] = avatar.bounds;
      avatar.place = avatars.length > 1 ? [right + widths[i] / 2 - (low[0] + high[0]) / 2, 0, 0] : [0, 0, 0];
      right += widths[i];
    }
    this.#looked = -1;
    this.reset();
  }

  /** Put the camera where all avatars are seen, from where the attributes say. */
  reset() {
    const { player, avatars } = this.avatar;
    if (!player || !avatars.length) return;
    player.camera.azimuth = DEGREE * numberOf(this.avatar, "azimuth", 0);
    player.camera.elevation = DEGREE * numberOf(this.avatar, "elevation", 0);
    player.frameAll();
    this.framed = player.camera.distance;
  }

  /** Keep all in a picture of another shape, such as of a phone that was turned, unless the reader has moved nearer or away. */
  refit() {
    const { player, avatars } = this.avatar;
    if (!player || !avatars.length || player.camera.distance !== this.framed) return;
    const { target } = player.camera; // where the reader looks stays in the middle
    player.frameAll();
    player.camera.target = target;
    this.framed = player.camera.distance;
  }

  lookAtNext() {
    const { player, avatars } = this.avatar;
    if (!player || !avatars.length) return;
    this.#looked = (this.#looked + 1) % avatars.length;
    player.frameAll([avatars[this.#looked]]);
  }

  /** Go round as the attribute orbit asks for so many seconds. */
  orbit(/** @type {number} */ seconds) {
    const { player } = this.avatar;
    if (player) player.camera.azimuth += DEGREE * numberOf(this.avatar, "orbit", 0) * seconds;
  }

  turn(/** @type {number} */ right, /** @type {number} */ down) {
    const { player } = this.avatar;
    if (player) turn(player.camera, right, down);
  }

  zoom(/** @type {number} */ notches) {
    const { player } = this.avatar;
    if (player) zoom(player.camera, notches, this.framed);
  }
}
