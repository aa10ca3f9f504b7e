// What is shown beside the splats: template and cast shadow, and the anatomy once it is asked for. Reference:
// python/mua/player/overlays.py.

import { frameBox, margin } from "./bounds.js";
import { framesAt, sample } from "./clip.js";
import { Pipeline } from "./kernel.js";
import { GroundFrag, GroundVert, ShadowFrag, ShadowVert } from "./wgsl/shadow.js";
import { TemplateFrag, TemplateVert } from "./wgsl/template.js";

/** @typedef {import("./device.js").Device} Device */
/** @typedef {import("./device.js").Memory} Memory */
/** @typedef {import("./camera.js").Camera} Camera */
/** @typedef {import("./frame.js").AvatarFrame} AvatarFrame */
/** @typedef {{buffer: GPUBuffer, count: number}} Indices */
/** @typedef {{color: GPUTextureFormat, depth: GPUTextureFormat}} Formats of what is drawn on */

const TEMPLATE_COLOR = [0.62, 0.72, 0.84, 1]; // sRGB
const LIGHT = [-0.35, -1, -0.45]; // from above, the character's left and front
const DARKNESS = 0.45; // of the ground in full shadow
const MASK_SIZE = 128; // samples along the shadow's square: its edge is as soft as two of them
const MASK_ROW = 256; // bytes from one row of samples to the next, MASK_ROW of surface_draw.hlsl
const GROUND_FRAMES = 32; // of a clip, in which the lowest point is sought
const BELOW_GROUND = 0.1; // of these that may reach below it
const MARGIN = 0.06; // of its size round the shadow

/** @type {typeof import("./anatomy.js") | null} */
let fetched = null;

/** Whether all is there that draws these. */
export const isThereFor = (/** @type {import("./player.js").Show} */ { geometry, skeleton }) =>
  fetched !== null || !(geometry || skeleton);

/** Fetch what draws geometry and skeletons, of all avatars of the page. */
export async function fetchAnatomy() {
  fetched = await import("./anatomy.js");
}

/** The pipelines of all overlays for targets of these formats. */
function pipelines(/** @type {Device} */ device, /** @type {Formats} */ { color, depth }) {
  const strip = /** @type {GPUPrimitiveTopology} */ ("triangle-strip");
  return {
    template: new Pipeline(device, TemplateVert, TemplateFrag, { color, depth, write: true }),
    shadow: new Pipeline(device, ShadowVert, ShadowFrag, { color: "r8unorm" }),
    ground: new Pipeline(device, GroundVert, GroundFrag, { color, depth, blend: true, topology: strip }),
  };
}

/** Draws around the splats of one avatar. */
export class Overlays {
  /** @type {import("./anatomy.js").Anatomy | null} */
  #anatomy = null;

  /** @param {Memory} memory @param {AvatarFrame} frame @param {Formats} formats */
  constructor(memory, frame, formats) {
    const { avatar } = frame.buffers;
    const { device } = memory;
    this.memory = memory;
    this.frame = frame;
    this.formats = formats;
    this.pipelines = device.once("overlays", () => pipelines(device, formats));
    this.bare = avatar.texels.texels.length === 0; // without splats: its template is shown in their place
    this.template = indices(memory, avatar.template.faces, "template");
    this.mask = memory.buffer(MASK_SIZE * MASK_ROW, "mask");
    this.maskTexture = memory.texture([MASK_SIZE, MASK_SIZE], "r8unorm", GPUTextureUsage.COPY_SRC);
    this.area = [0, 0, 1, 0];
  }

  /** Follow the pose that the frame decoded; `ground` is the height on which the shadow falls, metres. */
  pose(/** @type {number} */ ground) {
    this.#anatomy?.pose();
    this.area = shadowArea(this.frame.bounds, ground);
  }

  /** Draw the posed template along the light on to the ground, into the mask that `drawGround` reads. */
  drawMask(/** @type {GPUCommandEncoder} */ encoder) {
    const pass = encoder.beginRenderPass({
      colorAttachments: [{ view: this.maskTexture.createView(), loadOp: "clear", storeOp: "store" }],
    });
    this.pipelines.shadow.bind(pass, this.posed(), { light: [...LIGHT, DARKNESS], area: this.area });
    drawIndexed(pass, this.template);
    pass.end();
    const layout = { bytesPerRow: MASK_ROW, rowsPerImage: MASK_SIZE };
    encoder.copyTextureToBuffer({ texture: this.maskTexture }, { buffer: this.mask, ...layout }, [
      MASK_SIZE,
      MASK_SIZE,
    ]);
  }

