// The dispatches that the browser player makes of a file, in order: dispatches.mjs FILE CAMERAS, as JSON.
// A frame decoded at once and posed; then the next one in parts, at the coarsest level; each sorted for the cameras.

import { readFileSync } from "node:fs";
import { window } from "../../python/mua/web/clip.js";
import { read } from "../../python/mua/web/format/read.js";
import { fakeGpu } from "./units/gpu.mjs";

const { Device, Memory } = await import("../../python/mua/web/device.js");
const { Kernel } = await import("../../python/mua/web/kernel.js");
const { AvatarBuffers } = await import("../../python/mua/web/buffers.js");
const { Expressing } = await import("../../python/mua/web/expressing.js");
const { AvatarFrame } = await import("../../python/mua/web/frame.js");
const { SplatFrame } = await import("../../python/mua/web/splats.js");

const [file, eyes] = process.argv.slice(2);
const avatar = await read(Uint8Array.from(readFileSync(file)).buffer);
const cameras = JSON.parse(eyes);
const known = new Map(); // buffers by the order in which they are first bound
const numbered = (buffer) => known.get(buffer) ?? (known.set(buffer, known.size), known.size - 1);
const list = (value) => (typeof value === "number" ? value : Array.from(value));

Kernel.prototype.dispatch = function (_, groups, buffers, constants) {
  const { entry, buffers: slots, constants: read } = this.bindings.shader;
  const bound = Object.fromEntries(slots.map(({ name }) => [name, numbered(buffers[name])]));
  const given = Object.fromEntries(read.map(({ name }) => [name, list(constants[name] ?? [])]));
  process.stdout.write(`${JSON.stringify({ entry, groups, bound, given })}\n`);
};

const memory = new Memory(new Device({ info: {} }, fakeGpu()));
const frame = new AvatarFrame(new AvatarBuffers(memory, avatar, Expressing));
const splats = new SplatFrame(memory, [frame]);
const at = (index) => window(avatar.skeleton, avatar.clips[0], index, avatar.encoding);
frame.decode("pass", at(1), 0);
frame.repose("pass", at(1)[0], [0.5, 0, -1]);
splats.sort("pass", cameras.slice(0, 1));
frame.begin(at(2), avatar.texels.levels.length);
while (frame.partsLeft) frame.advance("pass");
frame.show();
frame.repose("pass", at(2)[0], [0, 0, 0]);
splats.sort("pass", cameras);
