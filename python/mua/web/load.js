// From a source to a checked avatar: fetched with progress and read in a worker, or here where there can be none. Of a file
// for the network, what has arrived is shown while the rest is still on its way, in one request that any host answers.

import { AvatarError } from "./error.js";
import { read, readStage } from "./format/read.js";
import { Stages } from "./format/stages.js";

/** @typedef {import("./format/read.js").Avatar} Avatar */
/** @typedef {(fraction: number, sentence: string) => void} Progress */
/** @typedef {(avatar: Avatar) => void} Preview takes what is there of an avatar before the rest is, and before its checksum */
/** @typedef {string | ArrayBuffer | Blob} Source */
/** @typedef {{message: string, code: string, field: string}} Told what an AvatarError says, which a message can carry */

const FETCHED = 0.8; // of the progress, the rest is reading and upload
const LARGEST = 2 ** 28; // bytes of a file that is shown before all of it is there: memory is taken on the server's word

/** The avatar of a source, by a worker; the page goes on meanwhile. @returns {Promise<Avatar>} */
export async function load(
  /** @type {Source} */ source,
  /** @type {Progress} */ progress,
  /** @type {Preview} */ preview = () => {},
) {
  const absolute = typeof source === "string" ? new URL(source, document.baseURI).href : source;
  const worker = startWorker();
  if (!worker) return loadHere(absolute, progress, preview);
  try {
    return await new Promise((resolve, reject) => {
      worker.onmessage = ({ data }) => {
        if (data.progress) progress(data.progress.fraction, data.progress.sentence);
        else if (data.preview) preview(data.preview);
        else if (data.told) reject(new AvatarError(data.told.message, data.told));
        else resolve(data.avatar);
      };
      worker.onerror = (event) => {
        event.preventDefault();
        resolve(loadHere(absolute, progress, preview)); // a page that forbids workers
      };
      worker.postMessage(absolute);
    });
  } finally {
    worker.terminate();
  }
}

function startWorker() {
  try {
    return new Worker(new URL("./worker.js", import.meta.url), { type: "module" });
  } catch {
    return null; // opened as a file, or forbidden by the page's policy
  }
}

/** The avatar of a source, in this thread. @returns {Promise<Avatar>} */
export async function loadHere(
  /** @type {Source} */ source,
  /** @type {Progress} */ progress,
  /** @type {Preview} */ preview = () => {},
) {
  const content = typeof source === "string" ? await fetched(source, progress, preview) : await bytesOf(source);
  progress(FETCHED, "Reading the avatar");
  return named(typeof source === "string" ? nameOf(source) : source instanceof File ? source.name : "", read(content));
}

/** With the file's name before what is wrong with it. @template T @param {string} name @param {Promise<T>} work @returns {Promise<T>} */
async function named(name, work) {
  try {
    return await work;
  } catch (error) {
    if (name && error instanceof AvatarError) throw new AvatarError(`${name}: ${error.message}`, error);
    throw error;
  }
}

async function bytesOf(/** @type {ArrayBuffer | Blob} */ source) {
  try {
    return source instanceof Blob ? await source.arrayBuffer() : source;
  } catch {
    throw new AvatarError("The file can no longer be read; choose it again.");
  }
}

async function fetched(
  /** @type {string} */ url,
  /** @type {Progress} */ progress,
  /** @type {Preview} */ preview,
) {
  const name = nameOf(url);
  const response = await fetch(url).catch(() => {
    throw new AvatarError(
      `${name} cannot be fetched: the server is out of reach, or does not allow this page to read it.`,
    );
  });
  if (!response.ok)
    throw new AvatarError(`${name} cannot be fetched: the server answers ${response.status} ${response.statusText}.`);
  const total = response.headers.get("content-encoding") ? 0 : Number(response.headers.get("content-length") ?? 0);
  const reader = response.body?.getReader();
  if (!reader) return response.arrayBuffer();
  const arriving = new Arriving(url.startsWith("http") && total <= LARGEST ? total : 0, preview);
  const of = total ? ` of ${(total / 1e6).toFixed(1)}` : "";
  try {
    for (let part = await reader.read(); !part.done; part = await reader.read()) {
      arriving.take(part.value);
      const { got } = arriving;
      progress(total ? Math.min((FETCHED * got) / total, FETCHED) : 0, `Fetching ${name}: ${(got / 1e6).toFixed(1)}${of} MB`);
    }
  } catch {
    const { got } = arriving;
    throw new AvatarError(`${name} was not fetched whole: the connection broke after ${(got / 1e6).toFixed(1)} MB.`);
  }
  await arriving.reading;
  return arriving.whole();
}

/** The bytes of a file of `expected` bytes, 0 where that is not known, and previews of what they show. */
class Arriving {
  constructor(/** @type {number} */ expected, /** @type {Preview} */ preview) {
    this.content = new Uint8Array(expected);
    this.preview = preview;
    this.stages = new Stages(this.content.buffer);
    this.got = 0;
    /** @type {Uint8Array[]} */
    this.beyond = []; // what a server sends without having said so
    /** @type {Promise<void> | null} */
    this.reading = null; // of a stage; no other one begins meanwhile
  }

  take(/** @type {Uint8Array} */ bytes) {
    const at = Math.min(this.got, this.content.length);
    const room = this.content.length - at;
    this.content.set(bytes.subarray(0, room), at);
    if (bytes.length > room) this.beyond.push(bytes.subarray(room));
    this.got += bytes.length;
    this.look();
  }

  /** Show the newest stage that is there. */
  look() {
    const end = this.reading ? 0 : this.stages.reached(this.got);
    if (!end) return;
    this.reading = this.show(end).finally(() => {
      this.reading = null;
      this.look(); // for what has arrived meanwhile
    });
  }

  async show(/** @type {number} */ end) {
    try {
      this.preview(await readStage(this.content.buffer, end));
    } catch (error) {
      if (!(error instanceof AvatarError)) throw error; // what is wrong is said of the whole file
    }
  }

  whole() {
    if (this.got === this.content.length) return this.content.buffer;
    return joined([this.content.subarray(0, this.got), ...this.beyond], this.got);
  }
}

function joined(/** @type {Uint8Array[]} */ parts, /** @type {number} */ length) {
  const whole = new Uint8Array(length);
  let at = 0;
  for (const part of parts) {
    whole.set(part, at);
    at += part.length;
  }
  return whole.buffer;
}

const nameOf = (/** @type {string} */ url) => decodeURIComponent(new URL(url).pathname.split("/").pop() || url);
