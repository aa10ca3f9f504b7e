"""Packing of charts: their shape and scale stay, none meets another, little of the square is left empty."""

import numpy as np
import pytest

from mua.arrays import Array
from mua.atlas import packing, packing_grid
from mua.atlas.chart_shapes import GUTTER
from mua.atlas.packing import pack
from mua.atlas.packing_grid import GRID
from mua.rig.charts import areas
from mua.rig.texel_map import cover

LENGTH_BOUND = 1e-9  # relative: float64 of a rotation and a scale
ROOT_2 = np.sqrt(2)


def rectangles(sides: Array) -> tuple[Array, Array]:
    """Two triangles for each width and height [n, 2], each rectangle turned its own way."""
    square = np.array([[[0, 0], [1, 0], [1, 1]], [[0, 0], [1, 1], [0, 1]]], float)
    corners = (square[None] * sides[:, None, None]).reshape(-1, 3, 2)
    charts = np.repeat(np.arange(len(sides)), 2)
    angle = 0.7 * charts
    turn = np.stack([np.cos(angle), -np.sin(angle), np.sin(angle), np.cos(angle)], axis=1).reshape(-1, 2, 2)
    return np.einsum("fij,fkj->fki", turn, corners), charts


def lengths(corners: Array) -> Array:
    return np.linalg.norm(corners - np.roll(corners, 1, axis=1), axis=2)


@pytest.mark.parametrize("count", [1, 2, 7, 60])
def test_charts_keep_their_shape_and_scale_and_do_not_meet(count: int) -> None:
    corners, charts = rectangles(np.random.default_rng(count).uniform(0.2, 1, (count, 2)))
    placed = pack(corners, charts)
    assert placed.min() >= 0
    assert placed.max() <= 1
    scale = lengths(placed) / lengths(corners)
    np.testing.assert_allclose(scale, scale[0, 0], rtol=LENGTH_BOUND)
    owner, claims = cover(placed * 1024, 1024)
    assert claims.max() == 1
    chart = np.where(owner >= 0, charts[owner], -1).reshape(1024, 1024)
    for one, other in ((chart[:, :-1], chart[:, 1:]), (chart[:-1], chart[1:])):
        assert not ((one != other) & (one >= 0) & (other >= 0)).any()


def test_little_of_the_square_is_left_empty() -> None:
    corners, charts = rectangles(np.random.default_rng(0).uniform(0.2, 1, (20, 2)))
    assert areas(pack(corners, charts)).sum() > 0.75


def test_a_small_chart_lies_in_the_hole_of_a_large_one() -> None:
    turns = np.linspace(0, 2 * np.pi, 65)
    inner, outer = (radius * np.stack([np.cos(turns), np.sin(turns)], axis=1) for radius in (0.8, 1.0))
    ring = np.concatenate(
        [np.stack([inner[:-1], outer[:-1], outer[1:]], 1), np.stack([inner[:-1], outer[1:], inner[1:]], 1)]
    )
    disc = 0.5 * np.stack([np.zeros_like(outer[:-1]), outer[:-1], outer[1:]], axis=1)
    placed = pack(np.concatenate([ring, disc]), np.repeat([0, 1], [len(ring), len(disc)]))
    middle = placed[: len(ring)].mean(axis=(0, 1))
    assert np.abs(placed[len(ring) :].mean(axis=(0, 1)) - middle).max() < 0.2  # somewhere in the hole


def test_gutters_are_at_least_as_wide_as_meant() -> None:
    corners, charts = rectangles(np.full((16, 2), 1.0))
    placed = pack(corners, charts)
    side = lengths(placed).min()
    middles = placed.reshape(16, 2, 3, 2).mean(axis=(1, 2))
    apart = np.linalg.norm(middles[:, None] - middles, axis=2)[~np.eye(16, dtype=bool)].min()
    assert apart > side + GUTTER / GRID


def test_charts_without_area_are_placed_too() -> None:
    corners, charts = rectangles(np.array([[1, 1], [1, 0], [0, 0], [0.5, 0.5]]))
    placed = pack(corners, charts)
    assert np.isfinite(placed).all()
    assert placed.min() >= 0
    assert placed.max() <= 1


def test_a_chart_longer_than_the_square_makes_it_larger() -> None:
    corners, charts = rectangles(np.array([[20.0, 0.5], [1, 1]]))
    placed = pack(corners, charts)
    np.testing.assert_allclose(lengths(placed)[0].max() / lengths(placed)[2].max(), np.hypot(20, 0.5) / ROOT_2)
    assert cover(placed * 512, 512)[1].max() == 1


def test_more_charts_than_the_grid_has_room_for_make_it_larger(monkeypatch: pytest.MonkeyPatch) -> None:
    for module in (packing, packing_grid):
        monkeypatch.setattr(module, "GRID", 16)
    corners, charts = rectangles(np.full((300, 2), 1.0))
    placed = packing.pack(corners, charts)
    centres = placed.reshape(len(charts) // 2, -1, 2).mean(axis=1)
    apart = np.abs(centres[:, None] - centres).max(axis=2)
    np.fill_diagonal(apart, np.inf)
    assert apart.min() > lengths(placed).min()  # none lies on another
