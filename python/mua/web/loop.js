// When pictures are drawn: all that the display shows while an avatar plays and can be seen, else only what changes.

import { nextFrame, windowOf } from "./display.js";

const LONGEST_STEP = 0.25; // seconds that count for one picture, so that nothing leaps after a pause

/** @typedef {import("./element.js").MuaAvatar} MuaAvatar */
/** @typedef {{tick: (seconds: number) => void, drawn: () => void, fail: (error: unknown) => void}} Asks tick: with every picture while it plays; drawn: after one while it does not */

/** Whether the reader asked the system for less motion. */
export function lessMotion() {
  return matchMedia("(prefers-reduced-motion: reduce)").matches;
}

export class Loop {
  #drawing = false;
  #waiting = false; // for a frame, to draw what has changed
  #changed = false;
  #visible = true;
  #ticking = false;
  #before = 0; // milliseconds of the last tick
  #windows = 1; // that it has been in

  /** @param {MuaAvatar} avatar @param {Asks} asks */
  constructor(avatar, asks) {
    this.avatar = avatar;
    this.asks = asks;
  }

  /** Whether any of the element is on the screen. */
  setVisible(/** @type {boolean} */ visible) {
    this.#visible = visible;
    this.pace();
  }

  /** Go on by the frames of another window: those that the one before owes may never come. */
  move() {
    this.#windows += 1;
    this.#ticking = false;
    this.avatar.player?.stop();
    this.pace();
    if (!this.#waiting) return;
    this.#drawing = this.#waiting = false;
    this.redraw();
  }

  get #going() {
    return Boolean(this.avatar.player?.moving) && this.#visible && this.avatar.avatars.length > 0;
  }

  /** Start or stop, as it plays or does not. */
  pace() {
    const { player } = this.avatar;
    if (!this.#going) return player?.stop();
    player?.start();
    if (this.#ticking) return;
    this.#ticking = true;
    this.#before = performance.now();
    this.#next((now) => this.#tick(now));
  }

  #next(/** @type {(now: number) => void} */ draw) {
    const windows = this.#windows;
    nextFrame(windowOf(this.avatar), (now) => windows === this.#windows && draw(now));
  }

  #tick(/** @type {number} */ now) {
    this.#ticking = this.#going;
    if (!this.#ticking) return this.pace();
    const seconds = Math.max(now - this.#before, 0) / 1000;
    this.#before = now;
    this.asks.tick(Math.min(seconds, LONGEST_STEP));
    this.#next((then) => this.#tick(then));
  }

  /** Draw what has changed, once however often it is asked for. */
  redraw() {
    this.#changed = true;
    if (this.#drawing || !this.avatar.player || this.avatar.player.moving) return;
    this.#drawing = this.#waiting = true;
    this.#next(() => void this.#drawChanged());
  }

  /** Draw now, and with it what was to be drawn. */
  async draw() {
    this.#changed = false;
    await this.avatar.player?.draw();
    this.asks.drawn();
  }

  async #drawChanged() {
    const { player } = this.avatar;
    this.#waiting = false;
    try {
      while (this.#changed && this.avatar.player && !this.avatar.player.moving) await this.draw();
    } catch (error) {
      if (this.avatar.player === player) this.asks.fail(error); // not of one that was given back meanwhile
    } finally {
      this.#drawing = false;
    }
  }
}
