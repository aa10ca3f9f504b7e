"""Decoding of texture images and base-colour factors to sRGB bytes."""

import io

import numpy as np
from PIL import Image

from mua.arrays import Array


def decode_image(content: bytes) -> Array:
    """Decode a PNG, JPEG or WebP to [h, w, 4] uint8; raises ValueError where Pillow cannot."""
    try:
        with Image.open(io.BytesIO(content)) as image:
            return np.asarray(image.convert("RGBA"))
    except (OSError, SyntaxError, Image.DecompressionBombError) as broken:
        raise ValueError(str(broken)) from broken


def flat(factor: Array) -> Array:
    """A picture [1, 1, 4] of a linear colour factor [4] in 0..1."""
    return tinted(np.full((1, 1, 4), 255, np.uint8), factor)


def tinted(image: Array, factor: Array) -> Array:
    """Multiply an sRGB picture [h, w, 4] uint8 by a linear colour factor [4] in 0..1."""
    if (np.asarray(factor) == 1).all():
        return image
    stored = np.arange(256) / 255
    linear = np.where(stored <= 0.04045, stored / 12.92, ((stored + 0.055) / 1.055) ** 2.4)
    result = np.empty_like(image)
    for channel in range(3):
        result[..., channel] = _encoded(linear * factor[channel])[image[..., channel]]
    result[..., 3] = np.round(255 * np.clip(stored * factor[3], 0, 1)).astype(np.uint8)[image[..., 3]]
    return result


def opaque(image: Array) -> Array:
    """The picture [h, w, 4] with full opacity."""
    result = image.copy()
    result[..., 3] = 255
    return result


def _encoded(linear: Array) -> Array:
    """sRGB bytes of linear values (IEC 61966-2-1)."""
    linear = np.clip(linear, 0, 1)
    encoded = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
    return np.round(255 * encoded).astype(np.uint8)
