// What keys do; those of mua-view's window do the same here.

/** @typedef {import("./element.js").MuaAvatar} MuaAvatar */

/** What can be shown, in the order of the number keys, and as the panel names it. */
export const SHOWN = /** @type {const} */ ({
  splats: "Splats",
  geometry: "Detailed geometry",
  template: "Template mesh",
  skeleton: "Skeleton",
  shadow: "Shadow",
});

/** @typedef {keyof typeof SHOWN} Shown the name of one of them */

const STEP = 20; // pixels of a drag that an arrow key stands for

/** @type {Record<string, [key: string, does: string, act: (avatar: MuaAvatar) => void]>} by KeyboardEvent.key */
export const KEYS = {
  " ": ["space", "play or pause", (avatar) => avatar.togglePlaying()],
  ArrowLeft: ["left", "one frame back", (avatar) => avatar.step(-1)],
  ArrowRight: ["right", "one frame on", (avatar) => avatar.step(1)],
  ...Object.fromEntries(
    Object.entries(SHOWN).map(([name, label], i) => [
      String(i + 1),
      [String(i + 1), label, (/** @type {MuaAvatar} */ avatar) => avatar.toggle(/** @type {Shown} */ (name))],
    ]),
  ),
  a: ["a", "look at the next avatar", (avatar) => avatar.lookAtNext()],
  s: ["s", "stereo", (avatar) => avatar.toggleStereo()],
  f: ["f", "follow", (avatar) => avatar.toggleFollow()],
  l: ["l", "next level of detail", (avatar) => avatar.nextLevel()],
  c: ["c", "next clip", (avatar) => avatar.nextClip()],
  r: ["r", "reset the view", (avatar) => avatar.resetView()],
  t: ["t", "show the times", (avatar) => avatar.toggleTimes()],
  p: ["p", "save a picture", (avatar) => void avatar.savePicture()],
  w: ["w", "whole screen", (avatar) => void avatar.toggleFullscreen()],
  "+": ["+", "nearer", (avatar) => avatar.zoom(1)],
  "=": ["", "", (avatar) => avatar.zoom(1)], // + without the shift key, as keyboards with a US layout have it
  "-": ["-", "farther", (avatar) => avatar.zoom(-1)],
};

/** @type {Record<string, [right: number, down: number]>} with shift: turns as a drag does */
const TURNS = { ArrowLeft: [-STEP, 0], ArrowRight: [STEP, 0], ArrowUp: [0, -STEP], ArrowDown: [0, STEP] };

/** What the panel lists. */
export const LISTED = [
  ["drag, one finger", "turn"],
  ["right drag, two fingers", "move aside"],
  ["wheel, pinch", "zoom"],
  ["shift and arrows", "turn"],
  ...Object.values(KEYS)
    .map(([key, does]) => [key, does])
    .filter(([key]) => key),
];

/** Do what a key stands for, unless the control that has the focus wants it; says whether it did. */
export function pressed(/** @type {KeyboardEvent} */ event, /** @type {MuaAvatar} */ avatar) {
  if (event.defaultPrevented || event.ctrlKey || event.metaKey || event.altKey) return false;
  const focus = event.composedPath()[0];
  if (focus instanceof HTMLElement && wants(focus, event.key)) return false;
  const drag = event.shiftKey ? TURNS[event.key] : undefined;
  if (drag) avatar.turn(...drag);
  else if (KEYS[event.key]) KEYS[event.key][2](avatar);
  else return false;
  event.preventDefault();
  return true;
}

/** Whether a control answers a key itself. */
function wants(/** @type {HTMLElement} */ control, /** @type {string} */ key) {
  if (control instanceof HTMLInputElement && control.type === "range") return key.startsWith("Arrow");
  if (control instanceof HTMLInputElement && control.type === "checkbox") return key === " ";
  if (control.matches("button, summary, a")) return key === " ";
  return control.matches("select, input, textarea") || control.isContentEditable;
}
