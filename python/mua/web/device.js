// The graphics device: buffers, and the memory through which constants travel.

import { AvatarError } from "./error.js";
import { offersVR } from "./webxr.js";

const ALIGNMENT = 256; // bytes; no device asks for more between the constants of two dispatches
const CAPACITY = 1 << 18; // bytes: a thousand dispatches may wait for one submit
const RAISED_LIMITS = ["maxBufferSize", "maxStorageBufferBindingSize", "maxTextureDimension2D"]; // raised to what the device has
const LEAST_BUFFERS = 8; // bound by one stage

/** An open device. */
export class Device {
  /** @throws {AvatarError} where the browser has none */
  static async open(/** @type {import("./player.js").PlayerOptions} */ options = {}) {
    const powerPreference = options.powerPreference ?? "high-performance";
    const inHeadset = { powerPreference, xrCompatible: true };
    const adapter =
      ((await offersVR()) && (await navigator.gpu.requestAdapter(inHeadset))) ||
      (await navigator.gpu.requestAdapter({ powerPreference }));
    if (!adapter)
      throw new AvatarError(
        "The browser offers no graphics device through WebGPU: its list of supported devices may leave this one out.",
      );
    const limits = /** @type {Record<string, number>} */ (/** @type {unknown} */ (adapter.limits));
    if (limits.maxStorageBuffersPerShaderStage < LEAST_BUFFERS)
      throw new AvatarError(
        `A shader may bind ${limits.maxStorageBuffersPerShaderStage} buffers on this device; the avatar needs ${LEAST_BUFFERS}.`,
      );
    /** @type {GPUFeatureName[]} */
    const features = adapter.features.has("timestamp-query") ? ["timestamp-query"] : [];
    const requiredLimits = Object.fromEntries(RAISED_LIMITS.map((name) => [name, limits[name]]));
    const gpu = await adapter.requestDevice({ requiredFeatures: features, requiredLimits });
    return new Device(adapter, gpu);
  }

  constructor(/** @type {GPUAdapter} */ adapter, /** @type {GPUDevice} */ gpu) {
    const { vendor, architecture, description } = adapter.info;
    this.name = description || [vendor, architecture].filter(Boolean).join(" ");
    this.gpu = gpu;
    this.since = performance.now();
    /** @type {string | null} */
    this.lost = null; // why, once it is
    /** @type {Set<(reason: string) => void>} */
    this.losing = new Set(); // called when it is lost
    gpu.lost.then(({ reason }) => {
      this.lost = reason;
      for (const listener of [...this.losing]) listener(reason);
    });
    this.timestamps = gpu.features.has("timestamp-query");
    this.uniforms = new Uniforms(gpu);
    /** @type {Map<unknown, unknown>} */
    this.known = new Map();
    /** @type {Set<{forget: (buffers: Set<GPUBuffer>) => void}>} */
    this.binders = new Set(); // that remember buffers which they bound
  }

  /** Call a listener when the device is lost, until a signal. */
  whenLost(/** @type {(reason: string) => void} */ listener, /** @type {AbortSignal | undefined} */ until = undefined) {
    const { lost } = this;
    if (lost) return queueMicrotask(() => listener(lost));
    this.losing.add(listener);
    until?.addEventListener("abort", () => this.losing.delete(listener));
  }

  /**
   * A buffer of an array's bytes, or of so many zero bytes.
   * @param {ArrayBufferView | number} content
   * @param {string} label
   * @param {GPUBufferUsageFlags} [more] usage beside storage and copies
   */
  buffer(content, label, more = 0) {
    const bytes = typeof content === "number" ? content : content.byteLength;
    const size = Math.max(Math.ceil(bytes / 16) * 16, 16); // an element may have 16, and no buffer is empty
    const most = Math.min(this.gpu.limits.maxBufferSize, this.gpu.limits.maxStorageBufferBindingSize);
    if (size > most)
      throw new AvatarError(`${label}: ${size} bytes are more than the ${most} that this device can bind.`);
    const usage = GPUBufferUsage.STORAGE | GPUBufferUsage.COPY_DST | GPUBufferUsage.COPY_SRC | more;
    const buffer = this.gpu.createBuffer({ label, size, usage });
    if (typeof content !== "number") this.write(buffer, content);
    return buffer;
  }

