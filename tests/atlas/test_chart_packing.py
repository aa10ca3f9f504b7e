"""Charts are packed whole, in one scale, and with a gutter between any two."""

import numpy as np
import pytest

from mua.arrays import Array
from mua.atlas.chart_packing import pack
from mua.atlas.packing_grid import GRID, ROOM
from mua.rig.charts import areas

CHARTS = 30
GUTTER = 1 / (ROOM * GRID)  # one cell of the widest square
ROUNDING = 1e-3  # of a cell


def rectangles() -> Array:
    """Two triangles each: corners [2 CHARTS, 3, 2]."""
    sizes = np.random.default_rng(0).uniform(0.3, 2, (CHARTS, 1, 1, 2))
    return (sizes * np.array([[[0, 0], [1, 0], [1, 1]], [[0, 0], [1, 1], [0, 1]]])).reshape(-1, 3, 2)


@pytest.fixture(scope="module")
def packed() -> tuple[Array, Array]:
    """Rectangles before and after."""
    corners = rectangles()
    return corners, pack(corners, np.repeat(np.arange(CHARTS), 2))


def test_any_two_charts_have_a_gutter_between_them(packed: tuple[Array, Array]) -> None:
    places = packed[1].reshape(CHARTS, 6, 2)
    low, high = places.min(axis=1), places.max(axis=1)
    gaps = np.maximum(low[:, None] - high, low - high[:, None]).max(axis=2)
    gaps[np.diag_indices(CHARTS)] = np.inf
    assert gaps.min() > GUTTER * (1 - ROUNDING)


def test_all_charts_keep_one_scale_and_fill_the_square(packed: tuple[Array, Array]) -> None:
    ratios = areas(packed[1]) / areas(packed[0])
    np.testing.assert_allclose(ratios, ratios[0])
    assert packed[1].min() == pytest.approx(0)
    assert packed[1].max() == pytest.approx(1)
    assert areas(packed[1]).sum() > 0.7
