// A file from a server, in one request that any host answers: the sections of a file for the network lie in the order in which
// they are shown. Where the connection breaks, the rest is asked for by range.

import { AvatarError } from "./error.js";
import { Stages } from "./format/stages.js";

/** @typedef {(fraction: number, sentence: string) => void} Progress */

const LARGEST = 2 ** 28; // bytes of a file that is shown before all of it is there: memory is taken on the server's word
const SOON = 2000; // milliseconds; within them a slow device has hardly prepared a part of a file
const STILL = 500; // milliseconds without a byte, after which nobody knows when the rest comes
const WAITS = [200, 1000]; // milliseconds before the rest is asked for again, after so many times in vain
const MARKS = ["etag", "last-modified"]; // that another version of the file would change

const megabytes = (/** @type {number} */ bytes) => (bytes / 1e6).toFixed(1);

/**
 * What a page asks to load: an address in full, a file or bytes.
 * @template {string | ArrayBuffer | Blob} T @param {T} source @returns {T extends string ? string : T}
 * @throws {AvatarError} for anything else
 */
export function sourceOf(source) {
  const given = /** @type {any} */ (source);
  if (given instanceof Blob || given instanceof ArrayBuffer) return /** @type {any} */ (given);
  if (typeof given !== "string") {
    const found = given?.constructor?.name ?? String(given);
    throw new AvatarError(`Expected an address, a File or an ArrayBuffer to load, found ${found}.`);
  }
  try {
    return /** @type {any} */ (new URL(given, document.baseURI).href);
  } catch {
    throw new AvatarError(`"${given}" is no address.`);
  }
}

export class Download {
  /** @param {string} url @param {AbortSignal} [signal] ends it */
  constructor(url, signal) {
    this.url = url;
    this.signal = signal;
    this.name = nameIn(url);
    this.got = 0;
    this.since = this.last = 0; // when it began and when bytes came last, milliseconds
    this.total = 0; // 0 where the server does not say
    this.content = new Uint8Array(); // of that size
    this.stages = new Stages(this.content.buffer);
    /** @type {Uint8Array[]} */
    this.beyond = []; // bytes beyond the length that the server announced
  }

  /** The end of the newest stage that has arrived and was not returned before; 0 if there is none. */
  reached() {
    return this.stages.reached(this.got);
  }

  /** Whether the rest is expected so soon that a part need not be shown before. */
  soon(now = performance.now()) {
    const left = ((this.total - this.got) * (now - this.since)) / this.got;
    return left < SOON && now - this.last < STILL;
  }

  /** All of it. @throws {AvatarError} where the server does not give it @returns {Promise<ArrayBuffer>} */
  async whole(/** @type {Progress} */ progress) {
    const first = await fetch(this.url, { signal: this.signal }).catch(() => {
      this.signal?.throwIfAborted();
      throw this.absent("the server is out of reach, or does not allow this page to read it.");
    });
    if (!first.ok) throw this.absent(`the server answers ${statusOf(first)}.`);
    this.begin(first);
    let there = await this.take(first, progress);
    for (let [vain, most] = [0, this.got]; !there; most = Math.max(most, this.got)) {
      this.signal?.throwIfAborted();
      if (!this.total || vain === WAITS.length) throw this.broken();
      await new Promise((resolve) => setTimeout(resolve, WAITS[vain]));
      there = await this.resume(first, progress);
      vain = this.got > most ? 0 : vain + 1;
    }
    if (this.got === this.content.length) return this.content.buffer;
    return joined([this.content.subarray(0, this.got), ...this.beyond], this.got);
  }

  begin(/** @type {Response} */ { headers }, now = performance.now()) {
    this.since = now;
    const total = headers.get("content-encoding") ? 0 : Number(headers.get("content-length") ?? 0);
    if (!this.url.startsWith("http") || total > LARGEST) return;
    this.total = total;
    this.content = new Uint8Array(total);
    this.stages = new Stages(this.content.buffer);
  }

  /** Take what an answer holds; whether it ended as it should. */
  async take(/** @type {Response} */ { body }, /** @type {Progress} */ progress) {
    const reader = body?.getReader();
    const of = this.total ? ` of ${megabytes(this.total)}` : "";
    try {
      for (let part = await reader?.read(); part && !part.done; part = await reader?.read()) {
        this.add(part.value);
        const share = this.total ? Math.min(this.got / this.total, 1) : 0;
        progress(share, `Fetching ${this.name}: ${megabytes(this.got)}${of} MB`);
      }
    } catch {
      return false;
    }
    return true;
  }

  add(/** @type {Uint8Array} */ bytes, now = performance.now()) {
    this.last = now;
    const at = Math.min(this.got, this.content.length);
    const room = this.content.length - at;
    this.content.set(bytes.subarray(0, room), at);
    if (bytes.length > room) this.beyond.push(bytes.subarray(room));
    this.got += bytes.length;
  }

  /** Ask for what is not there yet; a server that knows no ranges sends all of it again. @param {Response} first @param {Progress} progress */
  async resume(first, progress) {
    const { signal } = this;
    const headers = { Range: `bytes=${this.got}-` };
    const answer = await fetch(this.url, { headers, cache: "no-store", signal }).catch(() => null);
    if (!answer) return false;
    const part = answer.status === 206;
    if (!answer.ok && answer.status !== 416) throw this.broken(`; then the server answers ${statusOf(answer)}`);
    const marked = MARKS.every((mark) => answer.headers.get(mark) === first.headers.get(mark));
    const total = Number(answer.headers.get("content-length")) + (part ? this.got : 0);
    if (!marked || !answer.ok || total !== this.total)
      throw new AvatarError(`${this.name} has changed on the server while it was fetched; load it again.`);
    const range = answer.headers.get("content-range"); // of another address only where the server lets the page read it
    if (part && range && !range.startsWith(`bytes ${this.got}-`))
      throw this.broken("; then the server sends another part of it than was asked for");
    if (!part) [this.got, this.beyond] = [0, []];
    return this.take(answer, progress);
  }

  absent(/** @type {string} */ why) {
    return new AvatarError(`${this.name} cannot be fetched: ${why}`);
  }

  broken(then = "") {
    return new AvatarError(
      `${this.name} was not fetched whole: the connection broke after ${megabytes(this.got)} MB${then}.`,
    );
  }
}

/** What a server answers: HTTP/2 and later have no words for it. */
function statusOf(/** @type {Response} */ { status, statusText }) {
  return `${status} ${statusText}`.trim();
}

/** The file's name in an address; as it is written there where it is no text in UTF-8. */
function nameIn(/** @type {string} */ url) {
  const last = new URL(url).pathname.split("/").pop() || url;
  try {
    return decodeURIComponent(last);
  } catch {
    return last;
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
