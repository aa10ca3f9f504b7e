// From a source to a checked avatar: fetched with progress and read in a worker, or here where there can be none.

import { AvatarError } from "./error.js";
import { read } from "./format/read.js";

/** @typedef {import("./format/read.js").Avatar} Avatar */
/** @typedef {(fraction: number, sentence: string) => void} Progress */
/** @typedef {string | ArrayBuffer | Blob} Source */
/** @typedef {{message: string, code: string, field: string}} Told what an AvatarError says, which a message can carry */

const FETCHED = 0.8; // of the progress, the rest is reading and upload

/** The avatar of a source, by a worker; the page goes on meanwhile. @returns {Promise<Avatar>} */
export async function load(/** @type {Source} */ source, /** @type {Progress} */ progress) {
  const absolute = typeof source === "string" ? new URL(source, document.baseURI).href : source;
  const worker = startWorker();
  if (!worker) return loadHere(absolute, progress);
  try {
    return await new Promise((resolve, reject) => {
      worker.onmessage = ({ data }) => {
        if (data.progress) progress(data.progress.fraction, data.progress.sentence);
        else if (data.told) reject(new AvatarError(data.told.message, data.told));
        else resolve(data.avatar);
      };
      worker.onerror = (event) => {
        event.preventDefault();
        resolve(loadHere(absolute, progress)); // a page that forbids workers
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
export async function loadHere(/** @type {Source} */ source, /** @type {Progress} */ progress) {
  const content = typeof source === "string" ? await fetched(source, progress) : await bytesOf(source);
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

async function fetched(/** @type {string} */ url, /** @type {Progress} */ progress) {
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
  /** @type {Uint8Array[]} */
  const parts = [];
  let got = 0;
  try {
    for (let part = await reader.read(); !part.done; part = await reader.read()) {
      parts.push(part.value);
      got += part.value.length;
      progress(total ? (FETCHED * got) / total : 0, `Fetching ${name}: ${(got / 1e6).toFixed(1)} MB`);
    }
  } catch {
    throw new AvatarError(`${name} was not fetched whole: the connection broke after ${(got / 1e6).toFixed(1)} MB.`);
  }
  return joined(parts, got);
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
