// The player in a headset, with stand-ins for the session, its images and the graphics device.

import assert from "node:assert/strict";
import { beforeEach, test } from "node:test";
import { Headset } from "../../../python/mua/web/headset.js";
import { offersVR, requestSession } from "../../../python/mua/web/webxr.js";

globalThis.GPUTextureUsage = { TEXTURE_BINDING: 4, RENDER_ATTACHMENT: 16 };

const VIEWPORT = { x: 4, y: 6, width: 120, height: 160 };
const IDENTITY = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];
const CLIP = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -1, -1, 0, 0, -0.02, 0]; // column by column, z of 0 to w
const view = (eye) => ({ eye, projectionMatrix: CLIP, transform: { inverse: { matrix: IDENTITY } } });
const VIEWS = [view(0), view(1)];
const settled = () => new Promise((done) => setTimeout(done));

class Session extends EventTarget {
  frames = [];
  state = {};
  ended = 0;

  async requestReferenceSpace(kind) {
    if (kind !== "local-floor") throw new Error("no such space");
    if (xr.floorless) throw new Error("no floor");
    return { kind };
  }

  updateRenderState(state) {
    Object.assign(this.state, state);
  }

  requestAnimationFrame(draws) {
    return this.frames.push(draws);
  }

  async end() {
    this.ended += 1;
    if (this.ended > 1) throw new Error("The session has ended");
    await settled();
    this.dispatchEvent(new Event("end"));
  }

  /** A frame in which the reader's eyes are at so many views. */
  show(views, now = 40) {
    const frame = { getViewerPose: (space) => (space.kind === "local-floor" && views ? { views } : null) };
    for (const draws of this.frames.splice(0)) draws(now, frame);
  }
}

const xr = {
  async requestSession(mode, asked) {
    if (xr.refused) throw new Error(xr.refused);
    xr.asked = [mode, asked];
    return (xr.session = new Session());
  },
};

/** A graphics device that notes what is asked of it. */
function fakeGpu() {
  const noted = { textures: [], pipelines: [], passes: [], submitted: 0 };
  const gpu = {
    noted,
    queue: { submit: () => (noted.submitted += 1) },
    createTexture({ size: [width, height], ...given }) {
      const made = {
        width,
        height,
        ...given,
        destroyed: 0,
        createView: () => "picture",
        destroy: () => (made.destroyed += 1),
      };
      noted.textures.push(made);
      return made;
    },
    createShaderModule: (given) => given,
    createRenderPipeline: (given) => (noted.pipelines.push(given), { ...given, getBindGroupLayout: () => 0 }),
    createBindGroup: (given) => given,
    createCommandEncoder: () => ({
      beginRenderPass(given) {
        const pass = { given };
        for (const name of ["setPipeline", "setBindGroup", "setViewport", "draw", "end"])
          pass[name] = (...all) => (pass[name] = all);
        noted.passes.push(pass);
        return pass;
      },
      finish: () => 0,
    }),
  };
  return gpu;
}

/** A headset that was opened, and what it asks of the player. */
async function opened() {
  const gpu = fakeGpu();
  const reported = { drawn: [], failed: [], ended: 0 };
  const asks = {
    room: () => IDENTITY,
    draw(now, picture, eyes) {
      if (reported.fault) throw reported.fault;
      reported.drawn.push({ now, picture, eyes });
    },
    fail: (error) => reported.failed.push(error),
    ended: () => (reported.ended += 1),
  };
  const headset = await Headset.open({ gpu, free() {} }, asks);
  return { headset, gpu, reported, session: xr.session };
}

beforeEach(() => {
  Object.assign(xr, { refused: "", floorless: false, asked: null, isSessionSupported: async () => true });
  Object.defineProperty(globalThis, "navigator", { value: { xr }, configurable: true });
  globalThis.XRGPUBinding = class {
    getPreferredColorFormat() {
      return "bgra8unorm";
    }
    createProjectionLayer({ colorFormat }) {
      return { colorFormat };
    }
    getViewSubImage(_layer, { eye }) {
      const colorTexture = { width: 128, height: 168, createView: ({ eye: of }) => `image ${of}` };
      return { colorTexture, viewport: { ...VIEWPORT, x: VIEWPORT.x + eye }, getViewDescriptor: () => ({ eye }) };
    }
  };
});

test("a headset is offered where the browser draws on one by WebGPU", async () => {
  assert.equal(await offersVR(), true);
  xr.isSessionSupported = async (mode) => mode !== "immersive-vr";
  assert.equal(await offersVR(), false);
  xr.isSessionSupported = () => Promise.reject(new Error("not allowed here"));
  assert.equal(await offersVR(), false);
});

test("a browser whose headsets know no WebGPU offers none, and says so", async () => {
  delete globalThis.XRGPUBinding;
  assert.equal(await offersVR(), false);
  await assert.rejects(requestSession(), /no WebXR with WebGPU/);
});

