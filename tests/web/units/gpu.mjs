// A graphics device that computes nothing: it counts what is held on it and notes what is dispatched.

Object.assign(globalThis, {
  GPUBufferUsage: { STORAGE: 128, COPY_DST: 8, COPY_SRC: 4, INDIRECT: 256, INDEX: 16, UNIFORM: 64, MAP_READ: 1 },
  GPUTextureUsage: { RENDER_ATTACHMENT: 16, COPY_SRC: 1, TEXTURE_BINDING: 4 },
  GPUShaderStage: { COMPUTE: 4, VERTEX: 1, FRAGMENT: 2 },
});

/** `lacking` says what the next error scope found; `broken` which entry points do not compile. */
export function fakeGpu({ most = 1 << 28 } = {}) {
  const gpu = { held: new Set(), written: [], lacking: null, broken: "", destroyed: false };
  const made = (given) => ({ ...given, createView: () => ({}) });
  const holds = (given) => {
    const one = made({ ...given, destroy: () => gpu.held.delete(one) });
    gpu.held.add(one);
    return one;
  };
  return Object.assign(gpu, {
    lost: new Promise(() => {}),
    features: new Set(),
    limits: { maxBufferSize: most, maxStorageBufferBindingSize: most },
    queue: { submit() {}, onSubmittedWorkDone: async () => {}, writeBuffer: (...given) => gpu.written.push(given) },
    createBuffer: holds,
    createTexture: ({ size: [width, height], ...given }) => holds({ width, height, ...given }),
    createComputePipelineAsync: async ({ label }) => {
      if (label === gpu.broken) throw new Error(`${label} does not compile`);
      return made({ label });
    },
    pushErrorScope() {},
    popErrorScope: async () => gpu.lacking,
    destroy: () => (gpu.destroyed = true),
    ...Object.fromEntries(
      ["ShaderModule", "BindGroupLayout", "BindGroup", "PipelineLayout", "ComputePipeline", "RenderPipeline"].map(
        (kind) => [`create${kind}`, made],
      ),
    ),
    createRenderPipelineAsync: async (given) => made(given),
  });
}
