"""Pictures that the check writes, as another program reads them."""

from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from mua.fidelity import png


@pytest.mark.parametrize(("width", "height"), [(1, 1), (7, png.BLOCK), (5, png.BLOCK + 1), (3, 3 * png.BLOCK - 1)])
def test_pillow_reads_back_every_pixel(tmp_path: Path, width: int, height: int) -> None:
    pixels = np.random.default_rng(0).integers(0, 256, (height, width, 3), np.uint8)
    png.write_png(tmp_path / "a.png", Image.fromarray(pixels))
    with Image.open(tmp_path / "a.png") as read:
        assert (read.format, read.mode) == ("PNG", "RGB")
        assert np.array_equal(np.asarray(read), pixels)


def test_rows_like_those_above_take_next_to_nothing(tmp_path: Path) -> None:
    row = np.random.default_rng(0).integers(0, 256, (1, 100, 3), np.uint8)
    png.write_png(tmp_path / "a.png", Image.fromarray(np.repeat(row, 1000, axis=0)))
    assert (tmp_path / "a.png").stat().st_size < 0.02 * 1000 * row.size
