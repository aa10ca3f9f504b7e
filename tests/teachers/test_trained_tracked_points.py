"""Tracked points find their place on the template, and pull the template and its texels to where they went."""

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
import torch
from small_teachers import SETTINGS, material, motion, subject, teacher
from synthetic_avatar import synthetic_avatar

from mua import rotation
from mua.arrays import Array
from mua.capture.tracks import PointTracks
from mua.errors import InputError
from mua.pose.clip import Clip
from mua.rig.bones import figure_scale
from mua.rig.surface_points import face_normals, interpolate, spread_points
from mua.teachers.trained import tracked_points
from mua.teachers.trained.anchors import Anchors, anchors_of, first_hits, places
from mua.teachers.trained.image_losses import ImageLoss
from mua.teachers.trained.track_losses import TexelTracks, Tracks
from mua.teachers.trained.tracked_points import _nearest_texels

POINTS = 40


def template() -> tuple[Array, Array]:
    mesh = synthetic_avatar().rig.mesh
    return mesh.vertices, mesh.faces


def spread() -> tuple[Anchors, Array]:
    """Points all over the template, and its vertices in three frames."""
    mesh = synthetic_avatar().rig.mesh
    triangles, barycentrics = spread_points(mesh, POINTS)
    turned = mesh.vertices[..., [2, 1, 0]] * [1, 1, -1]
    posed = np.stack([mesh.vertices, turned + np.array([0.3, 0, 0]), turned + np.array([0, 0.1, 0.2])])
    return Anchors(triangles, barycentrics, np.ones(POINTS, bool)), posed


def followed(posed: Array, anchors: Anchors) -> Array:
    return np.stack([places(anchors, vertices, template()[1]) for vertices in posed])


def same(found: Anchors, wanted: Anchors) -> None:
    np.testing.assert_allclose(places(found, *template()), places(wanted, *template()), atol=1e-9)


@pytest.mark.parametrize("how", ["bind", "first frame"])
def test_points_in_the_world_are_found_on_the_template(how: str) -> None:
    wanted, posed = spread()
    weights = np.ones((3, POINTS))
    weights[0, ::3] = 0  # these are seen first in the second frame
    points = followed(posed, wanted)
    points[0, ::3] = 0
    bind = places(wanted, *template()) if how == "bind" else None
    found = anchors_of(PointTracks(Path(), points, weights, bind=bind), synthetic_avatar().rig.mesh, posed, size=1.0)
    assert found.found.all()
    same(found, wanted)


def test_points_in_pictures_are_what_their_ray_meets_first() -> None:
    wanted, posed = spread()
    mesh = synthetic_avatar().rig.mesh
    outward = face_normals(mesh)[wanted.triangles]
    points = places(wanted, *template())
    origins = points + 0.01 * outward
    order = np.tile(np.arange(POINTS), 3)  # more rays than are cut with all triangles at once
    rays = PointTracks(Path(), origins[None, order], np.ones((1, 3 * POINTS)), directions=-outward[None, order])
    found = places(anchors_of(rays, mesh, posed[:1], size=1.0), *template())
    np.testing.assert_allclose(found, points[order], atol=1e-9)
    upward, away = np.array([[0.0, 1, 0]]), np.array([[0.0, 10, 0]])
    assert not first_hits(*template(), away, upward).found.any()


def test_what_is_far_from_the_template_is_no_point_of_it() -> None:
    wanted, posed = spread()
    points = followed(posed, wanted)
    points[:, :5] += 0.5
    found = anchors_of(PointTracks(Path(), points, np.ones((3, POINTS))), synthetic_avatar().rig.mesh, posed, size=1.0)
    assert not found.found[:5].any()
    assert found.found[5:].all()


def test_a_ray_meets_triangles_alone_and_only_ahead_of_its_camera() -> None:
    vertices = np.array([[0.0, 0, 1], [1, 0, 1], [0, 1, 1], [0, 0, -1], [1, 0, -1], [0, 1, -1]])
    faces, ahead = np.array([[0, 1, 2], [3, 4, 5]]), np.array([0.0, 0, 1])
    beside = [(0.2, 0.3, 0), (0.7, 0.7, 0), (-0.1, 0.3, 0), (0.3, -0.1, 0), (0.2, 0.3, 2), (0.2, 0.3, -2)]
    hits = first_hits(vertices, faces, np.array(beside, float), np.tile(ahead, (len(beside), 1)))
    np.testing.assert_array_equal(hits.found, [True, False, False, False, False, True])
    np.testing.assert_array_equal(hits.triangles[[0, 5]], [0, 1])
    np.testing.assert_allclose(hits.barycentrics[[0, 5]], [[0.5, 0.2, 0.3]] * 2, atol=1e-12)


def test_a_point_that_is_never_seen_is_no_point_of_the_template() -> None:
    wanted, posed = spread()
    weights = np.ones((3, POINTS))
    weights[:, 3] = 0
    tracks = PointTracks(Path(), followed(posed, wanted), weights)
    found = anchors_of(tracks, synthetic_avatar().rig.mesh, posed, size=1.0).found
    np.testing.assert_array_equal(np.flatnonzero(~found), [3])


