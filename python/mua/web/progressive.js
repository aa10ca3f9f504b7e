// Progressive loading: each part of an avatar that has been downloaded replaces the one before, the whole avatar the last.

import { AvatarError } from "./error.js";

/** @typedef {import("./format/read.js").Avatar} Avatar */
/** @typedef {import("./avatars.js").Entry} Entry */
/** @typedef {import("./player.js").AvatarHandle} AvatarHandle */

export class ProgressiveLoad {
  constructor(
    /** @type {import("./engine.js").Engine} */ engine,
    /** @type {(avatar: AvatarHandle) => void} */ onPart,
  ) {
    this.engine = engine;
    this.onPart = onPart;
    /** @type {Entry | null} */
    this.entry = null; // once anything is shown
    /** @type {Avatar | null} */
    this.next = null; // the newest part, until it is shown
    /** @type {Promise<void>} */
    this.showing = Promise.resolve();
  }

  /** Show a part after the one before, unless a newer one has come by the time that the device can draw. */
  show(/** @type {Avatar} */ part) {
    this.next = part;
    this.showing = this.showing.then(() => this.showNext());
  }

  async showNext() {
    await this.engine.renderer?.projecting.catch(() => {}); // whoever puts an avatar there gets the error
    const part = this.next;
    if (!part) return;
    this.next = null;
    try {
      this.entry = await this.engine.put(part, this.entry, false);
    } catch (error) {
      if (error instanceof AvatarError) return; // the whole avatar fails with the same error, which is reported
      throw error;
    }
    if (this.engine.entries.includes(this.entry)) this.onPart(this.entry.handle);
  }

  /** Show all of it. @returns {Promise<AvatarHandle>} */
  async complete(/** @type {Avatar} */ avatar) {
    this.next = null;
    await this.showing;
    this.entry = await this.engine.put(avatar, this.entry, true);
    return this.entry.handle;
  }

  /** Take away what was shown of it. */
  async fail() {
    this.next = null;
    await this.showing.catch(() => {}); // the first error is reported elsewhere
    this.entry?.handle.remove();
  }
}
