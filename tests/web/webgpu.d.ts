// What TypeScript's own description of WebGPU lacks.

declare const GPUBufferUsage: Record<
  "MAP_READ" | "COPY_SRC" | "COPY_DST" | "INDEX" | "UNIFORM" | "STORAGE" | "INDIRECT" | "QUERY_RESOLVE",
  GPUBufferUsageFlags
>;
declare const GPUTextureUsage: Record<"COPY_SRC" | "RENDER_ATTACHMENT" | "TEXTURE_BINDING", GPUTextureUsageFlags>;
declare const GPUShaderStage: Record<"VERTEX" | "FRAGMENT" | "COMPUTE", GPUShaderStageFlags>;
declare const GPUMapMode: Record<"READ", GPUMapModeFlags>;
