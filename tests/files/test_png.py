"""PNG files that are packed in bands."""

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from mua.files.png import BAND, write_png


@pytest.mark.parametrize("size", [(1, 1), (3, 2), (7, BAND), (31, 2 * BAND + 1), (640, 211)])
def test_other_programs_read_the_same_pixels(tmp_path: Path, size: tuple[int, int]) -> None:
    pixels = np.random.default_rng(0).integers(0, 256, (*size[::-1], 3), dtype=np.uint8)
    write_png(tmp_path / "picture.png", Image.fromarray(pixels))
    with Image.open(tmp_path / "picture.png") as picture:
        picture.verify()
    with Image.open(tmp_path / "picture.png") as picture:
        assert (picture.format, picture.mode) == ("PNG", "RGB")
        np.testing.assert_array_equal(picture, pixels)


def test_what_repeats_is_packed(tmp_path: Path) -> None:
    write_png(tmp_path / "plain.png", Image.new("RGB", (400, 400), "teal"))
    assert (tmp_path / "plain.png").stat().st_size < 400 * 400 * 3 / 100
