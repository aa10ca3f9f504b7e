"""Shapes of charts: every way of a shape holds the points that it is the shape of."""

import numpy as np
import pytest

from mua.arrays import Array
from mua.atlas.chart_shapes import GUTTER, SAMPLING, Shape, grown, narrowest_angles, points_on, rasterised, ways

TRIANGLE = np.array([[[1.0, 2.0], [9.3, 4.1], [5.2, 8.7]]])
ANGLE_BOUND = np.radians(90 / 32)  # the steps in which angles are tried


def cells_of(shape: Shape, points: Array) -> Array:
    """The cells [n, 2] in which a shape's points [2, n] lie, moved off their edges."""
    return np.floor(shape.turn @ points + shape.shift[:, None]).astype(int)


def test_points_lie_on_the_triangles_and_close_together() -> None:
    (points,) = points_on(TRIANGLE, np.zeros(1, int))
    corners = np.concatenate([TRIANGLE[0].T, np.ones((1, 3))])
    shares = np.linalg.solve(corners, np.concatenate([points, np.ones((1, points.shape[1]))]))
    assert shares.min() > -1e-9
    dense = np.random.default_rng(0).dirichlet(np.ones(3), 200) @ TRIANGLE[0]
    apart = np.linalg.norm(points.T[:, None] - dense, axis=2).min(axis=0)
    assert apart.max() <= SAMPLING


@pytest.mark.parametrize("angle", [0.0, 0.4])
def test_every_way_of_a_shape_covers_its_points(angle: float) -> None:
    (points,) = points_on(TRIANGLE, np.zeros(1, int))
    found = ways(rasterised(points, angle))
    assert len(found) == 8
    inside = points - 1e-9 * (points - points.mean(axis=1, keepdims=True))  # a corner may lie on the edge of a cell
    for shape in found:
        column, row = cells_of(shape, inside)
        assert shape.solid[row, column].all()
        lit = np.zeros_like(shape.solid)
        lit[row, column] = True
        np.testing.assert_array_equal(lit, shape.solid)


def test_a_mask_is_the_shape_grown_by_its_gutter() -> None:
    (points,) = points_on(TRIANGLE, np.zeros(1, int))
    shape = rasterised(points, 0.0)
    row, column = np.nonzero(shape.solid)
    for r, c in np.argwhere(shape.mask):
        assert max(abs(row - r).min(), 0) <= GUTTER
        assert np.maximum(abs(row - r), abs(column - c)).min() <= GUTTER
    np.testing.assert_array_equal(grown(shape.solid, GUTTER), shape.mask)


def test_the_narrowest_box_stands_upright() -> None:
    turn = np.array([[np.cos(0.5), -np.sin(0.5)], [np.sin(0.5), np.cos(0.5)]])
    bar = np.array([[[0, 0], [20, 0], [20, 1]], [[0, 0], [20, 1], [0, 1]]], float) @ turn.T
    (angle,) = narrowest_angles(bar, np.zeros(2, int))
    away = (angle + 0.5) % (np.pi / 2)
    assert min(away, np.pi / 2 - away) < ANGLE_BOUND
