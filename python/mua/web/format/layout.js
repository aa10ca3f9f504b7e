// Generated from schemas/muaavatar.fbs by tools/gen_layout.py; do not edit.

export const IDENTIFIER = "MUAV";
export const ROOT = "Avatar";

/** @type {Record<string, string[]>} */
export const ENUMS = {"ElementType": ["F32", "F16", "I8", "I32"], "Packing": ["Plain", "Deflate", "Steps"], "Axes": ["MetresYUpRightHanded"], "RotationEncoding": ["SixD"], "WindowOrder": ["NewestFirst"]};

/** @type {Record<string, import("./parser.js").Field[]>} */
export const TABLES = {
  Tensor: [
    { name: "shape", kind: "uint", vector: true, required: true },
    { name: "type", kind: "ElementType" },
    { name: "data", kind: "ubyte", vector: true, required: true, align: 16 },
    { name: "scale", kind: "float", vector: true },
    { name: "packing", kind: "Packing" },
  ],
  Skeleton: [
    { name: "names", kind: "string", vector: true, required: true },
    { name: "parents", kind: "Tensor", required: true },
    { name: "bind_rotations", kind: "Tensor", required: true },
    { name: "bind_translations", kind: "Tensor", required: true },
    { name: "bind_inverse", kind: "Tensor", required: true },
    { name: "root", kind: "uint" },
    { name: "translated", kind: "Tensor" },
  ],
  PoseEncoding: [
    { name: "joints", kind: "Tensor", required: true },
    { name: "rotation", kind: "RotationEncoding" },
    { name: "order", kind: "WindowOrder" },
    { name: "window", kind: "uint" },
    { name: "rate", kind: "float" },
    { name: "heading", kind: "bool" },
    { name: "mean", kind: "Tensor", required: true },
    { name: "scale", kind: "Tensor", required: true },
    { name: "translated", kind: "Tensor" },
    { name: "components", kind: "Tensor", required: true },
    { name: "ranges", kind: "Tensor", required: true },
    { name: "margins", kind: "Tensor", required: true },
  ],
  Template: [
    { name: "faces", kind: "Tensor", required: true },
    { name: "uv", kind: "Tensor", required: true },
    { name: "uv_faces", kind: "Tensor", required: true },
    { name: "skin_indices", kind: "Tensor", required: true },
    { name: "skin_weights", kind: "Tensor", required: true },
  ],
  Level: [
    { name: "blocks", kind: "ubyte", vector: true, required: true },
  ],
  Texels: [
    { name: "size", kind: "uint" },
    { name: "texels", kind: "Tensor", required: true },
    { name: "triangles", kind: "Tensor", required: true },
    { name: "barycentrics", kind: "Tensor", required: true },
    { name: "listed", kind: "Tensor" },
    { name: "one_sided", kind: "ubyte", vector: true },
    { name: "length", kind: "float" },
    { name: "levels", kind: "Level", vector: true, required: true },
  ],
  Wavelet: [
    { name: "name", kind: "string", required: true },
    { name: "levels", kind: "uint" },
    { name: "rec_lo", kind: "double", vector: true, required: true },
    { name: "rec_hi", kind: "double", vector: true, required: true },
  ],
  Layer: [
    { name: "weight", kind: "Tensor", required: true },
    { name: "bias", kind: "Tensor", required: true },
  ],
  Coarse: [
    { name: "mlp", kind: "Layer", vector: true, required: true },
    { name: "mean", kind: "Tensor", required: true },
    { name: "basis", kind: "Tensor", required: true },
  ],
  DetailBand: [
    { name: "mean", kind: "Tensor", required: true },
    { name: "h", kind: "Tensor", required: true },
    { name: "w", kind: "Tensor", required: true },
  ],
  Branch: [
    { name: "mlp", kind: "Layer", vector: true, required: true },
    { name: "ll_mean", kind: "Tensor", required: true },
    { name: "ll_basis", kind: "Tensor", required: true },
    { name: "details", kind: "DetailBand", vector: true, required: true },
    { name: "static_offset", kind: "Tensor", required: true },
  ],
  Clip: [
    { name: "name", kind: "string", required: true },
    { name: "rate", kind: "float" },
    { name: "rotations", kind: "Tensor", required: true },
    { name: "translation", kind: "Tensor", required: true },
    { name: "translations", kind: "Tensor" },
    { name: "expressions", kind: "Tensor" },
  ],
  Surface: [
    { name: "runs", kind: "ubyte", vector: true, required: true },
    { name: "strips", kind: "Tensor", required: true },
  ],
  Expressions: [
    { name: "names", kind: "string", vector: true, required: true },
    { name: "starts", kind: "Tensor", required: true },
    { name: "vertices", kind: "Tensor", required: true },
    { name: "offsets", kind: "Tensor", required: true },
    { name: "gains", kind: "Tensor" },
    { name: "rules", kind: "Tensor" },
  ],
  Avatar: [
    { name: "version_major", kind: "ushort" },
    { name: "version_minor", kind: "ushort" },
    { name: "crc32", kind: "uint" },
    { name: "axes", kind: "Axes" },
    { name: "name", kind: "string", required: true },
    { name: "producer", kind: "string", required: true },
    { name: "notes", kind: "string", required: true },
    { name: "skeleton", kind: "Skeleton", required: true },
    { name: "encoding", kind: "PoseEncoding", required: true },
    { name: "template", kind: "Template", required: true },
    { name: "texels", kind: "Texels", required: true },
    { name: "wavelet", kind: "Wavelet", required: true },
    { name: "coarse", kind: "Coarse", required: true },
    { name: "geometry", kind: "Branch", required: true },
    { name: "appearance", kind: "Branch", required: true },
    { name: "clips", kind: "Clip", vector: true, required: true },
    { name: "bounds", kind: "Tensor", required: true },
    { name: "thumbnail", kind: "ubyte", vector: true, required: true },
    { name: "surface", kind: "Surface" },
    { name: "stages", kind: "uint", vector: true },
    { name: "expressions", kind: "Expressions" },
  ],
};
