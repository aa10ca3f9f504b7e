"""The order of a frame's dispatches, and how far a frame on the GPU may be from the reference."""

import numpy as np

from mua.arrays import Array

# Metres. Offsets from the mesh, up to 125 mm here, are half floats, rounded either way along three axes; float32 leaves
# a hundredth of it on a person two metres from the origin.
POSITION_BOUND = 0.125 * 2**-10 * float(np.sqrt(3))

COLOR_BOUND = 1 / 512  # half a step of 8 bits

OPACITY_BOUND = 2**-10  # a half float below 1, and a logit in one, both of which a GPU may round towards zero

LEAST_PSNR = 50.0  # dB of an image against the CPU rasteriser's

FEWER_THAN = 31  # dispatches in a frame

_BLEND = [*["MlpMatmul"] * 3, "BlendLl", "BlendDetail", "InverseDwt", "BlendDetail"]
_TEXELS = ["InverseDwt", "UpsampleTexels"]
_MESH = [*["MlpMatmul"] * 3, "MlpMatmulTransposed"]

PARTS_ORDER = [_BLEND, [*_MESH, *_TEXELS], _BLEND, _TEXELS]  # in the parts of a decode

DECODE_ORDER = [name for part in PARTS_ORDER for name in part]

HALVES = [len(PARTS_ORDER[i]) + len(PARTS_ORDER[i + 1]) for i in (0, 2)]  # dispatches, of an avatar alone in view

FRAME_ORDER = [
    *DECODE_ORDER,
    "BlendVertices",
    "SplatProject",
    *["CountDigits", "ScanDigits", "ScatterDigits"] * 2,
]


def psnr(image: Array, exact: Array) -> float:
    """Decibels below 1; two images that are both empty agree by 120."""
    return float(-10 * np.log10(np.maximum(np.mean((image - exact) ** 2), 1e-12)))
