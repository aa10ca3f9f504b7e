// What is said of a file that is no avatar.

import assert from "node:assert/strict";
import { readFileSync } from "node:fs";
import { test } from "node:test";
import { loadHere } from "../../../python/mua/web/load.js";

const sound = Uint8Array.from(readFileSync(new URL("../../golden/synthetic.muaavatar", import.meta.url)));
const load = (content, name) => loadHere(name ? new File([content], name) : new Blob([content]), () => {});

for (const [what, content, said] of [
  ["a page", "\n<!doctype html><title>Not found</title>", "this is a web page and not an avatar; is its address right?"],
  ["another file", "PK\x03\x04 and the rest of it", "this is not an avatar; expected a .muaavatar file."],
  ["two bytes", "no", "the file has 2 bytes, too few for a .muaavatar"],
])
  test(`${what} is said in a sentence that names the file and no bytes`, async () => {
    await assert.rejects(load(content, "hero.muaavatar"), { name: "AvatarError", message: `hero.muaavatar: ${said}` });
    await assert.rejects(load(content), { message: said });
  });

test("an avatar that is damaged is said so, with the code of the fault", async () => {
  const damaged = sound.slice();
  damaged[damaged.length >> 1] ^= 255;
  await assert.rejects(load(damaged, "a.muaavatar"), ({ code, message }) => code !== "" && message.startsWith("a.muaavatar: ") && /damaged/.test(message));
  assert.equal((await load(sound, "a.muaavatar")).clips.length, 1);
});
