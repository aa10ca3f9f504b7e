// What a page asks of an element before there is an avatar: to play or to pause, the time in the clip, a pose, a clip of its own.

/** @typedef {import("./player.js").AvatarHandle} AvatarHandle */

export class Asked {
  /** @type {boolean | null} */
  playing = null;
  /** @type {number | null} */
  time = null; // seconds
  /** @type {Parameters<AvatarHandle["setPose"]>[0]} */
  pose = null;
  /** @type {Record<string, number> | null} */
  weights = null;
  /** @type {((handle: AvatarHandle | null) => void) | null} takes the avatar that a clip is for, or none */
  #clip = null;

  /** Wait for an avatar to play a clip; null where there will be none, or another clip was asked for. @param {Parameters<AvatarHandle["playClip"]>} given */
  async playClip(...given) {
    this.drop();
    /** @type {AvatarHandle | null} */
    const handle = await new Promise((resolve) => (this.#clip = resolve));
    return handle ? handle.playClip(...given) : null;
  }

  /** Expect no avatar any more. */
  drop() {
    this.#clip?.(null);
    this.#clip = null;
  }

  /** Pose the avatar as was asked, once. */
  adopt(/** @type {AvatarHandle} */ handle) {
    const { pose, weights } = this;
    [this.pose, this.weights] = [null, null];
    this.#clip?.(handle);
    this.#clip = null;
    if (pose) handle.setPose(pose);
    if (weights) handle.setExpressions(weights);
  }

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
