"""Pictures in KTX2 (KHR_texture_basisu): ETC1S or UASTC, which Basis Universal unpacks to 8 bits a channel."""

import numpy as np
import opengl_basisu

from mua.arrays import Array

MAGIC = b"\xabKTX 20\xbb\r\n\x1a\n"
MOST_PIXELS = 1 << 28  # 16,384 texels a side


def is_ktx2(content: bytes) -> bool:
    return content.startswith(MAGIC)


def decode_ktx2(content: bytes) -> Array:
    """The largest level [h, w, 4] uint8; raises ValueError where it is broken, too large, or of high dynamic range."""
    texture = opengl_basisu.open(content)
    if texture.width * texture.height > MOST_PIXELS:
        raise ValueError(f"it has {texture.width} x {texture.height} texels, more than {MOST_PIXELS:,} in all")
    image = texture.transcode(opengl_basisu.Target.RGBA8)
    return np.array(image.data, np.uint8).reshape(texture.height, texture.width, 4)
