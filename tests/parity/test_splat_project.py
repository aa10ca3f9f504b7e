"""Projection against 4x4 matrices and a numerically differentiated Jacobian; culling and keys by behaviour."""

from dataclasses import replace

import numpy as np
import pytest
from packed_splats import LARGEST_HALF, colors_of
from projected import FACES, GROUP, UNWRITTEN, Scene, Texels, held, on_steps, project_on, texels_of
from projected_cases import BOX, SCREEN, random_texels, stereo
from projection_errors import assert_as_the_reference, covariance_of
from splat_rounding import CENTRE_BOUND, ULP

from mua import rotation
from mua.arrays import Array
from mua.avatar.camera import NEAR, Camera, orbit
from mua.avatar.decode import Splats
from mua.gpu import Device
from mua.kernels.dq_skinning import covariances
from mua.kernels.splat_draw import splat_colors
from mua.kernels.splat_project import (
    COLOR_SCALES,
    HIDDEN,
    LAST_KEY,
    LEAST_OPACITY,
    REACH,
    half_extents,
    splat_project,
)

GPU_COUNTS = [0, 1, GROUP - 1, GROUP, GROUP + 1, 4099, 300_007]

COUNTS = [0, 1, 7, 503]


def camera() -> Camera:
    return orbit(BOX, screen=SCREEN, azimuth=0.7, elevation=0.4)


def random_splats(count: int, dtype: type = np.float64) -> tuple[Array, Array, Array]:
    """Centres, covariances and opacities in the box; all in view of `camera`."""
    rng = np.random.default_rng(count)
    turns = rotation.normalize(rng.normal(size=(count, 4)))
    covariance = covariances(turns, np.exp(rng.uniform(-4, -2, (count, 3))))
    centres, opacities = rng.uniform(-1, 1, (count, 3)), rng.uniform(0.1, 1, count)
    return centres.astype(dtype), covariance.astype(dtype), opacities.astype(dtype)


def project(
    centres: Array, covariance: Array, opacities: Array, *cameras: Camera, bounds: Array = BOX
) -> tuple[Array, Array, Array]:
    return splat_project(
        centres,
        covariance,
        opacities,
        np.stack([c.view for c in cameras]),
        np.stack([c.projection for c in cameras]),
        screen=SCREEN,
        near=NEAR,
        bounds=bounds,
    )


def pixel_of(seen_by: Camera, points: Array) -> Array:
    """Column and row [N, 2] by 4x4 matrices, the perspective division and the viewport."""
    clip = np.concatenate([points, np.ones((len(points), 1))], axis=1) @ (seen_by.projection @ seen_by.view).T
    ndc = clip[:, :2] / clip[:, 3:]
    return (ndc * [1, -1] + 1) / 2 * SCREEN


@pytest.mark.parametrize("count", COUNTS)
def test_ellipse_is_the_covariance_through_the_derivative_of_the_projection(count: int) -> None:
    centres, covariance, opacities = random_splats(count)
    splats, _, ellipses = project(centres, covariance, opacities, camera())
    np.testing.assert_array_equal(splats, np.arange(count))
    np.testing.assert_allclose(ellipses[0, :, :2], pixel_of(camera(), centres), rtol=1e-12)
    step = 1e-5  # metres; balances truncation, step^2, with rounding, eps / step
    rise = [pixel_of(camera(), centres + step * e) - pixel_of(camera(), centres - step * e) for e in np.eye(3)]
    jacobian = np.stack(rise, axis=-1) / (2 * step)
    rows, columns = np.triu_indices(3)
    sigma = np.empty((count, 3, 3))
    sigma[:, rows, columns] = sigma[:, columns, rows] = covariance
    expected = jacobian @ sigma @ jacobian.swapaxes(1, 2)
    np.testing.assert_allclose(covariance_of(ellipses[0]), expected, rtol=1e-8, atol=1e-8 * expected.max(initial=1))
    assert np.all(ellipses[0, :, 4] >= ellipses[0, :, 5])


