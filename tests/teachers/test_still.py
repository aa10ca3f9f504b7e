"""Splats of a still character, drawn: its silhouette is the surface's, and nothing shines through."""

from dataclasses import replace

import numpy as np
import pytest
from tube import HEIGHT, RADIUS, tube

from mua.arrays import Array
from mua.avatar.camera import orbit
from mua.avatar.decode import pose_splats
from mua.avatar.rendering import render_premultiplied
from mua.channels import SH_C0
from mua.rig.character import Character
from mua.rig.texel_map import build_texel_map
from mua.teachers.simulated import texels
from mua.teachers.simulated.still import StillTeacher
from mua.texture import depths
from mua.texture.sharpness import SPREAD, Sharpness

SCREEN = (96, 256)  # pixels
TEXELS = 64
SINGLE = 16 * float(np.finfo(np.float32).eps)  # a few products of float32


def alpha_of(sides: int, *, azimuth: float = 0.0) -> tuple[np.ndarray, float]:
    """Opacity [H, W] of a tube that is seen from the front, and pixels for a metre."""
    character = tube(rings=29, sides=sides)
    teacher = StillTeacher(character, texels=TEXELS)
    frame = teacher.frame(character.skeleton.bind_pose)
    splats = pose_splats(teacher.rig, frame.mesh, texture=frame.texture, pose=frame.pose)
    low, high = character.mesh.vertices.min(axis=0), character.mesh.vertices.max(axis=0)
    camera = orbit(np.stack([low, high]), screen=SCREEN, azimuth=azimuth, elevation=0.0)
    middle = np.array([[0, y, 0, 1] for y in (0.4 * HEIGHT, 0.6 * HEIGHT)]) @ (camera.projection @ camera.view).T
    rows = middle[:, 1] / middle[:, 3] * SCREEN[1] / 2
    return render_premultiplied(splats, camera)[..., 3], float(abs(np.ptp(rows))) / (0.2 * HEIGHT)


def width(alpha: np.ndarray) -> float:
    """Mean distance in pixels between the places in the middle rows where half is covered."""
    found = []
    for row in alpha[len(alpha) // 3 : -len(alpha) // 3]:
        first, last = np.flatnonzero(row >= 0.5)[[0, -1]]
        left = first - (row[first] - 0.5) / (row[first] - row[first - 1])
        right = last + (row[last] - 0.5) / (row[last] - row[last + 1])
        found.append(right - left)
    return float(np.mean(found))


def test_a_silhouette_is_as_wide_as_the_surface(monkeypatch: pytest.MonkeyPatch) -> None:
    """A tube of 40 sides, on which splats of 7 x 12 mm lie."""
    alpha, scale = alpha_of(40)
    assert width(alpha) == pytest.approx(2 * RADIUS * scale, abs=0.3)  # of a pixel of 8 mm
    monkeypatch.setattr(depths, "SINK", 0.0)
    swollen, _ = alpha_of(40)
    assert width(swollen) > width(alpha) + 0.5


@pytest.mark.parametrize("azimuth", [0.0, np.pi / 3, np.pi / 2, 2.0])
def test_nothing_shines_through_at_sharp_edges(azimuth: float) -> None:
    """A tube of three sides: corners of 60 degrees that smooth normals round off."""
    alpha, _ = alpha_of(3, azimuth=azimuth)
    middle = alpha[len(alpha) // 3 : -len(alpha) // 3]
    assert len(middle) > 10
    for row in middle:
        inside = np.flatnonzero(row >= 0.5)
        assert row[inside[0] + 1 : inside[-1]].min() > 0.8


def striped_tube() -> Character:
    """A tube under slanting stripes of four texels."""
    row, column = (np.indices((256, 256)) + 0.5) * TEXELS / 256
    gray = 127 + 120 * np.sign(np.sin(2 * np.pi / 4 * (0.8 * column + 0.6 * row)))
    picture = np.stack([gray, gray, gray, np.full_like(gray, 255)], axis=2).astype(np.uint8)
    return replace(tube(rings=29, sides=40), base_color=picture)


def drawn(character: Character, size: int) -> Array:
    """The front of a character [H, W, 3] whose texture has so many texels a side."""
    teacher = StillTeacher(character, texels=size)
    frame = teacher.frame(character.skeleton.bind_pose)
    splats = pose_splats(teacher.rig, frame.mesh, texture=frame.texture, pose=frame.pose)
    low, high = character.mesh.vertices.min(axis=0), character.mesh.vertices.max(axis=0)
    camera = orbit(np.stack([low, high]), screen=SCREEN, azimuth=0.0, elevation=0.0)
    return np.asarray(render_premultiplied(splats, camera)[SCREEN[1] // 3 : -SCREEN[1] // 3, 40:56, :3])


def even(picture: Array) -> Sharpness:
    """The surfels that an even image asks for."""
    count = (len(picture) // 2) ** 2
    return Sharpness(np.full(count, SPREAD), np.tile([1.0, 0], (count, 1)), np.zeros(count))


def test_stripes_are_sharper_than_round_surfels_of_one_width_show_them(monkeypatch: pytest.MonkeyPatch) -> None:
    character = striped_tube()
    finer = drawn(character, 3 * TEXELS)
    sharp = float(np.mean((drawn(character, TEXELS) - finer) ** 2))
    monkeypatch.setattr(texels, "sharpness", even)
    assert sharp < 0.75 * float(np.mean((drawn(character, TEXELS) - finer) ** 2))


def test_lines_of_a_picture_change_nothing_that_moves() -> None:
    """The turn along a line is the same in all poses, so that textures over time stay as smooth."""
    plain = tube(rings=29, sides=40)
    bent = plain.skeleton.bind_pose.rotations.copy()
    bent[-1] = [np.cos(0.4), np.sin(0.4), 0, 0]
    moves = []
    for character in (plain, striped_tube()):
        teacher, rest = StillTeacher(character, texels=TEXELS), character.skeleton.bind_pose
        moves.append(teacher.frame(replace(rest, rotations=bent)).texture - teacher.frame(rest).texture)
    assert np.abs(moves[0][:, 3:10]).max() > 0.01
    np.testing.assert_allclose(moves[0][:, :10], moves[1][:, :10], atol=SINGLE)


def test_the_picture_beside_a_chart_gives_its_texels_no_colour() -> None:
    """An even chart in a black atlas: sharpened against the black, its rim would be brighter."""
    character = tube(rings=29, sides=40)
    gray = np.zeros(TEXELS * TEXELS, np.uint8)
    gray[build_texel_map(character.mesh, TEXELS).texels] = 128
    gray = gray.reshape(TEXELS, TEXELS).repeat(4, axis=0).repeat(4, axis=1)
    picture = np.stack([gray, gray, gray, np.full_like(gray, 255)], axis=2)
    teacher = StillTeacher(replace(character, base_color=picture), texels=TEXELS)
    colors = 0.5 + SH_C0 * teacher.frame(character.skeleton.bind_pose).texture[:, 11:14]
    np.testing.assert_allclose(colors, 128 / 255, atol=2 / 255)
