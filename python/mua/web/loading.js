// How avatars come into an element: one after the other, each drawn as soon as a part of it is there, and every failure shown.

import { AvatarError, createPlayer } from "./player.js";

/** @typedef {import("./element.js").MuaAvatar} MuaAvatar */
/** @typedef {import("./player.js").AvatarHandle} AvatarHandle */
/** @typedef {import("./player.js").Player} Player */
/** @typedef {string | File | ArrayBuffer} Source */
/**
 * @typedef {object} Asks what loading asks of the element
 * @property {(player: Player) => void} opened a player is there, and shows nothing yet
 * @property {(first: boolean) => Promise<void>} show draws what was loaded, of which the first part was or was not shown before
 * @property {() => void} emptied nothing is shown any more
 * @property {() => Promise<void>} withdraw after a part was shown whose rest is damaged or did not come
 */

export class Loading {
  /** @type {Player | null} what draws; null until an avatar is asked for */
  player = null;
  /** @type {Promise<Player> | null} */
  #opening = null;
  /** @type {Promise<void>} */
  #closed = Promise.resolve(); // when the player before has given the canvas back
  /** @type {Source[]} */
  #sources = [];
  #run = 0; // counts what src has been
  #left = 0; // sources that are still to be shown
  #stopping = new AbortController(); // of what is being loaded

  /** @param {MuaAvatar} avatar @param {import("./controls.js").Controls} controls @param {Asks} asks */
  constructor(avatar, controls, asks) {
    this.avatar = avatar;
    this.controls = controls;
    this.asks = asks;
  }

  /** Whether a player is there or being made. */
  get begun() {
    return Boolean(this.player ?? this.#opening);
  }

  /** Whether nothing is to be loaded any more. */
  get done() {
    return this.#left === 0;
  }

  /** Load what src names, anew. */
  async reload() {
    const sources = (this.avatar.getAttribute("src") ?? "").split(/\s+/).filter(Boolean);
    const files = this.#sources.filter((source) => typeof source !== "string");
    this.dispose();
    if (sources.length + files.length) await this.add([...sources, ...files]);
    else this.controls.hush();
  }

  /** Show more avatars beside those that are there. */
  async add(/** @type {Source[]} */ sources) {
    const run = this.#run;
    this.#left += sources.length;
    for (const [i, source] of sources.entries()) {
      this.#sources.push(source);
      try {
        await this.#load(source, run, (share) => (i + share) / sources.length);
      } catch (error) {
        this.#sources = this.#sources.filter((each) => each !== source || typeof source === "string");
        if (run !== this.#run) return;
        this.#left -= sources.length - i;
        return this.fail(error);
      }
      if (run !== this.#run) return; // another src since
    }
  }

  /** @param {Source} source @param {number} run @param {(share: number) => number} ofAll */
  async #load(source, run, ofAll) {
    const { avatar, controls } = this;
    const { signal } = this.#stopping;
    controls.load(0, "Starting the player");
    const player = await this.#open();
    if (run !== this.#run) return;
    const onProgress = (/** @type {number} */ share, /** @type {string} */ sentence) => {
      if (run !== this.#run) return;
      controls.load(share, sentence);
      avatar.dispatchEvent(new CustomEvent("progress", { detail: { totalProgress: ofAll(share) } }));
    };
    const address = typeof source === "string" ? new URL(source, document.baseURI).href : source;
    let begun = false; // with a part of it
    const onPart = async (/** @type {AvatarHandle} */ part) => {
      if (run !== this.#run || (!part.splats && !controls.poster.hidden)) return; // a poster shows more than a template
      const first = !begun;
      begun = true;
      await this.asks.show(first);
    };
    try {
      const handle = await player.load(address, {
        signal,
        onProgress,
        onPart: (part) => void onPart(part).catch(() => {}),
      });
      if (run !== this.#run) return handle.remove();
      this.#left -= 1;
      await this.asks.show(!begun);
      controls.hush({ wrong: false });
      controls.update();
      avatar.dispatchEvent(new CustomEvent("load", { detail: handle }));
    } catch (error) {
      if (begun && run === this.#run) await this.asks.withdraw();
      throw error;
    }
  }

  /** The player; made when first needed. */
  async #open() {
    const run = this.#run;
    this.#opening ??= this.#closed.then(() => {
      if (run !== this.#run) throw new AvatarError("Another avatar was asked for.");
      return createPlayer(this.controls.canvas);
    });
    const player = await this.#opening;
    if (run !== this.#run || this.player === player) return player;
    this.player = player;
    player.playing = false;
    player.onerror = (error) => this.fail(error, { again: true });
    this.asks.opened(player);
    return player;
  }

  /** Take all avatars and their player away. */
  dispose() {
    this.#run += 1;
    const opening = this.#opening;
    this.#stopping.abort();
    this.#stopping = new AbortController();
    [this.#opening, this.player, this.#sources, this.#left] = [null, null, [], 0];
    this.asks.emptied();
    if (opening)
      this.#closed = opening.then(
        (player) => player.dispose(),
        () => {},
      ); // the reader has seen why it did not open
  }

  /** Say what went wrong. */
  fail(/** @type {unknown} */ error, { again = false } = {}) {
    const { avatar, controls } = this;
    const known =
      error instanceof AvatarError
        ? error
        : new AvatarError(`The avatar cannot be shown: ${error instanceof Error ? error.message : error}.`);
    const empty = !avatar.avatars.length;
    if (again) this.player?.stop();
    if (empty && !this.player) this.#opening = null; // opened anew when asked for again
    controls.update();
    controls.say(known.message, { again: again || (empty && avatar.hasAttribute("src")), close: !again && !empty });
    avatar.dispatchEvent(new CustomEvent("error", { detail: known }));
  }
}
