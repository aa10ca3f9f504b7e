"""Losses of the template against plain loops, known answers and finite differences."""

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
import torch
from scipy import ndimage
from scipy.spatial.distance import cdist
from tube import HEIGHT, RADIUS, tube

from mua import rotation
from mua.avatar.camera import Camera, orbit
from mua.rig.character import Mesh
from mua.splatting.projection import Eye
from mua.teachers.trained import silhouette
from mua.teachers.trained.mesh_losses import FACING, REACH, SIDEWAYS, Cloud, Samples, chamfer, edges_of, roughness
from mua.teachers.trained.silhouette import Outline, outlines, silhouette_error
from mua.teachers.trained.track_losses import Tracks, track_error

BOUND = 1e-12  # some 100 operations on lengths of up to 2 metres in float64


@pytest.fixture(scope="module")
def mesh() -> Mesh:
    return tube().mesh


def moved(mesh: Mesh, *, seed: int = 0, by: float = 0.01) -> torch.Tensor:
    """Vertices [V, 3] a little away from those of the mesh."""
    return torch.tensor(mesh.vertices + np.random.default_rng(seed).normal(scale=by, size=mesh.vertices.shape))


def check_gradient(value: Callable[[torch.Tensor], torch.Tensor], at: torch.Tensor, *, relative: float = 1e-6) -> None:
    """Against a central difference along a random direction."""
    towards = torch.randn(at.shape, generator=torch.Generator().manual_seed(7), dtype=torch.float64)
    leaf = at.clone().requires_grad_()
    value(leaf).backward()
    assert leaf.grad is not None
    step = 1e-7
    difference = (value(at + step * towards) - value(at - step * towards)) / (2 * step)
    assert difference.abs() > 0
    torch.testing.assert_close((leaf.grad * towards).sum(), difference, rtol=relative, atol=0)


@pytest.mark.parametrize("sideways", [1.0, SIDEWAYS])
def test_chamfer_is_the_sum_over_nearest_pairs(mesh: Mesh, sideways: float) -> None:
    samples, cloud, posed = Samples.of(mesh, 150), Cloud.of(mesh, 200), moved(mesh)
    points, normals = (values.numpy() for values in samples.on(posed))
    away = np.sqrt(
        cdist(points, cloud.points) ** 2 + FACING**2 * cdist(normals, cloud.normals) ** 2
    )  # by place and facing
    expected = 0.0
    for first, second, across, nearest in (
        (points, cloud.points, cloud.normals, away.argmin(axis=1)),
        (cloud.points, points, None, away.argmin(axis=0)),
    ):
        terms = []
        for i, j in enumerate(nearest):
            apart = first[i] - second[j]
            normal = cloud.normals[i] if across is None else across[j]
            if np.linalg.norm(apart) < REACH:
                terms.append((1 - sideways) * (apart @ normal) ** 2 + sideways * apart @ apart)
        expected += float(np.mean(terms))
    assert float(chamfer(posed, samples, cloud, sideways=sideways)) == pytest.approx(expected, rel=1e-9)


def test_chamfer_has_the_gradient_of_finite_differences(mesh: Mesh) -> None:
    samples, cloud = Samples.of(mesh, 150), Cloud.of(mesh, 200)
    check_gradient(lambda posed: chamfer(posed, samples, cloud), moved(mesh))


def test_chamfer_pulls_a_wider_tube_in(mesh: Mesh) -> None:
    samples, cloud = Samples.of(mesh, 400), Cloud.of(mesh, 400)
    wider = torch.tensor(mesh.vertices * [1.2, 1, 1.2]).requires_grad_()
    loss = chamfer(wider, samples, cloud)
    assert float(loss.detach()) == pytest.approx(2 * (0.2 * RADIUS) ** 2, rel=0.2)
    loss.backward()
    assert wider.grad is not None
    outward = (wider.grad[:, [0, 2]] * wider.detach()[:, [0, 2]]).sum(1)
    assert (outward > 0).double().mean() > 0.95


def test_a_surface_that_faces_the_other_way_is_no_match(mesh: Mesh) -> None:
    """Two shells 2 cm apart, as the inside and the outside of a sleeve."""
    inner = replace(mesh, vertices=mesh.vertices * np.array([0.83, 1, 0.83]), faces=mesh.faces[:, ::-1])
    outer, within = Cloud.of(mesh, 4000), Cloud.of(inner, 4000)
    both = Cloud(np.concatenate([outer.points, within.points]), np.concatenate([outer.normals, within.normals]))
    near = torch.tensor(mesh.vertices * [0.9, 1, 0.9])  # between them, nearer to the inner one
    points, normals = (values.numpy() for values in Samples.of(mesh, 300).on(near))
    _, there = both.tree.query(both.features(points, normals))
    assert (there < 4000).mean() > 0.95


