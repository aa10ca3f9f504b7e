"""Generated from schemas/muaavatar.fbs by tools/gen_layout.py; do not edit."""

from typing import NamedTuple


class Field(NamedTuple):
    """One slot of a table: `kind` is a scalar, `string`, an enum or a table; `vector` says whether there are many."""

    name: str
    kind: str
    vector: bool = False
    required: bool = False
    align: int = 0


IDENTIFIER = b"MUAV"
ROOT = "Avatar"

ENUMS = {
    "ElementType": ("F32", "F16", "I8", "I32"),
    "Packing": ("Plain", "Deflate", "Steps"),
    "Axes": ("MetresYUpRightHanded",),
    "RotationEncoding": ("SixD",),
    "WindowOrder": ("NewestFirst",),
}

TABLES = {
    "Tensor": (
        Field("shape", "uint", vector=True, required=True),
        Field("type", "ElementType"),
        Field("data", "ubyte", vector=True, required=True, align=16),
        Field("scale", "float", vector=True),
        Field("packing", "Packing"),
    ),
    "Skeleton": (
        Field("names", "string", vector=True, required=True),
        Field("parents", "Tensor", required=True),
        Field("bind_rotations", "Tensor", required=True),
        Field("bind_translations", "Tensor", required=True),
        Field("bind_inverse", "Tensor", required=True),
        Field("root", "uint"),
        Field("translated", "Tensor"),
    ),
    "PoseEncoding": (
        Field("joints", "Tensor", required=True),
        Field("rotation", "RotationEncoding"),
        Field("order", "WindowOrder"),
        Field("window", "uint"),
        Field("rate", "float"),
        Field("heading", "bool"),
        Field("mean", "Tensor", required=True),
        Field("scale", "Tensor", required=True),
        Field("translated", "Tensor"),
        Field("components", "Tensor", required=True),
        Field("ranges", "Tensor", required=True),
        Field("margins", "Tensor", required=True),
    ),
    "Template": (
        Field("faces", "Tensor", required=True),
        Field("uv", "Tensor", required=True),
        Field("uv_faces", "Tensor", required=True),
        Field("skin_indices", "Tensor", required=True),
        Field("skin_weights", "Tensor", required=True),
    ),
    "Level": (Field("blocks", "ubyte", vector=True, required=True),),
    "Texels": (
        Field("size", "uint"),
        Field("texels", "Tensor", required=True),
        Field("triangles", "Tensor", required=True),
        Field("barycentrics", "Tensor", required=True),
        Field("listed", "Tensor"),
        Field("one_sided", "ubyte", vector=True),
        Field("length", "float"),
        Field("levels", "Level", vector=True, required=True),
    ),
    "Wavelet": (
        Field("name", "string", required=True),
        Field("levels", "uint"),
        Field("rec_lo", "double", vector=True, required=True),
        Field("rec_hi", "double", vector=True, required=True),
    ),
    "Layer": (
        Field("weight", "Tensor", required=True),
        Field("bias", "Tensor", required=True),
    ),
    "Coarse": (
        Field("mlp", "Layer", vector=True, required=True),
        Field("mean", "Tensor", required=True),
        Field("basis", "Tensor", required=True),
    ),
    "DetailBand": (
        Field("mean", "Tensor", required=True),
        Field("h", "Tensor", required=True),
        Field("w", "Tensor", required=True),
    ),
    "Branch": (
        Field("mlp", "Layer", vector=True, required=True),
        Field("ll_mean", "Tensor", required=True),
        Field("ll_basis", "Tensor", required=True),
        Field("details", "DetailBand", vector=True, required=True),
        Field("static_offset", "Tensor", required=True),
    ),
    "Clip": (
        Field("name", "string", required=True),
        Field("rate", "float"),
        Field("rotations", "Tensor", required=True),
        Field("translation", "Tensor", required=True),
        Field("translations", "Tensor"),
        Field("expressions", "Tensor"),
    ),
    "Surface": (
        Field("runs", "ubyte", vector=True, required=True),
        Field("strips", "Tensor", required=True),
    ),
    "Expressions": (
        Field("names", "string", vector=True, required=True),
        Field("starts", "Tensor", required=True),
        Field("vertices", "Tensor", required=True),
        Field("offsets", "Tensor", required=True),
        Field("gains", "Tensor"),
        Field("rules", "Tensor"),
    ),
    "Avatar": (
        Field("version_major", "ushort"),
        Field("version_minor", "ushort"),
        Field("crc32", "uint"),
        Field("axes", "Axes"),
        Field("name", "string", required=True),
        Field("producer", "string", required=True),
        Field("notes", "string", required=True),
        Field("skeleton", "Skeleton", required=True),
        Field("encoding", "PoseEncoding", required=True),
        Field("template", "Template", required=True),
        Field("texels", "Texels", required=True),
        Field("wavelet", "Wavelet", required=True),
        Field("coarse", "Coarse", required=True),
        Field("geometry", "Branch", required=True),
        Field("appearance", "Branch", required=True),
        Field("clips", "Clip", vector=True, required=True),
        Field("bounds", "Tensor", required=True),
        Field("thumbnail", "ubyte", vector=True, required=True),
        Field("surface", "Surface"),
        Field("stages", "uint", vector=True),
        Field("expressions", "Expressions"),
    ),
}
