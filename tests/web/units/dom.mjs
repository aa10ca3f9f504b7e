// As much of a page as <mua-avatar> needs: elements without a picture, observers and frames that the test drives.

import { SHOWN } from "../../../python/mua/web/keys.js";

/** An element with attributes, events and the properties that a test or a module sets. */
class Part extends EventTarget {
  attributes = {};
  children = [];
  options = [];
  hidden = false;
  value = "";
  textContent = "";
  focused = false;
  classes = new Set();
  classList = {
    toggle: (name, on = !this.classes.has(name)) => (on ? this.classes.add(name) : this.classes.delete(name)),
    contains: (name) => this.classes.has(name),
  };
  style = { setProperty() {} };

  getAttribute(name) {
    return this.attributes[name] ?? null;
  }

  hasAttribute(name) {
    return name in this.attributes;
  }

  setAttribute(name, value) {
    this.#change(name, String(value));
  }

  removeAttribute(name) {
    this.#change(name, null);
  }

  toggleAttribute(name) {
    this.#change(name, this.hasAttribute(name) ? null : "");
  }

  replaceChildren(...children) {
    this.children = this.options = children;
  }

  append(...children) {
    this.children.push(...children);
  }

  matches(selector) {
    return selector.split(", ").includes(this.tag);
  }

  focus() {
    this.focused = true;
  }

  click() {
    this.dispatchEvent(new Event("click"));
  }

  #change(name, value) {
    const before = this.getAttribute(name);
    if (value === null) delete this.attributes[name];
    else this.attributes[name] = value;
    if (this.constructor.observedAttributes?.includes(name)) this.attributeChangedCallback(name, before, value);
  }
}

/** An element of a document, in which it may be. */
class Rooted extends Part {
  isConnected = false;
  parts = new Map();

  attachShadow() {
    const toggles = Object.keys(SHOWN).map((name) => Object.assign(new Part(), { name, checked: false }));
    const find = (selector) => {
      if (!this.parts.has(selector)) this.parts.set(selector, Object.assign(new Part(), { parentElement: new Part() }));
      return this.parts.get(selector);
    };
    this.toggles = toggles;
    return { querySelector: find, querySelectorAll: () => toggles };
  }
}

export const page = { frames: [], lessMotion: false, seen: [] };

class Observer {
  constructor(reported) {
    page.seen.push(reported);
  }

  observe() {}

  disconnect() {}
}

Object.assign(globalThis, {
  HTMLElement: Rooted,
  HTMLInputElement: class extends Rooted {},
  Option: class extends Part {
    constructor(text, value) {
      super();
      Object.assign(this, { textContent: text, value });
    }
  },
  CSSStyleSheet: class {
    replaceSync() {}
  },
  ResizeObserver: Observer,
  IntersectionObserver: Observer,
  document: { baseURI: "http://host/page.html", fullscreenEnabled: false, createElement: () => new Part() },
  devicePixelRatio: 1,
  matchMedia: () => ({ matches: page.lessMotion }),
  requestAnimationFrame: (draws) => page.frames.push(draws),
});
Object.defineProperty(globalThis, "navigator", { value: { gpu: {} }, configurable: true });

export const settled = () => new Promise((done) => setTimeout(done));

/** Let the display show a frame. */
export async function shown() {
  for (const draws of page.frames.splice(0)) draws(performance.now());
  await settled();
}