@pytest.mark.parametrize("count", COUNTS)
def test_float32_stays_near_float64(count: int) -> None:
    splats, keys, ellipses = project(*random_splats(count, np.float32), camera())
    wide = random_splats(count, np.float32)
    centres, sigmas, opacities = (a.astype(float) for a in wide)
    exact_splats, exact_keys, exact = project(centres, sigmas, opacities, camera())
    assert ellipses.dtype == np.float32
    assert keys.dtype == np.uint16
    np.testing.assert_array_equal(splats, exact_splats)
    eps = float(np.finfo(np.float32).eps)
    np.testing.assert_allclose(ellipses[0, :, :2], exact[0, :, :2], rtol=0, atol=32 * eps * max(SCREEN))
    largest = np.square(exact[0, :, 4]).max(initial=1)
    np.testing.assert_allclose(
        covariance_of(ellipses[0].astype(float)), covariance_of(exact[0]), rtol=0, atol=64 * eps * largest
    )
    key_bound = 1 + 32 * eps * LAST_KEY
    assert np.all(np.abs(keys.astype(int) - exact_keys) <= key_bound)


def test_keys_order_splats_back_to_front_half_a_diagonal_beyond_the_bounds() -> None:
    centres, covariance, opacities = random_splats(503)
    splats, keys, _ = project(centres, covariance, opacities, camera())
    depth = -(centres[splats] @ camera().view[2, :3] + camera().view[2, 3])
    corners = np.array(np.meshgrid(*BOX.T)).reshape(3, -1).T
    reach = -(corners @ camera().view[2, :3] + camera().view[2, 3])
    spare = np.linalg.norm(BOX[1] - BOX[0]) / 2
    step = (reach.max() - reach.min() + 2 * spare) / LAST_KEY
    expected = (reach.max() + spare - depth) / step
    assert np.all(np.abs(keys - expected) <= 0.5 + 1e-6)


def test_what_lies_far_outside_the_bounds_takes_the_first_or_last_key() -> None:
    centres, covariance, opacities = random_splats(503)
    _, keys, _ = project(centres, covariance, opacities, camera(), bounds=0.01 * BOX)
    assert keys.min() == 0
    assert keys.max() == LAST_KEY


def test_bounds_without_depth_give_one_key() -> None:
    centres, covariance, opacities = random_splats(1)
    _, keys, _ = project(centres, covariance, opacities, camera(), bounds=np.repeat(centres, 2, axis=0))
    assert keys.shape == (1,)


def at_eye(x: float, y: float, z: float) -> Array:
    """The world point [1, 3] at eye coordinates x, y, z of `camera`, metres."""
    view = camera().view
    return (np.array([[x, y, z]]) - view[:3, 3]) @ view[:3, :3]


SMALL = np.array([[1e-4, 0, 0, 1e-4, 0, 1e-4]])


@pytest.mark.parametrize(
    "place", [(0, 0, 1), (0, 0, -NEAR / 2), (0, 0, 0), (0, 5, -3), (0, -5, -3), (9, 0, -3), (-9, 0, -3)]
)
def test_culls_behind_the_near_plane_and_beside_the_screen(place: tuple[float, float, float]) -> None:
    splats, keys, ellipses = project(at_eye(*place), SMALL, np.ones(1), camera())
    assert len(splats) == len(keys) == 0
    assert ellipses.shape == (1, 0, 6)


def test_culls_what_is_too_transparent_to_show() -> None:
    opacities = np.array([0, 0.99 * LEAST_OPACITY, 1.01 * LEAST_OPACITY, 1])
    splats, _, _ = project(at_eye(0, 0, -3).repeat(4, axis=0), SMALL.repeat(4, axis=0), opacities, camera())
    np.testing.assert_array_equal(splats, [2, 3])


def test_keeps_what_reaches_into_the_screen_from_outside() -> None:
    beside = at_eye(3 / camera().projection[0, 0] + 0.05, 0, -3)
    assert pixel_of(camera(), beside)[0, 0] > SCREEN[0]
    assert len(project(beside, 100 * SMALL, np.ones(1), camera())[0]) == 1
    assert len(project(beside, SMALL / 1e4, np.ones(1), camera())[0]) == 0


