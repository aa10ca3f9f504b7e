"""Images by the CPU reference, and the code that both renderers share; needs no graphics device."""

from collections.abc import Sequence
from functools import cache, lru_cache

import numpy as np

from mua.arrays import Array
from mua.asset.avatar import Avatar
from mua.avatar.camera import Camera
from mua.avatar.decode import decode_clip_frame
from mua.avatar.rendering import render_premultiplied, to_bytes
from mua.player.levels import Levels
from mua.pose.clip import Clip


class Reference:
    """Draws Offscreen's images by the CPU reference; each eye sees its own colours."""

    def __init__(self, avatar: Avatar, clip: Clip, *, levels: Levels | None = None) -> None:
        """`clip` is at the rate of the avatar's encoding; `levels` choose the level of detail, the finest if None."""
        self._clip, self._levels = clip, levels
        at_level = cache(avatar.at_level)
        self._decode = lru_cache(maxsize=1)(lambda index, level: decode_clip_frame(at_level(level), clip, frame=index))

    def picture(self, index: int, cameras: Sequence[Camera]) -> Array:
        """Premultiplied sRGB and alpha [H, E W, 4] of one frame, as Offscreen.picture draws it."""
        pose = self._clip.rotations[index], self._clip.translations[index]
        level = 0 if self._levels is None else self._levels.choose(*pose, cameras)
        return np.hstack([render_premultiplied(self._decode(index, level), camera) for camera in cameras])


def over(
    image: Array,  # [H, W, 4] premultiplied sRGB and alpha
    background: tuple[float, float, float] | None,  # sRGB, 0..1; None: transparent
) -> Array:
    """The image over a plain background, [H, W, 3] uint8, or transparent with straight alpha, [H, W, 4]."""
    if background is not None:
        return to_bytes(image[..., :3] + (1 - image[..., 3:]) * np.array(background))
    alpha = np.clip(image[..., 3:], 0, 1)
    color = image[..., :3] / np.where(alpha > 0, alpha, 1)
    return to_bytes(np.concatenate([color, alpha], axis=-1))
