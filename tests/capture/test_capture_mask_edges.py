"""mua-capture check compares the edges of masks with the posed template all round, and finds holes."""

import re
from dataclasses import replace
from pathlib import Path

import numpy as np
from captures import make_capture, repaint
from scipy.ndimage import distance_transform_edt

from mua.arrays import Array
from mua.capture import Capture
from mua.capture.check import check_capture
from mua.capture.fit import Posed, look_at


def test_masks_that_are_too_wide_everywhere_are_worth_a_remark_until_they_are_trimmed(
    tmp_path: Path, small_capture: Capture
) -> None:
    damaged = make_capture(tmp_path)

    def widen(pixels: Array) -> None:
        pixels[distance_transform_edt(pixels[..., 3] == 0) < 1.2, 3] = 255

    repaint(damaged.folder.glob("images/*/*/*.png"), widen)
    assert check_capture(small_capture, frames=0).remarks == ()
    checked = check_capture(damaged, frames=0)
    (remark,) = checked.remarks
    assert checked.problems == ()
    assert re.match(r"All round, .* by [67]\d%; they would by 9\d% if masks were 1 pixel narrower: set trim_m", remark)
    assert check_capture(replace(damaged, trim_masks=1), frames=0).remarks == ()


def test_masks_with_holes_are_worth_a_remark(tmp_path: Path) -> None:
    damaged = make_capture(tmp_path)
    posed = Posed.of(damaged, damaged.clips)
    view = look_at(damaged, posed, "walk", 2, damaged.camera("left"))
    row, column = np.unravel_index(distance_transform_edt(view.covered).argmax(), view.covered.shape)

    def cut(pixels: Array) -> None:
        pixels[row - 1 : row + 2, column - 1 : column + 2, 3] = 0

    repaint([damaged.files("walk", 2, "left").image], cut)
    (remark,) = check_capture(damaged, frames=0).remarks
    assert re.match(r"1 of 24 masks have holes .* of the mask of camera left, clip walk, frame 2\. Fill them", remark)
