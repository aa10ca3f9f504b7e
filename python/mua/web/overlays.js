// What is shown beside the splats: detailed geometry, template, skeleton, cast shadow. Reference:
// python/mua/player/overlays.py.

import { frameBox, margin } from "./bounds.js";
import { framesAt, sample } from "./clip.js";
import { Pipeline } from "./kernel.js";
import { surfaceMesh } from "./surface.js";
import { GroundFrag, GroundVert, ShadowFrag, ShadowVert } from "./wgsl/shadow.js";
import { StrokeFrag, StrokeVert } from "./wgsl/skeleton.js";
import { SurfaceFrag, SurfaceVert } from "./wgsl/surface.js";
import { TemplateFrag, TemplateVert } from "./wgsl/template.js";

/** @typedef {import("./device.js").Device} Device */
/** @typedef {import("./device.js").Memory} Memory */
/** @typedef {import("./camera.js").Camera} Camera */
/** @typedef {import("./frame.js").AvatarFrame} AvatarFrame */
/** @typedef {{buffer: GPUBuffer, count: number}} Indices */

const GEOMETRY_COLOR = [0.8, 0.78, 0.75, 1]; // sRGB
const TEMPLATE_COLOR = [0.62, 0.72, 0.84, 1];
const BONE_COLOR = [0.98, 0.62, 0.12, 1];
const JOINT_COLOR = [1, 0.97, 0.9, 1];
const OUTLINE_COLOR = [0.12, 0.1, 0.08, 1];
const [BONE_WIDTH, JOINT_WIDTH, OUTLINE] = [2.5, 5, 1.5]; // pixels
const LIGHT = [-0.35, -1, -0.45]; // from above, the character's left and front
const DARKNESS = 0.45; // of the ground in full shadow
const MASK_SIZE = 128; // samples along the shadow's square: its edge is as soft as two of them
const MASK_ROW = 256; // bytes from one row of samples to the next, MASK_ROW of surface_draw.hlsl
const GROUND_FRAMES = 32; // of a clip, in which the lowest point is sought
const BELOW_GROUND = 0.1; // of these that may reach below it
const MARGIN = 0.06; // of its size round the shadow

/** The pipelines of all overlays for targets of one format. */
function pipelines(
  /** @type {Device} */ device,
  /** @type {GPUTextureFormat} */ color,
  /** @type {GPUTextureFormat} */ depth,
) {
  const opaque = { color, depth, write: true };
  const strip = /** @type {GPUPrimitiveTopology} */ ("triangle-strip");
  return {
    surface: new Pipeline(device, SurfaceVert, SurfaceFrag, opaque),
    template: new Pipeline(device, TemplateVert, TemplateFrag, opaque),
    shadow: new Pipeline(device, ShadowVert, ShadowFrag, { color: "r8unorm" }),
    ground: new Pipeline(device, GroundVert, GroundFrag, { color, depth, blend: true, topology: strip }),
    stroke: new Pipeline(device, StrokeVert, StrokeFrag, { color, depth, blend: true, always: true }),
  };
}

/** Draws around the splats of one avatar. */
export class Overlays {
  constructor(
    /** @type {Memory} */ memory,
    /** @type {AvatarFrame} */ frame,
    /** @type {{color: GPUTextureFormat, depth: GPUTextureFormat}} */ { color, depth },
  ) {
    const { avatar } = frame.buffers;
    const { device } = memory;
    this.memory = memory;
    this.frame = frame;
    this.avatar = avatar;
    this.pipelines = device.once("overlays", () => pipelines(device, color, depth));
    this.bare = avatar.texels.texels.length === 0; // without splats: its template is shown in their place
    this.template = this.indices(avatar.template.faces, "template");
    this.joints = memory.buffer(16 * avatar.skeleton.names.length, "joints");
    this.strokes = strokes(memory, avatar.skeleton.parents);
    this.mask = memory.buffer(MASK_SIZE * MASK_ROW, "mask");
    this.maskTexture = memory.texture([MASK_SIZE, MASK_SIZE], "r8unorm", GPUTextureUsage.COPY_SRC);
    this.area = [0, 0, 1, 0];
    /** @type {{rings: Record<string, GPUBuffer>, indices: Indices} | null} */
    this.surface = null; // made when it is first shown
  }

