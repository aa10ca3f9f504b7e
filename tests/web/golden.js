// Dispatches golden cases by the player's own device and kernels, in the browser's WGSL compiler.

import { synthesis, upsampler } from "./channels.js";
import { Device } from "./device.js";
import { kernelsOf } from "./kernel.js";

const device = await Device.open();
device.gpu.onuncapturederror = ({ error }) => console.error(error.message);

/** Kernels as the player makes them: with as much shared memory as the constants ask for. */
const MADE = {
  InverseDwt: ({ taps }) => synthesis(device, Number(taps)),
  UpsampleTexels: ({ factor, reach }) => upsampler(device, { factor: Number(factor), reach: Number(reach) }),
};

/** The words of the writable buffers after a case of a kernel's file, as base64 by name. */
globalThis.replay = async (stem, number) => {
  const [document, binary, shaders] = await Promise.all([
    fetch(`golden/${stem}.json`).then((answer) => answer.json()),
    fetch(`golden/${stem}.bin`).then((answer) => answer.arrayBuffer()),
    import(`./wgsl/${stem}.js`),
  ]);
  const golden = document.cases[number];
  const given = Object.fromEntries(golden.buffers.map((described) => [described.name, upload(described, binary)]));
  const constants = Object.fromEntries(golden.constants.map(({ name, values }) => [name, values]));
  const kernel = MADE[golden.entry]?.(constants) ?? kernelsOf(device, { kernel: shaders[golden.entry] }).kernel;
  const encoder = device.gpu.createCommandEncoder();
  const pass = encoder.beginComputePass();
  kernel.dispatch(pass, golden.groups, given, constants);
  pass.end();
  device.uniforms.upload();
  device.gpu.queue.submit([encoder.finish()]);
  const written = shaders[golden.entry].buffers.filter((slot) => !slot.read_only);
  const found = await Promise.all(written.map(async ({ name }) => [name, await download(given[name])]));
  device.free(Object.values(given));
  return Object.fromEntries(found);
};

const wordsOf = (element) => (/\d$/.test(element) ? Number(element.at(-1)) : 1);

function upload({ name, count, element, offset }, binary) {
  return device.buffer(new Uint32Array(binary, offset, count * wordsOf(element)), name);
}

async function download(buffer) {
  const copy = device.gpu.createBuffer({ size: buffer.size, usage: GPUBufferUsage.MAP_READ | GPUBufferUsage.COPY_DST });
  const encoder = device.gpu.createCommandEncoder();
  encoder.copyBufferToBuffer(buffer, 0, copy, 0, buffer.size);
  device.gpu.queue.submit([encoder.finish()]);
  await copy.mapAsync(GPUMapMode.READ);
  const bytes = new Uint8Array(copy.getMappedRange().slice(0));
  copy.destroy();
  return btoa(Array.from(bytes, (byte) => String.fromCharCode(byte)).join(""));
}