  posed() {
    return { vertex_dq: this.frame.vertexDq, mesh: this.frame.shown.mesh };
  }

  /** Darken the ground by the mask. */
  drawGround(/** @type {GPURenderPassEncoder} */ pass, /** @type {Camera} */ { viewProjection: view_projection }) {
    const constants = { view_projection, light: [...LIGHT, DARKNESS], area: this.area, size: MASK_SIZE };
    this.pipelines.ground.bind(pass, { mask: this.mask }, constants);
    pass.draw(4);
  }

  /** Draw the texels as a lit mesh, where the file holds their triangles. @param {GPURenderPassEncoder} pass @param {Camera} camera @param {GPUBuffer} splats @param {number} firstSplat */
  drawGeometry(pass, camera, splats, firstSplat) {
    this.anatomy?.drawGeometry(pass, camera, splats, firstSplat);
  }

  /** Draw the posed template with flat shading. */
  drawTemplate(/** @type {GPURenderPassEncoder} */ pass, /** @type {Camera} */ camera) {
    this.pipelines.template.bind(pass, this.posed(), lit(camera, TEMPLATE_COLOR));
    drawIndexed(pass, this.template);
  }

  /** Draw bones and joints over all that is there. */
  drawSkeleton(/** @type {GPURenderPassEncoder} */ pass, /** @type {Camera} */ camera) {
    this.anatomy?.drawSkeleton(pass, camera);
  }

  get anatomy() {
    if (fetched) this.#anatomy ??= new fetched.Anatomy(this.memory, this.frame, this.formats);
    return this.#anatomy;
  }
}

/** @param {Memory} memory @param {ArrayBufferView & {length: number}} triangles @param {string} label @returns {Indices} */
export function indices(memory, triangles, label) {
  return { buffer: memory.buffer(triangles, label, GPUBufferUsage.INDEX), count: triangles.length };
}

export function lit(/** @type {Camera} */ { viewProjection, position }, /** @type {number[]} */ color) {
  return { view_projection: viewProjection, camera: [...position, 1], color };
}

export function drawIndexed(/** @type {GPURenderPassEncoder} */ pass, /** @type {Indices} */ { buffer, count }) {
  pass.setIndexBuffer(buffer, "uint32");
  pass.drawIndexed(count);
}

/** Where the character stands in a clip, metres: its lowest point, but for a few frames. @param {import("./format/read.js").Avatar} avatar @param {import("./format/read.js").Clip} clip */
export function groundHeight(avatar, clip) {
  const { rate } = avatar.encoding;
  const last = framesAt(clip, rate) - 1;
  const frames = Array.from({ length: GROUND_FRAMES }, (_, i) => Math.floor((last * i) / (GROUND_FRAMES - 1)));
  const lows = [...new Set(frames)].map((frame) => frameBox(avatar, sample(avatar.skeleton, clip, frame, rate))[1]);
  return quantile(lows, BELOW_GROUND) + margin(avatar);
}

function quantile(/** @type {number[]} */ values, /** @type {number} */ share) {
  const sorted = values.toSorted((a, b) => a - b);
  const at = share * (sorted.length - 1);
  const below = sorted[Math.floor(at)];
  return below + (at - Math.floor(at)) * (sorted[Math.ceil(at)] - below);
}

/** The square on the ground that holds the shadow of a box: lowest x and z, side, height; metres. */
export function shadowArea(/** @type {number[]} */ box, /** @type {number} */ ground) {
  const places = Array.from({ length: 8 }, (_, corner) => {
    const [x, y, z] = [0, 1, 2].map((axis) => box[corner & (1 << axis) ? 3 + axis : axis]);
    const fallen = (y - ground) / LIGHT[1];
    return [x - LIGHT[0] * fallen, z - LIGHT[2] * fallen];
  });
  const low = [0, 1].map((axis) => Math.min(...places.map((place) => place[axis])));
  const high = [0, 1].map((axis) => Math.max(...places.map((place) => place[axis])));
  const side = Math.max(high[0] - low[0], high[1] - low[1]) * (1 + 2 * MARGIN);
  return [(low[0] + high[0] - side) / 2, (low[1] + high[1] - side) / 2, side, ground];
}
