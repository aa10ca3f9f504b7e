// Fetches and reads an avatar away from the page's own thread: takes a source, answers progress, previews, then the avatar,
// whose bytes change hands without a copy, or what is wrong with it.

import { asAvatarError } from "./error.js";
import { loadHere } from "./load_here.js";

self.onmessage = async ({ data: source }) => {
  try {
    const avatar = await loadHere(
      source,
      (fraction, sentence) => self.postMessage({ progress: { fraction, sentence } }),
      (preview) => self.postMessage({ preview }, { transfer: [...new Set(memories(preview))] }),
    );
    self.postMessage({ avatar }, { transfer: [...new Set(memories(avatar))] });
  } catch (error) {
    const { message, code, field } = asAvatarError(error, "The avatar cannot be read"); // for lack of memory, say
    self.postMessage({ failure: { message, code, field } });
  }
};

/** The memory behind all arrays of an avatar. @returns {Generator<ArrayBuffer>} */
function* memories(/** @type {unknown} */ value) {
  if (ArrayBuffer.isView(value)) yield/** @type {ArrayBuffer} */ (value.buffer);
  else if (value && typeof value === "object") for (const part of Object.values(value)) yield* memories(part);
}
