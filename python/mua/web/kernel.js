// Compute kernels and drawing pipelines whose buffers and constants are given by name. References: python/mua/gpu/kernel.py,
// bindings.py, draw.py, commands.py.

import { AvatarError } from "./error.js";
import { Packer, withRoom } from "./shader.js";

/** @typedef {import("./device.js").Device} Device */
/** @typedef {import("./shader.js").Shader} Shader */
/** @typedef {import("./shader.js").Values} Values */
/** @typedef {Record<string, GPUBuffer>} Buffers */

/** @type {GPUBlendComponent} */
const OVER = { srcFactor: "one", dstFactor: "one-minus-src-alpha", operation: "add" }; // premultiplied colour

function moduleOf(/** @type {Device} */ device, /** @type {Shader} */ { entry, code }) {
  return device.gpu.createShaderModule({ label: entry, code });
}

/** What one entry point binds: its layout, and the groups made for it so far. */
class Bindings {
  constructor(/** @type {Device} */ device, /** @type {Shader} */ shader) {
    const { COMPUTE, VERTEX, FRAGMENT } = GPUShaderStage;
    const visibility = { comp: COMPUTE, vert: VERTEX, frag: FRAGMENT }[shader.stage] ?? COMPUTE;
    this.device = device;
    this.shader = shader;
    this.packer = new Packer(shader);
    /** @type {GPUBindGroupLayoutEntry[]} */
    const entries = shader.buffers.map(({ binding, read_only }) => ({
      binding,
      visibility,
      buffer: { type: read_only ? "read-only-storage" : "storage" },
    }));
    if (shader.constants_binding !== null)
      entries.push({
        binding: shader.constants_binding,
        visibility,
        buffer: { type: "uniform", hasDynamicOffset: true, minBindingSize: this.packer.size },
      });
    this.layout = device.gpu.createBindGroupLayout({ label: shader.entry, entries });
    /** @type {{buffers: GPUBuffer[], group: GPUBindGroup}[]} */
    this.groups = [];
    device.binders.add(this);
  }

  /** The bind group of these buffers, made once for the same ones. */
  group(/** @type {Buffers} */ given) {
    const buffers = this.shader.buffers.map(({ name }) => {
      if (!given[name]) throw new AvatarError(`kernel ${this.shader.entry}: buffer ${name} is missing`);
      return given[name];
    });
    const known = this.groups.find((one) => one.buffers.every((buffer, i) => buffer === buffers[i]));
    if (known) return known.group;
    /** @type {GPUBindGroupEntry[]} */
    const entries = buffers.map((buffer, i) => ({ binding: this.shader.buffers[i].binding, resource: { buffer } }));
    if (this.shader.constants_binding !== null) {
      const resource = { buffer: this.device.uniforms.buffer, offset: 0, size: this.packer.size };
      entries.push({ binding: this.shader.constants_binding, resource });
    }
    const group = this.device.gpu.createBindGroup({ label: this.shader.entry, layout: this.layout, entries });
    this.groups.push({ buffers, group });
    return group;
  }

  /** Drop the groups of buffers that are given back. */
  forget(/** @type {Set<GPUBuffer>} */ given) {
    this.groups = this.groups.filter(({ buffers }) => !buffers.some((buffer) => given.has(buffer)));
  }

  /** Dynamic offsets of a dispatch or draw with these constants. */
  offsets(/** @type {Values} */ values) {
    return this.shader.constants_binding === null ? [] : [this.device.uniforms.place(this.packer, values)];
  }
}

/** An entry point of a compute shader, compiled when it is first needed. */
export class Kernel {
  constructor(/** @type {Device} */ device, /** @type {Shader} */ shader) {
    this.gpu = device.gpu;
    this.bindings = new Bindings(device, shader);
    const layout = device.gpu.createPipelineLayout({ bindGroupLayouts: [this.bindings.layout] });
    const compute = { module: moduleOf(device, shader), entryPoint: shader.entry };
    this.described = { label: shader.entry, layout, compute };
    /** @type {GPUComputePipeline | null} */
    this.pipeline = null;
    /** @type {Promise<GPUComputePipeline> | null} */
    this.compiling = null;
  }

  /** Compile beside others, before it is needed. */
  async compile() {
    this.compiling ??= this.gpu.createComputePipelineAsync(this.described);
    this.pipeline ??= await this.compiling;
  }

