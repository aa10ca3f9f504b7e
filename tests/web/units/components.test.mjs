// What the networks read of a descriptor, of more components than a function takes arguments.

import assert from "node:assert/strict";
import { test } from "node:test";
import { readComponents } from "../../../python/mua/web/components.js";

test("a file may hold more components than a function takes arguments", () => {
  const encoding = {
    mean: new Float32Array(1),
    scale: Float32Array.of(1),
    directions: new Float32Array(300_000).fill(1),
    ranges: new Float32Array(600_000),
    margins: new Float32Array(300_000),
  };
  assert.equal(readComponents(encoding, Float64Array.of(2)).outside, 1);
});
