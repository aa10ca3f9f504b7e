// <mua-avatar src="hero.muaavatar" autoplay controls>: an avatar in a page.
//
//   src         address of an avatar file; several, separated by spaces, stand side by side
//   clip        name of the clip that plays; the first one if left out
//   autoplay    plays as soon as it is loaded, unless the reader wants less motion
//   controls    shows the bar and the panel
//   poster      picture until the avatar is drawn
//   alt         what is seen, for those who do not see it; the names of the avatars if left out
//   speed       playback speed; 1 plays at the recorded speed
//   show        what is drawn, separated by commas: splats, geometry, template, skeleton, shadow
//   level       of detail: auto (by the distance, if left out), full, or texels along a side of the texture
//   budget      most splats of all avatars together where level is auto
//   framebudget milliseconds that a picture may take: where it takes longer, fewer splats are shown
//   stereo      draws a left and a right eye side by side
//   follow      lets the camera go with the figure
//   azimuth     degrees that the camera stands round the figure, towards its left; 0 is its front
//   elevation   degrees above the horizon
//   orbit       degrees per second by which the camera goes round while it plays, unless less motion is wanted
//
// Each is a property too; both may be set before, while and after an avatar loads, as play(), pause() and seek() may be called.
// `outsideTraining` is how far the pose last drawn is from those of training, 0 to 1. setPose(), setExpressions() and playClip()
// move the first avatar as the page wants; each of `avatars` has them too.
// Events: `progress` with `detail.totalProgress` of 0 to 1, `load` when an avatar is shown, `error` with the error in `detail`,
// `picture` when the first one is drawn; `play`, `pause`, `loop` and `end` with clip and time in `detail`.

import { Operated } from "./actions.js";
import { Asked } from "./asked.js";
import { ASKABLE, adopt, FIRST, FOLLOWED, missingClip } from "./attributes.js";
import { Controls } from "./controls.js";
import { windowOf } from "./display.js";
import { acceptFiles } from "./drop.js";
import { listen } from "./hands.js";
import { pressed } from "./keys.js";
import { Loading } from "./loading.js";
import { look } from "./look.js";
import { Loop, lessMotion } from "./loop.js";
import { offersVR } from "./player.js";
import { Stage } from "./stage.js";

/** @typedef {import("./player.js").AvatarHandle} AvatarHandle */
/** @typedef {import("./player.js").Player} Player */
/** @typedef {import("./loading.js").Source} Source */

const SHARPEST = 2; // device pixels of a CSS pixel that are drawn: more cost much and show little

export class MuaAvatar extends Operated {
  static observedAttributes = FOLLOWED;

  /** Milliseconds from the start of the page to the first picture; 0 before. */
  firstPicture = 0;
  /** Whether there is a headset that could show the avatars. */
  offersVR = false;