  /**
   * Append a dispatch to a pass.
   * @param {GPUComputePassEncoder} pass
   * @param {number[]} groups
   * @param {Buffers} buffers
   * @param {Values} constants
   */
  dispatch(pass, groups, buffers, constants) {
    this.pipeline ??= this.gpu.createComputePipeline(this.described);
    pass.setPipeline(this.pipeline);
    pass.setBindGroup(0, this.bindings.group(buffers), this.bindings.offsets(constants));
    pass.dispatchWorkgroups(groups[0], groups[1], groups[2]);
  }
}

/** A kernel of each shader, compiled once for a device. @template {Record<string, Shader>} T */
export function kernelsOf(/** @type {Device} */ device, /** @type {T} */ shaders) {
  const made = Object.entries(shaders).map(([name, shader]) => [
    name,
    device.once(shader, () => new Kernel(device, shader)),
  ]);
  return /** @type {Record<keyof T, Kernel>} */ (Object.fromEntries(made));
}

/** Whether all of these kernels were compiled on a device before. */
export function areCompiled(/** @type {Device} */ device, /** @type {Record<string, Shader>} */ shaders) {
  return Object.values(shaders).every(
    (shader) => /** @type {Kernel | undefined} */ (device.known.get(shader))?.pipeline,
  );
}

/** A kernel whose groups share so many elements of an array, compiled once for a device. @param {Device} device @param {Shader} shader @param {string} array @param {number} count @returns {Kernel} */
export function kernelWithRoom(device, shader, array, count) {
  return device.once(`${shader.entry} ${count}`, () => new Kernel(device, withRoom(shader, array, count)));
}

/**
 * @typedef {object} Drawn how a pipeline draws
 * @property {GPUTextureFormat} color
 * @property {GPUTextureFormat} [depth]
 * @property {boolean} [blend] lay premultiplied colour over what is there
 * @property {boolean} [write] depth, too
 * @property {boolean} [always] whatever is nearer
 * @property {GPUPrimitiveTopology} [topology]
 */

/** A vertex and a fragment entry, compiled when first needed; the vertex's resources lie in group 0, the fragment's in 1. */
export class Pipeline {
  constructor(
    /** @type {Device} */ device,
    /** @type {Shader} */ vertex,
    /** @type {Shader} */ fragment,
    /** @type {Drawn} */ drawn,
  ) {
    const { gpu } = device;
    this.stages = [vertex, fragment].map((shader) => new Bindings(device, shader));
    const target = { format: drawn.color, blend: drawn.blend ? { color: OVER, alpha: OVER } : undefined };
    /** @type {GPUDepthStencilState | undefined} */
    const depthStencil = drawn.depth && {
      format: drawn.depth,
      depthWriteEnabled: drawn.write ?? false,
      depthCompare: drawn.always ? "always" : "less-equal",
    };
    this.gpu = gpu;
    /** @type {GPURenderPipeline | null} */
    this.pipeline = null;
    /** @type {Promise<GPURenderPipeline> | null} */
    this.compiling = null;
    /** @type {GPURenderPipelineDescriptor} */
    this.described = {
      label: vertex.entry,
      layout: gpu.createPipelineLayout({ bindGroupLayouts: this.stages.map((stage) => stage.layout) }),
      vertex: { module: moduleOf(device, vertex), entryPoint: vertex.entry },
      fragment: { module: moduleOf(device, fragment), entryPoint: fragment.entry, targets: [target] },
      primitive: { topology: drawn.topology ?? "triangle-list" },
      depthStencil,
    };
  }

  /** Compile beside others, before it is needed. */
  async compile() {
    this.compiling ??= this.gpu.createRenderPipelineAsync(this.described);
    this.pipeline ??= await this.compiling;
  }

  /** Set the pipeline, its buffers and its constants for the draws that follow in a pass. */
  bind(/** @type {GPURenderPassEncoder} */ pass, /** @type {Buffers} */ buffers, /** @type {Values} */ constants) {
    this.pipeline ??= this.gpu.createRenderPipeline(this.described);
    pass.setPipeline(this.pipeline);
    for (const [index, stage] of this.stages.entries())
      pass.setBindGroup(index, stage.group(buffers), stage.offsets(constants));
  }
}
