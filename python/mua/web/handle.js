// What a page knows of an avatar that was loaded, and may do with it.

import { framesAt } from "./clip.js";
import { sizesOf } from "./levels.js";

/** @typedef {import("./player.js").AvatarHandle} AvatarHandle */
/** @typedef {import("./player.js").ClipInfo} ClipInfo */
/** @typedef {import("./format/read.js").Avatar} Avatar */

/** @typedef {{remove: (handle: AvatarHandle) => void, outside: (handle: AvatarHandle) => number}} Asks what a handle asks of its player */

/** @param {Avatar} avatar @param {Asks} asks @returns {AvatarHandle} */
export function handleOf(avatar, asks) {
  /** @type {AvatarHandle} */
  const handle = {
    ...described(avatar),
    whole: false,
    place: [0, 0, 0],
    get outsideTraining() {
      return asks.outside(handle);
    },
    remove: () => asks.remove(handle),
  };
  return handle;
}

/** What a handle says of an avatar. */
export function described(/** @type {Avatar} */ avatar) {
  const [low, high] = [avatar.bounds.slice(0, 3), avatar.bounds.slice(3)].map((corner) => Array.from(corner));
  const bounds = /** @type {import("./player.js").Box} */ ([low, high]);
  const { name, notes, texels } = avatar;
  return { name, notes, clips: clipsOf(avatar), bounds, splats: texels.texels.length, levels: sizesOf(avatar) };
}

/** @returns {ClipInfo[]} */
function clipsOf(/** @type {Avatar} */ { clips, encoding }) {
  return clips.map((clip) => {
    const frames = framesAt(clip, encoding.rate);
    return { name: clip.name, frames, seconds: frames / encoding.rate };
  });
}
