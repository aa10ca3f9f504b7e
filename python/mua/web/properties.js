// The attributes of an element as properties, so that pages and frameworks may set either: before, while and after an avatar loads.

import { numberOf } from "./attributes.js";

/** Names of the properties, each that of its attribute. */
export const PROPERTIES = /** @type {const} */ ([
  ...["src", "clip", "autoplay", "controls", "poster", "alt", "speed", "show", "level", "budget"],
  ...["framebudget", "stereo", "follow", "azimuth", "elevation", "orbit"],
]);

const HTMLElementOrNone = /** @type {typeof HTMLElement} */ (globalThis.HTMLElement ?? class {});

export class Attributed extends HTMLElementOrNone {
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
