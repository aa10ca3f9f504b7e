"""Transparent surfaces before each other: each lets the next show through, in their order from either side."""

from dataclasses import replace

import numpy as np
import pytest
from patches import patch, plain, surfaces_of, uv_map

from mua.arrays import Array
from mua.atlas.character_surfaces import Surfaces
from mua.atlas.uv import build_atlas
from mua.avatar.camera import orbit
from mua.avatar.decode import pose_splats
from mua.avatar.rendering import render_premultiplied
from mua.teachers.simulated.still import StillTeacher

pytestmark = pytest.mark.usefixtures("first_try")

RED, GREEN, BLUE = np.eye(3)
SIDE, APART = 0.3, 0.005  # metres; splats are as wide as the layers are apart
HALF = 128
EIGHT_BITS, RIPPLE = 0.01, 0.02  # the latter of half-clear splats on a grid


def layers(*colors: tuple[int, int, int, int]) -> Surfaces:
    """Squares behind each other, the first in front."""
    sheets = []
    for k in range(len(colors)):
        vertices, faces, uv = patch(6, at=0, uv=uv_map(1, 1, at=(0, 0)))
        sheets.append((vertices * SIDE - [0, 0, k * APART], faces, uv))
    return surfaces_of(*sheets, images=tuple(plain(*color) for color in colors))


def seen(surfaces: Surfaces, azimuth: float) -> Array:
    """The pixels [n, 4] in the middle of a picture, premultiplied."""
    character = build_atlas(surfaces, uv="auto", size=128)
    teacher = StillTeacher(character, texels=64)
    frame = teacher.frame(character.skeleton.bind_pose)
    splats = pose_splats(teacher.rig, frame.mesh, texture=frame.texture, pose=frame.pose)
    vertices = character.mesh.vertices
    bounds = np.stack([vertices.min(axis=0), vertices.max(axis=0)])
    picture = render_premultiplied(splats, orbit(bounds, screen=(64, 64), azimuth=azimuth, elevation=0.0))
    return np.asarray(picture[20:44, 26:38].reshape(-1, 4))


@pytest.mark.parametrize(("azimuth", "order"), [(0.0, (RED, GREEN, BLUE)), (np.pi, (BLUE, GREEN, RED))])
def test_three_half_clear_layers_are_laid_over_each_other(azimuth: float, order: tuple[Array, ...]) -> None:
    pixels = seen(layers((255, 0, 0, HALF), (0, 255, 0, HALF), (0, 0, 255, HALF)), azimuth)
    share = HALF / 255
    expected = sum(share * (1 - share) ** k * color for k, color in enumerate(order))
    np.testing.assert_allclose(pixels[:, :3].mean(axis=0), expected, atol=EIGHT_BITS)
    assert pixels[:, :3].std(axis=0).max() < RIPPLE


def test_from_aside_the_front_layer_shows_most() -> None:
    for azimuth, first, last in ((0.7, 0, 2), (np.pi - 0.7, 2, 0)):
        red_to_blue = seen(layers((255, 0, 0, HALF), (0, 255, 0, HALF), (0, 0, 255, HALF)), azimuth).mean(axis=0)
        assert red_to_blue[first] > red_to_blue[1] > red_to_blue[last]


def test_a_card_with_holes_hides_what_is_behind_it_only_where_it_is_solid() -> None:
    """Lashes before skin: stripes, cut out, with skin between them; nothing of them is seen from behind."""
    surfaces = layers((0, 0, 0, 255), (200, 200, 200, 255))
    stripes = np.zeros((64, 64, 4), np.uint8)
    stripes[:, :, 3] = np.where(np.arange(64) // 16 % 2, 255, 0)
    lashes = replace(surfaces.materials[0], image=stripes, alpha_mode="mask")
    surfaces = replace(surfaces, materials=(lashes, surfaces.materials[1]))
    front, back = seen(surfaces, 0.0)[:, 0], seen(surfaces, np.pi)[:, 0]
    assert np.mean(front < 0.1) > 0.3
    assert np.mean(front > 0.7) > 0.3
    np.testing.assert_allclose(back, 200 / 255, atol=0.02)
