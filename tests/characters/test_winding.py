"""Which closed pieces of a surface are wound inside out."""

import numpy as np
import pytest
import trimesh

from mua.arrays import Array
from mua.characters.winding import inside_out


def cube(side: float = 1.0, middle: tuple[float, float, float] = (0, 0, 0)) -> tuple[Array, Array]:
    """Vertices and triangles that face outward."""
    box = trimesh.creation.box([side] * 3)
    return np.asarray(box.vertices) + middle, np.asarray(box.faces)


def together(*pieces: tuple[Array, Array]) -> tuple[Array, Array]:
    firsts = np.cumsum([0, *(len(vertices) for vertices, _ in pieces)])
    faces = [faces + first for (_, faces), first in zip(pieces, firsts, strict=False)]
    return np.concatenate([vertices for vertices, _ in pieces]), np.concatenate(faces)


def turned(piece: tuple[Array, Array]) -> tuple[Array, Array]:
    return piece[0], piece[1][:, ::-1]


@pytest.mark.parametrize("middle", [(0, 0, 0), (3, -2, 5), (-1e4, 2e4, 1e4)])
def test_of_several_pieces_those_that_face_inward_are_found(middle: tuple[float, float, float]) -> None:
    """They are found where they are small and far from the origin, and where one lies in another."""
    pieces = [turned(cube(1e-3, middle)), cube(1e-3, middle), cube(2.0), turned(cube(1.0))]
    vertices, faces = together(*pieces)
    found = inside_out(vertices, faces).reshape(4, 12)
    assert found.all(axis=1).tolist() == found.any(axis=1).tolist() == [True, False, False, True]


def test_a_piece_that_is_open_or_of_mixed_winding_stays() -> None:
    vertices, faces = turned(cube())
    mixed, doubled = faces.copy(), np.concatenate([faces, faces])
    mixed[0] = mixed[0, ::-1]
    for other in (faces[1:], mixed, doubled):
        assert not inside_out(vertices, other).any()


def test_no_triangles_are_no_piece() -> None:
    assert inside_out(np.zeros((3, 3)), np.zeros((0, 3), int)).tolist() == []
