"""What an inset mesh hides of splats, as it is measured beside one-sided texels."""

from dataclasses import replace

import numpy as np
import pytest
import torch
from measure_hiding import (
    MOST,
    NOTHING,
    STEPS,
    Mesh,
    View,
    Way,
    behind,
    drawn,
    extra_bytes,
    least_inset,
    mesh_of,
    milliseconds,
    on_screen,
    room_of,
    tensors,
    ways,
)
from synthetic_avatar import synthetic_avatar, synthetic_rig, with_one_sided

from mua.arrays import Array
from mua.camera import Camera, perspective
from mua.decode import decode_clip_frame
from mua.kernels.splat_draw import pixel_share
from mua.rendering import visible
from mua.splatting.projection import Eye
from mua.splatting.rasterise import rasterise

CORNERS = np.array([[x, y, z] for z in (-1.0, 1.0) for y in (-1.0, 1.0) for x in (-1.0, 1.0)])
FACES = np.array(
    [
        *[[4, 5, 7], [4, 7, 6], [1, 0, 2], [1, 2, 3]],  # front, back
        *[[5, 1, 3], [5, 3, 7], [0, 4, 6], [0, 6, 2]],  # right, left
        *[[6, 7, 3], [6, 3, 2], [0, 1, 5], [0, 5, 4]],  # top, bottom
    ]
)


def before(distance: float) -> Camera:
    view = np.eye(4)
    view[2, 3] = -distance
    return Camera(view, perspective(np.radians(60), aspect=1), (64, 64))


def box(half: Array) -> Mesh:
    """A box about the origin whose corners move straight inwards along each axis."""
    return Mesh(CORNERS * half, CORNERS, FACES, np.full(8, min(half)))


def test_the_surface_that_faces_the_eye_is_in_the_depth_buffer_moved_inwards() -> None:
    depths = box(np.array([0.5, 0.4, 0.3])).depths(before(2.0), 0.1)
    hit = depths < NOTHING
    np.testing.assert_allclose(depths[hit], 2.0 - 0.3 + 0.1, rtol=1e-6)
    focal = 32 / np.tan(np.radians(30))
    half = np.array([0.3, 0.4]) * focal / 1.8  # rows, columns
    assert [int(np.sum(hit[:, 32])), int(np.sum(hit[32]))] == (2 * np.round(half)).astype(int).tolist()


def test_a_surface_that_faces_away_hides_nothing() -> None:
    inside_out = replace(box(np.full(3, 0.5)), faces=FACES[:4, ::-1])
    np.testing.assert_allclose(inside_out.depths(before(2.0), 0.0)[32, 32], 2.5, rtol=1e-6)  # the back


def test_what_is_thinner_than_the_inset_is_left_out() -> None:
    assert (box(np.array([0.5, 0.5, 0.05])).depths(before(2.0), 0.06) == NOTHING).all()


def test_points_beyond_the_picture_are_not_hidden() -> None:
    at = np.array([[0.5, 0.5, 2], [0.5, 0.5, 0.5], [-0.5, 0.5, 2], [0.5, 2.5, 2]])
    assert behind(at, np.ones((2, 2))).tolist() == [True, False, False, False]


@pytest.mark.parametrize(("lost", "inset"), [(0.0, 0.08), (0.25, 0.04)])
def test_the_least_inset_hides_no_more_than_what_may_be_lost(lost: float, inset: float) -> None:
    camera = before(2.0)
    points = np.array([[0, 0, 0.5 - depth] for depth in (0.0, 0.02, 0.04, 0.08, 0.3)])
    shares = np.array([0.5, 0.5, 0.5, 0.5, 0.01])
    view = View(camera, box(np.full(3, 0.5)), on_screen(points, camera), shares)
    assert least_inset([view], 0.1, lost) == pytest.approx(inset, abs=MOST / 2**STEPS)


def test_room_is_half_of_the_way_to_the_opposite_surface() -> None:
    rig = synthetic_rig()
    mesh = replace(rig.mesh, vertices=CORNERS * [0.5, 0.5, 0.01], faces=FACES)
    a, b, c = np.swapaxes(mesh.vertices[FACES], 0, 1)
    room = room_of(replace(rig, mesh=mesh))
    assert np.cross(b - a, c - a)[0, 2] > 0  # outwards
    assert (room > 0.0099).all()
    assert room.min() < 0.02


def test_without_a_mesh_all_is_drawn_as_the_rasteriser_draws_it() -> None:
    avatar = synthetic_avatar()
    splats = decode_clip_frame(avatar, avatar.clips[0], frame=2)
    camera = before(3.0)
    image, count, fragments = drawn(splats, mesh_of(avatar.rig, splats), camera, Way("all"))
    given = tensors(splats)
    wanted = rasterise(given, Eye.of(camera, given.centres), torch.as_tensor(splats.bounds)).numpy()
    np.testing.assert_allclose(image, wanted, atol=1e-4)  # the rasteriser ends where 1e-5 is left
    seen, _, ellipses = visible(splats, camera)
    rows, columns = np.mgrid[0:64, 0:64] + 0.5
    offsets = np.stack([columns, rows], axis=-1) - ellipses[0][:, None, None, :2]
    assert count == len(seen)
    assert fragments == pytest.approx(np.count_nonzero(pixel_share(offsets, ellipses[0][:, None, None])), rel=1e-3)


def test_a_mesh_before_all_splats_leaves_nothing() -> None:
    avatar = synthetic_avatar()
    splats = decode_clip_frame(avatar, avatar.clips[0], frame=2)
    wall = Mesh(CORNERS * [50, 50, 0.1] + [0, 0, 2.5], CORNERS, FACES, np.full(8, 1.0))
    for whole in (False, True):
        image, count, fragments = drawn(splats, wall, before(3.0), Way("wall", inset=0.0, whole=whole))
        assert fragments == 0
        assert not image.any()
        assert count == 0 or not whole


def test_ways_are_with_and_without_marks_where_there_are_any() -> None:
    avatar = synthetic_avatar()
    assert [(way.marks, way.inset, way.whole) for way in ways(with_one_sided(avatar, None), [0.02])] == [
        *[(False, None, False), (False, 0.02, False), (False, 0.02, True)]
    ]
    assert len(ways(with_one_sided(avatar, np.ones(len(avatar.rig.texels.texels), bool)), [0.02])) == 6


def test_the_mesh_costs_time_and_what_it_hides_saves_some() -> None:
    mesh = box(np.full(3, 0.5))
    alone = milliseconds(1e5, 2e6, mesh, Way("all"))
    by_fragments, by_splats = (milliseconds(1e5, 2e6, mesh, Way("", inset=0.1, whole=whole)) for whole in (False, True))
    assert alone < by_fragments < by_splats
    assert milliseconds(1e5, 1e6, mesh, Way("", inset=0.1)) < alone
    assert extra_bytes(mesh, Way("all")) == 0
    assert extra_bytes(mesh, Way("", inset=0.6)) < extra_bytes(mesh, Way("", inset=0.1))
