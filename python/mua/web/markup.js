// What the element is made of.

import { LISTED, SHOWN } from "./keys.js";

const icon = (/** @type {string} */ path) => `<svg viewBox="0 0 24 24" aria-hidden="true"><path d="${path}"/></svg>`;

export const ICONS = {
  play: icon("M7 4.5v15l13-7.5z"),
  pause: icon("M6 4.5h4v15H6zm8 0h4v15h-4z"),
  settings: icon("M3 6h10v2H3zm14 0h4v2h-4zM14 4h2v6h-2zM3 16h4v2H3zm8 0h10v2H11zM8 14h2v6H8z"),
  picture: icon(
    "M9 4 7.5 6H4v13h16V6h-3.5L15 4zm3 4.5a4 4 0 1 1 0 8 4 4 0 0 1 0-8zm0 1.8a2.2 2.2 0 1 0 0 4.4 2.2 2.2 0 0 0 0-4.4z",
  ),
  vr: icon("M3 7h18v10h-5.2l-2.3-3h-3l-2.3 3H3zm4 2.5a2 2 0 1 0 0 4 2 2 0 0 0 0-4zm10 0a2 2 0 1 0 0 4 2 2 0 0 0 0-4z"),
  whole: icon("M4 4h6v2H6v4H4zm10 0h6v6h-2V6h-4zM4 14h2v4h4v2H4zm14 0h2v6h-6v-2h4z"),
};

const SPEEDS = [0.1, 0.25, 0.5, 1, 1.5, 2];

const option = (/** @type {number} */ speed) =>
  `<option value="${speed}"${speed === 1 ? " selected" : ""}>${speed} ×</option>`;
const toggle = (/** @type {string[]} */ [name, label]) =>
  `<label><input type="checkbox" name="${name}">${label}</label>`;
const row = (/** @type {string[]} */ [key, does]) => `<tr><td>${key}</td><td>${does}</td></tr>`;

export const MARKUP = `
<div class="frame">
<canvas part="canvas" tabindex="0" role="application" aria-roledescription="3D view" aria-label="No avatar"></canvas>
<img class="poster" alt="" hidden>
<section class="panel" id="panel" aria-label="Settings" hidden>
  <h2>Show</h2>
  ${Object.entries(SHOWN).map(toggle).join("\n  ")}
  <label><input type="checkbox" class="stereo">Stereo, side by side</label>
  <label><input type="checkbox" class="follow">Follow the figure</label>
  <label class="row">Level of detail <select class="level"></select></label>
  <h2>Avatars</h2>
  <ul class="avatars"></ul>
  <p class="outside"></p>
  <div class="row">
    <button type="button" class="open">Open a file…</button>
    <button type="button" class="reset">Reset the view</button>
  </div>
  <details class="times"><summary>Times</summary>
    <p class="rate"></p>
    <table aria-label="Milliseconds of each stage"><tbody></tbody></table>
    <p class="adapter"></p>
  </details>
  <details><summary>Mouse, touch and keys</summary>
    <table class="keys" aria-label="Keys"><tbody>${LISTED.map(row).join("")}</tbody></table>
  </details>
</section>
<div class="bar" role="group" aria-label="Playback" hidden>
  <button type="button" class="play" aria-label="Play">${ICONS.play}</button>
  <input class="scrub" type="range" min="0" max="0" step="any" value="0" aria-label="Time in the clip">
  <span class="clock"></span>
  <select class="clips" aria-label="Clip"></select>
  <select class="speed" aria-label="Playback speed">${SPEEDS.map(option).join("")}</select>
  <button type="button" class="settings" aria-label="Settings" aria-controls="panel" aria-expanded="false">${ICONS.settings}</button>
  <button type="button" class="picture" aria-label="Save a picture">${ICONS.picture}</button>
  <button type="button" class="whole" aria-label="Whole screen" aria-pressed="false">${ICONS.whole}</button>
  <button type="button" class="vr" aria-label="Show in a headset" aria-pressed="false" hidden>${ICONS.vr}</button>
</div>
<div class="says" hidden>
  <p role="status"></p>
  <progress max="1" aria-label="Loading"></progress>
  <div class="row"><button type="button" class="again">Try again</button><button type="button" class="close">Close</button></div>
</div>
<input class="file" type="file" accept=".muaavatar" multiple hidden aria-label="Avatar files">
</div>
`;
