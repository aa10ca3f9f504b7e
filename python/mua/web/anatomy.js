// What lies under the splats of an avatar: its detailed geometry and its skeleton; fetched when one of them is first shown.
// Reference: python/mua/player/overlays.py.

import { Pipeline } from "./kernel.js";
import { drawIndexed, indices, lit } from "./overlays.js";
import { surfaceMesh } from "./surface_mesh.js";
import { StrokeFrag, StrokeVert } from "./wgsl/skeleton.js";
import { SurfaceFrag, SurfaceVert } from "./wgsl/surface.js";

/** @typedef {import("./device.js").Device} Device */
/** @typedef {import("./device.js").Memory} Memory */
/** @typedef {import("./camera.js").Camera} Camera */
/** @typedef {import("./frame.js").AvatarFrame} AvatarFrame */
/** @typedef {import("./overlays.js").Formats} Formats */
/** @typedef {import("./overlays.js").Indices} Indices */

const GEOMETRY_COLOR = [0.8, 0.78, 0.75, 1]; // sRGB
const BONE_COLOR = [0.98, 0.62, 0.12, 1];
const JOINT_COLOR = [1, 0.97, 0.9, 1];
const OUTLINE_COLOR = [0.12, 0.1, 0.08, 1];
const [BONE_WIDTH, JOINT_WIDTH, OUTLINE] = [2.5, 5, 1.5]; // pixels

function pipelines(/** @type {Device} */ device, /** @type {Formats} */ { color, depth }) {
  return {
    surface: new Pipeline(device, SurfaceVert, SurfaceFrag, { color, depth, write: true }),
    stroke: new Pipeline(device, StrokeVert, StrokeFrag, { color, depth, blend: true, always: true }),
  };
}

/** Draws geometry and skeleton of one avatar. */
export class Anatomy {
  /** @param {Memory} memory @param {AvatarFrame} frame @param {Formats} formats */
  constructor(memory, frame, formats) {
    const { device } = memory;
    const { names, parents } = frame.buffers.avatar.skeleton;
    this.memory = memory;
    this.frame = frame;
    this.pipelines = device.once("anatomy", () => pipelines(device, formats));
    this.joints = memory.buffer(16 * names.length, "joints");
    this.strokes = strokes(memory, parents);
    /** @type {{rings: Record<string, GPUBuffer>, indices: Indices} | null} */
    this.surface = null; // made when it is first shown
    this.pose();
  }

  /** Follow the pose that the frame shows. */
  pose() {
    const { places } = this.frame;
    const joints = new Float32Array((places.length / 3) * 4).fill(1);
    for (let joint = 0; 3 * joint < places.length; joint++)
      joints.set(places.subarray(3 * joint, 3 * joint + 3), 4 * joint);
    this.memory.device.write(this.joints, joints);
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
    const { surface, texels } = this.frame.buffers.avatar;
    if (!surface) return null;
    const { triangles, ringStarts, ring } = surfaceMesh(texels, surface);
    const rings = {
      ring_starts: this.memory.buffer(ringStarts, "ring_starts"),
      ring: this.memory.buffer(ring, "ring"),
    };
    return { rings, indices: indices(this.memory, triangles, "surface") };
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
