// The attributes of an element as properties, so that pages and frameworks may set either: before, while and after an avatar loads.

import { FIRST, levelNamed, namesOf, numberOf } from "./attributes.js";

/** Names of the properties, each that of its attribute. */
export const PROPERTIES = /** @type {const} */ ([
  ...["src", "clip", "autoplay", "controls", "poster", "alt", "speed", "show", "level", "budget"],
  ...["framebudget", "stereo", "follow", "azimuth", "elevation", "orbit"],
]);

const HTMLElementOrNone = /** @type {typeof HTMLElement} */ (globalThis.HTMLElement ?? class {});

export class Attributed extends HTMLElementOrNone {
  /** What draws; null until an avatar is asked for. @returns {import("./player.js").Player | null} */
  get player() {
    return null;
  }

  /** The avatars that are shown. */
  get avatars() {
    return this.player?.avatars ?? [];
  }

  /** Addresses of avatar files, separated by spaces. @type {string} */
  get src() {
    return this.getAttribute("src") ?? "";
  }

  set src(value) {
    this.reflect("src", value);
  }

  /** Address of an image until the avatar is drawn. @type {string} */
  get poster() {
    return this.getAttribute("poster") ?? "";
  }

  set poster(value) {
    this.reflect("poster", value);
  }

  /** What is seen, for those who do not see it; the names of the avatars if left out. @type {string} */
  get alt() {
    return this.getAttribute("alt") ?? "";
  }

  set alt(value) {
    this.reflect("alt", value);
  }

  /** Whether it plays as soon as it is loaded. @type {boolean} */
  get autoplay() {
    return this.hasAttribute("autoplay");
  }

  set autoplay(value) {
    this.reflect("autoplay", value);
  }

  /** Whether the bar is shown. @type {boolean} */
  get controls() {
    return this.hasAttribute("controls");
  }

  set controls(value) {
    this.reflect("controls", value);
  }

  /** Whether a left and a right eye are drawn side by side. @type {boolean} */
  get stereo() {
    return this.hasAttribute("stereo");
  }

  set stereo(value) {
    this.reflect("stereo", value);
  }

  /** Whether the camera goes with the figure. @type {boolean} */
  get follow() {
    return this.hasAttribute("follow");
  }

  set follow(value) {
    this.reflect("follow", value);
  }

  /** Name of the clip that plays. @type {string | null} */
  get clip() {
    return this.player?.clip ?? this.getAttribute("clip");
  }

  set clip(name) {
    this.reflect("clip", name);
    if (!this.player || this.player.clip !== name) return;
    this.player.time = 0;
    this.player.onchange?.();
  }

  /** Playback speed; 1 plays at the recorded speed. @type {number} */
  get speed() {
    return this.player?.speed ?? numberOf(this, "speed", 1);
  }

  set speed(speed) {
    this.reflect("speed", speed);
  }

  /** What is drawn, separated by commas: splats, geometry, template, skeleton, shadow. @type {string} */
  get show() {
    return this.player ? namesOf(this.player.show) : (this.getAttribute("show") ?? namesOf(FIRST));
  }

  set show(names) {
    this.reflect("show", names);
  }

  /** The level of detail that is asked for. @returns {import("./player.js").Level} */
  get level() {
    return this.player?.level ?? levelNamed(this.getAttribute("level"));
  }

  set level(level) {
    this.reflect("level", level);
  }

  /** All that may be asked for: by the distance, the finest, and the sizes of the first avatar, texels along a side. */
  get levels() {
    return /** @type {import("./player.js").Level[]} */ (["auto", "full", ...(this.avatars[0]?.levels.slice(1) ?? [])]);
  }

  /** Most splats of all avatars together; null: no limit. @type {number | null} */
  get budget() {
    return this.hasAttribute("budget") ? numberOf(this, "budget", Infinity) : null;
  }

  set budget(value) {
    this.reflect("budget", value);
  }

  /** Milliseconds of a picture, within which splats are left out; null: none are. @type {number | null} */
  get framebudget() {
    return this.hasAttribute("framebudget") ? numberOf(this, "framebudget", Infinity) : null;
  }

  set framebudget(value) {
    this.reflect("framebudget", value);
  }

  /** Degrees that the camera stands round the figure. @type {number} */
  get azimuth() {
    return numberOf(this, "azimuth", 0);
  }

  set azimuth(value) {
    this.reflect("azimuth", value);
  }

  /** Degrees above the horizon. @type {number} */
  get elevation() {
    return numberOf(this, "elevation", 0);
  }

  set elevation(value) {
    this.reflect("elevation", value);
  }

  /** Degrees per second by which the camera goes round while it plays. @type {number} */
  get orbit() {
    return numberOf(this, "orbit", 0);
  }

  set orbit(value) {
    this.reflect("orbit", value);
  }

  /** Set an attribute; none for null, undefined and false, an empty one for true. @protected */
  reflect(/** @type {string} */ name, /** @type {unknown} */ value) {
    if (value === null || value === undefined || value === false) this.removeAttribute(name);
    else this.setAttribute(name, value === true ? "" : String(value));
  }

  /** Take over what was set before the browser knew this class. @protected */
  upgrade() {
    for (const name of PROPERTIES) {
      if (!Object.hasOwn(this, name)) continue;
      // biome-ignore lint/complexity/noUselessThisAlias: its type is another one
      const held = /** @type {Record<string, unknown>} */ (/** @type {unknown} */ (this));
      const value = held[name];
      delete held[name];
      held[name] = value;
    }
  }
}
