// All avatars' splats together: the dispatches from posed texels to the splats that are seen, back to front, a plain list in
// the order of the kernels. Reference: python/mua/player/splats.py.

import { sees } from "./camera.js";
import { FLOAT, groups } from "./channels.js";
import { AvatarError } from "./error.js";
import { kernelsOf } from "./kernel.js";
import { splatCorners } from "./level_choice.js";
import { SplatProject } from "./wgsl/splat_project.js";
import { CountDigits, ScanDigits, ScatterDigits } from "./wgsl/splat_sort.js";

/** @typedef {import("./frame.js").AvatarFrame} AvatarFrame */
/** @typedef {import("./camera.js").Camera} Camera */

const MOST_SPLATS = (1 << 24) - 1; // distinct indices of the sort's elements, less the one that means none
const SPLAT_WORDS = 8;
const PROJECTED = 256; // texels of a group of SplatProject
const SORTED = 2048; // keys of a group of the sort
const DIGITS = 256; // values of 8 bits
const SCANNED = 16; // digits of a group of ScanDigits
const ARGUMENTS = 5; // words: of the draw, and how many splats are seen
export const PROJECTING = { SplatProject };
export const SORTING = { ScatterDigits, CountDigits, ScanDigits };

const even = (/** @type {number} */ count) => count + (count % 2);

/** The box that splats may reach: half a diagonal beyond, as far as SplatProject keys their depth. */
export function reach(/** @type {number[]} */ box) {
  const spare = Math.hypot(...[0, 1, 2].map((axis) => box[3 + axis] - box[axis])) / 2;
  return box.map((value, i) => value + (i < 3 ? -spare : spare));
}

/**
 * One sort for all avatars in view, so that those that stand among each other blend rightly. Those out of view are neither
 * projected nor sorted; their splats' places lie behind the others'.
 */
export class SplatFrame {
  constructor(/** @type {import("./device.js").Memory} */ memory, /** @type {AvatarFrame[]} */ avatars) {
    this.avatars = avatars;
    this.seen = avatars.map(() => true); // by the last sort
    this.corners = 6; // vertices of a splat, by the last sort
    const finest = avatars.map((avatar) => even(avatar.buffers.level(0).splatCount));
    const count = finest.reduce((all, one) => all + one, 0);
    if (count > MOST_SPLATS) throw new AvatarError(`${count} splats of all avatars; expected at most ${MOST_SPLATS}`);
    this.kernels = kernelsOf(memory.device, { ...PROJECTING, ...SORTING });
    this.splats = memory.buffer(4 * SPLAT_WORDS * count, "splats");
    this.keys = memory.buffer((FLOAT * count) / 2, "keys");
    this.digitCounts = memory.buffer(FLOAT * DIGITS * groups(count, SORTED), "digit_counts");
    this.digitTotals = memory.buffer(FLOAT * DIGITS, "digit_totals");
    this.arguments = memory.buffer(FLOAT * ARGUMENTS, "arguments", GPUBufferUsage.INDIRECT);
    this.halfSorted = memory.buffer(FLOAT * count, "half_sorted");
    this.order = memory.buffer(FLOAT * count, "order");
  }

  /** Where the splats of each avatar begin, of those in view before the others: even numbers. */
  get starts() {
    const starts = new Array(this.avatars.length).fill(0);
    let next = 0;
    for (const wanted of [true, false])
      this.avatars.forEach((avatar, i) => {
        if (this.seen[i] !== wanted) return;
        starts[i] = next;
        next += even(avatar.splatCount);
      });
    return starts;
  }

  /** Splats of the avatars that the last sort found in view. */
  get sortedCount() {
    return this.avatars.reduce((all, avatar, i) => all + (this.seen[i] ? even(avatar.splatCount) : 0), 0);
  }

  /** Append the dispatches from posed texels to `order`, the splats that one or two eyes see, back to front. */
  sort(/** @type {GPUComputePassEncoder} */ pass, /** @type {Camera[]} */ cameras) {
    this.projectAll(pass, cameras);
    this.sortDigit(pass, this.keys, this.halfSorted, 0);
    this.sortDigit(pass, this.halfSorted, this.order, 1);
  }

  /** Append the dispatches from posed texels to splats and `keys`. */
  projectAll(/** @type {GPUComputePassEncoder} */ pass, /** @type {Camera[]} */ cameras) {
    this.seen = this.avatars.map(
      ({ places, bounds }) => places.length > 0 && cameras.some((camera) => sees(camera, reach(bounds))),
    );
    const boxes = this.avatars.filter((_, i) => this.seen[i]).map(({ bounds }) => bounds);
    this.corners = splatCorners(boxes, this.sortedCount, cameras);
    const { starts } = this;
    this.avatars.forEach((avatar, i) => {
      if (this.seen[i]) this.project(pass, avatar, starts[i], cameras);
    });
  }

  /** World box of what was posed last, of the avatars in view: lowest then highest corner, metres. */
  box() {
    const boxes = this.avatars.filter((_, i) => this.seen[i]).map((avatar) => avatar.bounds);
    return [0, 1, 2, 3, 4, 5].map((i) => (i < 3 ? Math.min : Math.max)(...boxes.map((box) => box[i])));
  }

  /** @param {GPUComputePassEncoder} pass @param {AvatarFrame} avatar @param {number} firstSplat @param {Camera[]} cameras */
  project(pass, avatar, firstSplat, cameras) {
    const box = this.box();
    const [left, right = left] = cameras;
    this.kernels.SplatProject.dispatch(
      pass,
      [groups(avatar.splatCount, PROJECTED), 1, 1],
      {
        mesh: avatar.shown.mesh,
        faces: avatar.buffers.faces,
        texels: avatar.shown.level.texels,
        texel_channels: avatar.shown.texelChannels,
        vertex_dq: avatar.vertexDq,
        splats: this.splats,
        keys: this.keys,
      },
      {
        view: [...left.view, ...right.view],
        projection: [...left.projection, ...right.projection],
        bounds_low: [...box.slice(0, 3), 1], // at the size that it was baked with
        bounds_high: [...box.slice(3), 1],
        screen: left.screen,
        near: left.near,
        eyes: cameras.length,
        texel_count: avatar.splatCount,
        first_splat: firstSplat,
      },
    );
  }

  /** One pass of the sort, from the splats' keys to elements, or from those to the order. @param {GPUComputePassEncoder} pass @param {GPUBuffer} keys @param {GPUBuffer} sorted @param {number} second_pass */
  sortDigit(pass, keys, sorted, second_pass) {
    const count = this.sortedCount;
    const blocks = [Math.max(groups(count, SORTED), 1), 1, 1]; // the first one writes the draw's arguments
    const counts = { digit_counts: this.digitCounts, arguments: this.arguments };
    const totals = { ...counts, digit_totals: this.digitTotals };
    const constants = { second_pass, key_count: count, instances: 1, corners: this.corners };
    this.kernels.CountDigits.dispatch(pass, blocks, { keys, ...counts }, constants);
    this.kernels.ScanDigits.dispatch(pass, [DIGITS / SCANNED, 1, 1], totals, constants);
    this.kernels.ScatterDigits.dispatch(pass, blocks, { keys, ...totals, sorted }, constants);
  }
}
