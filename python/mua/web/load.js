// From a source to a checked avatar: fetched with progress and read in a worker, or here where there can be none.

import { sourceOf } from "./download.js";
import { AvatarError } from "./error.js";
import { loadHere } from "./load_here.js";

/** @typedef {import("./format/read.js").Avatar} Avatar */
/** @typedef {import("./load_here.js").Progress} Progress */
/** @typedef {import("./load_here.js").Preview} Preview */
/** @typedef {import("./load_here.js").Source} Source */

/** The avatar of a source, by a worker; the page goes on meanwhile. @returns {Promise<Avatar>} */
export async function load(
  /** @type {Source} */ source,
  /** @type {Progress} */ progress,
  /** @type {Preview} */ preview = () => {},
  /** @type {AbortSignal | undefined} */ signal = undefined,
) {
  signal?.throwIfAborted();
  const absolute = sourceOf(source);
  const worker = startWorker();
  if (!worker) return loadHere(absolute, progress, preview, signal);
  try {
    return await new Promise((resolve, reject) => {
      worker.onmessage = ({ data }) => {
        if (data.progress) progress(data.progress.fraction, data.progress.sentence);
        else if (data.preview) preview(data.preview);
        else if (data.failure) reject(new AvatarError(data.failure.message, data.failure));
        else resolve(data.avatar);
      };
      worker.onerror = (event) => {
        event.preventDefault();
        resolve(loadHere(absolute, progress, preview, signal)); // a page that forbids workers
      };
      signal?.addEventListener("abort", () => reject(signal.reason)); // the worker ends, and its download with it
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
