// What a headset is shown frame by frame, and when that ends; session, layer and device are stand-ins.

import assert from "node:assert/strict";
import { beforeEach, test } from "node:test";
import { Device } from "../../../python/mua/web/device.js";
import { Headset } from "../../../python/mua/web/headset.js";
import { fakeGpu } from "./gpu.mjs";

const EYE = { apart: 0.06, width: 120, height: 160 };
const IDENTITY = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];
const PROJECTION = [2, 0, 0, 0, 0, 1.5, 0, 0, 0, 0, -1.002, -1, 0, 0, -0.2, 0]; // column by column

let gpu, session, passes; // passes: eye, viewport and image of each that was drawn

class Session extends EventTarget {
  frames = [];
  ended = 0;
  requestReferenceSpace = async () => "floor";
  updateRenderState = (state) => (this.state = state);
  requestAnimationFrame = (draws) => this.frames.push(draws);
  end = async () => void (this.ended += 1);
}

beforeEach(() => {
  [gpu, session, passes] = [fakeGpu(), new Session(), []];
  const beginRenderPass = ({ colorAttachments: [{ view }] }) => {
    const pass = { image: view };
    passes.push(pass);
    return {
      setPipeline: ({ fragment }) => (pass.format = fragment.targets[0].format),
      setBindGroup() {},
      setViewport: (...given) => (pass.viewport = given),
      draw: (_vertices, _instances, _first, eye) => (pass.eye = eye),
      end() {},
    };
  };
  gpu.createCommandEncoder = () => ({ beginRenderPass, finish() {} });
  gpu.createRenderPipeline = (given) => ({ ...given, getBindGroupLayout() {} });
  globalThis.XRGPUBinding = class {
    getPreferredColorFormat = () => "rgba8unorm-srgb";
    createProjectionLayer = () => "layer";
    getViewSubImage = (_layer, { eye }) => ({
      viewport: { x: eye * 10, y: 6, width: EYE.width, height: EYE.height },
      colorTexture: { createView: (which) => which },
      getViewDescriptor: () => `image ${eye}`,
    });
  };
  Object.defineProperty(globalThis, "navigator", {
    value: { xr: { requestSession: async (...asked) => Object.assign(session, { asked }) } },
    configurable: true,
  });
});

/** Eyes that stand beside each other, the first at the left. */
const views = (count) =>
  Array.from({ length: count }, (_, eye) => ({
    eye,
    projectionMatrix: PROJECTION,
    transform: { inverse: { matrix: IDENTITY.map((value, i) => (i === 12 ? (0.5 - eye) * EYE.apart : value)) } },
  }));

/** A headset, what it asked for, and how it shows a frame. */
async function opened({ draw } = {}) {
  const done = { drawn: [], failed: [], ended: 0 };
  const asks = {
    room: () => IDENTITY,
    draw: draw ?? ((...given) => done.drawn.push(given)),
    fail: (error) => done.failed.push(error.message),
    ended: () => (done.ended += 1),
  };
  const headset = await Headset.open(new Device({ info: {} }, gpu), asks);
  const show = (now, seen) =>
    session.frames.splice(0).forEach((draws) => draws(now, { getViewerPose: () => seen && { views: seen } }));
  return { headset, done, show };
}

test("each eye is drawn from where it is, and laid on its own image", async () => {
  const { done, show } = await opened();
  assert.deepEqual(session.asked, ["immersive-vr", { requiredFeatures: ["webgpu", "local-floor"] }]);
  show(1000, views(2));
  const [[now, picture, eyes]] = done.drawn;
  assert.deepEqual([now, picture.width, picture.height], [1000, 2 * EYE.width, EYE.height]);
  assert.deepEqual(
    eyes.map(({ position: [x], screen, near }) => [x.toFixed(3), screen, near.toFixed(4)]),
    ["-0.030", "0.030"].map((x) => [x, [EYE.width, EYE.height], "0.1996"]),
  );
  assert.deepEqual(
    passes.map(({ eye, image, viewport }) => [eye, image, viewport.slice(0, 4)]),
    [0, 1].map((eye) => [eye, `image ${eye}`, [10 * eye, 6, EYE.width, EYE.height]]),
  );
  assert.ok(passes.every(({ format }) => format === "rgba8unorm-srgb"));
});

test("while nobody knows where the reader's head is nothing is drawn, and the next frame is asked for", async () => {
  const { done, show } = await opened();
  for (const seen of [null, []]) show(1000, seen);
  assert.deepEqual([done.drawn, done.failed, session.frames.length], [[], [], 1]);
});

test("the picture is kept from frame to frame, and given back where eyes have another size or it ends", async () => {
  const { done, show } = await opened();
  for (const now of [1, 2]) show(now, views(2));
  assert.equal(done.drawn[0][1], done.drawn[1][1]);
  show(3, views(1));
  const held = () => done.drawn.filter(([, picture]) => gpu.held.has(picture)).map(([now]) => now);
  assert.deepEqual([done.drawn[2][1].width, held()], [EYE.width, [3]]);
  session.dispatchEvent(new Event("end"));
  assert.deepEqual([held(), done.ended], [[], 1]);
});

test("after it was left no frame is drawn or asked for", async () => {
  const { headset, done, show } = await opened();
  headset.leave();
  show(1000, views(2));
  assert.deepEqual([done.drawn, session.frames, session.ended], [[], [], 1]);
});

test("a picture that cannot be drawn ends it with a sentence, a session that cannot be had too", async () => {
  const { done, show } = await opened({ draw: () => assert.fail("no memory") });
  show(1000, views(2));
  assert.deepEqual([done.failed, session.ended], [["no memory"], 1]);
  session.requestReferenceSpace = () => Promise.reject(new Error("no floor"));
  await assert.rejects(opened(), { message: "The headset cannot show the avatar: no floor" });
  assert.equal(session.ended, 2);
});
