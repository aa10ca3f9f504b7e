// Plays a motion file that a page loads.

import { readClip } from "./read.js";

/** @typedef {import("../player.js").AvatarHandle} AvatarHandle */
/** @typedef {import("../player.js").ClipInfo} ClipInfo */

/** @param {import("../avatars.js").Avatars} engine @param {AvatarHandle} handle @param {import("./types.js").MotionSource} source @param {import("./types.js").PlayClipOptions} [options] @returns {Promise<import("./types.js").PlayedClip | null>} */
export async function playClip(engine, handle, source, options = {}) {
  const entry = engine.entryOf(handle);
  if (!entry) return null;
  const asked = ++entry.asked;
  const { clip, notes } = await readClip(source, entry.avatar, options);
  if (engine.entryOf(handle) !== entry || entry.asked !== asked) return null;
  const { loop = true } = options;
  entry.added = [...entry.added.filter(({ name }) => name !== clip.name), { ...clip, loop }];
  entry.changes += 1;
  engine.addClips(entry);
  engine.clip = clip.name;
  engine.time = 0;
  engine.playing = true;
  engine.setPose(handle, null);
  return { .../** @type {ClipInfo} */ (handle.clips.find(({ name }) => name === clip.name)), notes };
}
