// Stand-ins for a page and its display: what <mua-avatar> is made of, without a browser. Import it before the element.

/** A part of a page, with what the element asks of parts. */
class Part extends EventTarget {
  hidden = false;
  value = "";
  textContent = "";
  children = [];
  options = [];
  isConnected = false;
  clientWidth = 100;
  clientHeight = 50;
  offsetHeight = 0;
  style = { setProperty() {} };
  classList = Object.assign(new Set(), {
    contains: (name) => this.classList.has(name),
    toggle: (name, on = !this.classList.has(name)) => (on ? this.classList.add(name) : this.classList.delete(name)),
  });
  #attributes = new Map();

  get ownerDocument() {
    return document;
  }

  get parentElement() {
    this.parent ??= new Part();
    return this.parent;
  }

  getAttribute(name) {
    return this.#attributes.get(name) ?? null;
  }

  hasAttribute(name) {
    return this.#attributes.has(name);
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

  #change(name, value) {
    const before = this.getAttribute(name);
    if (value === null) this.#attributes.delete(name);
    else this.#attributes.set(name, value);
    if (this.constructor.observedAttributes?.includes(name)) this.attributeChangedCallback(name, before, value);
  }

  attachShadow() {
    const parts = new Map();
    this.shadow = Object.assign(new Part(), {
      querySelector: (name) => parts.get(name) ?? parts.set(name, new Part()).get(name),
      querySelectorAll: () => named(this.shadow).filter((part) => part.getAttribute("type") === "checkbox"),
    });
    return this.shadow;
  }

  append(...parts) {
    this.children.push(...parts);
  }

  replaceChildren(...parts) {
    this.children = this.options = parts;
  }

  matches() {
    return false;
  }

  click() {
    this.dispatchEvent(new Event("click"));
  }

  focus() {
    document.activeElement = this;
  }
}

/** The parts within one that have names. */
function named(part) {
  const inner = (part.children ?? []).flatMap(named);
  const name = part.getAttribute?.("name");
  return name ? [Object.assign(part, { name }), ...inner] : inner;
}

const made = new Map(); // elements by name
const frames = new Map(); // that were asked of the display, by their requests
let requests = 0;

Object.assign(globalThis, {
  HTMLElement: Part,
  HTMLInputElement: class extends Part {},
  CSSStyleSheet: class {
    replaceSync() {}
  },
  Option: class {
    constructor(text, value) {
      Object.assign(this, { text, value });
    }
  },
  ResizeObserver: class {
    observe() {}
    disconnect() {}
  },
  IntersectionObserver: class {
    observe() {}
    disconnect() {}
  },
  customElements: { get: (name) => made.get(name), define: (name, kind) => made.set(name, kind) },
  devicePixelRatio: 3,
  matchMedia: () => ({ matches: page.lessMotion }),
  requestAnimationFrame: (draws) => (frames.set(++requests, draws), requests),
  cancelAnimationFrame: (request) => frames.delete(request),
  document: {
    baseURI: "http://host/page.html",
    fullscreenEnabled: false,
    createElement: () => page.make(),
    createElementNS: () => page.make(),
  },
});
Object.defineProperty(globalThis, "navigator", { value: { gpu: {} }, configurable: true });

/** The reader's wishes, what a page makes, and how it forgets what waits for the display. */
export const page = { lessMotion: false, make: () => new Part(), rest: () => frames.clear() };

export const settled = () => new Promise((done) => setTimeout(done));

/** Show so many frames of the display, `apart` milliseconds between them. */
export async function display(count, apart = 0) {
  for (let i = 0; i < count; i++) {
    const now = (display.now = Math.max(display.now ?? 0, performance.now()) + apart);
    const due = [...frames.values()];
    frames.clear();
    for (const draws of due) draws(now);
    await settled();
  }
}

/** Put an element into the page, or take it out, or into another place. */
export function place(element, ...there) {
  for (const is of there) {
    element.isConnected = is;
    if (is) element.connectedCallback();
    else element.disconnectedCallback();
  }
}

/** The part of an element that a selector finds, or the checkbox of a name. */
export const part = (element, name) => element.shadow.querySelector(name);
export const checkbox = (element, name) => element.shadow.querySelectorAll().find((each) => each.name === name);
export const told = (part, kind, more = {}) =>
  part.dispatchEvent(Object.assign(new Event(kind, { cancelable: true }), more));
