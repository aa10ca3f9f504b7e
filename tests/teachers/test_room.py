"""Where a surface has room beneath it, and hangs."""

import numpy as np
import pytest
from tube import RADIUS, tube

from mua.arrays import Array
from mua.teachers.simulated.room import room_beneath

BODY = tube().mesh  # 24 cm thick
MIDDLE = (BODY.vertices[:, 1] > 0.5) & (BODY.vertices[:, 1] < 1.25)
NO_LEG = 0
LEFT, RIGHT = 1, 2


def dressed(air: float) -> tuple[Array, Array]:
    """The body in a sleeve as long as itself, with so many metres between."""
    outer = BODY.vertices * [1 + air / RADIUS, 1, 1 + air / RADIUS]
    return np.concatenate([BODY.vertices, outer]), np.concatenate([BODY.faces, BODY.faces + len(outer)])


def room(vertices: Array, faces: Array) -> Array:
    return room_beneath(vertices, faces, legs=np.full(len(faces), NO_LEG))


def test_a_bare_body_has_no_room_beneath_its_skin() -> None:
    assert room(BODY.vertices, BODY.faces)[MIDDLE].max() < 0.1


@pytest.mark.parametrize(("air", "least", "most"), [(0.008, 0.0, 0.1), (0.08, 0.7, 1.0)])
def test_a_wide_sleeve_has_room_and_a_tight_one_has_not(air: float, least: float, most: float) -> None:
    skin, sleeve = np.split(room(*dressed(air)), 2)
    assert skin[MIDDLE].max() < 0.1
    assert least <= sleeve[MIDDLE].min() <= sleeve[MIDDLE].max() <= most


@pytest.mark.parametrize("size", [0.01, 100.0])
def test_room_is_measured_beside_the_figure(size: float) -> None:
    vertices, faces = dressed(0.08)
    np.testing.assert_allclose(room(size * vertices, faces), room(vertices, faces), atol=0.05)


def test_a_cape_has_room_from_both_sides() -> None:
    """A sheet of two sides, 3 mm apart, behind a body."""
    corners = np.array([[-0.3, 0.4, -0.3], [0.3, 0.4, -0.3], [0.3, 1.5, -0.3], [-0.3, 1.5, -0.3]])
    count, outside = len(BODY.vertices), np.array([[0, 2, 1], [0, 3, 2]])
    sheet = np.concatenate([outside, outside[:, ::-1] + 4])
    vertices = np.concatenate([BODY.vertices, corners, corners + np.array([0, 0, 0.003])])
    found = room(vertices, np.concatenate([BODY.faces, sheet + count]))
    assert found[count:].min() > 0.7
    assert found[:count][MIDDLE].max() < 0.1


def in_a_lined_sleeve(air: float, thickness: float, leg: int) -> tuple[Array, Array, Array]:
    """Room of the body, of the outside of a sleeve with two sides and of its lining, so many metres from the body."""
    inner, outer = (BODY.vertices * [1 + away / RADIUS, 1, 1 + away / RADIUS] for away in (air, air + thickness))
    vertices, count = np.concatenate([BODY.vertices, outer, inner]), len(BODY.vertices)
    faces = np.concatenate([BODY.faces, BODY.faces + count, BODY.faces[:, ::-1] + 2 * count])
    skin, outside, lining = np.split(room_beneath(vertices, faces, legs=np.full(len(faces), leg)), 3)
    return skin[MIDDLE], outside[MIDDLE], lining[MIDDLE]


@pytest.mark.parametrize("leg", [NO_LEG, RIGHT])
@pytest.mark.parametrize("air", [-0.002, 0.005])
def test_a_vest_of_two_sides_that_lies_on_a_body_is_tight(air: float, leg: int) -> None:
    for part in in_a_lined_sleeve(air, 0.005, leg):
        assert part.max() < 0.1


@pytest.mark.parametrize("leg", [NO_LEG, RIGHT])
def test_a_wide_sleeve_of_two_sides_has_room_from_both(leg: int) -> None:
    skin, outside, lining = in_a_lined_sleeve(0.05, 0.005, leg)
    assert skin.max() < 0.1
    assert min(outside.min(), lining.min()) > 0.7


@pytest.mark.parametrize("leg", [LEFT, RIGHT])
def test_the_thick_hem_of_a_skirt_that_stands_off_its_leg_has_room(leg: int) -> None:
    skin, outside, lining = in_a_lined_sleeve(0.04, 0.03, leg)
    assert skin.max() < 0.1
    assert min(outside.min(), lining.min()) > 0.7


def test_what_is_as_thick_and_lies_on_a_leg_or_is_about_an_arm_is_tight() -> None:
    for air, leg in ((0.005, LEFT), (0.04, NO_LEG)):
        _, outside, lining = in_a_lined_sleeve(air, 0.03, leg)
        assert max(outside.max(), lining.max()) < 0.1


def test_a_tube_about_both_legs_is_a_skirt() -> None:
    sides = np.where(BODY.vertices[BODY.faces].mean(axis=1)[:, 0] > 0, LEFT, RIGHT)
    assert room_beneath(BODY.vertices, BODY.faces, legs=sides)[MIDDLE].mean() > 0.5
    assert room_beneath(BODY.vertices, BODY.faces, legs=np.full(len(sides), LEFT))[MIDDLE].max() < 0.1