def test_what_is_out_of_reach_does_not_count(mesh: Mesh) -> None:
    samples, cloud = Samples.of(mesh, 150), Cloud.of(mesh, 200)
    litter = Cloud(np.concatenate([cloud.points, [[3.0, 0, 0]]]), np.concatenate([cloud.normals, [[1.0, 0, 0]]]))
    posed = moved(mesh)
    torch.testing.assert_close(chamfer(posed, samples, litter), chamfer(posed, samples, cloud), rtol=1e-12, atol=0)


def tracks_at(mesh: Mesh, posed: torch.Tensor, *, by: float) -> Tracks:
    samples = Samples.of(mesh, 20)
    points = samples.on(posed)[0]
    weights = torch.ones(20, dtype=torch.float64)
    weights[3] = 0
    points = points + torch.tensor([by, 0, 0], dtype=torch.float64)
    points[3] = torch.nan_to_num(points[3]) + 50
    return Tracks(samples.corners, samples.barycentrics, points, weights)


def test_tracks_count_where_they_were_seen(mesh: Mesh) -> None:
    posed = moved(mesh)
    for by, expected in ((0.0, 0.0), (0.02, 0.02**2), (0.5, 2 * REACH * 0.5 - REACH**2)):
        assert float(track_error(posed, tracks_at(mesh, posed, by=by))) == pytest.approx(expected, abs=BOUND)
    tracks = tracks_at(mesh, posed, by=0.09)
    check_gradient(lambda vertices: track_error(vertices, tracks), moved(mesh, seed=1))


def test_errors_of_a_figure_of_another_size_are_those_of_a_person_in_its_measure(mesh: Mesh) -> None:
    """This includes points out of reach, and a shell inside another one that faces the other way."""
    samples, posed, size = Samples.of(mesh, 150), moved(mesh, by=0.03), 8.0
    inner = Cloud.of(replace(mesh, vertices=mesh.vertices * [0.83, 1, 0.83], faces=mesh.faces[:, ::-1]), 300)
    outer = Cloud.of(mesh, 300)
    points = np.concatenate([outer.points, inner.points, [[0.0, 0.5, 1.2 * REACH + RADIUS]]])
    normals = np.concatenate([outer.normals, inner.normals, [[0.0, 0, 1]]])
    large = Cloud(size * points, normals, size)
    expected = size**2 * chamfer(posed, samples, Cloud(points, normals))
    torch.testing.assert_close(chamfer(size * posed, samples, large), expected, rtol=1e-9, atol=0)
    tracks = tracks_at(mesh, posed, by=2 * REACH)
    grown = replace(tracks, points=size * tracks.points)
    expected = size**2 * track_error(posed, tracks)
    torch.testing.assert_close(track_error(size * posed, grown, size=size), expected, rtol=1e-9, atol=0)


def test_a_point_that_one_camera_saw_counts_its_distance_from_the_ray(mesh: Mesh) -> None:
    posed = moved(mesh)
    tracks = replace(tracks_at(mesh, posed, by=0.0), points=torch.tensor([[0.0, 5, 0]], dtype=torch.float64))
    points = (tracks.barycentrics[..., None] * posed[tracks.corners]).sum(1)
    away = points - tracks.points
    ray = torch.nn.functional.normalize(away + torch.tensor([0.05, 0.02, -0.01]), dim=1)
    wanted = float((torch.linalg.cross(away, ray).square().sum(1) * tracks.weights).sum() / tracks.weights.sum())
    seen = replace(tracks, points=tracks.points.expand_as(points), directions=ray)
    assert float(track_error(posed, seen)) == pytest.approx(wanted, abs=BOUND)
    assert wanted > 1e-4
    check_gradient(lambda vertices: track_error(vertices, seen), moved(mesh, seed=1))


def test_roughness_is_nothing_for_what_all_share(mesh: Mesh) -> None:
    edges = edges_of(mesh)
    assert len({frozenset(edge) for edge in edges.tolist()}) == len(edges)
    field = torch.ones(2, len(mesh.vertices), 3, dtype=torch.float64)
    assert roughness(field, edges) == 0
    field[0, 5, 1] += 0.1
    touching = int((edges == 5).any(dim=1).sum())
    assert float(roughness(field, edges)) == pytest.approx(0.01 * touching / (2 * len(edges)))
    check_gradient(lambda values: roughness(values, edges), moved(mesh))


def camera(side: int = 48) -> Camera:
    """The whole tube from the side."""
    bounds = np.array([[-RADIUS, 0, -RADIUS], [RADIUS, HEIGHT, RADIUS]])
    return orbit(bounds, screen=(side, side), azimuth=0.4, elevation=0.2)