test("the session is asked for WebGPU and a floor", async () => {
  const { session, headset } = await opened();
  assert.deepEqual(xr.asked, ["immersive-vr", { requiredFeatures: ["webgpu", "local-floor"] }]);
  assert.deepEqual(session.state, { layers: [headset.layer], depthNear: 0.02 });
  assert.equal(headset.layer.colorFormat, "bgra8unorm");
});

test("a headset that is refused is reported in a sentence", async () => {
  xr.refused = "denied";
  await assert.rejects(opened(), { name: "AvatarError", message: "The headset cannot show the avatar: denied" });
});

test("a session that cannot be used is ended", async () => {
  xr.floorless = true;
  await assert.rejects(opened(), { name: "AvatarError", message: "The headset cannot show the avatar: no floor" });
  assert.equal(xr.session.ended, 1);
});

test("a frame draws both eyes side by side and lays each on its part of its image", async () => {
  const { gpu, reported, session } = await opened();
  session.show(VIEWS, 40);
  const [{ now, picture, eyes }] = reported.drawn;
  assert.equal(now, 40);
  assert.deepEqual(
    eyes.map(({ screen }) => screen),
    [
      [120, 160],
      [120, 160],
    ],
  );
  assert.deepEqual([picture.width, picture.height, picture.usage], [240, 160, 20]);
  assert.deepEqual(
    gpu.noted.passes.map(({ setViewport }) => setViewport),
    [
      [4, 6, 120, 160, 0, 1],
      [5, 6, 120, 160, 0, 1],
    ],
  );
  assert.deepEqual(
    gpu.noted.passes.map(({ draw }) => draw),
    [
      [3, 1, 0, 0],
      [3, 1, 0, 1],
    ],
  );
  assert.deepEqual(
    gpu.noted.passes.map(({ given }) => given.colorAttachments[0].view),
    ["image 0", "image 1"],
  );
  assert.deepEqual(
    gpu.noted.pipelines.map(({ vertex, fragment }) => [vertex.constants, fragment.targets]),
    [[{ eyes: 2 }, [{ format: "bgra8unorm" }]]],
  );
  assert.equal(gpu.noted.submitted, 1);
});

test("each eye is seen through its own projection from its own place", async () => {
  const { reported, session } = await opened();
  const other = view(1);
  other.projectionMatrix = CLIP.map((value, i) => (i === 0 ? 2 : i === 8 ? 0.25 : value));
  other.transform = { inverse: { matrix: IDENTITY.map((value, i) => (i === 12 ? -0.064 : value)) } };
  session.show([view(0), other]);
  const [left, right] = reported.drawn[0].eyes;
  assert.deepEqual(
    [left, right].map(({ position }) => position[0] + 0),
    [0, 0.064],
  );
  assert.deepEqual(
    [left, right].map(({ projection }) => [projection[0], projection[2] + 0]),
    [
      [1, 0],
      [2, 0.25],
    ],
  );
});

test("the picture is kept from frame to frame, and made anew for images of another width or height", async () => {
  const { gpu, session } = await opened();
  const { width, height } = VIEWPORT;
  try {
    for (const size of [{}, {}, { width: 90 }, { width: 90, height: 100 }]) {
      Object.assign(VIEWPORT, size);
      session.show(VIEWS);
    }
  } finally {
    Object.assign(VIEWPORT, { width, height });
  }
  assert.deepEqual(
    gpu.noted.textures.map(({ width: w, height: h, destroyed }) => [w, h, destroyed]),
    [
      [240, 160, 1],
      [180, 160, 1],
      [180, 100, 0],
    ],
  );
});

test("while nobody knows where the head is, nothing is drawn and the next frame is waited for", async () => {
  const { reported, session } = await opened();
  for (const nowhere of [null, []]) session.show(nowhere);
  assert.deepEqual([reported.drawn, reported.failed], [[], []]);
  session.show(VIEWS);
  assert.equal(reported.drawn.length, 1);
});

test("a picture that cannot be drawn ends the session and is reported once", async () => {
  const { reported, session } = await opened();
  reported.fault = new Error("lost");
  session.show(VIEWS);
  await settled();
  await settled();
  session.show(VIEWS);
  assert.deepEqual([reported.failed, reported.ended, session.ended], [[reported.fault], 1, 1]);
});

test("nothing is drawn once the headset was left, and its memory is given back", async () => {
  const { gpu, headset, reported, session } = await opened();
  session.show(VIEWS);
  headset.leave();
  session.show(VIEWS);
  await settled();
  assert.equal(reported.drawn.length, 1);
  assert.deepEqual([reported.ended, gpu.noted.textures[0].destroyed, session.frames.length], [1, 1, 0]);
  headset.leave(); // twice is no fault
  await settled();
});

test("a session that the browser ends is reported and gives its memory back", async () => {
  const { gpu, reported, session } = await opened();
  session.show(VIEWS);
  session.dispatchEvent(new Event("end"));
  assert.deepEqual([reported.ended, gpu.noted.textures[0].destroyed], [1, 1]);
});