  /** @type {{disconnect: () => void}[]} */
  #observers = [];
  #controls;
  #loading;
  #asked = new Asked();
  #stage = new Stage(this);
  #loop = new Loop(this, {
    tick: (seconds) => this.#tick(seconds),
    drawn: () => this.#controls.showOutside(),
    fail: (error) => this.#loading.fail(error),
  });

  constructor() {
    super();
    const root = this.attachShadow({ mode: "open" });
    root.adoptedStyleSheets = [look(document)];
    this.#controls = new Controls(root, this);
    this.#loading = new Loading(this, this.#controls, {
      opened: (player) => this.#begin(player),
      show: (first) => this.#show(first),
      withdraw: () => this.#withdraw(),
      emptied: () => this.#controls.setPoster(this.getAttribute("poster")),
    });
    const moved = () => this.#redraw();
    listen(this.#controls.canvas, { camera: () => this.player?.camera, framed: () => this.#stage.framed, moved });
    this.addEventListener("keydown", (event) => pressed(event, this));
    this.addEventListener("fullscreenchange", () => this.#controls.update());
    this.addEventListener("error", () => this.avatars.length || this.#asked.drop());
    acceptFiles(this);
  }

  connectedCallback() {
    this.upgrade();
    this.#observe(windowOf(this));
    if (!this.#loading.begun) void this.reload();
    void this.#findHeadset();
  }

  disconnectedCallback() {
    for (const observer of this.#observers) observer.disconnect();
    setTimeout(() => {
      if (this.isConnected) return; // an element that is moved stays as it is
      this.#asked.drop();
      this.#loading.dispose();
    });
  }

  /** Follow its size, and whether it is on the screen, by a window's own observers: those of a page in the background rest. */
  #observe(/** @type {Window & typeof globalThis} */ view) {
    const sized = new view.ResizeObserver(() => {
      this.#controls.update();
      this.#fit();
    });
    for (const part of [this.#controls.canvas, this.#controls.bar]) sized.observe(part);
    const seen = new view.IntersectionObserver(([entry]) => this.#loop.setVisible(entry.isIntersecting));
    seen.observe(this);
    this.#observers = [sized, seen];
  }

  /** In the document of a frame or of another window, such as a picture in picture. */
  adoptedCallback() {
    const { shadowRoot, ownerDocument } = this;
    if (shadowRoot && ownerDocument.defaultView) shadowRoot.adoptedStyleSheets = [look(ownerDocument)]; // no template's
    this.#loop.move();
  }

  attributeChangedCallback(
    /** @type {string} */ name,
    /** @type {string | null} */ before,
    /** @type {string | null} */ value,
  ) {
    if (before === value) return;
    if (name === "poster") this.#controls.setPoster(value);
    else if (name === "src") this.isConnected && void this.reload();
    else if (name === "azimuth" || name === "elevation") this.resetView();
    else this.#adopt(name);
    if (name === "clip") queueMicrotask(() => this.#missClip()); // src may change with it
    this.#redraw();
  }

  /** Whether all that was to be loaded is shown. */
  get loaded() {
    return this.#loading.done && this.avatars.length > 0;
  }

  /** What draws; null until an avatar is asked for. @returns {Player | null} */
  get player() {
    return this.#loading?.player ?? null;
  }

  /** Share of the pose of the first avatar, as last drawn, that training did not show, 0 to 1. */
  get outsideTraining() {
    return this.avatars[0]?.outsideTraining ?? 0;
  }

  /** The skeleton of the first avatar; null before it is there. */
  get skeleton() {
    return this.avatars[0]?.skeleton ?? null;
  }

  /** Names of the first avatar's expressions. */
  get expressions() {
    return this.avatars[0]?.expressions ?? [];
  }

  /** Show the first avatar in a pose in place of its clip; null gives it back to the clip. @type {AvatarHandle["setPose"]} */
  setPose(pose) {
    if (this.avatars[0]) this.avatars[0].setPose(pose);
    else this.#asked.pose = pose;
  }

  /** Set weights of the first avatar's expressions. @type {AvatarHandle["setExpressions"]} */
  setExpressions(weights) {
    if (this.avatars[0]) this.avatars[0].setExpressions(weights);
    else this.#asked.weights = weights && { ...this.#asked.weights, ...weights };
  }

  /** Play a motion file on the first avatar; a failure is shown on the page and reported by the event `error`. @type {AvatarHandle["playClip"]} */
  async playClip(source, options) {
    try {
      return await (this.avatars[0] ?? this.#asked).playClip(source, options);
    } catch (error) {
      this.#loading.fail(error);
      return null;
    }
  }

  /** Load what src names, anew. */
  async reload() {
    await this.#loading.reload();
  }

  /** Show more avatars beside those that are there; a failure is shown on the page and reported by the event `error`. */
  async add(/** @type {Source[]} */ ...sources) {
    await this.#loading.add(sources);
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

  /** Pause and go to a time in the clip, seconds. */
  seek(/** @type {number} */ seconds) {
    this.pause();
    if (this.player && this.avatars.length) this.player.time = seconds;
    else this.#asked.time = seconds;
    this.#redraw();
  }

  /** Open the panel at the times of each stage, or close them. */
  toggleTimes() {
    this.#controls.toggleTimes();
  }

  /** Turn as a drag of so many pixels does. */
  turn(/** @type {number} */ right, /** @type {number} */ down) {
    this.#stage.turn(right, down);
    this.#redraw();
  }

  /** Nearer by so many notches of a wheel. */
  zoom(/** @type {number} */ notches) {
    this.#stage.zoom(notches);
    this.#redraw();
  }

  /** Put the camera where all avatars are seen, from where the attributes say. */
  resetView() {
    this.#stage.reset();
    this.#redraw();
  }

  lookAtNext() {
    this.#stage.lookAtNext();
    this.#redraw();
  }

  /** Download the present picture. */
  async savePicture() {
    try {
      const address = URL.createObjectURL(await this.screenshot());
      const name = `${this.avatars[0]?.name ?? "avatar"}.png`;
      Object.assign(document.createElement("a"), { href: address, download: name }).click();
      setTimeout(() => URL.revokeObjectURL(address), 60_000);
    } catch (error) {
      this.#loading.fail(error);
    }
  }

  /** Show the avatars in a headset, or on the page again; only while the browser handles a click or a key. */
  async toggleVR() {
    try {
      if (this.player?.vr) this.player.leaveVR();
      else await this.player?.enterVR();
    } catch (error) {
      this.#loading.fail(error);
    }
  }

  async #findHeadset() {
    this.offersVR = await offersVR();
    this.#controls.update();
  }

  /** A player that shows nothing yet. */
  #begin(/** @type {Player} */ player) {
    Object.assign(player.show, FIRST);
    player.onvr = () => this.#redraw();
    player.onchange = () => {
      this.#loop.pace();
      this.#redraw();
    };
    player.onplayback = ({ type, clip, time }) => {
      player.onchange?.();
      this.dispatchEvent(new CustomEvent(type, { detail: { clip, time } }));
    };
  }

  /** Draw what was loaded; what the reader has set since the `first` picture of an avatar stays. */
  async #show(/** @type {boolean} */ first) {
    for (const name of first ? ASKABLE : ["clip"]) this.#adopt(name);
    if (first) this.#arrange();
    if (first && this.player) this.#begun(this.player);
    this.#missClip();
    this.#redraw();
    this.#fit(); // the bar has taken its place
    await this.#loop.draw();
    this.#controls.poster.hidden = true;
    if (!this.firstPicture) {
      this.firstPicture = performance.now();
      this.dispatchEvent(new Event("picture"));
    }
    if (first && this.avatars.length === 1 && this.#asked.play(this.autoplay && !lessMotion())) this.play();
    this.#controls.update();
  }

  /** Let the first avatar do what was asked before it was there, or say why it cannot. */
  #begun(/** @type {Player} */ player) {
    try {
      this.#asked.seek(player);
      this.#asked.adopt(player.avatars[0]);
    } catch (error) {
      this.#loading.fail(error);
    }
  }

  /** Let the player do what an attribute asks for, or say why it cannot. */
  #adopt(/** @type {string} */ name) {
    try {
      if (this.player) adopt(this.player, this, name);
    } catch (error) {
      this.#loading.fail(error);
    }
  }

  /** Say so where the clip that is asked for is not there. */
  #missClip() {
    const missing = missingClip(this);
    if (missing) this.#loading.fail(missing);
  }

  /** After a part of an avatar was shown whose rest is damaged or did not come. */
  async #withdraw() {
    this.#controls.setPoster(this.getAttribute("poster"));
    this.#arrange();
    await this.player?.draw();
  }

  /** Stand avatars side by side and show all of them. */
  #arrange() {
    this.#stage.arrange();
    this.#redraw();
  }

  #setPlaying(/** @type {boolean} */ playing) {
    if (!this.firstPicture || !this.avatars.length) this.#asked.playing = playing;
    if (!this.player) return;
    this.player.playing = playing && this.player.clips.length > 0;
    this.#loop.pace();
    this.#redraw();
  }

  /** With every picture while it plays. */
  #tick(/** @type {number} */ seconds) {
    if (this.player?.playing && !lessMotion()) this.#stage.orbit(seconds);
    this.#controls.tick();
    this.#fit(); // no observer hears of a display of another density
  }

  /** Draw what has changed. */
  #redraw() {
    this.#controls.update();
    this.#loop.redraw();
  }

  /** Give the canvas the pixels that it has on the screen. */
  #fit() {
    const { canvas } = this.#controls;
    const sharp = Math.min(windowOf(this).devicePixelRatio, SHARPEST);
    const [width, height] = [canvas.clientWidth, canvas.clientHeight].map((side) =>
      Math.max(Math.round(side * sharp), 1),
    );
    if (canvas.width === width && canvas.height === height) return;
    [canvas.width, canvas.height] = [width, height];
    this.#stage.refit();
    this.#redraw();
  }
}

if (!globalThis.customElements?.get("mua-avatar")) globalThis.customElements?.define("mua-avatar", MuaAvatar);
