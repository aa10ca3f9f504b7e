// From a page's own motion file to a clip of an avatar, fetched and read when it is asked for.

import { Download, sourceOf } from "../download.js";
import { AvatarError, unfetched } from "../error.js";
import { readBvh } from "./bvh.js";
import { readGltf } from "./gltf.js";
import { withoutLeadingPose } from "./leading_pose.js";
import { retarget } from "./retarget.js";

/** @typedef {import("./types.js").MotionSource} MotionSource */
/** @typedef {import("./types.js").PlayClipOptions} Options */

const UTF_16 = ["utf-16le", "utf-16be"];
const MARKS = [
  [0xff, 0xfe],
  [0xfe, 0xff],
];

/** The clip of a BVH, glTF, GLB, VRM or VRMA file on an avatar, and notes worth telling. @param {MotionSource} source @param {import("../format/read.js").Avatar} avatar @param {Options} options @returns {Promise<{clip: import("../clip.js").Clip, notes: string[]}>} */
export async function readClip(source, avatar, { name, mapping = {}, animation }) {
  const { content, title, beside } = await opened(source);
  try {
    const text = textOf(content);
    const isBvh = /^\s*(#|\/\/|;|hierarchy)/i.test(text.slice(0, 200));
    if (!isBvh && !/^\s*(glTF|\{)/.test(text)) throw new AvatarError("expected a BVH, glTF, GLB, VRM or VRMA file.");
    const motion = withoutLeadingPose(isBvh ? readBvh(text) : await readGltf(content, beside, animation));
    const expresses = motion.expressions.names.length && avatar.expressions.length;
    const names = expresses ? await import("../names/match.js").catch(unfetched("its expressions")) : null;
    const { clip, notes } = retarget(motion, avatar, mapping, names);
    const stem = title.replace(/\.[^.]*$/, "");
    return { clip: { ...clip, name: name ?? (stem || "motion") }, notes };
  } catch (error) {
    if (!(error instanceof AvatarError)) throw error;
    throw new AvatarError(title ? `${title}: ${error.message}` : `The motion: ${error.message}`);
  }
}

/** @param {MotionSource} source @returns {Promise<{content: ArrayBuffer, title: string, beside: (uri: string) => Promise<ArrayBuffer>}>} */
async function opened(source) {
  const found = sourceOf(source);
  if (typeof found !== "string") {
    const content = found instanceof Blob ? await found.arrayBuffer() : found;
    const beside = (/** @type {string} */ uri) =>
      Promise.reject(new AvatarError(`its ${uri} is another file; give its address, or a .glb.`));
    return { content, title: found instanceof File ? found.name : "", beside };
  }
  const download = new Download(found);
  const beside = (/** @type {string} */ uri) => new Download(new URL(uri, found).href).whole(() => {});
  return { content: await download.whole(() => {}), title: download.name, beside };
}

function textOf(/** @type {ArrayBuffer} */ content) {
  const first = new Uint8Array(content.slice(0, 2));
  const wide = MARKS.findIndex((mark) => mark.every((byte, i) => byte === first[i]));
  return new TextDecoder(wide < 0 ? "utf-8" : UTF_16[wide]).decode(content);
}
