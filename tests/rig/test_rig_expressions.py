"""Expressions over a mesh, and weights in clips."""

from dataclasses import replace

import numpy as np
import pytest

from mua.arrays import Array
from mua.pose.clip import Clip
from mua.rig.expressions import Expressions

VERTICES = 40


@pytest.fixture
def targets() -> Array:
    """Offsets [E, V, 3] of three expressions, of which one moves nothing."""
    rng = np.random.default_rng(3)
    targets = rng.standard_normal((3, VERTICES, 3)).astype(np.float32)
    targets[0, 10:] = 0
    targets[1] = 0
    targets[2, ::2] = 0
    return targets


@pytest.fixture
def expressions(targets: Array) -> Expressions:
    expression, vertices = np.nonzero(targets.any(axis=2))
    starts = np.searchsorted(expression, np.arange(4)).astype(np.int32)
    offsets = targets[expression, vertices]
    return Expressions(("jawOpen", "neutral", "blink"), starts, vertices.astype(np.int32), offsets, offsets[:, 0] / 2)


def test_displacement_is_the_weighted_sum_of_targets(expressions: Expressions, targets: Array) -> None:
    weights = np.array([0.25, 1, 0.5])
    expected = np.einsum("e,evc->vc", weights, targets)
    assert np.allclose(expressions.displacement(weights, vertices=VERTICES), expected, atol=1e-6)
    assert not expressions.displacement(np.zeros(3), vertices=VERTICES).any()
    assert np.allclose(expressions.brightening(weights, vertices=VERTICES), expected[:, 0] / 2, atol=1e-6)
    assert not replace(expressions, gains=None).brightening(weights, vertices=VERTICES).any()


def test_part_of_the_mesh_moves_as_in_the_whole(expressions: Expressions, targets: Array) -> None:
    kept = np.random.default_rng(4).permutation(VERTICES)[:25]
    part = expressions.at(kept)
    weights = np.array([1, 0.5, 0.125])
    whole = expressions.displacement(weights, vertices=VERTICES)
    assert np.array_equal(part.displacement(weights, vertices=25), whole[kept])
    whole = expressions.brightening(weights, vertices=VERTICES)
    assert np.array_equal(part.brightening(weights, vertices=25), whole[kept])
    ruled = replace(expressions, rules=np.array([1, 0, 3], np.int32)).at(kept)
    assert np.array_equal(ruled.shown(weights), [1, 0.5, 0])
    for first, last in zip(part.starts[:-1], part.starts[1:], strict=True):
        assert (np.diff(part.vertices[first:last]) > 0).all()


def test_weights_follow_the_frames_of_a_clip() -> None:
    rest = np.tile([1.0, 0, 0, 0], (4, 2, 1))
    weights = np.arange(12.0).reshape(4, 3) / 12
    still = Clip("still", 30, rest, np.zeros((4, 2, 3)))
    face = replace(still, expressions=weights)
    np.testing.assert_array_equal(face.pose(2).expressions, weights[2])
    np.testing.assert_array_equal(face.cut(slice(1, 3)).expressions, weights[1:3])
    np.testing.assert_array_equal(face.then(still).expressions, np.concatenate([weights, np.zeros((4, 3))]))
    np.testing.assert_array_equal(still.then(face).expressions, np.concatenate([np.zeros((4, 3)), weights]))
    assert still.pose(1).expressions is None
    assert still.then(still).expressions is None
