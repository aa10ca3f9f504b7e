"""Surfels: frames, footprints, signs, and how they follow a deformation."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from tube import HEIGHT, RADIUS, tube

from mua import rotation
from mua.rig.texel_map import build_texel_map
from mua.texture import surfels
from mua.texture.sharpness import NARROW, SPREAD, Sharpness

SIZE = 61
ROUNDING = 1e3 * float(np.finfo(np.float64).eps)  # one-rings' 2 x 2 inverses lose two digits


def tube_surfels(
    sides: int = 13, factor: float = 1.0, wanted: float | None = None
) -> tuple[surfels.Surfels, np.ndarray]:
    mesh = tube(sides=sides).mesh
    mesh = replace(mesh, vertices=factor * mesh.vertices)
    texels = build_texel_map(mesh, SIZE)
    found = surfels.rest_surfels(
        mesh,
        size=SIZE,
        texels=texels.texels,
        triangles=texels.triangles,
        barycentrics=texels.barycentrics,
        wanted=None if wanted is None else round_ones(wanted, len(texels.texels)),
    )
    return found, texels.texels


def round_ones(spread: float, count: int) -> Sharpness:
    """Surfels of one width that lie along no line."""
    return Sharpness(np.full(count, spread), np.tile([1.0, 0], (count, 1)), np.zeros(count))


def test_frames_are_unit_and_look_along_normal_and_u() -> None:
    found, texels = tube_surfels(sides=60)
    np.testing.assert_allclose(np.linalg.norm(found.rotations, axis=1), 1, atol=ROUNDING)
    u = ((texels % SIZE) + 0.5) / SIZE
    angle = (u - 0.1) / 0.8 * 2 * np.pi
    axes = rotation.to_matrix(found.rotations)
    outward = np.stack([np.sin(angle), 0 * angle, np.cos(angle)], axis=1)
    around = np.stack([np.cos(angle), 0 * angle, -np.sin(angle)], axis=1)
    one_side = 2 * np.pi / 60  # the tube has corners
    assert np.min(np.sum(axes[:, :, 2] * outward, axis=1)) > np.cos(one_side)
    assert np.min(np.sum(axes[:, :, 0] * around, axis=1)) > np.cos(one_side)


def test_neighbouring_frames_have_one_sign_right_around_the_tube() -> None:
    found, texels = tube_surfels()
    flat = np.full((SIZE * SIZE, 4), np.nan)
    flat[texels] = found.rotations
    grid = flat.reshape(SIZE, SIZE, 4)
    for a, b in ((grid[:, :-1], grid[:, 1:]), (grid[:-1], grid[1:])):
        dots = np.sum(a * b, axis=2)
        assert np.nanmin(dots) > 0
    ends = np.nanmean(np.sum(grid[:, int(0.12 * SIZE)] * grid[:, int(0.88 * SIZE)], axis=1))
    assert ends < -0.9  # a full turn leads to the other sign, so no fixed hemisphere would have done


def test_footprint_is_the_distance_of_texels() -> None:
    found, texels = tube_surfels(sides=60)
    scales = np.exp(found.log_scales)
    wide, high = 2 * np.pi * RADIUS / (0.8 * SIZE), HEIGHT / (0.8 * SIZE)
    chord = np.sinc(1 / 60)  # a side of the 60-gon over its arc
    tilt = 1 - np.cos(2 * np.pi / 60)  # smooth normals lie between those of two sides
    inner = surrounded(texels)
    np.testing.assert_allclose(scales[inner, 0], SPREAD * wide * chord, rtol=tilt)
    np.testing.assert_allclose(scales[inner, 1], SPREAD * high, rtol=tilt)
    assert np.all(scales[:, 2] <= scales[:, :2].min(axis=1))


def test_surfels_are_as_wide_as_the_image_asks() -> None:
    (found, texels), (narrow, _) = tube_surfels(), tube_surfels(wanted=NARROW)
    inner = surrounded(texels)
    ratios = np.exp(narrow.log_scales - found.log_scales)[inner, :2]
    assert np.median(ratios) == pytest.approx(NARROW / SPREAD, rel=ROUNDING)  # few have to cover more


def surrounded(texels: np.ndarray) -> np.ndarray:
    """Whether texels have all eight neighbours; surfels at a chart's border reach out to it."""
    grid = np.zeros((SIZE + 2, SIZE + 2), int)
    row, column = np.divmod(texels, SIZE)
    grid[row + 1, column + 1] = 1
    around = sum(grid[row + 1 + i, column + 1 + j] for i in (-1, 0, 1) for j in (-1, 0, 1))
    return np.asarray(around == 9)


@pytest.mark.parametrize("factor", [2.0**-10, 2.0**5])  # exact in floating point
def test_surfels_of_a_figure_of_any_size_differ_by_its_size_alone(factor: float) -> None:
    found, _ = tube_surfels()
    other, _ = tube_surfels(factor=factor)
    np.testing.assert_allclose(other.log_scales - found.log_scales, np.log(factor), atol=ROUNDING)
    np.testing.assert_allclose(other.rotations, found.rotations, atol=ROUNDING)


