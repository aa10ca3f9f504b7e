"""Splats of a thin plate: sunk less far than elsewhere, so that each side is seen from its own side."""

import numpy as np
import pytest
from patches import ONE_JOINT, grid_faces, grid_points, joined

from mua.arrays import Array
from mua.avatar.camera import orbit
from mua.avatar.decode import pose_splats
from mua.avatar.rendering import render_premultiplied
from mua.rig.character import Character, Mesh
from mua.teachers.simulated.still import StillTeacher
from mua.texture.depths import BESIDE, SINK, depths

SIDE = 0.3  # metres
TEXELS = 48  # of the texture along a side; each side of the plate has half of them
DEVIATION = 0.006
GREY, BLACK = 180, 0


def sheet(*, height: float, turned: bool, column: int) -> Mesh:
    """A square in a plane across z, to the left or right of the texture, that faces +z, or -z where it is turned."""
    points, faces = grid_points(8), grid_faces(8, 8)
    vertices = np.column_stack([points * SIDE, np.full(len(points), height)])
    uv = (0.05 + 0.9 * points) * [0.5, 0.5] + [0.5 * column, 0.25]
    faces = faces[:, ::-1] if turned else faces
    return Mesh(vertices, faces.astype(np.int32), uv, faces.astype(np.int32))


def plate(thickness: float) -> Character:
    """A grey square whose black back lies so far behind it."""
    mesh = joined(sheet(height=thickness, turned=False, column=0), sheet(height=0.0, turned=True, column=1))
    picture = np.full((64, 64, 4), 255, np.uint8)
    picture[:, :32, :3], picture[:, 32:, :3] = GREY, BLACK
    count = len(mesh.vertices)
    return Character(
        name="plate",
        skeleton=ONE_JOINT,
        mesh=mesh,
        skin_indices=np.zeros((count, 8), np.int32),
        skin_weights=np.eye(1, 8, dtype=np.float32).repeat(count, axis=0),
        base_color=picture,
    )


def middle(character: Character, azimuth: float) -> Array:
    """The colour in the middle of a picture."""
    teacher = StillTeacher(character, texels=TEXELS)
    frame = teacher.frame(character.skeleton.bind_pose)
    splats = pose_splats(teacher.rig, frame.mesh, texture=frame.texture, pose=frame.pose)
    vertices = character.mesh.vertices
    bounds = np.stack([vertices.min(axis=0), vertices.max(axis=0)])
    picture = render_premultiplied(splats, orbit(bounds, screen=(48, 48), azimuth=azimuth, elevation=0.0))
    return np.asarray(picture[18:30, 20:28, 0].mean())


@pytest.mark.parametrize("thickness", [0.001, 0.003, 0.02])  # of splats that would be sunk by 2.6 mm
def test_each_side_of_a_plate_has_its_own_colour(thickness: float) -> None:
    character = plate(thickness)
    assert middle(character, 0.0) == pytest.approx(GREY / 255, abs=0.02)
    assert middle(character, np.pi) == pytest.approx(BLACK, abs=0.02)


@pytest.mark.parametrize("thickness", [0.0, 0.003, 0.0054, 0.008, 0.0108, 0.05])
def test_sides_stay_apart_by_twice_the_full_depth_or_as_far_as_they_are(thickness: float) -> None:
    across = np.column_stack([24 * DEVIATION * grid_points(12), np.zeros(169)])
    places = np.concatenate([np.add(across, [0, 0, thickness]), across])
    normals = np.repeat([[0.0, 0, 1], [0, 0, -1]], 169, axis=0)
    found = depths(places, normals=normals, deviations=np.full(338, DEVIATION))
    full = SINK * DEVIATION
    np.testing.assert_allclose(thickness - 2 * found, max(min(thickness, 2 * full), thickness - 2 * full), atol=1e-12)


def test_what_faces_away_beside_a_texel_is_not_behind_it() -> None:
    """The other side of a fold that lies so far to the side; as far behind, it is the back of a plate."""
    places = np.array([[0.0, 0, 0], [(BESIDE + 0.1) * DEVIATION, 0, -0.1 * DEVIATION]])
    normals, deviations = np.array([[0.0, 0, 1], [0, 0, -1]]), np.full(2, DEVIATION)
    np.testing.assert_allclose(depths(places, normals=normals, deviations=deviations), SINK * DEVIATION)
    places[1, 0] = (BESIDE - 0.1) * DEVIATION
    assert depths(places, normals=normals, deviations=deviations).max() < 0.2 * SINK * DEVIATION


def test_layers_that_face_one_way_are_sunk_as_one_is() -> None:
    across = np.column_stack([24 * DEVIATION * grid_points(12), np.zeros(169)])
    places = np.concatenate([across, np.add(across, [0, 0, 0.002])])
    found = depths(places, normals=np.tile([0.0, 0, 1], (338, 1)), deviations=np.full(338, DEVIATION))
    np.testing.assert_allclose(found, SINK * DEVIATION)