  /** Overwrite a buffer's beginning before what is submitted next. */
  write(/** @type {GPUBuffer} */ buffer, /** @type {ArrayBufferView} */ content) {
    const whole = content.byteLength - (content.byteLength % 4);
    this.gpu.queue.writeBuffer(buffer, 0, content.buffer, content.byteOffset, whole);
    if (whole === content.byteLength) return;
    const rest = new Uint8Array(4);
    rest.set(new Uint8Array(content.buffer, content.byteOffset + whole, content.byteLength - whole));
    this.gpu.queue.writeBuffer(buffer, whole, rest);
  }

  /** Give buffers back, and what was bound of them. */
  free(/** @type {GPUBuffer[]} */ buffers) {
    const given = new Set(buffers);
    for (const binder of this.binders) binder.forget(given);
    for (const buffer of given) buffer.destroy();
  }

  /** What was made for a key, once. @template T @param {unknown} key @param {() => T} make @returns {T} */
  once(key, make) {
    if (!this.known.has(key)) this.known.set(key, make());
    return /** @type {T} */ (this.known.get(key));
  }
}

/** Buffers that go together: of one avatar, say. */
export class Memory {
  constructor(/** @type {Device} */ device) {
    this.device = device;
    /** @type {GPUBuffer[]} */
    this.held = [];
    /** @type {GPUTexture[]} */
    this.textures = [];
  }

  /** A buffer of this group; see Device.buffer. */
  buffer(
    /** @type {ArrayBufferView | number} */ content,
    /** @type {string} */ label,
    /** @type {GPUBufferUsageFlags} */ more = 0,
  ) {
    const made = this.device.buffer(content, label, more);
    this.held.push(made);
    return made;
  }

  /** A texture to draw into. @param {number[]} size width and height, pixels @param {GPUTextureFormat} format @param {GPUTextureUsageFlags} [more] */
  texture(size, format, more = 0) {
    const made = this.device.gpu.createTexture({ size, format, usage: GPUTextureUsage.RENDER_ATTACHMENT | more });
    this.textures.push(made);
    return made;
  }

  /** Bytes of its buffers. */
  get bytes() {
    return this.held.reduce((sum, { size }) => sum + size, 0);
  }

  /** May be called twice. */
  free() {
    this.device.free(this.held.splice(0));
    for (const texture of this.textures.splice(0)) texture.destroy();
  }
}

/** A ring of constants: what was placed stays until CAPACITY more bytes were, by then long submitted. */
class Uniforms {
  constructor(/** @type {GPUDevice} */ gpu) {
    this.buffer = gpu.createBuffer({
      label: "constants",
      size: CAPACITY,
      usage: GPUBufferUsage.UNIFORM | GPUBufferUsage.COPY_DST,
    });
    this.queue = gpu.queue;
    this.staged = new DataView(new ArrayBuffer(CAPACITY));
    this.first = 0; // of what is not uploaded yet
    this.next = 0;
  }

  /** The offset at which an entry point's constants will be. */
  place(/** @type {import("./shader.js").Packer} */ packer, /** @type {import("./shader.js").Values} */ values) {
    if (this.next + packer.size > CAPACITY) {
      this.upload();
      this.first = this.next = 0;
    }
    const at = this.next;
    packer.pack(this.staged, at, values);
    this.next = Math.ceil((at + packer.size) / ALIGNMENT) * ALIGNMENT;
    return at;
  }

  /** Before a submit. */
  upload() {
    if (this.next > this.first)
      this.queue.writeBuffer(
        this.buffer,
        this.first,
        this.staged.buffer,
        this.first,
        Math.min(this.next, CAPACITY) - this.first,
      );
    this.first = this.next;
  }
}
