// Where avatars stand in the frame that they play: their boxes, the ground below them, the way that they have gone.

import { sample } from "./clip.js";
import { groundHeight } from "./overlays.js";
import { world } from "./skeleton.js";

/** @typedef {import("./engine.js").Entry} Entry */
/** @typedef {import("./playback.js").Playback} Playback */
/** @typedef {import("./format/read.js").Avatar} Avatar */

/** World box of avatars: lowest then highest corner, metres. */
export function boxAround(/** @type {Entry[]} */ entries, /** @type {Playback} */ playback) {
  const boxes = entries.map((entry) => boxOf(entry, playback));
  return [0, 1, 2, 3, 4, 5].map((i) => (i < 3 ? Math.min : Math.max)(...boxes.map((one) => one[i])));
}

function boxOf(/** @type {Entry} */ { avatar, handle }, /** @type {Playback} */ playback) {
  const root = rootAt(avatar, playback, playback.frameOf(avatar));
  return Array.from(avatar.bounds, (value, i) => value + root[i % 3] + handle.place[i % 3]);
}

/** How far an avatar has gone since its clip began, metres; along the ground. */
export function gone(/** @type {Avatar} */ avatar, /** @type {Playback} */ playback) {
  const [now, start] = [playback.frameOf(avatar), 0].map((frame) => rootAt(avatar, playback, frame));
  return [now[0] - start[0], 0, now[2] - start[2]];
}

/** Place of the root joint, metres. */
function rootAt(/** @type {Avatar} */ avatar, /** @type {Playback} */ playback, /** @type {number} */ frame) {
  const { skeleton, encoding } = avatar;
  const pose = sample(skeleton, playback.clipOf(avatar), frame, encoding.rate);
  return world(skeleton, pose).places.subarray(3 * skeleton.root, 3 * skeleton.root + 3);
}

/** Height on which an avatar stands in what it plays, metres. */
export function groundOf(/** @type {Entry} */ { avatar, grounds }, /** @type {Playback} */ playback) {
  const clip = playback.clipOf(avatar);
  const ground = grounds.get(clip.name) ?? groundHeight(avatar, clip);
  grounds.set(clip.name, ground);
  return ground;
}
