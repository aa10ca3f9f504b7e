// What a page asks of an element before there is an avatar: to play or to pause, and the time in the clip.

export class Asked {
  /** @type {boolean | null} */
  playing = null;
  /** @type {number | null} */
  time = null; // seconds

  /** Seek to the requested time, once. */
  seek(/** @type {import("./player.js").Player} */ player) {
    if (this.time !== null) player.time = this.time;
    this.time = null;
  }

  /** Whether the first avatar plays: as was asked, once, or `otherwise`. */
  play(/** @type {boolean} */ otherwise) {
    const playing = this.playing ?? otherwise;
    this.playing = null;
    return playing;
  }
}
