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

test("a component is as it is within its range, and approaches the margin beyond either end", () => {
  const expected = [
    [-1, -1],
    [2, 2],
    [0.5, 0.5],
    [2.5, 2.25],
    [3.5, 2.375],
    [-1.5, -1.25],
    [1e9, 2.5],
    [-1e9, -1.5],
  ];
  assert.equal(expected.length, 8);
  for (const [found, held] of expected)
    assert.ok(Math.abs(read(along([-1, 2, 0.5]), found).held[0] - held) < 1e-8, `${found}`);
});

test("a component without a margin ends with its range", () => {
  const found = [-7, -1, 0, 2, 9].map((value) => read(along([-1, 2, 0]), value).held[0]);
  assert.deepEqual(found, [-1, -1, 0, 2, 2]);
});

test("each component has its own range and margin", () => {
  const encoding = along([-1, 1, 1], [3, 5, 0], [0, 0, 2]);
  assert.deepEqual([...read(encoding, 2, 2, -2).held], [1.5, 3, -1]);
  assert.deepEqual([...read(encoding, -2, 6, 2).held], [-1.5, 5, 1]);
});

test("how far outside is the share that is taken off", () => {
  const encoding = along([-1, 1, 0], [-1, 1, 0]);
  const found = [
    [0, 0],
    [0.6, 0.8],
    [3, 4],
    [4, 0],
    [0, -4],
  ].map((pose) => read(encoding, ...pose).outside);
  assert.deepEqual(found, [0, 0, Math.sqrt(13) / 5, 0.75, 0.75]);
});

test("components are of the normalised descriptor", () => {
  const encoding = {
    mean: Float32Array.of(1, 2, 3),
    scale: Float32Array.of(2, 4, 8),
    directions: Float32Array.of(1, 10, 100, -1, 0, 1),
    ranges: Float32Array.of(-999, -999, 999, 999),
    margins: new Float32Array(2),
  };
  assert.deepEqual([...read(encoding, 3, 10, 27).held], [1 + 20 + 300, -1 + 3]);
});

test("a file may hold more components than a function takes arguments", () => {
  const encoding = {
    ...along([0, 0, 0]),
    directions: new Float32Array(300_000).fill(1),
    ranges: new Float32Array(600_000),
    margins: new Float32Array(300_000),
  };
  assert.equal(read(encoding, 2).outside, 1);
});
