// A file from a server that breaks off, refuses or fails; the server is a stand-in.

import assert from "node:assert/strict";
import { beforeEach, test } from "node:test";
import { Download } from "../../../python/mua/web/download.js";

const CONTENT = Uint8Array.from({ length: 100 }, (_, i) => i);
const { setTimeout: later } = globalThis;

let answers; // of the server, one after the other: [status, first byte, end] of what is sent before the connection breaks
let asked; // the range of each request
let waits; // milliseconds between them
let headers; // that each answer has beside the length, one after the other

globalThis.setTimeout = (act, wait) => (waits.push(wait), later(act));
globalThis.fetch = async (_, { headers: given } = {}) => {
  asked.push(given?.Range ?? null);
  const [status, begin = 0, end = begin] = answers.shift() ?? [503];
  const left = status === 206 ? CONTENT.length - begin : CONTENT.length;
  const body = new ReadableStream({
    pull(stream) {
      if (end > begin && !this.sent) stream.enqueue(CONTENT.slice(begin, end));
      else if (end === CONTENT.length) stream.close();
      else stream.error(new Error("reset"));
      this.sent = true;
    },
  });
  return new Response(body, {
    status,
    statusText: status === 500 ? "Internal Server Error" : "",
    headers: { "content-length": left, ...headers.shift() },
  });
};

beforeEach(() => ([asked, waits, headers] = [[], [], []]));

async function fetched(...given) {
  answers = given;
  return new Uint8Array(await new Download("http://host/a.muaavatar").whole(() => {}));
}

test("a connection that breaks often is asked for the rest as long as each time brings more", async () => {
  const often = Array.from({ length: 9 }, (_, i) => [i ? 206 : 200, 10 * i, 10 * i + 10]);
  assert.deepEqual(await fetched(...often, [206, 90, 100]), CONTENT);
  assert.deepEqual(
    asked.slice(1),
    Array.from({ length: 9 }, (_, i) => `bytes=${10 * i + 10}-`),
  );
  assert.deepEqual(new Set(waits), new Set([200]));
});

test("what brings nothing more is given up after three requests", async () => {
  await assert.rejects(fetched([200, 0, 40], [206, 40], [206, 40], [206, 40, 100]), {
    message: "a.muaavatar was not fetched whole: the connection broke after 0.0 MB.",
  });
  assert.deepEqual(waits, [200, 1000]);
});

test("a server that sends all of it again is taken at its word, and given up where it breaks earlier each time", async () => {
  assert.deepEqual(await fetched([200, 0, 40], [200, 0, 100]), CONTENT);
  await assert.rejects(fetched([200, 0, 60], [200, 0, 30], [200, 0, 50], [200, 0, 100]), /was not fetched whole/);
});

test("a server that fails is a sentence with its answer, at first and while the rest is asked for", async () => {
  await assert.rejects(fetched([500]), {
    message: "a.muaavatar cannot be fetched: the server answers 500 Internal Server Error.",
  });
  assert.equal(asked.length, 1);
  await assert.rejects(fetched([404]), { message: "a.muaavatar cannot be fetched: the server answers 404." });
  await assert.rejects(fetched([200, 0, 40], [500]), /the connection broke after 0.0 MB; then the server answers 500/);
});

test("an address that is no text in UTF-8 is named as it is written", async () => {
  answers = [[404]];
  await assert.rejects(
    new Download("http://host/100%.muaavatar").whole(() => {}),
    /^AvatarError: 100%.muaavatar cannot/,
  );
});

test("a server out of reach is a sentence", async () => {
  const { fetch } = globalThis;
  globalThis.fetch = () => Promise.reject(new TypeError("Failed to fetch"));
  await assert.rejects(fetched(), { message: /a.muaavatar cannot be fetched: the server is out of reach/ });
  globalThis.fetch = fetch;
});

for (const [mark, first, then] of [
  ["etag", { etag: "one" }, { etag: "two" }],
  ["last-modified", { "last-modified": "Monday" }, { "last-modified": "Tuesday" }],
  ["length", {}, { "content-length": "50" }],
])
  test(`a file of another ${mark} is not joined to the first part`, async () => {
    headers = [first, then];
    await assert.rejects(fetched([200, 0, 40], [206, 40, 100]), {
      message: "a.muaavatar has changed on the server while it was fetched; load it again.",
    });
    headers = [first, first];
    assert.deepEqual(await fetched([200, 0, 40], [206, 40, 100]), CONTENT);
    await assert.rejects(fetched([200, 0, 40], [416]), /has changed on the server/);
  });

test("a server that sends another part than was asked for is a sentence", async () => {
  headers = [{}, { "content-range": "bytes 30-99/100" }];
  await assert.rejects(fetched([200, 0, 40], [206, 40, 100]), /sends another part of it than was asked for/);
});

test("of a file that is packed on the way nobody knows the length: it is not asked for in parts", async () => {
  headers = [{ "content-encoding": "gzip", "content-length": "30" }];
  await assert.rejects(fetched([200, 0, 40], [206, 40, 100]), /was not fetched whole/);
  assert.equal(asked.length, 1);
  headers = [{ "content-encoding": "gzip", "content-length": "30" }];
  assert.deepEqual(await fetched([200, 0, 100]), CONTENT);
});

test("how far it is is said, of all where that is known", async () => {
  const reported = [];
  for (const given of [{}, { "content-encoding": "br" }]) {
    [answers, headers] = [[[200, 0, 100]], [given]];
    await new Download("http://host/a%20b.muaavatar").whole((...said) => reported.push(said));
  }
  assert.deepEqual(reported, [
    [1, "Fetching a b.muaavatar: 0.0 of 0.0 MB"],
    [0, "Fetching a b.muaavatar: 0.0 MB"],
  ]);
});
