// What one picture shows: background, shadow, geometry or mesh, splats and skeleton, in this order. Reference:
// python/mua/player/scene.py.

import { Pipeline } from "./kernel.js";
import { SplatFrag, SplatVert } from "./wgsl/splat.js";

/** @typedef {import("./camera.js").Camera} Camera */
/** @typedef {import("./overlays.js").Overlays} Overlays */
/** @typedef {import("./splats.js").SplatFrame} SplatFrame */

export const COLOR = "rgba16float"; // in which many faint splats add up
export const DEPTH = "depth32float";

/** Draws sorted splats and what is around them. */
export class Scene {
  constructor(/** @type {import("./device.js").Device} */ device, /** @type {number[]} */ background) {
    this.device = device;
    this.background = background; // premultiplied sRGB and alpha
    this.splats = new Pipeline(device, SplatVert, SplatFrag, { color: COLOR, depth: DEPTH, blend: true });
    /** @type {GPUTexture | null} */
    this.depth = null;
  }

  /**
   * Append a picture to what is submitted next.
   * @param {GPUCommandEncoder} encoder
   * @param {GPUTexture} target
   * @param {{frame: SplatFrame | null, overlays: Overlays[], camera: Camera, show: import("./player.js").Show}} shown
   * @param {GPURenderPassTimestampWrites} [timestampWrites]
   */
  draw(encoder, target, { frame, overlays, camera, show }, timestampWrites) {
    if (show.shadow) for (const overlay of overlays) overlay.drawMask(encoder);
    const pass = encoder.beginRenderPass({
      colorAttachments: [{ view: target.createView(), loadOp: "clear", storeOp: "store", clearValue: this.background }],
      depthStencilAttachment: {
        view: this.depthOf(target).createView(),
        depthClearValue: 1,
        depthLoadOp: "clear",
        depthStoreOp: "discard",
      },
      timestampWrites,
    });
    overlays.forEach((overlay, i) => {
      if (show.geometry && frame?.seen[i]) overlay.drawGeometry(pass, camera, frame.splats, frame.starts[i]);
      if (show.mesh || (show.splats && overlay.bare)) overlay.drawTemplate(pass, camera);
    });
    for (const overlay of overlays) if (show.shadow) overlay.drawGround(pass, camera);
    if (show.splats && frame) this.drawSplats(pass, frame, camera);
    for (const overlay of overlays) if (show.skeleton) overlay.drawSkeleton(pass, camera);
    pass.end();
  }

  drawSplats(/** @type {GPURenderPassEncoder} */ pass, /** @type {SplatFrame} */ frame, /** @type {Camera} */ camera) {
    const constants = { view_projection: camera.viewProjection, screen: camera.screen, eye: 0 };
    this.splats.bind(pass, { order: frame.order, splats: frame.splats }, constants);
    pass.drawIndirect(frame.arguments, 0);
  }

  /** Depth for a target, kept until one of another size comes. */
  depthOf(/** @type {GPUTexture} */ { width, height }) {
    if (this.depth?.width !== width || this.depth.height !== height) {
      this.depth?.destroy();
      const usage = GPUTextureUsage.RENDER_ATTACHMENT;
      this.depth = this.device.gpu.createTexture({ size: [width, height], format: DEPTH, usage });
    }
    return this.depth;
  }
}
