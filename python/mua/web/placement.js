// Where avatars stand in the frame that they play: their boxes, the ground below them, the way that they have gone.

import { sample } from "./clip.js";
import { groundHeight } from "./overlays.js";
import { stillClip } from "./playback.js";
import { world } from "./skeleton.js";

/** @typedef {import("./avatars.js").Entry} Entry */
/** @typedef {import("./playback.js").Playback} Playback */
/** @typedef {import("./format/read.js").Avatar} Avatar */

/** World box of avatars: lowest then highest corner, metres. */
export function boxAround(/** @type {Entry[]} */ entries, /** @type {Playback} */ playback) {
  const boxes = entries.map((entry) => boxOf(entry, playback));
  return [0, 1, 2, 3, 4, 5].map((i) => (i < 3 ? Math.min : Math.max)(...boxes.map((one) => one[i])));
}

function boxOf(/** @type {Entry} */ entry, /** @type {Playback} */ playback) {
  const { avatar, handle } = entry;
  const root = rootOf(avatar, poseAt(entry, playback));
  return Array.from(avatar.bounds, (value, i) => value + root[i % 3] + handle.place[i % 3]);
}

/** How far an avatar has gone since its clip, or the page that poses it, began, metres; along the ground. */
export function gone(/** @type {Entry} */ entry, /** @type {Playback} */ playback) {
  const { avatar, live } = entry;
  const poses = [poseAt(entry, playback), live?.first ?? poseAt(entry, playback, 0)];
  const [now, start] = poses.map((pose) => rootOf(avatar, pose));
  return [now[0] - start[0], 0, now[2] - start[2]];
}

/** The pose that a page has set, else that of a frame of the clip, the present one if left out. */
function poseAt(
  /** @type {Entry} */ { avatar, live },
  /** @type {Playback} */ playback,
  frame = playback.frameOf(avatar),
) {
  return live?.current ?? sample(avatar.skeleton, playback.clipOf(avatar), frame, avatar.encoding.rate);
}

/** Place of the root joint, metres. */
function rootOf(/** @type {Avatar} */ { skeleton }, /** @type {import("./skeleton.js").Pose} */ pose) {
  return world(skeleton, pose).places.subarray(3 * skeleton.root, 3 * skeleton.root + 3);
}

/** Height on which an avatar stands in what it plays; of poses that a page sets, in its bind pose; metres. */
export function groundOf(/** @type {Entry} */ { avatar, grounds, live }, /** @type {Playback} */ playback) {
  const clip = live ? stillClip(avatar) : playback.clipOf(avatar);
  const ground = grounds.get(clip.name) ?? groundHeight(avatar, clip);
  grounds.set(clip.name, ground);
  return ground;
}
