// A headset that shows the player: a WebXR session whose frames take the place of the display's. The eyes are drawn side by
// side, as on a page, in the format in which faint splats add up, and then laid on the images that the session gives for each.

import { eyeInRoom, NEAR } from "./camera.js";
import { Memory } from "./device.js";
import { AvatarError } from "./error.js";
import { COLOR } from "./scene.js";
import { requestSession } from "./webxr.js";

/** @typedef {import("./webxr.js").Session} Session */
/** @typedef {{x: number, y: number, width: number, height: number}} Viewport pixels */
/** @typedef {{colorTexture: GPUTexture, viewport: Viewport, getViewDescriptor: () => GPUTextureViewDescriptor}} SubImage */
/**
 * @typedef {object} Binding of a session to a device
 * @property {() => GPUTextureFormat} getPreferredColorFormat
 * @property {(asked: {colorFormat: GPUTextureFormat}) => object} createProjectionLayer
 * @property {(layer: object, view: import("./webxr.js").View) => SubImage} getViewSubImage
 */
/** @typedef {import("./camera.js").Camera} Camera */
/**
 * @typedef {object} Asks what a headset asks of the player
 * @property {() => number[]} room [4, 4] from the world to the room, metres
 * @property {(now: number, picture: GPUTexture, eyes: Camera[]) => void} draw
 * @property {(error: unknown) => void} fail where a picture could not be drawn: the headset is left
 * @property {() => void} ended the reader, the page or the browser left it
 */

const BACKDROP = [0.44, 0.47, 0.5]; // sRGB of the empty room: dark hair and a shadow show against it

// Written by hand: what it reads are textures, which no kernel has.
const LAYING = `
override eyes: f32;
@group(0) @binding(0) var picture: texture_2d<f32>;
struct Corner { @builtin(position) position: vec4f, @location(0) at: vec2f };

@vertex fn corner(@builtin(vertex_index) vertex: u32, @builtin(instance_index) eye: u32) -> Corner {
  let share = vec2f(f32(2 * (vertex & 1)), f32(vertex & 2)); // a triangle over all of the eye's image
  return Corner(vec4f(2 * share.x - 1, 1 - 2 * share.y, 0, 1), vec2f((f32(eye) + share.x) / eyes, share.y));
}

@fragment fn pixel(corner: Corner) -> @location(0) vec4f {
  let shown = textureLoad(picture, vec2u(corner.at * vec2f(textureDimensions(picture))), 0);
  return vec4f(shown.rgb + (1 - shown.a) * vec3f(${BACKDROP.join()}), 1);
}`;

export class Headset {
  /** Ask for the headset; only while the browser handles a click or a key. @throws {AvatarError} where it is refused */
  static async open(/** @type {import("./device.js").Device} */ device, /** @type {Asks} */ asks) {
    /** @type {Session | undefined} */
    let session;
    try {
      session = await requestSession();
      return new Headset(device, session, await session.requestReferenceSpace("local-floor"), asks);
    } catch (error) {
      await session?.end().catch(() => {});
      throw new AvatarError(`The headset cannot show the avatar: ${error instanceof Error ? error.message : error}`);
    }
  }

  /** @param {import("./device.js").Device} device @param {Session} session @param {object} space @param {Asks} asks */
  constructor(device, session, space, asks) {
    this.device = device;
    this.session = session;
    this.space = space; // the reader's, its origin on the floor
    this.asks = asks;
    this.left = false;
    this.binding = bindingOf(session, device.gpu);
    this.format = this.binding.getPreferredColorFormat();
    this.layer = this.binding.createProjectionLayer({ colorFormat: this.format });
    this.memory = new Memory(device); // of the picture
    /** @type {{texture: GPUTexture, group: GPUBindGroup, pipeline: GPURenderPipeline} | null} */
    this.picture = null; // of all eyes, made by the first frame
    session.updateRenderState({ layers: [this.layer], depthNear: NEAR });
    session.addEventListener("end", () => this.end());
    session.requestAnimationFrame((now, frame) => this.frame(now, frame));
  }

  /** @param {number} now milliseconds @param {import("./webxr.js").Frame} frame */
  frame(now, frame) {
    if (this.left) return; // it ends as soon as the browser has ended it; the device may be gone
    this.session.requestAnimationFrame((then, next) => this.frame(then, next));
    const views = frame.getViewerPose(this.space)?.views;
    if (!views?.length) return; // nobody knows where the reader's head is
    try {
      const images = views.map((view) => this.binding.getViewSubImage(this.layer, view));
      const { width, height } = images[0].viewport;
      const room = this.asks.room();
      const eyes = views.map((view) => eyeInRoom(room, view, [width, height]));
      this.asks.draw(now, this.pictureOf(eyes).texture, eyes);
      this.lay(images);
    } catch (error) {
      this.leave();
      this.asks.fail(error);
    }
  }

  /** The picture of all eyes, kept until they are of another size. */
  pictureOf(/** @type {Camera[]} */ eyes) {
    const [width, height] = [eyes.length * eyes[0].screen[0], eyes[0].screen[1]];
    const known = this.picture;
    if (known?.texture.width === width && known.texture.height === height) return known;
    this.memory.free();
    const { gpu } = this.device;
    const texture = this.memory.texture([width, height], COLOR, GPUTextureUsage.TEXTURE_BINDING);
    const module = gpu.createShaderModule({ label: "headset", code: LAYING });
    const pipeline = gpu.createRenderPipeline({
      label: "headset",
      layout: "auto",
      vertex: { module, constants: { eyes: eyes.length } },
      fragment: { module, targets: [{ format: this.format }] },
    });
    const entries = [{ binding: 0, resource: texture.createView() }];
    const group = gpu.createBindGroup({ label: "headset", layout: pipeline.getBindGroupLayout(0), entries });
    this.picture = { texture, group, pipeline };
    return this.picture;
  }

  /** Lay the eyes of the picture on the session's images. */
  lay(/** @type {SubImage[]} */ images) {
    if (!this.picture) return;
    const { group, pipeline } = this.picture;
    const encoder = this.device.gpu.createCommandEncoder();
    images.forEach((image, eye) => {
      const { colorTexture, viewport } = image;
      const view = colorTexture.createView(image.getViewDescriptor());
      const pass = encoder.beginRenderPass({ colorAttachments: [{ view, loadOp: "clear", storeOp: "store" }] });
      pass.setPipeline(pipeline);
      pass.setBindGroup(0, group);
      pass.setViewport(viewport.x, viewport.y, viewport.width, viewport.height, 0, 1);
      pass.draw(3, 1, 0, eye);
      pass.end();
    });
    this.device.gpu.queue.submit([encoder.finish()]);
  }

  leave() {
    this.left = true;
    this.session.end().catch(() => {}); // it has ended
  }

  end() {
    this.memory.free();
    this.picture = null;
    this.asks.ended();
  }
}

/** @returns {Binding} */
function bindingOf(/** @type {Session} */ session, /** @type {GPUDevice} */ gpu) {
  const { XRGPUBinding } = /** @type {{XRGPUBinding: new (session: Session, gpu: GPUDevice) => Binding}} */ (
    /** @type {unknown} */ (globalThis)
  );
  return new XRGPUBinding(session, gpu);
}
