"""Splats of a still character, drawn: its silhouette is the surface's, and nothing shines through."""

from dataclasses import replace

import numpy as np
import pytest
from patches import ONE_JOINT, grid_faces, grid_points
from scipy.ndimage import map_coordinates
from scipy.spatial.transform import Rotation
from tube import HEIGHT, RADIUS, tube

from mua.arrays import Array
from mua.avatar.camera import orbit
from mua.avatar.decode import pose_splats
from mua.avatar.rendering import render_premultiplied
from mua.channels import SH_C0
from mua.kernels.expressions import reach_of
from mua.rig.character import Character, Mesh
from mua.rig.expressions import Expressions
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


def checked_sheet(texels: int, wide: float) -> tuple[Character, Array]:
    """A sheet of 1 m under slanting checks so many texels wide, and their grey in 0..1 at sixteenths of a texel."""
    v, u = (np.indices((16 * texels, 16 * texels)) + 0.5) / 16
    along, across = 0.955 * u + 0.296 * v, 0.955 * v - 0.296 * u
    gray = np.where((np.sin(np.pi / wide * along) > 0) ^ (np.sin(np.pi / wide * across) > 0), 220, 40)
    points, faces = grid_points(8), grid_faces(8, 8).astype(np.int32)
    mesh = Mesh(np.column_stack([points, np.zeros(len(points))]), faces, 0.1 + 0.8 * points * [1, -1] + [0, 0.8], faces)
    weights = np.zeros((len(points), 8), np.float32)
    weights[:, 0] = 1
    picture = np.stack([gray, gray, gray, np.full_like(gray, 255)], axis=2).astype(np.uint8)
    return Character("sheet", ONE_JOINT, mesh, np.zeros((len(points), 8), np.int32), weights, picture), gray / 255


@pytest.mark.parametrize("wide", [1.5, 2.0, 4.0])
def test_checks_come_out_at_least_as_sharp_as_under_a_texture_of_as_many_texels(wide: float) -> None:
    texels, side = 32, 160
    character, gray = checked_sheet(texels, wide)
    teacher = StillTeacher(character, texels=texels)
    frame = teacher.frame(character.skeleton.bind_pose)
    splats = pose_splats(teacher.rig, frame.mesh, texture=frame.texture, pose=frame.pose)
    camera = orbit(np.array([[0, 0, 0], [1, 1, 0]]), screen=(side, side), azimuth=0.3, elevation=0.2)
    row, column = np.mgrid[side // 4 : 3 * side // 4, side // 4 : 3 * side // 4]
    shown = render_premultiplied(splats, camera)[row, column, 0]
    corners = np.array([[0.0, 0, 0, 1], [1, 0, 0, 1], [0, 1, 0, 1]]) @ (camera.projection @ camera.view).T
    axes = np.stack([corners[1] - corners[0], corners[2] - corners[0], corners[0]])[:, [0, 1, 3]]
    x, y = (column + 0.5) / side * 2 - 1, 1 - (row + 0.5) / side * 2
    seen = np.stack([x, y, np.ones_like(x)], axis=-1) @ np.linalg.inv(axes)
    u, v = 0.1 + 0.8 * seen[..., 0] / seen[..., 2], 0.9 - 0.8 * seen[..., 1] / seen[..., 2]
    there = map_coordinates(gray, [len(gray) * v - 0.5, len(gray) * u - 0.5], order=1)
    means = gray.reshape(texels, 16, texels, 16).mean(axis=(1, 3))
    textured = map_coordinates(means, [texels * v - 0.5, texels * u - 0.5], order=1)
    assert np.mean((shown - there) ** 2) < np.mean((textured - there) ** 2)
    assert shown.std() > 0.5 * there.std()


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


def test_expressions_move_texels_with_the_surface_in_any_pose() -> None:
    character = tube(rings=29, sides=40)
    bulge = np.flatnonzero(np.abs(character.mesh.vertices[:, 1] - HEIGHT / 2) < HEIGHT / 5).astype(np.int32)
    offsets = 0.1 * character.mesh.vertices[bulge].astype(np.float32) * np.array([1, 0, 1], np.float32)
    expressions = Expressions(("bulge",), np.array([0, len(bulge)], np.int32), bulge, offsets)
    character = replace(character, expressions=expressions)
    teacher, rest = StillTeacher(character, texels=TEXELS), character.skeleton.bind_pose
    bent = rest.rotations.copy()
    bent[-1] = [np.cos(0.4), np.sin(0.4), 0, 0]
    for pose in (rest, replace(rest, rotations=bent)):
        before, after, none = (
            teacher.frame(replace(pose, expressions=weights)) for weights in (None, np.ones(1), np.zeros(1))
        )
        assert np.array_equal(none.texture, before.texture)
        swollen = StillTeacher(
            replace(character, mesh=replace(character.mesh, vertices=expressed(character))), texels=TEXELS
        )
        places = [
            pose_splats(one.rig, frame.mesh, texture=frame.texture, pose=pose).centres
            for one, frame in ((teacher, after), (swollen, swollen.frame(pose)))
        ]
        # Beside the rims, whose texels reach beyond the surface: relief of a few millimetres is not scaled along.
        assert np.quantile(np.abs(places[0] - places[1]), 0.9) < 2e-3
        triangles = teacher.rig.texels.triangles
        far = np.ones(len(triangles), bool)
        far[reach_of(rigged(teacher), teacher.rig.mesh.faces, triangles).texels] = False
        assert far.any()
        assert np.abs(after.texture[far, :3] - before.texture[far, :3]).max() < 1e-4


def expressed(character: Character) -> Array:
    """The vertices of a character in its first expression."""
    assert character.expressions is not None
    vertices = character.mesh.vertices
    return vertices + character.expressions.displacement(np.eye(len(character.expressions))[0], vertices=len(vertices))


def rigged(teacher: StillTeacher) -> Array:
    """The vertices of a template that expressions move."""
    assert teacher.rig.expressions is not None
    return teacher.rig.expressions.vertices


def test_an_expression_that_turns_a_figure_turns_what_lies_below_its_surface() -> None:
    """A tube that lies down: all of its splats turn with it, whatever a fit moved them by."""
    character, turn = tube(), Rotation.from_euler("xyz", [1.2, 0.3, -0.5])
    vertices = character.mesh.vertices
    every = np.arange(len(vertices), dtype=np.int32)
    offsets = turn.apply(vertices) - vertices
    lying = Expressions(("lie",), np.array([0, len(every)], np.int32), every, offsets.astype(np.float32))
    teacher = StillTeacher(replace(character, expressions=lying), texels=TEXELS)
    corrections = np.zeros((len(teacher.rig.texels.texels), 9), np.float32)
    corrections[:, :3] = [0.01, 0.02, -0.03]
    teacher, pose = teacher.corrected(corrections), character.skeleton.bind_pose
    frames = teacher.frame(pose), teacher.frame(replace(pose, expressions=np.ones(1)))
    rest, lain = (pose_splats(teacher.rig, frame.mesh, texture=frame.texture, pose=pose) for frame in frames)
    np.testing.assert_allclose(lain.centres, turn.apply(rest.centres), rtol=0, atol=SINGLE * HEIGHT)
