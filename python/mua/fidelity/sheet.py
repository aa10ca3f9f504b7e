"""One image of the comparison: source, splats and their difference side by side."""

import numpy as np
from PIL import Image, ImageDraw

from mua.arrays import Array
from mua.avatar.rendering import to_bytes
from mua.fidelity.background import background_for, over
from mua.fidelity.compare import SCREEN, Fidelity, PoseFidelity, Shot
from mua.fidelity.strips import GAIN, caption, difference, sheet

COLUMNS = 2  # views beside each other
MARK = 14  # pixels from the middle of the worst place to the frame around it


def fidelity_sheet(fidelity: Fidelity) -> Image.Image:
    """Three cells for every view of every pose; a frame marks the worst place of each view."""
    background = _background(fidelity)
    rows = [_strip(pose, shot, background=background) for pose in fidelity.poses for shot in pose.shots]
    return sheet(rows, COLUMNS)


def worst_strips(
    fidelity: Fidelity,
    cell: tuple[int, int],  # width, height, pixels
) -> list[Array]:
    """For each pose its worst view: source, splats and difference [h, 3 w, 3] uint8 under a caption."""
    background = _background(fidelity)
    return [_strip(pose, pose.worst, cell, background=background) for pose in fidelity.poses]


def _background(fidelity: Fidelity) -> float:
    return background_for(shot.source for pose in fidelity.poses for shot in pose.shots)


def _strip(pose: PoseFidelity, shot: Shot, cell: tuple[int, int] = SCREEN, *, background: float) -> Array:
    scale = min(cell[0] / SCREEN[0], cell[1] / SCREEN[1])
    shown = [_fitted(image, cell, scale, background) for image in (shot.source, shot.splats)]
    picture = Image.fromarray(np.hstack([to_bytes(image) for image in (*shown, difference(*shown))]))
    draw = ImageDraw.Draw(picture)
    column, row = (scale * place for place in shot.place)
    for i in range(3):
        middle = column + i * cell[0]
        draw.rectangle((middle - MARK, row - MARK, middle + MARK, row + MARK), outline="red")
    found = shot.agreement
    titles = (
        f"source: {pose.pose}, {shot.view}",
        f"splats: overlap {100 * found.iou:.1f} %, {found.psnr:.1f} dB",
        f"difference x{GAIN}; frame: worst, at {shot.joint}",
    )
    return np.vstack([caption(titles, cell[0]), np.asarray(picture)])


def _fitted(
    image: Array,  # [H, W, 4] premultiplied sRGB and alpha
    cell: tuple[int, int],
    scale: float,
    background: float,
) -> Array:
    """The image over a plain background, [h, w, 3] in 0..1, at the top left of a cell."""
    shown = over(image, background)
    if scale != 1:
        size = round(scale * SCREEN[0]), round(scale * SCREEN[1])
        shown = np.asarray(Image.fromarray(to_bytes(shown)).resize(size), np.float32) / 255
    filled = np.full((cell[1], cell[0], 3), background, np.float32)
    filled[: shown.shape[0], : shown.shape[1]] = shown
    return filled
