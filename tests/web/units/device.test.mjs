// What a device holds and how constants reach it.

import assert from "node:assert/strict";
import { test } from "node:test";
import { fakeGpu } from "./gpu.mjs";

const { Device, Memory } = await import("../../../python/mua/web/device.js");
const deviceOf = (gpu) => new Device({ info: { vendor: "maker", architecture: "", description: "" } }, gpu);

test("what buffers hold is counted until they are freed, once", () => {
  const gpu = fakeGpu();
  const device = deviceOf(gpu);
  const before = gpu.held.size; // the constants
  const memory = new Memory(device);
  memory.buffer(20, "a");
  memory.buffer(Float32Array.of(1, 2), "b");
  memory.texture([4, 4], "r8unorm");
  assert.deepEqual([memory.bytes, gpu.held.size - before], [48, 3]);
  memory.free();
  memory.free();
  assert.deepEqual([memory.bytes, gpu.held.size - before], [0, 0]);
});

test("a buffer that the device cannot bind is a sentence", () => {
  const device = deviceOf(fakeGpu({ most: 64 }));
  assert.equal(device.buffer(64, "small").size, 64);
  assert.throws(() => device.buffer(65, "basis"), {
    name: "AvatarError",
    message: "basis: 80 bytes are more than the 64 that this device can bind.",
  });
});

test("all of an array reaches a buffer, also where it ends within a word", () => {
  const gpu = fakeGpu();
  deviceOf(gpu).buffer(Uint8Array.of(9, 1, 2, 3, 4, 5, 6).subarray(1), "bytes");
  const bytes = new Uint8Array(8);
  for (const [, at, source, from = 0, size = source.byteLength] of gpu.written)
    bytes.set(new Uint8Array(source.buffer ?? source, from, size), at);
  assert.deepEqual([...bytes], [1, 2, 3, 4, 5, 6, 0, 0]);
});

test("constants of a thousand dispatches reach the device, those that wait when the ring begins again too", () => {
  const gpu = fakeGpu();
  const { uniforms } = deviceOf(gpu);
  const held = new Uint8Array(1 << 18);
  const packer = { size: 16, pack: (view, at, value) => view.setUint32(at, value) };
  const places = Array.from({ length: 1500 }, (_, i) => {
    const at = uniforms.place(packer, i + 1);
    if (i % 400 === 399 || i === 1499) uniforms.upload();
    for (const [, to, source, from, size] of gpu.written.splice(0)) held.set(new Uint8Array(source, from, size), to);
    return at;
  });
  const view = new DataView(held.buffer);
  const last = places.slice(-1000);
  assert.deepEqual(
    last.map((at) => view.getUint32(at)),
    last.map((_, i) => 501 + i),
  );
  assert.ok(places.every((at) => at % 256 === 0 && at + 16 <= held.length));
});

test("a device is called as the browser describes it, or by its maker", () => {
  assert.equal(deviceOf(fakeGpu()).name, "maker");
  assert.equal(
    new Device({ info: { vendor: "maker", architecture: "x", description: "Card" } }, fakeGpu()).name,
    "Card",
  );
});

test("where there is no WebGPU, a page that is not secure is told that this is why", async () => {
  const { createPlayer } = await import("../../../python/mua/web/player.js");
  await assert.rejects(createPlayer({}), { name: "AvatarError", message: /no WebGPU/ });
  globalThis.isSecureContext = false;
  await assert.rejects(createPlayer({}), { name: "AvatarError", message: /only to pages opened by https/ });
});
