// <mua-avatar src="hero.muaavatar" autoplay controls>: an avatar in a page.
//
//   src         address of an avatar file; several, separated by spaces, stand side by side
//   clip        name of the clip that plays; the first one if left out
//   autoplay    plays as soon as it is loaded, unless the reader wants less motion
//   controls    shows the bar and the panel
//   poster      picture until the avatar is drawn
//   speed       playback speed; 1 plays at the recorded speed
//   show        what is drawn, separated by commas: splats, geometry, mesh, skeleton, shadow
//   level       of detail: auto (by the distance, if left out), full, or texels along a side of the texture
//   budget      most splats of all avatars together where level is auto
//   stereo      draws a left and a right eye side by side
//   follow      lets the camera go with the figure
//   azimuth     degrees that the camera stands round the figure, towards its left; 0 is its front
//   elevation   degrees above the horizon
//   orbit       degrees per second by which the camera goes round while it plays, unless less motion is wanted
//
// Events: `load` when an avatar is shown, `error` with the error in `detail`, `picture` when the first one is drawn.

import { Controls, levelNamed } from "./controls.js";
import { acceptFiles } from "./drop.js";
import { listen } from "./hands.js";
import { pressed, SHOWN } from "./keys.js";
import { look } from "./look.js";
import { Loop } from "./loop.js";
import { AvatarError, createPlayer } from "./player.js";
import { turn, zoom } from "./view.js";

/** @typedef {import("./player.js").AvatarHandle} AvatarHandle */
/** @typedef {import("./player.js").Player} Player */
/** @typedef {string | File | ArrayBuffer} Source */

const DEGREE = Math.PI / 180;
const SHARPEST = 2; // device pixels of a CSS pixel that are drawn: more cost much and show little
const GAP = 0.15; // metres between avatars that stand side by side
const FIRST = { splats: true, geometry: false, mesh: false, skeleton: false, shadow: true }; // what is shown where nothing is asked for

const HTMLElementOrNone = /** @type {typeof HTMLElement} */ (globalThis.HTMLElement ?? class {});

export class MuaAvatar extends HTMLElementOrNone {
  static observedAttributes = ["src", "clip", "controls", "poster", "speed", "show", "level", "budget", "stereo", "follow", "azimuth", "elevation"];

  /** @type {Player | null} what draws; null until an avatar is asked for */
  player = null;
  /** Milliseconds from the start of the page to the first picture; 0 before. */
  firstPicture = 0;

