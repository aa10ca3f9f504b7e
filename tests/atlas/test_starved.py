"""Triangles with next to no texels for their surface are found, together or scattered."""

import numpy as np
import pytest
from patches import grid_faces

from mua.arrays import Array
from mua.atlas.chart_quality import distorted, starved
from mua.rig.charts import find_charts

ROWS, COLUMNS = 12, 20


def sheet(widths: Array) -> tuple[Array, Array, Array]:
    """UV and space of a flat sheet, [F, 3, 2] and [F, 3, 3], and its nodes [F, 3].

    Its cells are as large as each other, but as wide in the texture as `widths` [ROWS, COLUMNS(, 2)] says.
    """
    x, y = np.meshgrid(np.arange(COLUMNS + 1.0), np.arange(ROWS + 1.0))
    faces = grid_faces(ROWS, COLUMNS)
    places = np.stack([x, y, 0 * x], axis=-1).reshape(-1, 3)[faces]
    uv = places[..., :2]
    middle = uv.mean(axis=1, keepdims=True)
    shrunk = np.tile(widths.reshape(ROWS * COLUMNS, -1), (2, 1))  # of each triangle, in its place
    return (middle + (uv - middle) * shrunk[:, None]) / COLUMNS, places, faces


def found(widths: Array) -> Array:
    """Cells [ROWS, COLUMNS] that are starved."""
    uv, places, faces = sheet(widths)
    charts = np.zeros_like(find_charts(faces, uv))
    lost = starved(uv, places, faces, charts=charts, distorted=distorted(uv, places, charts))
    return np.asarray(lost[: ROWS * COLUMNS].reshape(ROWS, COLUMNS))


def test_many_small_patches_count_however_small_they_are() -> None:
    widths = np.ones((ROWS, COLUMNS))
    widths[1::3, 1::4] = 1e-2
    assert np.array_equal(found(widths), widths < 1)


def test_one_small_patch_does_not_count() -> None:
    widths = np.ones((ROWS, COLUMNS))
    widths[5, 9] = 1e-2
    assert not found(widths).any()


@pytest.mark.parametrize("width", [1e-2, 0.2])
def test_a_large_patch_counts(width: float) -> None:
    widths = np.ones((ROWS, COLUMNS))
    widths[3:9, 4:14] = width
    assert found(widths)[4:8, 5:13].all()


def test_a_large_patch_drawn_too_short_in_one_direction_alone_counts() -> None:
    widths = np.ones((ROWS, COLUMNS, 2))
    widths[4:7, 8:11, 1] = 0.3  # 0.3 of the area are texels enough, but each would be three times as long
    assert found(widths)[5, 9]
    assert not found(np.maximum(widths, 0.6)).any()
