"""Videos are whole or not there; images lie over their background."""

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from mua.arrays import Array
from mua.errors import InputError
from mua.player.cpu_image import over
from mua.player.video import write_video


def pictures(count: int) -> Iterator[Array]:
    for i in range(count):
        yield np.full((32, 48, 3), 10 * i, np.uint8)


def failing() -> Iterator[Array]:
    yield from pictures(2)
    raise InputError("the device was lost")


def test_what_is_transparent_shows_the_background() -> None:
    image = np.array([[[0, 0, 0, 0], [0.25, 0, 0.5, 0.5], [2.0, 0.5, -1, 1]]])
    shown = over(image, (1.0, 0.5, 0.0))
    np.testing.assert_array_equal(shown, [[[255, 128, 0], [191, 64, 128], [255, 128, 0]]])


def test_a_video_that_fails_midway_leaves_what_was_there(tmp_path: Path) -> None:
    path = tmp_path / "v.mp4"
    path.write_bytes(b"earlier")
    with pytest.raises(InputError, match="the device was lost"):
        write_video(path, failing(), rate=24.0)
    assert path.read_bytes() == b"earlier"
    assert list(tmp_path.iterdir()) == [path]


def test_an_encoder_that_stops_is_reported(tmp_path: Path) -> None:
    path = tmp_path / "v.mp4"
    with pytest.raises(InputError, match=r"v\.mp4: the encoder stopped"):
        write_video(path, pictures(3), rate=-1.0)
    assert list(tmp_path.iterdir()) == []


def test_one_picture_is_a_video(tmp_path: Path) -> None:
    path = tmp_path / "v.mp4"
    write_video(path, pictures(1), rate=23.976)
    assert path.stat().st_size > 0