@pytest.mark.parametrize("seed", [0, 1])
def test_alignment_recovers_a_smooth_field_from_random_signs(seed: int) -> None:
    rng = np.random.default_rng(seed)
    size = 23
    valid = np.zeros((size, size), bool)
    valid[2:11, 3:20] = valid[13:22, 1:9] = True  # two charts
    texels = np.flatnonzero(valid)
    row, column = np.divmod(texels, size)
    angles = np.stack([0.3 * row, 0.2 * column, 0.1 * row], axis=1)
    smooth = rotation.from_axis_angle(np.array([0, 0, 1.0]), angles[:, 0])
    smooth = rotation.multiply(smooth, rotation.from_axis_angle(np.array([1.0, 0, 0]), angles[:, 1]))
    flipped = smooth * rng.choice([-1, 1], len(smooth))[:, None]
    aligned = surfels.align_neighbours(flipped, texels, size)
    for chart in (row < 12, row >= 12):
        assert len(np.unique(np.sign(np.sum(aligned[chart] * smooth[chart], axis=1)))) == 1
        assert aligned[chart, 0].mean() >= 0


@pytest.mark.parametrize("count", [0, 1])
def test_alignment_of_hardly_any_texels(count: int) -> None:
    q = np.tile([-1.0, 0, 0, 0], (count, 1))
    np.testing.assert_array_equal(surfels.align_neighbours(q, np.arange(count), 4), -q)


def test_rigid_motion_and_growth_are_measured() -> None:
    mesh = tube().mesh
    turn = Rotation.from_euler("xyz", [0.5, -1.0, 0.3])
    q, strain = surfels.SurfaceFrames(mesh.vertices, mesh.faces)(1.5 * turn.apply(mesh.vertices) + [1, 2, 3])
    expected = np.roll(turn.as_quat(), 1)
    np.testing.assert_allclose(np.abs(q @ expected), 1, atol=ROUNDING)
    np.testing.assert_allclose(strain[:, 1], 1.5**2 - 1, rtol=0.01)  # along y; at a border edges on both sides differ
    normals = surfels.vertex_normals(mesh.vertices, mesh.faces)
    np.testing.assert_allclose(_applied(strain, normals), 0, atol=ROUNDING)
    across = np.cross(normals, [0, 1.0, 0])
    across /= np.linalg.norm(across, axis=1, keepdims=True)
    np.testing.assert_allclose(_applied(strain, across), 1.5**2 - 1, rtol=0.01)


def _applied(strain: np.ndarray, x: np.ndarray) -> np.ndarray:
    """x . strain x."""
    xx, yy, zz, xy, xz, yz = strain.T
    a, b, c = x.T
    return np.asarray(a * a * xx + b * b * yy + c * c * zz + 2 * (a * b * xy + a * c * xz + b * c * yz))


def test_frames_do_not_turn_at_rest() -> None:
    mesh = tube().mesh
    q, strain = surfels.SurfaceFrames(mesh.vertices, mesh.faces)(mesh.vertices)
    np.testing.assert_allclose(q, np.tile([1.0, 0, 0, 0], (len(q), 1)), atol=ROUNDING)
    np.testing.assert_allclose(strain, 0, atol=ROUNDING)


def test_a_surface_without_extent_gets_surfels_of_the_least_size() -> None:
    """The lower half of the tube is one point."""
    mesh = tube().mesh
    low = mesh.vertices[:, 1] < np.median(mesh.vertices[:, 1])
    mesh = replace(mesh, vertices=np.where(low[:, None], [0.0, mesh.vertices[:, 1].min(), 0], mesh.vertices))
    texels = build_texel_map(mesh, SIZE)
    found = surfels.rest_surfels(
        mesh, size=SIZE, texels=texels.texels, triangles=texels.triangles, barycentrics=texels.barycentrics
    )
    least = surfels.LEAST * np.ptp(mesh.vertices, axis=0).max()
    assert found.log_scales.min() == pytest.approx(np.log(least), abs=ROUNDING)
    np.testing.assert_allclose(np.linalg.norm(found.rotations, axis=1), 1, atol=ROUNDING)


def test_normals_of_a_sheet_with_two_sides_point_up() -> None:
    sheet = np.array([[0.0, 0, 0], [1, 0, 0], [0, 0, 1]]), np.array([[0, 1, 2], [0, 2, 1]])
    np.testing.assert_array_equal(surfels.vertex_normals(*sheet), np.tile([0.0, 1, 0], (3, 1)))


@pytest.mark.parametrize(
    "corner", [(0.5, 0.0, 0.0), (0.0, 0.0, 0.0), (0.0, 0.0, 1e-9)], ids=["on a line", "twice", "all but twice"]
)
def test_a_triangle_without_area_follows_as_well_as_it_can(corner: tuple[float, float, float]) -> None:
    """Such triangles are in many files; their neighbours must not suffer."""
    rest = np.array([[0.0, 0, 0], [1, 0, 0], corner, [0, 0, -1]])
    follow = surfels.SurfaceFrames(rest, np.array([[0, 1, 2], [0, 3, 1]]))
    rotations, strains = follow(rest)
    np.testing.assert_allclose(np.abs(rotations[:, 0]), 1, atol=ROUNDING)
    np.testing.assert_allclose(strains, 0, atol=ROUNDING)
    assert (follow.squeeze(np.zeros_like(rest)) > 1).all()  # squeezed to a point, by a number that is finite
    assert np.isfinite(follow.squeeze(np.zeros_like(rest))).all()