  indices(/** @type {ArrayBufferView & {length: number}} */ triangles, /** @type {string} */ label) {
    return { buffer: this.memory.buffer(triangles, label, GPUBufferUsage.INDEX), count: triangles.length };
  }

  /** Follow the pose that the frame decoded; `ground` is the height on which the shadow falls, metres. */
  pose(/** @type {number} */ ground) {
    const { places, bounds } = this.frame;
    const joints = new Float32Array((places.length / 3) * 4).fill(1);
    for (let joint = 0; 3 * joint < places.length; joint++)
      joints.set(places.subarray(3 * joint, 3 * joint + 3), 4 * joint);
    this.memory.device.write(this.joints, joints);
    this.area = shadowArea(bounds, ground);
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
    this.surface ??= this.makeSurface();
    if (!this.surface) return;
    const constants = { ...lit(camera, GEOMETRY_COLOR), first_splat: firstSplat };
    this.pipelines.surface.bind(pass, { splats, ...this.surface.rings }, constants);
    drawIndexed(pass, this.surface.indices);
  }

  makeSurface() {
    const { surface, texels } = this.avatar;
    if (!surface) return null;
    const { triangles, ringStarts, ring } = surfaceMesh(texels, surface);
    const rings = {
      ring_starts: this.memory.buffer(ringStarts, "ring_starts"),
      ring: this.memory.buffer(ring, "ring"),
    };
    return { rings, indices: this.indices(triangles, "surface") };
  }

  /** Draw the posed template with flat shading. */
  drawTemplate(/** @type {GPURenderPassEncoder} */ pass, /** @type {Camera} */ camera) {
    this.pipelines.template.bind(pass, this.posed(), lit(camera, TEMPLATE_COLOR));
    drawIndexed(pass, this.template);
  }

  /** Draw bones and joints over all that is there. */
  drawSkeleton(
    /** @type {GPURenderPassEncoder} */ pass,
    /** @type {Camera} */ { viewProjection: view_projection, screen },
  ) {
    const { bones, dots } = this.strokes;
    const layers = /** @type {const} */ ([
      [bones, BONE_WIDTH + 2 * OUTLINE, OUTLINE_COLOR],
      [bones, BONE_WIDTH, BONE_COLOR],
      [dots, JOINT_WIDTH + 2 * OUTLINE, OUTLINE_COLOR],
      [dots, JOINT_WIDTH, JOINT_COLOR],
    ]);
    for (const [strokes, width, color] of layers) {
      const buffers = { joints: this.joints, strokes: strokes.buffer };
      this.pipelines.stroke.bind(pass, buffers, { view_projection, screen, width, color });
      pass.draw(6 * strokes.count);
    }
  }
}

/** Pairs of joints between which strokes are drawn: bones, and dots, which name one joint twice. */
function strokes(/** @type {Memory} */ memory, /** @type {Int32Array} */ parents) {
  const bones = Array.from(parents).flatMap((parent, joint) => (parent < 0 ? [] : [joint, parent]));
  const dots = Array.from(parents).flatMap((_, joint) => [joint, joint]);
  const made = (/** @type {number[]} */ pairs, /** @type {string} */ label) => ({
    buffer: memory.buffer(Uint32Array.from(pairs), label),
    count: pairs.length / 2,
  });
  return { bones: made(bones, "bones"), dots: made(dots, "dots") };
}

function lit(/** @type {Camera} */ { viewProjection, position }, /** @type {number[]} */ color) {
  return { view_projection: viewProjection, camera: [...position, 1], color };
}

function drawIndexed(/** @type {GPURenderPassEncoder} */ pass, /** @type {Indices} */ { buffer, count }) {
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
