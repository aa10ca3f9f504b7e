"""The choice of avatars' levels of detail and of splats' shapes by their size on the screen, and a budget of splats.

unity-package/Runtime/LevelChoice.cs and web/level_choice.js choose alike; tests/golden/level_choice.json holds all to
it.
"""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass

import numpy as np

from mua.arrays import Array
from mua.avatar.camera import Camera

LARGEST_TEXEL = 0.65  # pixels along a side; texels up to this size look the same as smaller ones
LARGEST_TRIANGLE = 32.0  # pixels of a quad, about; up to this size one triangle costs less than two halves
HYSTERESIS = 1.15  # factor by which texels must look larger before a finer level returns


@dataclass(frozen=True)
class Seen:
    """An avatar as the eyes see it."""

    distance: float  # metres
    texel: float  # pixels along a side of a texel of its finest level
    counts: tuple[int, ...]  # splats by level, the finest first
    shown: int = 0  # level at present


def texel_pixels(
    length: float,  # side of a texel, metres
    box: Array,  # [2, 3] the avatar's box in the world, metres
    cameras: Sequence[Camera],  # one or two eyes
) -> tuple[float, float]:
    """Metres of the box from the middle of the eyes, and pixels along a side of a texel at its nearest point."""
    camera = cameras[0]
    eye = _middle(cameras)
    away = float(np.linalg.norm(np.maximum(np.maximum(box[0] - eye, eye - box[1]), 0)))
    focal = float(camera.projection[1, 1]) * camera.screen[1] / 2
    return away, length * focal / max(away, camera.near)


def splat_corners(
    boxes: Iterable[Array],  # [2, 3] of each avatar in view, metres
    splats: int,  # of all of them
    cameras: Sequence[Camera],  # one or two eyes
) -> int:
    """Vertices of each splat: 3 where splats are small, one triangle around the quad; else 6, the quad's halves.

    Both make the same picture: the triangle has twice the area, but is half of the triangles and of the vertices. Quads
    are taken to cover together the squares on the diagonals of the avatars' boxes.
    """
    eye, camera = _middle(cameras), cameras[0]
    focal = float(camera.projection[1, 1]) * camera.screen[1] / 2
    covered = 0.0
    for low, high in boxes:
        away = max(float(np.linalg.norm((low + high) / 2 - eye)), camera.near)
        covered += (float(np.linalg.norm(high - low)) * focal / away) ** 2
    return 3 if covered <= LARGEST_TRIANGLE * splats else 6


def choose_level(seen: Seen) -> int:
    """The coarsest level with texels up to LARGEST_TEXEL; one that is shown stays until they are a little larger."""
    level = 0
    for coarser in range(1, len(seen.counts)):
        largest = LARGEST_TEXEL * (HYSTERESIS if coarser <= seen.shown else 1)
        if seen.texel * 2**coarser <= largest:
            level = coarser
    return level


def choose_levels(
    avatars: Sequence[Seen],
    budget: int | None,  # splats of all together; None: as many as there are
) -> list[int]:
    """A level for each, no finer than it is worth: the nearest first has what it is worth, as far as the budget goes.

    Every other one is kept the splats of its coarsest level; where not even these fit, all are at their coarsest. Of
    two that are about as near, the one that is shown finer now counts as nearer, so that they do not swap to and fro.
    """
    worth = [choose_level(seen) for seen in avatars]
    if budget is None:
        return worth
    spare = budget - sum(seen.counts[-1] for seen in avatars)
    levels = [len(seen.counts) - 1 for seen in avatars]
    for i in sorted(range(len(avatars)), key=lambda i: avatars[i].distance * HYSTERESIS ** avatars[i].shown):
        counts = avatars[i].counts
        for level in range(worth[i], len(counts)):
            if counts[level] - counts[-1] <= spare:
                levels[i] = level
                spare -= counts[level] - counts[-1]
                break
    return levels


def _middle(cameras: Sequence[Camera]) -> Array:
    """Place [3] between the eyes, metres."""
    return np.asarray(np.mean([camera.position for camera in cameras], axis=0))
