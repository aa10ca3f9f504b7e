"""Surfels of a stretched surface: they grow along the stretch and along nothing else, and stay closed."""

from typing import Any

import numpy as np
import pytest
from surfel_coverage import coverage
from tube import HEIGHT, tube

from mua import rotation
from mua.arrays import Array
from mua.rig.character import Mesh
from mua.rig.texel_map import build_texel_map
from mua.texture.footprints import TexelPoints
from mua.texture.stretch import HOLD, LEAN, LONGEST, SurfelStretch
from mua.texture.surfels import SurfaceFrames, rest_surfels

SIZE = 61


def stretched(mesh: Mesh, moved: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Log stretches [2, N] of a mesh's surfels, their places and scales after it."""
    texels = build_texel_map(mesh, SIZE)
    at: dict[str, Any] = {"texels": texels.texels, "triangles": texels.triangles, "barycentrics": texels.barycentrics}
    found = rest_surfels(mesh, size=SIZE, **at)
    turn, strain = SurfaceFrames(mesh.vertices, mesh.faces)(moved)
    at_texels = np.einsum("nk,nkc->cn", texels.barycentrics, strain[mesh.faces[texels.triangles]])
    stretch = SurfelStretch(
        mesh.vertices,
        mesh.faces,
        triangles=texels.triangles,
        barycentrics=texels.barycentrics,
        rotations=found.rotations,
        deviations=np.exp(found.log_scales[:, :2]),
    )
    grown = stretch(moved, at_texels, turn)
    scales = np.exp(found.log_scales + np.concatenate([grown, np.zeros((1, len(texels.texels)))]).T)
    return grown, TexelPoints(Mesh(moved, mesh.faces, mesh.uv, mesh.uv_faces), SIZE, **at).places, scales


@pytest.mark.parametrize("factor", [0.5, 3.0])
def test_a_tube_pulled_along_its_axis_grows_along_it_alone(factor: float) -> None:
    mesh = tube(sides=40).mesh
    (across, along), _, _ = stretched(mesh, mesh.vertices * [1, factor, 1])
    np.testing.assert_allclose(along, np.log(factor), atol=0.02)  # smooth normals and flat triangles differ a little
    np.testing.assert_allclose(across, 0, atol=0.02)


def test_one_ring_pulled_apart_stays_closed_and_its_neighbours_small() -> None:
    mesh = tube(rings=8, sides=13).mesh
    cut = HEIGHT * 3.5 / 7
    moved = mesh.vertices + (mesh.vertices[:, 1:2] > cut) * [0, 5 * HEIGHT / 7, 0]  # one ring, 6 times as long
    (_, along), places, scales = stretched(mesh, moved)
    pulled = (places[:, 1] > HEIGHT * 3 / 7) & (places[:, 1] < HEIGHT * 9 / 7)
    assert np.all(along[pulled] >= np.log(6) - HOLD - 1e-6)
    assert np.all(along[~pulled] <= HOLD + 1e-6)
    frames = np.tile(np.eye(3), (len(places), 1, 1))
    angle = np.arctan2(places[:, 0], places[:, 2])
    frames[:, :, 0] = np.stack([np.cos(angle), 0 * angle, -np.sin(angle)], axis=1)
    frames[:, :, 2] = np.stack([np.sin(angle), 0 * angle, np.cos(angle)], axis=1)
    a, b, c = moved[mesh.faces].swapaxes(0, 1)
    middle = ((a + b + c) / 3)[np.ptp(moved[mesh.faces][:, :, 1], axis=1) > HEIGHT / 2]
    assert coverage(middle, places, rotation.from_matrix(frames), scales).min() > 0.9


def on_a_triangle(corners: Array, deviation: float) -> SurfelStretch:
    """Of one round surfel in the middle of a triangle [3, 3]."""
    return SurfelStretch(
        corners,
        np.array([[0, 1, 2]]),
        triangles=np.array([0]),
        barycentrics=np.full((1, 3), 1 / 3),
        rotations=np.array([[1.0, 0, 0, 0]]),
        deviations=np.full((1, 2), deviation),
    )


def test_a_surfel_wider_than_the_sliver_it_lies_on_grows_by_what_the_sliver_opens() -> None:
    thin, opened, deviation = 1e-4, 0.03, 0.01  # metres
    corners = np.array([[0.0, 0, 0], [1, 0, 0], [0.5, thin, 0]])
    stretch = on_a_triangle(corners, deviation)
    moved = corners + np.array([[0, 0, 0], [0, 0, 0], [0, opened, 0]])
    (along,), (across,) = stretch(moved, np.zeros((6, 1)), np.eye(4)[[0, 0, 0]])
    assert abs(along) <= HOLD
    assert 0 <= deviation * np.expm1(across) <= opened


def test_no_surfel_spans_a_gap_that_opens_far_beyond_its_size() -> None:
    """An armpit, whose skin opens tenfold from a few triangles: surfels as long would stand out of the body."""
    mesh = tube(rings=8, sides=13).mesh
    moved = mesh.vertices + (mesh.vertices[:, 1:2] > HEIGHT * 3.5 / 7) * [0, 20 * HEIGHT / 7, 0]
    (_, along), _, _ = stretched(mesh, moved)
    assert along.max() == pytest.approx(np.log(LONGEST))


def test_a_surfel_that_leans_out_of_its_stretched_triangle_stands_off_by_part_of_its_rest_length() -> None:
    corners, deviation, lean = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0]]), 0.01, 0.25  # radians about y
    stretch = on_a_triangle(corners, deviation)
    moved, longer = corners * [4, 1, 1], np.array([[15.0], [0], [0], [0], [0], [0]])
    flat, leaning = (
        stretch(moved, longer, rotation.from_axis_angle(np.eye(3)[[1, 1, 1]], angle)) for angle in (0, lean)
    )
    assert np.exp(flat[0]) == pytest.approx(4)
    assert np.exp(leaning[0]) * np.sin(lean) == pytest.approx(LEAN)
    assert leaning[1] == flat[1]


def test_a_surface_squeezed_to_nothing_keeps_finite_surfels() -> None:
    mesh = tube().mesh
    grown, _, scales = stretched(mesh, mesh.vertices * [1, 0, 1])
    assert np.isfinite(grown).all()
    assert scales.min() > 0
