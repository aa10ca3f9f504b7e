// What an element's attributes ask of its player.

import { AvatarError } from "./error.js";
import { SHOWN } from "./keys.js";

/** @typedef {import("./player.js").Player} Player */

/** Attributes that take effect whenever they change. */
export const FOLLOWED = [
  "src",
  "clip",
  "controls",
  "poster",
  "alt",
  "speed",
  "show",
  "level",
  "budget",
  "framebudget",
  "stereo",
  "follow",
  "azimuth",
  "elevation",
];

/** What is shown where nothing is asked for. */
export const FIRST = { splats: true, geometry: false, template: false, skeleton: false, shadow: true };

/** @type {Record<string, (player: Player, value: string | null) => void>} by the attribute's name */
const ASKED = {
  clip(player, value) {
    if (value && player.clips.some(({ name }) => name === value)) player.clip = value;
  },
  speed: (player, value) => (player.speed = asked("speed", value, "a number", numberIn(value)) ?? 1),
  level(player, value) {
    const level = levelNamed(value);
    player.level =
      asked("level", value, "auto, full or texels along a side", level === "auto" && value !== level ? null : level) ??
      "auto";
  },
  budget: (player, value) => (player.budget = asked("budget", value, "a number of splats", numberIn(value))),
  framebudget: (player, value) =>
    (player.frameBudget = asked("framebudget", value, "a number of milliseconds", numberIn(value))),
  stereo: (player, value) => (player.stereo = value !== null),
  follow: (player, value) => (player.follow = value !== null),
  show(player, value) {
    if (value === null) return;
    const shown = value
      .split(",")
      .map((word) => word.trim())
      .filter(Boolean);
    const known = /** @type {import("./keys.js").Shown[]} */ (Object.keys(SHOWN));
    const other = shown.find((word) => !known.some((each) => each === word));
    if (other) throw new AvatarError(`show="${value}": "${other}" cannot be shown, only ${known.join(", ")}.`);
    for (const each of known) player.show[each] = shown.includes(each);
  },
};

/** What an attribute was found to ask for; null where it is left out. @template T @param {string} name @param {string | null} value @param {string} expected @param {T | null} found @returns {T | null} */
function asked(name, value, expected, found) {
  if (value && found === null) throw new AvatarError(`${name}="${value}": expected ${expected}.`);
  return found;
}

/** An error if everything is loaded and the requested clip does not exist; null otherwise. */
export function missingClip(/** @type {import("./element.js").MuaAvatar} */ element) {
  const { loaded, avatars } = element;
  const name = element.getAttribute("clip");
  const clips = avatars[0]?.clips.map((clip) => clip.name) ?? [];
  if (!loaded || !name || clips.includes(name)) return null;
  return new AvatarError(
    `clip="${name}": ${avatars[0].name} has no such clip, only ${clips.join(", ") || "its bind pose"}.`,
  );
}

/** Attributes that set something on the player. */
export const ASKABLE = Object.keys(ASKED);

/** Let a player do what an element's attribute asks for. */
export function adopt(/** @type {Player} */ player, /** @type {HTMLElement} */ element, /** @type {string} */ name) {
  ASKED[name]?.(player, element.getAttribute(name));
}

/** The number that an attribute holds. */
export function numberOf(
  /** @type {HTMLElement} */ element,
  /** @type {string} */ name,
  /** @type {number} */ otherwise,
) {
  return numberIn(element.getAttribute(name)) ?? otherwise;
}

function numberIn(/** @type {string | null} */ text) {
  const value = Number.parseFloat(text ?? "");
  return Number.isFinite(value) ? value : null;
}

/** What a player is asked for by a name in the panel or an attribute: by the distance, the finest, or texels along a side. @returns {import("./player.js").Level} */
export function levelNamed(/** @type {string | null} */ name) {
  return name === "full" ? "full" : Number(name) || "auto";
}

/** What is shown, as the attribute says it. */
export function namesOf(/** @type {import("./player.js").Show} */ show) {
  return Object.entries(show)
    .filter(([, shown]) => shown)
    .map(([name]) => name)
    .join();
}