def test_a_splat_seen_by_one_eye_is_kept_and_marked_in_the_other() -> None:
    behind = orbit(BOX, screen=SCREEN, azimuth=0.7 + np.pi, elevation=-0.4)
    beyond = at_eye(0, 0, -40)
    splats, _, ellipses = project(beyond, 100 * SMALL, np.ones(1), camera(), behind)
    np.testing.assert_array_equal(splats, [0])
    assert np.all(ellipses[0, :, 4:] > 0)
    assert np.all(ellipses[1, :, 4:] == 0)


def test_two_eyes_agree_with_each_alone() -> None:
    centres, covariance, opacities = random_splats(101)
    other = orbit(BOX, screen=SCREEN, azimuth=0.75, elevation=0.4)
    _, _, both = project(centres, covariance, opacities, camera(), other)
    for eye, seen_by in enumerate((camera(), other)):
        np.testing.assert_array_equal(both[eye], project(centres, covariance, opacities, seen_by)[2][0])


def test_the_box_holds_all_that_shows() -> None:
    centres, covariance, opacities = random_splats(101)
    _, _, ellipses = project(centres, covariance, opacities, camera())
    extent = half_extents(ellipses[0])
    marginal = np.sqrt(np.diagonal(covariance_of(ellipses[0]), axis1=1, axis2=2))
    assert np.all(extent >= REACH * marginal)


@pytest.mark.parametrize("eyes", [1, 2])
@pytest.mark.parametrize("count", GPU_COUNTS)
def test_hlsl_projects_as_the_reference(device: Device, count: int, eyes: int) -> None:
    scene = Scene(random_texels(count), stereo()[:eyes], 1.6 * BOX)
    found = project_on(device, scene)
    assert_as_the_reference(scene, found)
    if count > GROUP:
        assert 0 < np.count_nonzero(found.keys != HIDDEN) < count


@pytest.mark.parametrize("count", [GROUP + 1, 4099])
def test_hlsl_takes_any_scale_opacity_and_sign(device: Device, count: int) -> None:
    scene = Scene(random_texels(count, scales=(-12, 0), logit=100), stereo(), 1.6 * BOX)
    assert_as_the_reference(scene, project_on(device, scene))


