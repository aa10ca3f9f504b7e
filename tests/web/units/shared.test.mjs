// Which players of a page share a device, when it is opened, closed and lost, and who hears of it; the devices are stand-ins.

import assert from "node:assert/strict";
import { beforeEach, mock, test } from "node:test";
import { Device } from "../../../python/mua/web/device.js";
import { giveBack, takeDevice } from "../../../python/mua/web/shared.js";

const LATER = 60_000; // milliseconds

let devices; // that were opened
mock.timers.enable({ apis: ["setTimeout"] });

class FakeDevice {
  destroyed = 0;
  gpu = { destroy: () => (this.destroyed += 1) };
  lose = () => this.listener?.();
  whenLost = (listener) => (this.listener = listener);
}

beforeEach(() => {
  for (const one of devices ?? []) one.lose();
  devices = [];
  Device.open = async () => devices[devices.push(new FakeDevice()) - 1];
});

test("players that begin together and later have one device, which is closed when all have given it back", async () => {
  const [first, second] = await Promise.all([takeDevice(), takeDevice({ background: [0, 0, 0, 1] })]);
  const third = await takeDevice({ powerPreference: "high-performance" });
  assert.deepEqual([devices.length, second === first, third === first], [1, true, true]);
  for (const one of [first, second]) giveBack(one);
  mock.timers.tick(LATER);
  assert.equal(first.destroyed, 0);
  giveBack(third);
  mock.timers.tick(LATER);
  assert.equal(first.destroyed, 1);
  assert.notEqual(await takeDevice(), first);
});

test("a player that begins soon after another one has the same device", async () => {
  const first = await takeDevice();
  giveBack(first);
  mock.timers.tick(100);
  assert.equal(await takeDevice(), first);
  mock.timers.tick(LATER);
  assert.equal(first.destroyed, 0);
});

test("who asks for less power has a device of its own", async () => {
  const [fast, slow] = [await takeDevice(), await takeDevice({ powerPreference: "low-power" })];
  assert.notEqual(fast, slow);
  giveBack(slow);
  mock.timers.tick(LATER);
  assert.deepEqual([fast.destroyed, slow.destroyed], [0, 1]);
});

test("after a loss all players have one other device, and may give back the one that was lost", async () => {
  const first = await takeDevice();
  await takeDevice();
  first.lose({ reason: "unknown" });
  const [again, too] = await Promise.all([takeDevice(), takeDevice()]);
  assert.deepEqual([devices.length, again === too, again === first], [2, true, false]);
  giveBack(first);
  giveBack(again);
  mock.timers.tick(LATER);
  assert.deepEqual([first.destroyed, again.destroyed], [0, 0]);
});

test("a device that does not open is asked for again", async () => {
  const { open } = Device;
  Device.open = () => Promise.reject(new Error("no adapter"));
  for (const asked of [takeDevice(), takeDevice()]) await assert.rejects(asked, { message: "no adapter" });
  Device.open = open;
  assert.equal(await takeDevice(), devices[0]);
});

test("listeners hear once that a device is lost, and later ones at once", async () => {
  globalThis.GPUBufferUsage = {};
  let lose;
  const lost = new Promise((done) => (lose = done));
  const device = new Device({ info: {} }, { lost, features: new Set(), createBuffer: () => ({}) });
  const [reported, gone] = [[], new AbortController()];
  device.whenLost((reason) => reported.push(["stays", reason]));
  device.whenLost((reason) => reported.push(["gone", reason]), gone.signal);
  gone.abort();
  assert.equal(device.losing.size, 1);
  lose({ reason: "unknown" });
  await lost;
  device.whenLost((reason) => reported.push(["later", reason]));
  await null;
  assert.deepEqual(reported, [
    ["stays", "unknown"],
    ["later", "unknown"],
  ]);
});
