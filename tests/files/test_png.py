"""PNG files of pictures, read by Pillow."""

import io

import numpy as np
import pytest
from PIL import Image

from mua.files.png import png_bytes


@pytest.mark.parametrize(("height", "width"), [(1, 1), (1, 7), (5, 1), (13, 37)])
def test_a_picture_reads_back(height: int, width: int) -> None:
    picture = np.random.default_rng(0).integers(0, 256, (height, width, 3), np.uint8)
    with Image.open(io.BytesIO(png_bytes(picture))) as image:
        image.verify()  # the checksums
    with Image.open(io.BytesIO(png_bytes(picture))) as image:
        assert (image.format, image.mode) == ("PNG", "RGB")
        np.testing.assert_array_equal(np.asarray(image), picture)


def test_an_even_picture_takes_little_room() -> None:
    assert len(png_bytes(np.full((500, 400, 3), 90, np.uint8))) < 2000