ROLL = np.array([[0.0, -1, 0, 0], [1, 0, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])
SHIFT = np.eye(4) + 2.0 * np.eye(4, k=3)
INSIDE = np.eye(4)
INSIDE[:3, 3] = -random_texels(4099).splats.centres.mean(axis=0)
CAMERAS = {
    "inside the body": Camera(INSIDE, camera().projection, SCREEN),
    "looking past its side": Camera(SHIFT @ camera().view, camera().projection, SCREEN),
    "one pixel": orbit(BOX, screen=(1, 1)),
    "rolled by a right angle": Camera(ROLL @ camera().view, camera().projection, SCREEN),
}


@pytest.mark.parametrize("place", CAMERAS)
def test_hlsl_projects_from_wherever_the_camera_is(device: Device, place: str) -> None:
    scene = Scene(random_texels(4099), (CAMERAS[place],), 1.6 * BOX)
    found = project_on(device, scene)
    assert_as_the_reference(scene, found)
    assert 0 < np.count_nonzero(found.keys != HIDDEN) < 4099


def posed(centres: Array, scales: Array) -> Texels:
    """Opaque splats where they are asked for, their axes those of the world."""
    count = len(centres)
    turn = np.tile([1.0, 0, 0, 0], (count, 1))
    frame = Splats(
        canonical=centres,
        mesh=centres,
        texture=centres,
        centres=centres,
        rotations=turn,
        scales=scales,
        opacities=np.full(count, 0.99),
        sh=np.zeros((count, 12)),
        texel_dq=np.concatenate([turn, np.zeros((count, 4))], axis=1),
        bounds=BOX,
    )
    return texels_of(frame)


def test_hlsl_culls_before_the_near_plane_in_each_eye(device: Device) -> None:
    depths = np.array([-1, 0, 0.5, 0.99, 1.01, 2]) * NEAR
    texels = posed(np.stack([np.zeros(6), np.zeros(6), -depths], axis=1), np.full((6, 3), 0.01))
    back = np.eye(4)
    back[2, 3] = -0.5
    eyes = tuple(Camera(view, camera().projection, SCREEN) for view in (back, np.eye(4)))
    for seen_by, visible in ((eyes[1:], [4, 5]), (eyes, range(6))):
        scene = Scene(texels, seen_by, BOX)
        found = project_on(device, scene)
        np.testing.assert_array_equal(np.flatnonzero(found.keys != HIDDEN), visible)
        assert_as_the_reference(scene, found)
        drawn = found.splats[found.keys != HIDDEN]
        assert all(np.isfinite(drawn[name]).all() for name in drawn.dtype.names)


def test_hlsl_sees_nothing_behind_the_camera_and_leaves_its_splats_a_centre_alone(device: Device) -> None:
    away = camera().view.copy()
    away[[0, 2]] *= -1
    scene = Scene(random_texels(503), (Camera(away, camera().projection, SCREEN),), BOX)
    scene = replace(scene, texels=scene.texels.kept(np.linalg.norm(scene.texels.splats.centres, axis=1) < 1))
    found = project_on(device, scene)
    assert len(scene.texels) > 100
    assert np.all(found.keys == HIDDEN)
    assert_as_the_reference(scene, found)
    np.testing.assert_array_equal(found.words[: len(scene.texels), 4:], UNWRITTEN)


def test_hlsl_sees_all_that_lies_before_the_camera(device: Device) -> None:
    texels = posed(random_splats(503)[0], np.full((503, 3), 0.01))
    found = project_on(device, Scene(texels, stereo(), BOX))
    assert np.all(found.keys[:503] != HIDDEN)


def test_hlsl_takes_the_first_of_equal_barycentrics_for_the_sign(device: Device) -> None:
    """Each vertex lies across from both others, so that the reference decides where the sum turns to."""
    half_turn = np.array([[1, 0, 0, 0], [-0.6, 0.8, 0, 0], [-0.6, -0.64, 0.48, 0]], np.float32)
    vertex_dq = np.concatenate([half_turn, np.zeros((3, 4), np.float32)], axis=1)
    barycentrics = on_steps(np.array([[0.5, 0.5, 0], [0, 0.5, 0.5], [3 / 8, 3 / 8, 1 / 4], [3 / 8, 1 / 4, 3 / 8]]))
    texture = np.zeros((4, 23))
    texture[:, :3], texture[:, 7:10], texture[:, 10] = [0.1, 0.2, 0.3], -4, 3
    texels = Texels(
        vertex_dq,
        np.zeros((3, 3), np.float32),
        FACES[:1],
        np.zeros(4, int),
        barycentrics,
        held(texture),
        np.ones(4, bool),
    )
    found = project_on(device, Scene(texels, (camera(),), BOX))
    np.testing.assert_allclose(
        found.splats["centre"], texels.splats.centres, rtol=0, atol=CENTRE_BOUND / 0.7
    )  # the least norm of a sum


def test_hlsl_reaches_the_corners_of_triangles(device: Device) -> None:
    corners, turn = 64 * np.eye(3, dtype=np.float32), np.tile(np.array([1, 0, 0, 0], np.float32), (3, 1))
    vertex_dq = np.concatenate([turn, np.zeros((3, 4), np.float32)], axis=1)
    on_mesh = corners, FACES[:1], np.zeros(3, int), np.eye(3)
    texels = Texels(vertex_dq, *on_mesh, held(np.zeros((3, 23))), np.zeros(3, bool))
    found = project_on(device, Scene(texels, (camera(),), BOX)).splats["centre"][:3]
    np.testing.assert_allclose(found, corners[FACES[0]], rtol=0, atol=64 * 8 * ULP)


def test_hlsl_keeps_rotations_that_cancel_and_scales_beyond_any_finite(device: Device) -> None:
    texels = random_texels(65)
    texels.texture[:, 7:10] = np.resize([10.0, 11.0, LARGEST_HALF], (65, 3))
    texels.vertex_dq[:3] = 0
    found = project_on(device, Scene(texels, (camera(),), BOX))
    assert np.isfinite(found.splats["centre"][:65]).all()
    drawn = found.splats[found.keys != HIDDEN]
    assert len(drawn) > 0
    assert all(np.isfinite(drawn[name]).all() for name in drawn.dtype.names)


def test_hlsl_draws_splats_as_large_as_houses(device: Device) -> None:
    texels = posed(np.tile([0, 0, -2.0], (4, 1)), np.exp([[4.0] * 3, [5.0] * 3, [6.0] * 3, [7.0] * 3]))
    found = project_on(device, Scene(texels, (Camera(np.eye(4), camera().projection, SCREEN),), 3 * BOX))
    minors = found.splats["minors"][:, 0].astype(float)
    np.testing.assert_allclose(minors[1:] / minors[:-1], np.e, rtol=2**-9)


def test_hlsl_holds_a_tint_beyond_the_largest_scale(device: Device) -> None:
    texels = posed(np.array([[0, 0, -2.0], [0, 0, -2.1]]), np.full((2, 3), 0.01))
    texels.texture[:, 20:23] = [[80, -160, 240], [-500, 900, 30]]  # what goes with x
    frame = texels.splats
    sides = [np.eye(4), np.eye(4)]
    sides[0][0, 3], sides[1][0, 3] = -0.3, 0.3
    scene = Scene(texels, tuple(Camera(view, camera().projection, SCREEN) for view in sides), 3 * BOX)
    exact = [splat_colors(frame.centres, frame.texel_dq, frame.sh, camera.position) for camera in scene.cameras]
    mean, tint = (exact[0] + exact[1]) / 2, (exact[0] - exact[1]) / 2
    most = 63 / 1023 * COLOR_SCALES[-1]
    assert np.all(abs(tint) > most)
    expected = np.minimum(mean, COLOR_SCALES[-1]) + [[[1]], [[-1]]] * np.clip(tint, -most, most)
    colors = colors_of(project_on(device, scene).splats)
    np.testing.assert_allclose(colors, expected, rtol=0, atol=2 * COLOR_SCALES[-1] / 1023)


@pytest.mark.parametrize("scales", [(3, 1, 1), (1, 3, 1), (1, 1, 3), (1, 1, 1), (0.01, 2, 2)])
@pytest.mark.parametrize("angle", [0.0, 1e-4, -1e-4, 0.7, -0.7, np.pi / 2])
def test_hlsl_turns_the_axis_of_any_covariance(device: Device, scales: tuple[float, ...], angle: float) -> None:
    """Upright, level, slanting and round ellipses, through a camera that keeps x and y apart."""
    texels = posed(np.array([[0, 0, -2.0]]), 0.01 * np.array([scales]))
    texels.texture[0, 3:7] = [np.cos(angle / 2), 0, 0, np.sin(angle / 2)]
    texels = replace(texels, texture=held(texels.texture))
    scene = Scene(texels, (Camera(np.eye(4), np.diag([1.0, 97 / 61, -1, 0]), SCREEN),), 3 * BOX)
    assert_as_the_reference(scene, project_on(device, scene))


@pytest.mark.parametrize("first", [0, 2, 256])
@pytest.mark.parametrize("count", [GROUP - 1, GROUP, GROUP + 1])
def test_hlsl_leaves_the_splats_of_others_alone(device: Device, count: int, first: int) -> None:
    scene = Scene(random_texels(count), (camera(),), BOX)
    alone, behind = project_on(device, scene), project_on(device, scene, first_splat=first)
    np.testing.assert_array_equal(behind.words[first:], alone.words)
    np.testing.assert_array_equal(behind.keys[first:], alone.keys)
    assert np.all(behind.words[:first] == UNWRITTEN)
    assert np.all(behind.keys[:first].view(np.uint32) == UNWRITTEN - 1)
