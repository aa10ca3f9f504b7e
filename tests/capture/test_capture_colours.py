"""mua-capture check finds cameras whose exposure or white balance differs, by points that several cameras show."""

import re
from pathlib import Path

import numpy as np
from captures import make_capture, repaint

from mua.arrays import Array
from mua.capture.check import check_capture

GAINS = (1.0, 0.8, 0.85)


def dim(pixels: Array) -> None:
    pixels[..., :3] = pixels[..., :3] * GAINS


def test_a_camera_that_shows_other_colours_is_named_with_how_much_they_differ(tmp_path: Path) -> None:
    """A held-out one, of which mua-eval counts it as error."""
    capture = make_capture(tmp_path)
    repaint(capture.folder.glob("images/*/above/*.png"), dim)
    (remark,) = check_capture(capture, frames=0).remarks
    found = re.findall(r"(\w+) by ([+-]\d+)%, ([+-]\d+)%, ([+-]\d+)%", remark)
    assert [name for name, *_ in found] == ["above"]
    np.testing.assert_allclose(np.array(found[0][1:], float) / 100, np.subtract(GAINS, 1), atol=0.04)
    assert remark.endswith("of what above sees.")
