"""Folds of squeezed cloth."""

import numpy as np
import pytest
from tube import tube

from mua.arrays import Array
from mua.teachers.simulated.folds import HEIGHT, Folds

SINGLE = 1e-3  # of the height: tangents of one-rings are regularised by 1e-6


def folds(looseness: float, seed: int = 0) -> tuple[Folds, Array, Array]:
    mesh = tube(rings=61, sides=24).mesh
    hanging = np.full(len(mesh.vertices), looseness)
    unturned = np.tile([1.0, 0, 0, 0], (len(mesh.vertices), 1))
    return Folds(mesh.vertices, mesh.faces, looseness=hanging, rng=np.random.default_rng(seed)), mesh.vertices, unturned


@pytest.mark.parametrize("stretch", [1.0, 1.5])
def test_a_surface_without_squeeze_has_none(stretch: float) -> None:
    relief, vertices, unturned = folds(1.0)
    target = vertices * stretch
    np.testing.assert_allclose(relief(target, unturned), target, atol=SINGLE * HEIGHT)


def test_squeezed_cloth_rises_along_its_normals_up_to_its_height() -> None:
    relief, vertices, unturned = folds(1.0)
    target = vertices * [1, 0.3, 1]
    moved = relief(target, unturned) - target
    np.testing.assert_allclose(moved[200:-200, 1], 0, atol=SINGLE * HEIGHT)  # the wall is upright
    assert 0.8 * HEIGHT < np.sqrt(np.mean(np.sum(moved**2, axis=1))) <= HEIGHT


def test_looser_cloth_folds_more_and_skin_not_at_all() -> None:
    heights = []
    for looseness in (0.0, 0.3, 1.0):
        relief, vertices, unturned = folds(looseness)
        target = vertices * [1, 0.5, 1]
        heights.append(np.abs(relief(target, unturned) - target).max())
    assert heights[0] == 0
    assert heights == sorted(heights)


def test_the_seed_chooses_the_folds() -> None:
    first, vertices, unturned = folds(1.0, seed=1)
    again, other = folds(1.0, seed=1)[0], folds(1.0, seed=2)[0]
    target = vertices * [1, 0.5, 1]
    np.testing.assert_array_equal(first(target, unturned), again(target, unturned))
    assert np.abs(first(target, unturned) - other(target, unturned)).max() > HEIGHT / 10