def test_how_far_is_too_far_grows_with_the_figure() -> None:
    wanted, posed = spread()
    mesh = synthetic_avatar().rig.mesh
    large = replace(mesh, vertices=8 * mesh.vertices)
    points = 8 * followed(posed, wanted) + [0.3, 0, 0]  # 3 cm on a person
    for bind in (None, points[0]):
        tracks = PointTracks(Path(), points, np.ones((3, POINTS)), bind=bind)
        assert anchors_of(tracks, large, 8 * posed, size=8.0).found.all()


def large_figure(points: Array, monkeypatch: pytest.MonkeyPatch) -> list[TexelTracks]:
    """The tracks of a frame in which a figure of some 12 m stands as in its bind pose."""
    rig = synthetic_avatar().rig
    rig = replace(rig, mesh=replace(rig.mesh, vertices=8 * rig.mesh.vertices))
    bind = rig.skeleton.bind_pose
    clip = Clip("stands", 30.0, bind.rotations[None], bind.translations[None])
    seen = PointTracks(Path("tracks.npz"), points[None], np.ones((1, len(points))))
    monkeypatch.setattr(tracked_points, "read_tracks", lambda *_: [seen])
    filmed = SimpleNamespace(subject=SimpleNamespace(rig=rig), capture=None, device=torch.device("cpu"))
    return tracked_points.tracks_of_clip(filmed, clip)  # type: ignore[arg-type]


def test_tracks_of_a_clip_are_those_of_its_points_that_lie_on_the_figure(monkeypatch: pytest.MonkeyPatch) -> None:
    """Near is judged by the figure's size; points that are left out change nothing for the others."""
    own, _ = spread()
    on = 8 * places(own, *template()) + [0.2, 0, 0]  # 3 cm on a person
    off = np.add(on[:5], [9.0, 0, 0])
    [alone], [beside] = (large_figure(points, monkeypatch) for points in (on, np.concatenate([off, on])))
    assert len(alone.tracks.points) == len(beside.tracks.points) == POINTS
    torch.testing.assert_close(beside.tracks.points, torch.tensor(on).float())
    assert torch.equal(beside.texels, alone.texels)
    with pytest.raises(InputError, match=r"tracks\.npz: no tracked point lies on the posed template"):
        large_figure(off, monkeypatch)


def of_texels(*, shift: float) -> TexelTracks:
    """Points of the template in the frame of `motion()[0]`, each seen `shift` metres beside it."""
    rig, window = subject().rig, motion()[0]
    own, _ = spread()
    with torch.no_grad():
        posed = teacher()(window, moving=False).posed.numpy()
    corners = torch.tensor(rig.mesh.faces[own.triangles])
    points = torch.tensor(places(own, posed, rig.mesh.faces)) + torch.tensor([shift, 0, 0])
    tracks = Tracks(corners, torch.tensor(own.barycentrics).float(), points.float(), torch.ones(POINTS))
    return TexelTracks(tracks, torch.tensor(_nearest_texels(rig, own)))


def test_texels_carry_the_points_beside_them() -> None:
    rig = subject().rig
    own, _ = spread()
    texels, normals = _nearest_texels(rig, own), face_normals(rig.mesh)
    at = interpolate(rig.mesh.vertices, rig.mesh.faces[rig.texels.triangles], rig.texels.barycentrics)
    away = np.linalg.norm(at - places(own, *template())[:, None], axis=2)
    assert (away[np.arange(POINTS), texels] <= away.min(axis=1) + 0.02).all()
    assert (np.sum(normals[rig.texels.triangles[texels]] * normals[own.triangles], axis=1) > 0).all()


@torch.no_grad()
@pytest.mark.parametrize("offset", [0.0, 0.01])
def test_a_point_is_where_the_template_and_its_splats_offset_have_it(offset: float) -> None:
    window, untrained = motion()[0], teacher()
    frame = untrained(window, moving=False)
    splats = untrained.splats(frame, window.joints[0])
    back = rotation.rotate(rotation.conjugate(splats.turns.double().numpy()), np.array([offset, 0, 0]))
    error = of_texels(shift=0.02).error(frame.posed, splats, torch.tensor(back).float())
    assert float(error) == pytest.approx((0.02 - offset) ** 2, rel=1e-4)


def test_tracks_pull_the_texels_to_where_points_went() -> None:
    shown = replace(material(), tracks=[of_texels(shift=0.02)] * 3)
    weights = replace(SETTINGS.weights, l1=0.0, ssim=0.0, alpha=0.0, residual=0.0, correction=0.0, tracks=1.0)
    settings = replace(SETTINGS, weights=weights)
    image_loss = ImageLoss(teacher(settings), shown, settings)
    loss = image_loss(torch.tensor([0, 1]), torch.ones(2, 3), True)
    size = figure_scale(subject().rig.mesh.vertices)
    assert float(loss.detach()) == pytest.approx((2 / size) ** 2, rel=1e-3)  # in squares of centimetres on a person
    (slope,) = torch.autograd.grad(loss, image_loss.teacher.still)
    moved = slope[:, 0:3].abs().sum(1)
    assert moved[shown.tracks[0].texels].all()
    assert torch.count_nonzero(moved) <= POINTS
    assert not slope[:, 3:].any()
