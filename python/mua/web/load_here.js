// From a source to a checked avatar in the thread that asks: the worker's, or the page's own. It knows of no worker, as bundlers
// would otherwise find one that starts itself.

import { Download } from "./download.js";
import { AvatarError } from "./error.js";
import { read, readStage } from "./format/read.js";

/** @typedef {import("./format/read.js").Avatar} Avatar */
/** @typedef {(fraction: number, sentence: string) => void} Progress */
/** @typedef {(avatar: Avatar) => void} Preview takes what is there of an avatar before the rest is, and before its checksum */
/** @typedef {string | ArrayBuffer | Blob} Source */

const AGAIN = 250; // milliseconds after which a part that was not shown is thought of again: no byte may come meanwhile
const FETCHED = 0.8; // of the progress, the rest is reading and upload

/** The avatar of a source, in this thread. @returns {Promise<Avatar>} */
export async function loadHere(
  /** @type {Source} */ source,
  /** @type {Progress} */ progress,
  /** @type {Preview} */ preview = () => {},
  /** @type {AbortSignal | undefined} */ signal = undefined,
) {
  if (typeof source === "string") return loadFrom(new Download(source, signal), progress, preview);
  const content = await bytesOf(source);
  progress(FETCHED, "Reading the avatar");
  return checked(content, source instanceof File ? source.name : "");
}

/** The avatar that a file holds; with the file's name before what is wrong with it. @param {ArrayBuffer} content @param {string} name */
async function checked(content, name) {
  try {
    return await read(content);
  } catch (error) {
    if (!(error instanceof AvatarError)) throw error;
    const sentence = error.code === "identifier" ? otherThanAvatar(content) : error.message;
    throw new AvatarError(name ? `${name}: ${sentence}` : sentence, error);
  }
}

/** What is there in place of an avatar: many servers answer with a page of their own where a file is absent. */
function otherThanAvatar(/** @type {ArrayBuffer} */ content) {
  const begin = new TextDecoder().decode(content.slice(0, 64)).trimStart();
  return begin.startsWith("<")
    ? "this is a web page and not an avatar; is its address right?"
    : "this is not an avatar; expected a .muaavatar file.";
}

async function bytesOf(/** @type {ArrayBuffer | Blob} */ source) {
  try {
    return source instanceof Blob ? await source.arrayBuffer() : source;
  } catch {
    throw new AvatarError("The file can no longer be read; choose it again.");
  }
}

/** An avatar from a server; what has arrived of a file for the network is shown while the rest is far away. @returns {Promise<Avatar>} */
async function loadFrom(
  /** @type {Download} */ download,
  /** @type {Progress} */ progress,
  /** @type {Preview} */ preview,
) {
  /** @type {Promise<void> | null} */
  let reading = null; // of a stage; no other one begins meanwhile
  const look = () => {
    const end = reading || download.soon() ? 0 : download.reached();
    if (!end) return;
    reading = shown(download.content.buffer, end, preview).finally(() => {
      reading = null;
      look(); // for what has arrived meanwhile
    });
  };
  const looking = setInterval(look, AGAIN);
  const fetched = download.whole((share, sentence) => {
    progress(FETCHED * share, sentence);
    look();
  });
  const content = await fetched.finally(() => clearInterval(looking));
  while (reading) await reading;
  progress(FETCHED, "Reading the avatar");
  return checked(content, download.name);
}

async function shown(/** @type {ArrayBuffer} */ content, /** @type {number} */ end, /** @type {Preview} */ preview) {
  try {
    preview(await readStage(content, end));
  } catch (error) {
    if (!(error instanceof AvatarError)) throw error; // reading the whole file says what is wrong
  }
}
