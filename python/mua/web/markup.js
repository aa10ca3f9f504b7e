// What the element is made of: one part by one, as pages that require trusted types take no HTML.

import { LISTED, SHOWN } from "./keys.js";

/** Paths of the buttons' icons. */
export const ICONS = {
  play: "M7 4.5v15l13-7.5z",
  pause: "M6 4.5h4v15H6zm8 0h4v15h-4z",
  settings: "M3 6h10v2H3zm14 0h4v2h-4zM14 4h2v6h-2zM3 16h4v2H3zm8 0h10v2H11zM8 14h2v6H8z",
  picture:
    "M9 4 7.5 6H4v13h16V6h-3.5L15 4zm3 4.5a4 4 0 1 1 0 8 4 4 0 0 1 0-8zm0 1.8a2.2 2.2 0 1 0 0 4.4 2.2 2.2 0 0 0 0-4.4z",
  vr: "M3 7h18v10h-5.2l-2.3-3h-3l-2.3 3H3zm4 2.5a2 2 0 1 0 0 4 2 2 0 0 0 0-4zm10 0a2 2 0 1 0 0 4 2 2 0 0 0 0-4z",
  whole: "M4 4h6v2H6v4H4zm10 0h6v6h-2V6h-4zM4 14h2v4h4v2H4zm14 0h2v6h-6v-2h4z",
};

const SPEEDS = [0.1, 0.25, 0.5, 1, 1.5, 2];

/** @typedef {Record<string, string>} Attributes */

/** A part by its name, and its class after a point. @param {string} kind @param {Attributes} attributes @param {(Node | string)[]} inner */
function make(kind, attributes, ...inner) {
  const [name, look] = kind.split(".");
  return filled(document.createElement(name), look ? { class: look, ...attributes } : attributes, inner);
}

/** @template {Element} T @param {T} part @param {Attributes} attributes @param {(Node | string)[]} inner */
function filled(part, attributes, inner = []) {
  for (const [name, value] of Object.entries(attributes)) part.setAttribute(name, value);
  part.append(...inner);
  return part;
}

const drawn = (/** @type {string} */ name, /** @type {Attributes} */ attributes) =>
  filled(document.createElementNS("http://www.w3.org/2000/svg", name), attributes);

/** A button with an icon. */
function button(
  /** @type {keyof typeof ICONS} */ icon,
  /** @type {string} */ label,
  /** @type {Attributes} */ more = {},
) {
  const image = drawn("svg", { viewBox: "0 0 24 24", "aria-hidden": "true" });
  image.append(drawn("path", { d: ICONS[icon] }));
  return make(`button.${icon}`, { type: "button", "aria-label": label, ...more }, image);
}

const named = (/** @type {string} */ kind, /** @type {string} */ text) =>
  make(`button.${kind}`, { type: "button" }, text);
const toggle = (/** @type {Attributes} */ attributes, /** @type {string} */ label) =>
  make("label", {}, make("input", { type: "checkbox", ...attributes }), label);
const row = (/** @type {string[]} */ cells) => make("tr", {}, ...cells.map((text) => make("td", {}, text)));

/** All of it. */
export const parts = () =>
  make(
    "div.frame",
    {},
    make("canvas", {
      part: "canvas",
      tabindex: "0",
      role: "application",
      "aria-roledescription": "3D view",
      "aria-label": "No avatar",
    }),
    make("img.poster", { alt: "", hidden: "" }),
    panel(),
    bar(),
    says(),
    make("input.file", { type: "file", accept: ".muaavatar", multiple: "", hidden: "", "aria-label": "Avatar files" }),
  );

const panel = () =>
  make(
    "section.panel",
    { id: "panel", "aria-label": "Settings", hidden: "" },
    make("h2", {}, "Show"),
    ...Object.entries(SHOWN).map(([name, label]) => toggle({ name }, label)),
    toggle({ class: "stereo" }, "Stereo, side by side"),
    toggle({ class: "follow" }, "Follow the figure"),
    make("label.row", {}, "Level of detail ", make("select.level", {})),
    make("h2", {}, "Avatars"),
    make("ul.avatars", {}),
    make("p.outside", {}),
    make("div.row", {}, named("open", "Open a file…"), named("reset", "Reset the view")),
    make(
      "details.times",
      {},
      make("summary", {}, "Times"),
      make("p.rate", {}),
      make("table", { "aria-label": "Milliseconds of each stage" }, make("tbody", {})),
      make("p.adapter", {}),
    ),
    make(
      "details",
      {},
      make("summary", {}, "Mouse, touch and keys"),
      make("table.keys", { "aria-label": "Keys" }, make("tbody", {}, ...LISTED.map(row))),
    ),
  );

const bar = () =>
  make(
    "div.bar",
    { role: "group", "aria-label": "Playback", hidden: "" },
    button("play", "Play"),
    make("input.scrub", {
      type: "range",
      min: "0",
      max: "0",
      step: "any",
      value: "0",
      "aria-label": "Time in the clip",
    }),
    make("span.clock", {}),
    make("select.clips", { "aria-label": "Clip" }),
    make("select.speed", { "aria-label": "Playback speed" }, ...SPEEDS.map(speed)),
    button("settings", "Settings", { "aria-controls": "panel", "aria-expanded": "false" }),
    button("picture", "Save a picture"),
    button("whole", "Whole screen", { "aria-pressed": "false" }),
    button("vr", "Show in a headset", { "aria-pressed": "false", hidden: "" }),
  );

const speed = (/** @type {number} */ value) =>
  make("option", { value: String(value), ...(value === 1 && { selected: "" }) }, `${value} ×`);

const says = () =>
  make(
    "div.says",
    { hidden: "" },
    make("p", { role: "status" }),
    make("progress", { max: "1", "aria-label": "Loading" }),
    make("div.row", {}, named("again", "Try again"), named("close", "Close")),
  );
