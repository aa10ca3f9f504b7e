"""The image of a check: the posed template's outline over what some cameras saw."""

import numpy as np
from PIL import Image, ImageDraw
from PIL.Image import Resampling

from mua.arrays import Array
from mua.avatar.rendering import to_bytes
from mua.capture.check import Checked
from mua.capture.fit import Seen
from mua.capture.silhouette import COVERED
from mua.capture.view import person, smaller

CELL = 420  # pixels along the longer side of an image
COLUMNS, ROWS = 4, 2
OUTLINE, MASK = (255, 0, 160), (0, 200, 255)  # of the template and of the mask
CAPTION = 32  # pixels, of two lines
LEAST_WIDTH = 170  # of a caption, pixels
BEHIND = 0.35  # grey of what is clear


def check_sheet(checked: Checked) -> Image.Image:
    """Up to eight views: those that fit worst of four cameras, and one more of each."""
    cells = [_cell(checked, view) for view in _chosen(checked)]
    columns = min(COLUMNS, len(cells)) or 1
    rows = -(-len(cells) // columns)
    width = max((cell.width for cell in cells), default=CELL)
    height = max((cell.height for cell in cells), default=CELL)
    sheet = Image.new("RGB", (columns * width, rows * height + CAPTION), "white")
    for i, cell in enumerate(cells):
        sheet.paste(cell, (i % columns * width, i // columns * height))
    draw = ImageDraw.Draw(sheet)
    draw.text((4, rows * height + 3), "outline of the posed template", fill=OUTLINE)
    draw.text((230, rows * height + 3), "edge of the mask", fill=MASK)
    return sheet


def _chosen(checked: Checked) -> list[Seen]:
    """The worst camera and others spread over the list; of each the worst view and, below it, the middle one."""
    seen = [camera for camera in checked.cameras if camera.views]
    worst = sorted(seen, key=lambda camera: camera.mean or 0)[:1]
    others = [camera for camera in seen if camera not in worst]
    spread = [others[i] for i in np.unique(np.linspace(0, len(others) - 1, COLUMNS - 1).astype(int))] if others else []
    ordered = [sorted(camera.views, key=lambda view: view.overlap) for camera in (*worst, *spread)]
    return [of[0] for of in ordered] + [of[len(of) // 2] for of in ordered if len(of) > 1]


def _cell(checked: Checked, view: Seen) -> Image.Image:
    """The part of one view with the person or the template in it, and both outlines, below its names."""
    capture, camera = checked.capture, checked.capture.camera(view.camera.name)
    box = np.array(person((view.mask | view.covered).astype(float)))
    rows = min(camera.size[1], max(1, CELL * view.camera.size[1] // int((box[2:] - box[:2]).max())))
    camera = smaller(camera, rows)
    left, upper, right, lower = (int(edge) for edge in box * np.tile(camera.size, 2) // np.tile(view.camera.size, 2))
    seen, part = capture.view(view.clip, view.frame, camera.name, rows=rows), np.s_[upper:lower, left:right]
    mask, image = seen.mask[part], seen.image[part]
    if capture.masks is None:  # what is clear has no colour
        image = image * mask[..., None] + BEHIND * (1 - mask[..., None])
    size = (round(CELL * (right - left) / max(mask.shape)), round(CELL * (lower - upper) / max(mask.shape)))
    shown, masked = (np.array(Image.fromarray(to_bytes(a)).resize(size, Resampling.NEAREST)) for a in (image, mask))
    camera = camera.cropped((left, upper, right, lower)).resized(size)
    shown[_edge(masked >= 255 * COVERED)] = MASK
    shown[_edge(checked.posed.covers(view.clip, view.frame, camera))] = OUTLINE
    return _captioned(shown, f"{camera.name}: {view.overlap:.0%}\n{view.clip}, frame {view.frame}")


def _edge(covered: Array) -> Array:
    """Pixels of a surface [H, W] bool beside those that are not."""
    padded = np.pad(covered, 1)
    inner = padded[:-2, 1:-1] & padded[2:, 1:-1] & padded[1:-1, :-2] & padded[1:-1, 2:]
    return np.asarray(covered & ~inner)


def _captioned(picture: Array, caption: str) -> Image.Image:
    width = max(picture.shape[1], LEAST_WIDTH) + 4
    cell = Image.new("RGB", (width, picture.shape[0] + CAPTION + 4), "white")
    cell.paste(Image.fromarray(picture), ((width - picture.shape[1]) // 2, CAPTION))
    ImageDraw.Draw(cell).text((4, 2), caption, fill="black")
    return cell
