// An avatar on its way into an engine: each part that has arrived takes the place of the one before, the whole one the last.

import { AvatarError } from "./error.js";

/** @typedef {import("./format/read.js").Avatar} Avatar */
/** @typedef {import("./engine.js").Entry} Entry */
/** @typedef {import("./player.js").AvatarHandle} AvatarHandle */

export class Arrival {
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
    await this.engine.renderer?.projecting.catch(() => {}); // what fails is told where an avatar is put
    const part = this.next;
    if (!part) return;
    this.next = null;
    try {
      this.entry = await this.engine.put(part, this.entry, false);
    } catch (error) {
      if (error instanceof AvatarError) return; // which the whole avatar meets too, and tells
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
    await this.showing.catch(() => {}); // what failed first is told
    this.entry?.handle.remove();
  }
}
