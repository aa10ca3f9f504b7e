// What the networks read of a descriptor, and how far outside of training it is.

import assert from "node:assert/strict";
import { test } from "node:test";
import { readComponents } from "../../../python/mua/web/components.js";

/** Components along the axes, each of a range and with a margin. */
function along(...parts) {
  const count = parts.length;
  return {
    mean: new Float32Array(count),
    scale: new Float32Array(count).fill(1),
    directions: Float32Array.from({ length: count * count }, (_, at) => Number(at % (count + 1) === 0)),
    ranges: Float32Array.from([...parts.map(([low]) => low), ...parts.map(([, high]) => high)]),
    margins: Float32Array.from(parts, ([, , margin]) => margin),
  };
}

const read = (encoding, ...numbers) => readComponents(encoding, Float64Array.from(numbers));

test("a file may hold more components than a function takes arguments", () => {
  const encoding = {
    ...along([0, 0, 0]),
    directions: new Float32Array(300_000).fill(1),
    ranges: new Float32Array(600_000),
    margins: new Float32Array(300_000),
  };
  assert.equal(read(encoding, 2).outside, 1);
});
