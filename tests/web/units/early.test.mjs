// Pictures whose splats the processor sorts, with a stand-in for the device.

import assert from "node:assert/strict";
import { test } from "node:test";
import { readOrder, writeOrder } from "../../../python/mua/web/early.js";

globalThis.GPUBufferUsage = { MAP_READ: 1, COPY_DST: 8 };
globalThis.GPUMapMode = { READ: 1 };

/** A device whose buffers hold these keys; a lost one maps nothing. */
function deviceWith(keys, { lost = false } = {}) {
  const noted = { written: [], made: [] };
  const gpu = {
    queue: { submit: () => {} },
    createBuffer(given) {
      const made = { ...given, destroyed: 0, destroy: () => (made.destroyed += 1) };
      made.mapAsync = async () => {
        if (lost) throw new Error("lost");
      };
      made.getMappedRange = () => made.content;
      noted.made.push(made);
      return made;
    },
    createCommandEncoder: () => ({
      copyBufferToBuffer: (from, first, to, _at, size) => (to.content = from.slice(first, first + size)),
      finish: () => 0,
    }),
  };
  const splats = {
    keys: Uint16Array.from(keys).buffer,
    sortedCount: keys.length,
    order: "order",
    arguments: "arguments",
    corners: 3,
  };
  return {
    device: { gpu, write: (buffer, content) => noted.written.push([buffer, Array.from(content)]) },
    splats,
    noted,
  };
}

test("splats are read and put in order, hidden ones left out, and the buffer is given back", async () => {
  const { device, splats, noted } = deviceWith([5, 0xffff, 2, 5]);
  assert.deepEqual(Array.from(await readOrder(device, splats)), [2, 0, 3]);
  assert.deepEqual(
    noted.made.map(({ size, destroyed }) => [size, destroyed]),
    [[8, 1]],
  );
});

test("a device that is lost meanwhile has no order", async () => {
  const { device, splats, noted } = deviceWith([1, 2], { lost: true });
  assert.equal(await readOrder(device, splats), null);
  assert.equal(noted.made[0].destroyed, 1);
});

test("the device draws as many splats as are in order", () => {
  const { device, splats, noted } = deviceWith([5, 0xffff, 2, 5]);
  writeOrder(device, splats, Uint32Array.of(2, 0, 3));
  assert.deepEqual(noted.written, [
    ["order", [2, 0, 3]],
    ["arguments", [9, 1, 0, 0, 3]],
  ]);
});
