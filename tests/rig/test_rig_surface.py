"""The stored surface: runs and strips round-trip, and blocks equal those found by a loop."""

from itertools import pairwise

import numpy as np
import pytest
from tube import tube

from mua.arrays import Array
from mua.rig.surface import blocks, codes_of, count_codes, runs_of, strip_triangles, strips_of
from mua.rig.texel_map import TexelMap


def texel_map(valid: Array) -> TexelMap:
    """The map of a mask [H, W]; which triangles its texels show does not matter."""
    texels = np.flatnonzero(valid).astype(np.int32)
    return TexelMap(len(valid), texels, np.zeros_like(texels), np.zeros((len(texels), 3), np.float32), 0)


def turned(triangles: Array) -> list[tuple[int, ...]]:
    """Each triangle begun at its least corner, sorted."""
    first = [row.index(min(row)) for row in triangles.tolist()]
    return sorted((*row[k:], *row[:k]) for row, k in zip(triangles.tolist(), first, strict=True))


@pytest.mark.parametrize("size", [1, 2, 3, 17])
@pytest.mark.parametrize("share", [0.0, 0.5, 0.8, 1.0])
def test_blocks_are_those_with_at_least_three_texels_row_by_row(size: int, share: float) -> None:
    valid = np.random.default_rng(size).random((size, size)) < share
    rank = np.where(valid, np.cumsum(valid).reshape(size, size) - 1, -1)
    squares = [rank[r : r + 2, c : c + 2].ravel() for r in range(size - 1) for c in range(size - 1)]
    expected = [square.tolist() for square in squares if (square >= 0).sum() >= 3]
    assert blocks(texel_map(valid)).tolist() == expected


@pytest.mark.parametrize("lengths", [[], [1], [16], [17], [1, 15, 16, 17, 32, 33, 100, 1]])
def test_runs_give_their_codes_back_in_as_few_bytes_as_can_be(lengths: list[int]) -> None:
    codes = np.repeat(np.arange(len(lengths)) * 5 % 16, lengths)
    runs = runs_of(codes)
    assert runs.dtype == np.uint8
    assert codes_of(runs).tolist() == codes.tolist()
    assert count_codes(runs) == len(codes)
    assert len(runs) == sum(-(-length // 16) for length in lengths)


@pytest.mark.parametrize(
    "triangles",
    [
        np.empty((0, 3), np.int64),
        np.array([[4, 2, 9]]),
        np.array([[0, 1, 2], [2, 1, 3], [2, 3, 4], [4, 3, 5], [4, 5, 6]]),  # zipped
        np.array([[0, k, k + 1] for k in range(1, 9)]),  # a fan
        np.array([[0, 1, 2], [0, 1, 3], [1, 2, 4], [1, 0, 5]]),  # two on one edge in the same direction
        np.array([[0, 1, 2], [0, 2, 1]]),  # both sides of one
        tube().mesh.faces.astype(np.int64),
    ],
)
def test_strips_give_their_triangles_back(triangles: Array) -> None:
    assert turned(strip_triangles(strips_of(triangles))) == turned(triangles)


def test_a_zipped_seam_is_one_strip() -> None:
    rows = np.arange(40).reshape(20, 2)  # two rows of 20
    zipped = np.concatenate([[[a, b, c], [c, b, d]] for (a, b), (c, d) in pairwise(rows)])
    assert len(strips_of(zipped)) == len(zipped) + 2 + 1  # two corners to begin with, and the end


def test_strips_too_short_for_a_triangle_are_none() -> None:
    assert strip_triangles(np.array([-1, 2, -1, 2, 4, -1, -1, 6])).tolist() == []
