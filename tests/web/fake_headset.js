// A stand-in for a browser with WebXR by WebGPU and for its headset: navigator.xr and XRGPUBinding, whose images are textures of
// the player's own device. `headset.show(now, views)` is a frame; `headset.image(eye)` gives the pixels that it was given.

{
  const [WIDTH, HEIGHT] = [128, 168]; // of an image, pixels
  const VIEWPORT = { x: 4, y: 6, width: 120, height: 160 }; // of it that the reader sees

  class Session extends EventTarget {
    frames = [];
    state = {};
    ended = false;

    async requestReferenceSpace(kind) {
      if (headset.floorless) throw new Error("There is no floor");
      return { kind };
    }

    updateRenderState(state) {
      Object.assign(this.state, state);
    }

    requestAnimationFrame(draws) {
      return this.frames.push(draws);
    }

    async end() {
      if (this.ended) throw new DOMException("The session has ended", "InvalidStateError");
      this.ended = true;
      await new Promise((done) => setTimeout(done)); // as a browser, which tells it a little later
      this.dispatchEvent(new Event("end"));
    }
  }

  const headset = {
    supported: async () => true,
    refused: "",
    floorless: false,
    viewport: { ...VIEWPORT },
    adapters: [], // whether each was asked to fit the headset
    async requestSession(mode, { requiredFeatures }) {
      if (headset.refused) throw new DOMException(headset.refused, "NotAllowedError");
      headset.asked = [mode, requiredFeatures];
      return (headset.session = new Session());
    },
    /** A frame in which the reader's eyes are at so many views; null where nobody knows where. */
    show(now, views) {
      const { session } = headset;
      const frame = { getViewerPose: ({ kind }) => (kind === "local-floor" && views ? { views } : null) };
      for (const draws of session.frames.splice(0)) draws(now, frame);
    },
    /** The pixels of an eye, [height, width, 4] bytes as base64. */
    async image(eye) {
      const { gpu, texture } = headset;
      const size = 4 * WIDTH * HEIGHT;
      const buffer = gpu.createBuffer({ size, usage: GPUBufferUsage.MAP_READ | GPUBufferUsage.COPY_DST });
      const encoder = gpu.createCommandEncoder();
      encoder.copyTextureToBuffer({ texture, origin: [0, 0, eye] }, { buffer, bytesPerRow: 4 * WIDTH }, [
        WIDTH,
        HEIGHT,
      ]);
      gpu.queue.submit([encoder.finish()]);
      await buffer.mapAsync(GPUMapMode.READ);
      return btoa(Array.from(new Uint8Array(buffer.getMappedRange()), (byte) => String.fromCharCode(byte)).join(""));
    },
  };

  globalThis.headset = headset;
  globalThis.XRGPUBinding = class {
    constructor(_session, gpu) {
      if (!headset.adapters.at(-1)) throw new DOMException("The device does not fit the headset", "InvalidStateError");
      Object.assign(headset, { gpu });
    }

    getPreferredColorFormat() {
      return "rgba8unorm";
    }

    createProjectionLayer({ colorFormat: format }) {
      const usage = GPUTextureUsage.RENDER_ATTACHMENT | GPUTextureUsage.COPY_SRC;
      headset.texture = headset.gpu.createTexture({ size: [WIDTH, HEIGHT, 2], format, usage });
      return { texture: headset.texture };
    }

    getViewSubImage(layer, { eye }) {
      if (headset.session.state.layers[0] !== layer) throw new TypeError("Not a layer of this session");
      const image = { colorTexture: layer.texture, viewport: headset.viewport, eye };
      image.getViewDescriptor = function () {
        return { dimension: "2d", mipLevelCount: 1, arrayLayerCount: 1, baseArrayLayer: this.eye };
      };
      return image;
    }
  };
  const xr = Object.assign(new EventTarget(), {
    isSessionSupported: (mode) => headset.supported(mode),
    requestSession: (...given) => headset.requestSession(...given),
  });
  Object.defineProperty(Navigator.prototype, "xr", { get: () => xr });
  const ask = GPU.prototype.requestAdapter;
  GPU.prototype.requestAdapter = function (wanted) {
    headset.adapters.push(Boolean(wanted?.xrCompatible));
    return headset.unfit && wanted?.xrCompatible
      ? Promise.resolve(null)
      : ask.call(this, { powerPreference: wanted?.powerPreference });
  };
}