def test_an_outline_covers_what_triangles_cover(mesh: Mesh) -> None:
    posed, samples, seen = torch.tensor(mesh.vertices), Samples.of(mesh, 3000), camera()
    cover = outlines(posed, samples, [Eye.of(seen, posed)])[0].numpy()
    clip = np.column_stack([mesh.vertices, np.ones(len(mesh.vertices))]) @ (seen.projection @ seen.view).T
    x, y = (clip[:, axis] / clip[:, 3] for axis in (0, 1))
    columns, rows = (x + 1) * 24, (1 - y) * 24
    inside = np.zeros((48, 48), bool)
    grid = np.stack(np.meshgrid(np.arange(48) + 0.5, np.arange(48) + 0.5), axis=-1).reshape(-1, 2)
    for a, b, c in mesh.faces:
        one, two, three = (np.array([columns[v], rows[v]]) for v in (a, b, c))
        corners = ((one, two), (two, three), (three, one))
        signs = [(q - p)[0] * (grid - p)[:, 1] - (q - p)[1] * (grid - p)[:, 0] for p, q in corners]
        inside |= ((np.array(signs) >= 0).all(axis=0) | (np.array(signs) <= 0).all(axis=0)).reshape(48, 48)
    within, about = ndimage.binary_erosion(inside, iterations=2), ndimage.binary_dilation(inside, iterations=2)
    assert within.sum() > 50
    assert cover[within].min() > 0.9
    assert cover[~about].max() < 0.1


def test_silhouettes_have_the_gradient_of_finite_differences(mesh: Mesh, monkeypatch: pytest.MonkeyPatch) -> None:
    """How discs turn is taken as given."""
    posed, samples = moved(mesh, by=0.003), Samples.of(mesh, 500)
    eye = Eye.of(camera(), posed)
    (mask,) = outlines(posed * 1.1, samples, [eye])
    turns = silhouette.facing(samples.on(posed)[1])
    monkeypatch.setattr(silhouette, "facing", lambda _: turns)
    check_gradient(lambda at: silhouette_error(at, samples, [Outline(eye, mask)]), posed, relative=1e-4)


def test_silhouettes_pull_a_shifted_tube_to_its_mask(mesh: Mesh) -> None:
    posed, samples = torch.tensor(mesh.vertices), Samples.of(mesh, 1000)
    eye = Eye.of(camera(), posed)
    (mask,) = outlines(posed, samples, [eye])
    right = torch.tensor(np.linalg.inv(camera().view)[:3, 0])
    shift = torch.tensor(0.05, dtype=torch.float64, requires_grad=True)
    before = silhouette_error(posed + shift * right, samples, [Outline(eye, mask)])
    before.backward()
    assert shift.grad is not None
    assert shift.grad > 0
    assert silhouette_error(posed, samples, [Outline(eye, mask)]) < before / 100


def test_a_silhouette_counts_by_what_the_mask_covers(mesh: Mesh) -> None:
    """Room about the person changes nothing, and a mask without anyone is no division by zero."""
    posed, samples = torch.tensor(mesh.vertices), Samples.of(mesh, 500)
    eye = Eye.of(camera(), posed)
    (mask,) = outlines(posed * 1.1, samples, [eye])
    wide = (outlines(posed, samples, [eye])[0] - mask).square().sum() / mask.sum()
    torch.testing.assert_close(silhouette_error(posed, samples, [Outline(eye, mask)]), wide)
    assert torch.isfinite(silhouette_error(posed, samples, [Outline(eye, torch.zeros_like(mask))]))


def test_silhouettes_of_several_cameras_count_their_mean(mesh: Mesh) -> None:
    posed, samples = torch.tensor(mesh.vertices), Samples.of(mesh, 500)
    eye = Eye.of(camera(), posed)
    masks = [outlines(posed * scale, samples, [eye])[0] for scale in (1.1, 1.2)]
    errors = [silhouette_error(posed, samples, [Outline(eye, mask)]) for mask in masks]
    both = silhouette_error(posed, samples, [Outline(eye, mask) for mask in masks])
    torch.testing.assert_close(both, torch.stack(errors).mean())


def test_discs_face_as_the_surface_does() -> None:
    normals = np.random.default_rng(0).normal(size=(20, 3))
    normals = np.concatenate([normals / np.linalg.norm(normals, axis=1, keepdims=True), [[0, 0, 1], [0, 0, -1]]])
    turns = silhouette.facing(torch.tensor(normals)).numpy()
    np.testing.assert_allclose(np.linalg.norm(turns, axis=1), 1, rtol=1e-12)
    np.testing.assert_allclose(rotation.rotate(turns, np.tile([0.0, 0, 1], (22, 1))), normals, atol=1e-12)


def test_a_triangle_without_area_is_a_finite_disc() -> None:
    flat = Mesh(np.array([[0.0, 1, 0]] * 3), np.array([[0, 1, 2]]), np.zeros((3, 2)), np.array([[0, 1, 2]]))
    samples = Samples.of(flat, 4)
    image = outlines(torch.tensor(flat.vertices), samples, [Eye.of(camera(), torch.tensor(flat.vertices))])[0]
    assert torch.isfinite(image).all()
