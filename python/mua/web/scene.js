// What one picture shows: background, shadow, geometry or template, splats and skeleton, in this order. Reference:
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
    const over = () => new Pipeline(device, SplatVert, SplatFrag, { color: COLOR, depth: DEPTH, blend: true });
    this.splats = device.once("splats", over);
    /** @type {GPUTexture | null} */
    this.depth = null;
  }

  /**
   * Append a picture of one or two eyes, side by side from the left, to what is submitted next.
   * @param {GPUCommandEncoder} encoder
   * @param {GPUTexture} target
   * @param {{frame: SplatFrame | null, overlays: Overlays[], cameras: Camera[], show: import("./player.js").Show}} shown
   * @param {GPURenderPassTimestampWrites} [timestampWrites]
   */
  draw(encoder, target, { frame, overlays, cameras, show }, timestampWrites) {
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
    cameras.forEach((camera, eye) => {
      setEye(pass, eye, camera);
      overlays.forEach((overlay, i) => {
        if (show.geometry && frame?.seen[i]) overlay.drawGeometry(pass, camera, frame.splats, frame.starts[i]);
        if (show.template || (show.splats && overlay.bare)) overlay.drawTemplate(pass, camera);
      });
      for (const overlay of overlays) if (show.shadow) overlay.drawGround(pass, camera);
      if (show.splats && frame) this.drawSplats(pass, frame, camera, eye);
      for (const overlay of overlays) if (show.skeleton) overlay.drawSkeleton(pass, camera);
    });
    pass.end();
  }

  /** @param {GPURenderPassEncoder} pass @param {SplatFrame} frame @param {Camera} camera @param {number} eye */
  drawSplats(pass, frame, camera, eye) {
    const constants = { view_projection: camera.viewProjection, screen: camera.screen, eye, corners: frame.corners };
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

  free() {
    this.depth?.destroy();
  }
}

/** Confine what follows to the part of the target that an eye has. @param {GPURenderPassEncoder} pass @param {number} eye @param {Camera} camera */
function setEye(pass, eye, { screen: [width, height] }) {
  pass.setViewport(eye * width, 0, width, height, 0, 1);
  pass.setScissorRect(eye * width, 0, width, height);
}
