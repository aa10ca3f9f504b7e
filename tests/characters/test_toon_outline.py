"""Which parts are outlines of toon figures: shells around the others, wound inside out."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from scenes import GREY, HERE, part, scene
from scipy.spatial.transform import Rotation

from mua.characters.assemble import assemble
from mua.scene import Material, Part

BLACK = Material("ink", np.array([[[0, 0, 0, 255]]], np.uint8))
TURN = Rotation.from_euler("xyz", [10, 20, 30], degrees=True).as_matrix()


def ball(radius: float, *, material: int, rings: int = 12, inward: bool = False) -> Part:
    """A closed ball above the floor, with one vertex for each corner of a triangle as exporters write flat shading."""
    high, round_ = np.linspace(0, np.pi, rings + 1), np.linspace(0, 2 * np.pi, 2 * rings + 1)
    grid = np.stack(
        [
            np.sin(high)[:, None] * np.cos(round_),
            np.broadcast_to(np.cos(high)[:, None], (rings + 1, len(round_))),
            np.sin(high)[:, None] * np.sin(round_),
        ],
        axis=-1,
    )
    a, b, c, d = grid[:-1, :-1], grid[:-1, 1:], grid[1:, 1:], grid[1:, :-1]
    corners = np.concatenate([np.stack(t, axis=2).reshape(-1, 3, 3) for t in ((a, b, c), (a, c, d))])
    corners = corners[
        np.linalg.norm(np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1) > 1e-9
    ]
    corners = corners[:, ::-1] if inward else corners
    places = (corners.reshape(-1, 3) @ TURN.T) * radius * [0.4, 0.9, 0.3] + [0, 0.9, 0]
    faces = np.arange(len(places)).reshape(-1, 3)
    return replace(
        part(),
        name=f"ball{material}",
        positions=places,
        faces=faces,
        uv=places[:, :2],
        uv_faces=faces,
        material=material,
        joints=np.zeros((len(places), 1), int),
        weights=np.ones((len(places), 1)),
    )


def together(first: Part, second: Part) -> Part:
    """Both as one part."""
    count = len(first.positions)
    columns = {name: (getattr(first, name), getattr(second, name)) for name in ("positions", "uv", "joints", "weights")}
    columns |= {name: (getattr(first, name), getattr(second, name) + count) for name in ("faces", "uv_faces")}
    joined: dict[str, Any] = {name: np.concatenate(column) for name, column in columns.items()}
    return replace(first, **joined)


def kept(*parts: Part) -> tuple[list[str], tuple[str, ...]]:
    """The materials that a character of these parts shows, and what is said of it."""
    surfaces = assemble(scene(materials=(GREY, BLACK), parts=parts), HERE)
    return [material.name for material in surfaces.materials], surfaces.notes


@pytest.mark.parametrize("apart", [1.01, 1.04])
def test_a_shell_around_the_body_wound_inside_out_is_left_out(apart: float) -> None:
    names, notes = kept(ball(1, material=0), ball(apart, material=1, inward=True))
    assert names == ["grey"]
    assert "Outlines, drawn as shells that are wound inside out, are left out: ball1." in notes


def test_a_shell_keeps_nothing_of_what_was_there_without_it() -> None:
    body = ball(1, material=0)
    with_shell, without = (
        assemble(scene(materials=(GREY, BLACK), parts=parts), HERE)
        for parts in ((body, ball(1.02, material=1, inward=True)), (body,))
    )
    np.testing.assert_array_equal(with_shell.vertices, without.vertices)
    np.testing.assert_array_equal(with_shell.faces, without.faces)


@pytest.mark.parametrize(
    "other",
    [
        ball(1.02, material=1),  # clothing: faces outward
        ball(0.98, material=1, inward=True),  # a lining: lies within
        ball(1.02, material=1, inward=True, rings=7),  # the inside of a coat of its own shape
        ball(1.4, material=1, inward=True),
        together(ball(1.02, material=1, inward=True), ball(1.03, material=1, inward=True, rings=9)),
    ],
    ids=["clothing", "lining", "coat", "far from the body", "a copy beside a coat"],
)
def test_other_surfaces_beside_the_body_stay(other: Part) -> None:
    names, _ = kept(ball(1, material=0), other)
    assert names == ["grey", "ink"]


def test_a_shell_with_a_picture_stays() -> None:
    picture = Material("painted", np.array([[[0, 0, 0, 255], [255, 0, 0, 255]]], np.uint8))
    parts = (ball(1, material=0), ball(1.02, material=1, inward=True))
    surfaces = assemble(scene(materials=(GREY, picture), parts=parts), HERE)
    assert len(surfaces.materials) == 2
