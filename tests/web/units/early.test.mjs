// Pictures whose splats the processor sorts, with a stand-in for the device.

import assert from "node:assert/strict";
import { test } from "node:test";
import { readOrder, writeOrder } from "../../../python/mua/web/early.js";
import { Renderer } from "../../../python/mua/web/renderer.js";

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
    ["arguments", [18, 1, 0, 0, 3]],
  ]);
});

/** A renderer that draws an early picture while `change` happens to it; how many pictures that makes. */
async function drawnEarly(change) {
  const { device, splats } = deviceWith([3, 1], { lost: change === "lost" });
  device.gpu.queue.onSubmittedWorkDone = async () => {};
  const renderer = {
    device,
    splats: { ...splats, projectAll: () => {} },
    canvas: { width: 40, height: 30 },
    projecting: Promise.resolve(),
  };
  let pictures = 0;
  Object.assign(renderer, {
    compute: () => {},
    pose: () => {},
    send: () => {},
    compile: async () => {},
    context: { getCurrentTexture: () => 0 },
    scene: { draw: () => (pictures += 1) },
  });
  const { copyBufferToBuffer: copy } = device.gpu.createCommandEncoder();
  const create = device.gpu.createCommandEncoder;
  device.gpu.createCommandEncoder = () => ({
    ...create(),
    copyBufferToBuffer: (...given) => (copy(...given), change.call?.(0, renderer)),
  });
  const look = {
    camera: { azimuth: 0, elevation: 0, distance: 3, target: [0, 0, 0], fov: 0.5 },
    stereo: false,
    show: {},
  };
  await Renderer.prototype.drawEarly.call(renderer, [], look);
  return pictures;
}

for (const [what, change, pictures] of [
  ["nothing", () => {}, 1],
  ["the avatars", (renderer) => (renderer.splats = { ...renderer.splats }), 0],
  ["the canvas' width", (renderer) => (renderer.canvas.width = 41), 0],
  ["the canvas' height", (renderer) => (renderer.canvas.height = 31), 0],
  ["the device, which is lost", "lost", 0],
])
  test(`where ${what} has changed meanwhile, so many pictures are drawn: ${pictures}`, async () => {
    assert.equal(await drawnEarly(change), pictures);
  });
