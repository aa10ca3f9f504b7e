"""The file's tensors as the kernels read them: words of packed elements, and how to unpack them."""

import numpy as np

from mua.arrays import Array
from mua.asset.flatbuffer import Tree
from mua.asset.layout import ENUMS

Layout = tuple[int, int, int]  # element type, elements for each scale, index of the first scale's word


def upload_words(tensor: Tree) -> tuple[Array, Layout]:
    """The words (uint32) and the layout of a tensor stored as F32, F16 or I8: its bytes, then the scales of I8.

    Mirrored by `stored()` of ComputeShaders/common.hlsl.
    """
    data = tensor["data"]
    padded = np.zeros(-(-data.size // 4) * 4, np.uint8)
    padded[: data.size] = data
    words = padded.view("<u4")
    kind = ENUMS["ElementType"].index(tensor["type"])
    if tensor["type"] != "I8":
        return words, (kind, 1, 0)
    scales = tensor["scale"].astype("<f4", copy=False)
    per_scale = max(data.size // max(scales.size, 1), 1)
    return np.concatenate([words, scales.view("<u4")]), (kind, per_scale, words.size)
