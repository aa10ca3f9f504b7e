"""Charts are redrawn to the sizes that they are to have, and never over themselves."""

import numpy as np
import pytest
from patches import grid_faces, grid_points

from mua.arrays import Array
from mua.atlas.chart_quality import overlapping
from mua.atlas.redraw import redrawn
from mua.rig.charts import areas

CELLS = 24


def square(cells: int = CELLS) -> Array:
    return np.asarray(grid_points(cells)[grid_faces(cells, cells)])


def test_a_chart_of_one_size_is_scaled_and_nothing_else() -> None:
    corners = square()
    drawn = redrawn(corners, np.zeros(len(corners), np.int64), np.full(len(corners), 2.0))
    np.testing.assert_allclose(drawn, 2 * corners, rtol=1e-12)


def test_the_middle_of_a_chart_is_drawn_larger_without_a_cut() -> None:
    corners = square()
    middle = np.linalg.norm(corners.mean(axis=1) - 0.5, axis=1)
    wanted = 1 + 2 * np.exp(-((middle / 0.2) ** 2) / 2)
    drawn = redrawn(corners, np.zeros(len(corners), np.int64), wanted)
    size = np.sqrt(areas(drawn) / areas(corners))
    assert size[middle < 0.1].mean() > 1.6 * size[middle > 0.45].mean()
    assert overlapping(drawn, np.zeros(len(corners), np.int64))[0] == 0
    ends = np.round(corners.reshape(-1, 2) * CELLS).astype(int) @ [CELLS + 1, 1]
    places = drawn.reshape(-1, 2)
    same = places[np.unique(ends, return_index=True)[1]][np.unique(ends, return_inverse=True)[1]]
    np.testing.assert_allclose(places, same, atol=1e-12)


@pytest.mark.parametrize("slit", [1, 2])
def test_flaps_beside_a_slit_do_not_cover_each_other(slit: int) -> None:
    corners = square()
    middle = corners.mean(axis=1)
    corners = corners[~((np.abs(middle[:, 0] - 0.5) < slit / CELLS) & (middle[:, 1] < 0.8))]
    middle = corners.mean(axis=1)
    wanted = 1 + 3 * np.exp(-((np.abs(np.abs(middle[:, 0] - 0.5) - 0.15) / 0.1) ** 2))
    charts = np.zeros(len(corners), np.int64)
    assert overlapping(redrawn(corners, charts, wanted), charts)[0] == 0


def test_a_long_chart_does_not_make_all_others_small() -> None:
    strip, rest = square() * [4.0, 0.01], square() + 5
    corners, charts = np.concatenate([strip, rest]), np.repeat([0, 1], len(strip))
    drawn = redrawn(corners, charts, np.ones(len(corners)))
    assert np.ptp(drawn[charts == 0].reshape(-1, 2), axis=0).max() < 1.2 * np.sqrt(areas(rest).sum())
    np.testing.assert_allclose(drawn[charts == 1], rest, rtol=1e-12)
