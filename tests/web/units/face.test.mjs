// Weights that a page sets by names of its own, and what of the avatar follows.

import assert from "node:assert/strict";
import { test } from "node:test";
import { Face } from "../../../python/mua/web/names/face.js";

const VRM = ["aa", "oh", "blink", "Smoking"];
const [A, O, BLINK, SMOKING] = [0, 1, 2, 3];
const STILL = Number.NaN;

/** The weights after some are set in turn. */
function after(names, ...given) {
  const face = new Face(names);
  const weights = given.map((one) => face.set(one)).at(-1);
  return weights && Array.from(weights, (weight) => Math.round(1e6 * weight) / 1e6);
}

test("weights by the avatar's names stay until all are forgotten", () => {
  assert.deepEqual(after(VRM, { aa: 0.25 }, { Smoking: 1 }), [0.25, STILL, STILL, 1]);
  assert.deepEqual(after(VRM, { aa: 0.25 }, { aa: 0 }), [0, STILL, STILL, STILL]);
  assert.equal(after(VRM, { aa: 0.25 }, null), null);
  assert.deepEqual(after(VRM, { aa: 0.25 }, null, { oh: 1 }), [STILL, 1, STILL, STILL]);
  assert.equal(after(VRM, {}), null);
});

test("a tracker's names move what the avatar has", () => {
  const weights = after(VRM, { jawOpen: 0.6, cheekPuff: 1 }, { eyeBlinkLeft: 1, eyeBlink_R: 0.5, mouthClose: 0.2 });
  assert.deepEqual(weights, [0.4, STILL, 0.75, STILL]);
  assert.deepEqual(
    after(VRM, { viseme_aa: 0.5, jawOpen: 1 }),
    [0.5, STILL, STILL, STILL],
    "the jaw is not opened twice",
  );
  assert.deepEqual(after(VRM, { jawOpen: 1 }, { aa: 0.2 }), [0.2, STILL, STILL, STILL], "its own name goes first");
});

test("weights are held to 0 to 1", () => {
  assert.deepEqual(after(VRM, { aa: -3, oh: 3, mouthFunnel: 1 }), [0, 1, STILL, STILL]);
  assert.deepEqual(after(VRM, { mouthClose: 1 }), [0, STILL, STILL, STILL]);
});

test("what is wrong is a sentence, and changes nothing", () => {
  const face = new Face(VRM);
  const says = (message) => ({ name: "AvatarError", message: `setExpressions: ${message}.` });
  const wink = 'the avatar has no expression "wink", only aa, oh, blink, Smoking';
  assert.throws(() => face.set({ aa: 1, wink: 1 }), says(wink));
  assert.throws(() => face.set({ oh: 1, jawOpen: NaN }), says("jawOpen: expected a finite number, found NaN"));
  assert.equal(face.set({}), null);
  assert.ok(face.set({ oh: 1 })[A] !== 1);
  assert.deepEqual(
    [O, BLINK, SMOKING].map((row) => face.set({})[row]),
    [1, STILL, STILL],
  );
});
