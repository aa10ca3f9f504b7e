// What reads an avatar and what is shown of it meanwhile, and what is said of a file that is none.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { load as loadApart } from "../../../python/mua/web/load.js";
import { loadHere } from "../../../python/mua/web/load_here.js";

const sound = Uint8Array.from(readFileSync(new URL("../../golden/synthetic.muaavatar", import.meta.url)));
const load = (content, name) => loadHere(name ? new File([content], name) : new Blob([content]), () => {});

for (const [what, content, said] of [
  [
    "a page",
    "\n<!doctype html><title>Not found</title>",
    "this is a web page and not an avatar; is its address right?",
  ],
  ["a page without a doctype", "<html><body>Not found", "this is a web page and not an avatar; is its address right?"],
  ["another file", "PK\x03\x04 and the rest of it", "this is not an avatar; expected a .muaavatar file."],
])
  test(`${what} is said in a sentence that names the file and no bytes`, async () => {
    await assert.rejects(load(content, "hero.muaavatar"), { name: "AvatarError", message: `hero.muaavatar: ${said}` });
    await assert.rejects(load(content), { message: said });
  });

/** A worker that answers what it is sent with these messages, or fails; and how often one was ended. */
function working(...messages) {
  const worker = { ended: 0 };
  globalThis.Worker = class {
    terminate() {
      worker.ended += 1;
    }

    postMessage(source) {
      worker.source = source;
      for (const data of messages)
        queueMicrotask(() => (data === "fails" ? this.onerror(new Event("error")) : this.onmessage({ data })));
    }
  };
  return worker;
}

test("a worker reads an avatar, tells how far it is and what is there, and is ended", async () => {
  globalThis.document = { baseURI: "http://host/folder/page.html" };
  const worker = working(
    { progress: { fraction: 0.5, sentence: "half" } },
    { preview: "a part" },
    { avatar: "all of it" },
  );
  const reported = [];
  const found = await loadApart(
    "a.muaavatar",
    (...said) => reported.push(said),
    (part) => reported.push(part),
  );
  assert.deepEqual([found, reported], ["all of it", [[0.5, "half"], "a part"]]);
  assert.deepEqual([worker.source, worker.ended], ["http://host/folder/a.muaavatar", 1]);
});

test("what a worker finds wrong is an error of the page's own, with code and field, and the worker is ended", async () => {
  const worker = working({ failure: { message: "It is damaged.", code: "checksum", field: "clips" } });
  await assert.rejects(
    loadApart(new Blob([sound]), () => {}),
    { name: "AvatarError", message: "It is damaged.", code: "checksum", field: "clips" },
  );
  assert.equal(worker.ended, 1);
});

test("a page that forbids workers reads an avatar itself", async () => {
  const worker = working("fails");
  assert.equal((await loadApart(new Blob([sound]), () => {})).clips.length, 1);
  assert.equal(worker.ended, 1);
  globalThis.Worker = class {
    constructor() {
      throw new Error("forbidden");
    }
  };
  assert.equal((await loadApart(new Blob([sound]), () => {})).clips.length, 1);
});

test("what is there of a file is shown while its rest does not come", async () => {
  const packed = readFileSync(new URL("../../golden/packed.muaavatar", import.meta.url));
  let release;
  globalThis.fetch = async () => {
    const body = new ReadableStream({
      async start(stream) {
        stream.enqueue(Uint8Array.from(packed.subarray(0, packed.length - 10)));
        await new Promise((done) => (release = done));
        stream.enqueue(Uint8Array.from(packed.subarray(packed.length - 10)));
        stream.close();
      },
    });
    return new Response(body, { headers: { "content-length": packed.length } });
  };
  const parts = [];
  const late = setTimeout(() => release(), 10_000);
  const loaded = loadHere(
    "http://host/packed.muaavatar",
    () => {},
    (part) => (parts.push(part), clearTimeout(late), release()),
  );
  assert.equal((await loaded).clips.length, 1);
  assert.equal(parts.length, 1);
});

test("a download that is stopped ends its worker, and says why", async () => {
  const worker = working();
  const stopping = new AbortController();
  const stopped = () =>
    loadApart(
      "http://host/a.muaavatar",
      () => {},
      () => {},
      stopping.signal,
    );
  const loads = stopped();
  stopping.abort(new Error("another one"));
  await assert.rejects(loads, { message: "another one" });
  assert.deepEqual([worker.source, worker.ended], ["http://host/a.muaavatar", 1]);
  await assert.rejects(stopped(), { message: "another one" });
  assert.equal(worker.ended, 1, "none is begun afterwards");
});

test("a download in the page itself is stopped too, and nothing more is asked for", async () => {
  globalThis.Worker = undefined;
  const [stopping, requests] = [new AbortController(), []];
  globalThis.fetch = async (_, { signal }) => {
    requests.push(signal);
    signal.throwIfAborted();
    const body = new ReadableStream({
      start: (stream) => signal.addEventListener("abort", () => stream.error(signal.reason)),
    });
    return new Response(body, { headers: { "content-length": 100 } });
  };
  const loads = loadApart("http://host/a.muaavatar", () => {}, undefined, stopping.signal);
  stopping.abort(new Error("another one"));
  await assert.rejects(loads, { message: "another one" });
  assert.equal(requests.length, 1);
});

test("what fails in a worker for lack of memory is a sentence", async () => {
  const get = () => {
    throw new RangeError("Array buffer allocation failed"); // as where the page has no room for what is announced
  };
  globalThis.fetch = async () => ({ ok: true, headers: { get } });
  const sent = await new Promise((resolve) => {
    globalThis.self = { postMessage: resolve };
    void import("../../../python/mua/web/worker.js").then(() => self.onmessage({ data: "http://host/a.muaavatar" }));
  });
  assert.equal(sent.failure.message, "The avatar cannot be read: Array buffer allocation failed");
});
