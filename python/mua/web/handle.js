// What a page knows of an avatar that was loaded, and may do with it.

import { framesAt } from "./clip.js";
import { sizesOf } from "./levels.js";
import { skeletonInfo } from "./pose.js";

/** @typedef {import("./player.js").AvatarHandle} AvatarHandle */
/** @typedef {import("./player.js").ClipInfo} ClipInfo */
/** @typedef {import("./format/read.js").Avatar} Avatar */

/**
 * @typedef {object} Asks what a handle asks of its player
 * @property {(handle: AvatarHandle) => void} remove
 * @property {(handle: AvatarHandle) => number} outside
 * @property {(handle: AvatarHandle, ...given: Parameters<AvatarHandle["setPose"]>) => void} setPose
 * @property {(handle: AvatarHandle, ...given: Parameters<AvatarHandle["setExpressions"]>) => void} setExpressions
 * @property {(handle: AvatarHandle, ...given: Parameters<AvatarHandle["playClip"]>) => ReturnType<AvatarHandle["playClip"]>} playClip
 * @property {(handle: AvatarHandle, ...given: Parameters<AvatarHandle["retarget"]>) => ReturnType<AvatarHandle["retarget"]>} retarget
 */

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
    setPose: (pose) => asks.setPose(handle, pose),
    setExpressions: (weights) => asks.setExpressions(handle, weights),
    playClip: (source, options) => asks.playClip(handle, source, options),
    retarget: (rig, options) => asks.retarget(handle, rig, options),
    remove: () => asks.remove(handle),
  };
  return handle;
}

/** What a handle says of an avatar. */
export function described(/** @type {Avatar} */ avatar) {
  const [low, high] = [avatar.bounds.slice(0, 3), avatar.bounds.slice(3)].map((corner) => Array.from(corner));
  const bounds = /** @type {import("./player.js").Box} */ ([low, high]);
  const { name, notes, texels, expressions } = avatar;
  const skeleton = skeletonInfo(avatar.skeleton);
  const shown = { bounds, splats: texels.texels.length, levels: sizesOf(avatar) };
  return { name, notes, clips: clipsOf(avatar), skeleton, expressions, ...shown };
}

/** @returns {ClipInfo[]} */
export function clipsOf(/** @type {Avatar} */ { clips, encoding }) {
  return clips.map((clip) => {
    const frames = framesAt(clip, encoding.rate);
    return { name: clip.name, frames, seconds: frames / encoding.rate, loop: clip.loop ?? true };
  });
}
