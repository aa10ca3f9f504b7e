"""Decoding of texture images and base-colour factors to sRGB bytes."""

import io

import numpy as np
from PIL import Image, UnidentifiedImageError

from mua.arrays import Array
from mua.files.signature import told_by

STORED = np.arange(256) / 255
LINEAR = np.where(STORED <= 0.04045, STORED / 12.92, ((STORED + 0.055) / 1.055) ** 2.4)  # of the sRGB bytes 0 to 255

SQUARE = 16  # texels along the side of a square that one texel becomes: its edge is a sixteenth of it wide
FINEST = 1024  # texels along a side, beyond which no picture is made finer


def decode_image(content: bytes) -> Array:
    """Decode a PNG, JPEG, WebP or AVIF to [h, w, 4] uint8; raises ValueError where Pillow cannot."""
    try:
        with Image.open(io.BytesIO(content)) as image:
            return np.asarray(in_8_bits(image).convert("RGBA"))
    except UnidentifiedImageError as unknown:  # whose text names an object in memory
        raise ValueError(f"its content is {told_by(content) or 'no known kind of picture'}") from unknown
    except (OSError, SyntaxError, Image.DecompressionBombError) as broken:
        raise ValueError(str(broken)) from broken


def in_8_bits(image: Image.Image) -> Image.Image:
    """The picture with 8 bits a value; Pillow would clip greys of 16 bits at 255 in place of scaling them."""
    if not image.mode.startswith("I;16"):
        return image
    return Image.fromarray(np.rint(np.asarray(image) / 257).astype(np.uint8))


def from_linear(image: Array) -> Array:
    """The sRGB picture [h, w, 4] uint8 of one whose colours are linear, in 8 bits too; opacity stays."""
    return np.dstack([_encoded(STORED)[image[..., :3]], image[..., 3]])


def blocky(image: Array) -> Array:
    """The picture [h, w, 4] with each texel as a square of several, as samplers show it that do not interpolate."""
    times = min(SQUARE, FINEST // max(image.shape[:2]))
    return image if times < 2 else image.repeat(times, axis=0).repeat(times, axis=1)


def flat(factor: Array) -> Array:
    """A picture [1, 1, 4] of a linear colour factor [4] in 0..1."""
    return tinted(np.full((1, 1, 4), 255, np.uint8), factor)


def tinted(image: Array, factor: Array) -> Array:
    """Multiply an sRGB picture [h, w, 4] uint8 by a linear colour factor [4] in 0..1."""
    if (np.asarray(factor) == 1).all():
        return image
    result = np.empty_like(image)
    for channel in range(3):
        result[..., channel] = _encoded(LINEAR * factor[channel])[image[..., channel]]
    result[..., 3] = np.round(255 * np.clip(STORED * factor[3], 0, 1)).astype(np.uint8)[image[..., 3]]
    return result


def multiplied(colors: Array, factors: Array) -> Array:
    """Multiply sRGB colours [n, 4] uint8 by a linear factor [n, 4] each."""
    encoded = _encoded(LINEAR[colors[:, :3]] * factors[:, :3])
    opacity = np.round(255 * np.clip(STORED[colors[:, 3]] * factors[:, 3], 0, 1)).astype(np.uint8)
    return np.column_stack([encoded, opacity])


def glowing(image: Array, glow: Array) -> Array:
    """A picture [h, w, 4] uint8 that sends out the light of another, [h', w', 4] uint8 sRGB; both may be 1 x 1.

    The brighter of both is taken in each channel: exporters often give the same picture as colour and as glow, and
    their sum would burn out.
    """
    height, width = np.maximum(image.shape[:2], glow.shape[:2])
    image, glow = (_resized(picture, width, height) for picture in (image, glow))
    return np.dstack([np.maximum(image[..., :3], glow[..., :3]), image[..., 3]])


def with_opacity(image: Array, opacity: Array) -> Array:
    """A picture [h, w, 4] uint8 with another opacity [h', w'] uint8, both brought to the larger size."""
    height, width = np.maximum(image.shape[:2], opacity.shape)
    color, alpha = (
        np.asarray(Image.fromarray(plane).resize((width, height), Image.Resampling.BILINEAR))
        for plane in (np.ascontiguousarray(image[..., :3]), np.ascontiguousarray(opacity))
    )
    return np.dstack([color, alpha])


def transmitting(image: Array, share: Array) -> Array:
    """A picture [h, w, 4] uint8 that lets through a share of the light, [h', w'] in 0..1; both may be 1 x 1.

    Glass filters light by its colour: what is white becomes clear, what is dark stays opaque.
    """
    height, width = np.maximum(image.shape[:2], share.shape)
    image = _resized(image, width, height)
    passed = _resized(np.repeat(np.round(255 * share[..., None]).astype(np.uint8), 4, axis=2), width, height)[..., 0]
    opacity = image[..., 3] * (1 - passed / 255 * LINEAR[image[..., :3].max(axis=2)])
    return np.dstack([image[..., :3], np.round(opacity).astype(np.uint8)])


def _resized(image: Array, width: int, height: int) -> Array:
    if image.shape[:2] == (height, width):
        return image
    return np.asarray(Image.fromarray(image).resize((width, height), Image.Resampling.BILINEAR))


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
