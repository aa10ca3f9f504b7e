"""What texels show that no view can reach."""

from dataclasses import replace

import numpy as np
import pytest
from people import upright

from mua.arrays import Array
from mua.channels import SH_C0
from mua.rig.character import Character, Mesh
from mua.rig.expressions import Expressions
from mua.teachers.simulated.still import StillTeacher

TEXELS = 64
RED, BLUE = (200, 40, 40), (40, 40, 200)
LID, WALL = 0, 1  # joints


def cube(side: float) -> tuple[Array, Array]:
    """Eight corners about (0, 1, 0) and twelve triangles that face outward, the two of the top last."""
    corners = (np.array(np.unravel_index(np.arange(8), (2, 2, 2))).T - 0.5) * side + [0, 1, 0]
    quads = np.array([[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [0, 2, 6, 4], [1, 5, 7, 3], [2, 3, 7, 6]])
    return corners, np.concatenate([quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]]).reshape(2, 6, 3)


def box_in_a_box(*, alpha: int = 255, lid: int = WALL) -> Character:
    """A blue box in a red one, each of twelve triangles with a square of the texture; the red top is on a joint."""
    (outer, quads), (inner, _) = cube(0.4), cube(0.2)
    faces = np.concatenate([quads[0], quads[1]])
    vertices = np.concatenate([outer[faces].reshape(-1, 3), inner[faces].reshape(-1, 3)])
    own = np.arange(len(vertices)).reshape(-1, 3).astype(np.int32)
    column, row = np.divmod(np.arange(len(own)), 5)
    corner = np.array([[0.1, 0.1], [0.9, 0.1], [0.1, 0.9]])
    uv = (np.stack([column, row], axis=1)[:, None] + corner) / 5
    joints = np.zeros((len(vertices), 8), np.int32)
    joints[:, 0] = WALL
    joints[own[[5, 11]].ravel(), 0] = lid
    weights = np.zeros((len(vertices), 8), np.float32)
    weights[:, 0] = 1
    picture = np.full((TEXELS * 5, TEXELS * 5, 4), 255, np.uint8)
    for face in range(len(own)):
        at = np.s_[row[face] * TEXELS : (row[face] + 1) * TEXELS, column[face] * TEXELS : (column[face] + 1) * TEXELS]
        picture[at] = (*RED, alpha) if face < 12 else (*BLUE, 255)
    skeleton = upright(("Lid", "Wall"), (-1, 0), [[0, 1.2, -0.2], [0, -0.2, 0.2]])
    mesh = Mesh(vertices, own, uv.reshape(-1, 2), own)
    return Character("boxes", skeleton, mesh, joints, weights, picture)


def colours(character: Character) -> tuple[Array, Array]:
    """The mean colours 0..255 of the texels of the outer box and of the inner one."""
    teacher = StillTeacher(character, texels=TEXELS)
    texture = teacher.frame(character.skeleton.bind_pose).texture
    shown = 255 * (texture[:, 11:14] * SH_C0 + 0.5)
    inside = np.abs(teacher.rig.texels.triangles[:, None] - np.arange(12, 24)).min(axis=1) == 0
    return shown[~inside].mean(axis=0), shown[inside].mean(axis=0)


def test_what_a_closed_box_holds_has_the_colour_of_the_box() -> None:
    outer, inner = colours(box_in_a_box())
    assert inner == pytest.approx(outer, abs=6)
    assert outer == pytest.approx(RED, abs=6)


def test_what_a_glass_box_holds_keeps_its_colour() -> None:
    _, inner = colours(box_in_a_box(alpha=100))
    assert inner == pytest.approx(BLUE, abs=6)


def test_what_a_joint_can_open_keeps_its_colour_where_it_is_then_seen() -> None:
    character = box_in_a_box(lid=LID)
    _, inner = colours(character)
    assert inner[2] > inner[0] + 20  # bluer than red
    _, shut = colours(replace(character, skin_indices=np.full_like(character.skin_indices, WALL)))
    assert shut[0] > shut[2] + 100


def test_what_an_expression_uncovers_keeps_its_colour() -> None:
    character = box_in_a_box()
    lid = np.unique(character.mesh.faces[[5, 11]]).astype(np.int32)
    starts, offsets = np.array([0, len(lid)], np.int32), np.tile(np.array([0, 0, 0.6], np.float32), (len(lid), 1))
    _, inner = colours(replace(character, expressions=Expressions(("open",), starts, lid, offsets)))
    assert inner[2] > inner[0] + 20  # bluer than red