  /** @type {Promise<Player> | null} */
  #opening = null;
  /** @type {Source[]} */
  #sources = [];
  #run = 0; // counts what src has been
  #framed = 1; // metres from which all is seen
  #watched = new ResizeObserver(() => {
    this.#controls.update();
    this.#fit();
  });
  #seen = new IntersectionObserver(([entry]) => {
    this.#loop.setVisible(entry.isIntersecting);
  });
  #controls;
  #loop = new Loop(this, {
    tick: (seconds) => this.#tick(seconds),
    fail: (error) => this.#fail(error),
  });

  constructor() {
    super();
    const root = this.attachShadow({ mode: "open" });
    root.adoptedStyleSheets = [look()];
    this.#controls = new Controls(root, this);
    const moved = () => this.#redraw();
    listen(this.#controls.canvas, { camera: () => this.player?.camera, framed: () => this.#framed, moved });
    this.addEventListener("keydown", (event) => pressed(event, this));
    this.addEventListener("fullscreenchange", () => this.#controls.update());
    acceptFiles(this);
  }

  connectedCallback() {
    for (const part of [this.#controls.canvas, this.#controls.bar]) this.#watched.observe(part);
    this.#seen.observe(this);
    if (!this.player && !this.#opening) void this.reload();
  }

  disconnectedCallback() {
    this.#watched.disconnect();
    this.#seen.disconnect();
    queueMicrotask(() => this.isConnected || this.#dispose()); // an element that is moved stays as it is
  }

  attributeChangedCallback(/** @type {string} */ name, /** @type {string | null} */ before, /** @type {string | null} */ value) {
    if (before === value) return;
    if (name === "poster") this.#setPoster(value);
    else if (name === "src") this.isConnected && void this.reload();
    else if (name === "azimuth" || name === "elevation") this.resetView();
    else this.#adopt(name);
    this.#controls.update();
  }

  /** The avatars that are shown. */
  get avatars() {
    return this.player?.avatars ?? [];
  }

  get controls() {
    return this.hasAttribute("controls");
  }

  get clip() {
    return this.player?.clip ?? this.getAttribute("clip");
  }

  set clip(name) {
    if (!this.player || !name) return;
    this.player.clip = name;
    this.player.time = 0;
    this.#redraw();
  }

  get speed() {
    return this.player?.speed ?? 1;
  }

  set speed(speed) {
    if (this.player) this.player.speed = speed;
    this.#redraw();
  }

  /** The level of detail that is asked for. @returns {import("./player.js").Level} */
  get level() {
    return this.player?.level ?? levelNamed(this.getAttribute("level"));
  }

  set level(level) {
    if (this.player) this.player.level = level;
    this.#redraw();
  }

  /** All that may be asked for: by the distance, the finest, and the sizes of the first avatar, texels along a side. */
  get levels() {
    return /** @type {import("./player.js").Level[]} */ (["auto", "full", ...(this.avatars[0]?.levels.slice(1) ?? [])]);
  }

  /** The next coarser level of detail; after the coarsest, by the distance again. */
  nextLevel() {
    const at = this.levels.indexOf(this.level);
    this.level = this.levels[(at + 1) % this.levels.length];
  }

  /** Draw two eyes side by side, or one. */
  toggleStereo() {
    if (this.player) this.player.stereo = !this.player.stereo;
    this.#redraw();
  }

  /** Let the camera go with the figure, or stay. */
  toggleFollow() {
    if (this.player) this.player.follow = !this.player.follow;
    this.#redraw();
  }

  /** Load what src names, anew. */
  async reload() {
    const sources = (this.getAttribute("src") ?? "").split(/\s+/).filter(Boolean);
    const files = this.#sources.filter((source) => typeof source !== "string");
    this.#dispose();
    if (sources.length + files.length) await this.add(...sources, ...files);
    else this.#controls.hush();
  }

  /** Show more avatars beside those that are there; what fails is said on the page and told by the event `error`. */
  async add(/** @type {Source[]} */ ...sources) {
    const run = this.#run;
    for (const source of sources) {
      this.#sources.push(source);
      try {
        await this.#load(source, run);
      } catch (error) {
        this.#sources = this.#sources.filter((each) => each !== source || typeof source === "string");
        if (run === this.#run) this.#fail(error);
        return;
      }
      if (run !== this.#run) return; // another src since
    }
  }

  /** Let the reader choose files to show. */
  openFiles() {
    this.#controls.file.click();
  }

  /** Take an avatar away. */
  dismiss(/** @type {AvatarHandle} */ avatar) {
    avatar.remove();
    this.#arrange();
  }

  play() {
    this.#setPlaying(true);
  }

  pause() {
    this.#setPlaying(false);
  }

  togglePlaying() {
    this.#setPlaying(!this.player?.playing);
  }

  /** Pause and go to a time in the clip, seconds. */
  seek(/** @type {number} */ seconds) {
    if (!this.player) return;
    this.pause();
    this.player.time = seconds;
    this.#redraw();
  }

  /** Pause and go so many frames on, round and round. */
  step(/** @type {number} */ frames) {
    const clip = this.player?.clips.find(({ name }) => name === this.player?.clip);
    if (!this.player || !clip) return;
    const rate = clip.frames / clip.seconds;
    const index = (Math.floor(this.player.time * rate + 1e-6) + frames + clip.frames) % clip.frames;
    this.seek(index / rate);
  }

  nextClip() {
    const names = this.player?.clips.map(({ name }) => name) ?? [];
    if (names.length) this.clip = names[(names.indexOf(this.clip ?? "") + 1) % names.length];
  }

  /** Show or hide a part of the picture. */
  toggle(/** @type {keyof typeof SHOWN} */ name) {
    if (!this.player) return;
    this.player.show[name] = !this.player.show[name];
    this.#redraw();
  }

  /** Open the panel at the times of each stage, or close them. */
  toggleTimes() {
    const { times, panel } = this.#controls;
    times.open = Boolean(panel.hidden) || !times.open;
    this.#controls.openPanel(true);
  }

  /** Turn as a drag of so many pixels does. */
  turn(/** @type {number} */ right, /** @type {number} */ down) {
    if (this.player) turn(this.player.camera, right, down);
    this.#redraw();
  }

  /** Nearer by so many notches of a wheel. */
  zoom(/** @type {number} */ notches) {
    if (this.player) zoom(this.player.camera, notches, this.#framed);
    this.#redraw();
  }

  /** Put the camera where all avatars are seen, from where the attributes say. */
  resetView() {
    if (!this.player || !this.avatars.length) return;
    const { camera } = this.player;
    camera.azimuth = DEGREE * this.#number("azimuth", 0);
    camera.elevation = DEGREE * this.#number("elevation", 0);
    this.player.frameAll();
    this.#framed = camera.distance;
    this.#redraw();
  }

  #looked = -1; // which avatar is in the middle

  lookAtNext() {
    if (!this.player || !this.avatars.length) return;
    this.#looked = (this.#looked + 1) % this.avatars.length;
    this.player.frameAll([this.avatars[this.#looked]]);
    this.#redraw();
  }

  /** The present picture as a PNG. */
  async screenshot() {
    if (!this.player) throw new AvatarError("No avatar is loaded, so there is no picture to save.");
    return this.player.screenshot();
  }

  /** Download the present picture. */
  async savePicture() {
    try {
      const address = URL.createObjectURL(await this.screenshot());
      const name = `${this.avatars[0]?.name ?? "avatar"}.png`;
      Object.assign(document.createElement("a"), { href: address, download: name }).click();
      setTimeout(() => URL.revokeObjectURL(address), 60_000);
    } catch (error) {
      this.#fail(error);
    }
  }

  async toggleFullscreen() {
    if (!document.fullscreenEnabled) return;
    if (this.matches(":fullscreen")) await document.exitFullscreen();
    else await this.requestFullscreen();
  }

  /** One avatar after the other. */
  async #load(/** @type {Source} */ source, /** @type {number} */ run) {
    this.#controls.load(0, "Starting the player");
    const player = await this.#open();
    const onProgress = (/** @type {number} */ share, /** @type {string} */ sentence) => {
      if (run === this.#run) this.#controls.load(share, sentence);
    };
    const address = typeof source === "string" ? new URL(source, document.baseURI).href : source;
    let begun = false; // with a part of it
    const onPart = async (/** @type {AvatarHandle} */ part) => {
      if (run !== this.#run || (!part.splats && !this.#controls.poster.hidden)) return; // a poster shows more than a mesh
      const first = !begun;
      begun = true;
      await this.#show(first);
    };
    try {
      const handle = await player.load(address, { onProgress, onPart: (part) => void onPart(part).catch(() => {}) });
      if (run !== this.#run) return handle.remove();
      await this.#show(!begun);
      this.#controls.hush();
      this.#controls.update();
      this.dispatchEvent(new CustomEvent("load", { detail: handle }));
    } catch (error) {
      if (begun && run === this.#run) await this.#withdraw();
      throw error;
    }
  }

  /** Draw what was loaded; what the reader has set since the `first` picture of an avatar stays. */
  async #show(/** @type {boolean} */ first) {
    for (const name of first ? ["clip", "speed", "show", "level", "budget", "stereo", "follow"] : ["clip"]) this.#adopt(name);
    if (first) this.#arrange();
    this.#fit(); // the bar has taken its place
    await this.#loop.draw();
    this.#controls.poster.hidden = true;
    if (!this.firstPicture) {
      this.firstPicture = performance.now();
      this.dispatchEvent(new Event("picture"));
    }
    if (first && this.hasAttribute("autoplay") && !lessMotion()) this.play();
    this.#controls.update();
  }

  /** After a part of an avatar was shown whose rest is damaged or did not come. */
  async #withdraw() {
    this.#setPoster(this.getAttribute("poster"));
    this.#arrange();
    await this.player?.draw();
  }

  /** The player; made when first needed. */
  async #open() {
    this.#fit();
    this.#opening ??= createPlayer(this.#controls.canvas);
    const [opening, run] = [this.#opening, this.#run];
    const player = await opening;
    if (run !== this.#run || this.player === player) return player;
    this.player = player;
    player.playing = false;
    Object.assign(player.show, FIRST);
    player.onerror = (error) => this.#fail(error, { again: true });
    return player;
  }

  #dispose() {
    this.#run += 1;
    const opening = this.#opening;
    [this.#opening, this.player, this.#sources] = [null, null, []];
    opening?.then((player) => player.dispose(), () => {}); // why it did not open has been said
  }

  /** Say what went wrong. */
  #fail(/** @type {unknown} */ error, { again = false } = {}) {
    const known = error instanceof AvatarError ? error : new AvatarError(`The avatar cannot be shown: ${error instanceof Error ? error.message : error}.`);
    const empty = !this.avatars.length;
    if (again) this.player?.stop();
    if (empty && !this.player) this.#opening = null; // opened anew when asked for again
    this.#controls.update();
    this.#controls.say(known.message, { again: again || (empty && this.hasAttribute("src")), close: !again && !empty });
    this.dispatchEvent(new CustomEvent("error", { detail: known }));
  }

  /** Follow an attribute. */
  #adopt(/** @type {string} */ name) {
    const { player } = this;
    if (!player) return;
    const value = this.getAttribute(name);
    if (name === "clip" && value && player.clips.some((clip) => clip.name === value)) player.clip = value;
    if (name === "speed") player.speed = this.#number("speed", 1);
    if (name === "level") player.level = levelNamed(value);
    if (name === "budget") player.budget = value === null ? null : this.#number("budget", Infinity);
    if (name === "stereo") player.stereo = value !== null;
    if (name === "follow") player.follow = value !== null;
    if (name === "show" && value !== null) {
      const shown = value.split(",").map((word) => word.trim());
      for (const each of /** @type {(keyof typeof SHOWN)[]} */ (Object.keys(SHOWN))) player.show[each] = shown.includes(each);
    }
    this.#redraw();
  }

  #number(/** @type {string} */ name, /** @type {number} */ otherwise) {
    const value = Number.parseFloat(this.getAttribute(name) ?? "");
    return Number.isFinite(value) ? value : otherwise;
  }

  /** Stand avatars side by side and show all of them. */
  #arrange() {
    const widths = this.avatars.map(({ bounds: [low, high] }) => high[0] - low[0] + GAP);
    let right = -widths.reduce((sum, width) => sum + width, 0) / 2;
    for (const [i, avatar] of this.avatars.entries()) {
      const [low, high] = avatar.bounds;
      avatar.place = this.avatars.length > 1 ? [right + widths[i] / 2 - (low[0] + high[0]) / 2, 0, 0] : [0, 0, 0];
      right += widths[i];
    }
    this.#looked = -1;
    this.resetView();
    this.#redraw();
  }

  #setPlaying(/** @type {boolean} */ playing) {
    if (!this.player) return;
    this.player.playing = playing && this.player.clips.length > 0;
    this.#loop.pace();
    this.#redraw();
  }

  /** With every picture while it plays. */
  #tick(/** @type {number} */ seconds) {
    if (this.player && !lessMotion()) this.player.camera.azimuth += DEGREE * this.#number("orbit", 0) * seconds;
    this.#controls.tick();
  }

  /** Draw what has changed. */
  #redraw() {
    this.#controls.update();
    this.#loop.redraw();
  }

  /** Give the canvas the pixels that it has on the screen. */
  #fit() {
    const { canvas } = this.#controls;
    const sharp = Math.min(devicePixelRatio, SHARPEST);
    const [width, height] = [canvas.clientWidth, canvas.clientHeight].map((side) => Math.max(Math.round(side * sharp), 1));
    if (canvas.width === width && canvas.height === height) return;
    [canvas.width, canvas.height] = [width, height];
    this.#redraw();
  }

  #setPoster(/** @type {string | null} */ address) {
    const { poster } = this.#controls;
    poster.hidden = !address || this.avatars.length > 0;
    if (address) poster.src = address;
  }
}

/** Whether the reader asked the system for less motion. */
function lessMotion() {
  return matchMedia("(prefers-reduced-motion: reduce)").matches;
}

globalThis.customElements?.define("mua-avatar", MuaAvatar);
