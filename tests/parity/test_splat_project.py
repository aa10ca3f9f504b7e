"""Projection against 4x4 matrices and a numerically differentiated Jacobian; culling and keys by behaviour."""

import numpy as np
import pytest

from mua import rotation
from mua.arrays import Array
from mua.camera import NEAR, Camera, orbit
from mua.kernels.dq_skinning import covariances
from mua.kernels.splat_project import LAST_KEY, LEAST_OPACITY, half_extents, splat_project

SCREEN = (97, 61)
BOX = np.array([[-1.0, -1, -1], [1, 1, 1]])
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


def screen_covariance(ellipses: Array) -> Array:
    """[M, 2, 2] from the ellipses' axes."""
    cosine, sine, major, minor = ellipses[:, 2:6].T
    axes = np.stack([np.stack([cosine, -sine], 1), np.stack([sine, cosine], 1)], 1)
    return axes * np.stack([major, minor], 1)[:, None] ** 2 @ axes.swapaxes(1, 2)


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
    np.testing.assert_allclose(screen_covariance(ellipses[0]), expected, rtol=1e-8, atol=1e-8 * expected.max(initial=1))
    assert np.all(ellipses[0, :, 4] >= ellipses[0, :, 5])


@pytest.mark.parametrize("count", COUNTS)
def test_float32_stays_near_float64(count: int) -> None:
    splats, keys, ellipses = project(*random_splats(count, np.float32), camera())
    wide = random_splats(count, np.float32)
    exact_splats, exact_keys, exact = project(*(a.astype(float) for a in wide), camera())
    assert ellipses.dtype == np.float32
    assert keys.dtype == np.uint16
    np.testing.assert_array_equal(splats, exact_splats)
    eps = np.finfo(np.float32).eps
    np.testing.assert_allclose(ellipses[0, :, :2], exact[0, :, :2], rtol=0, atol=32 * eps * max(SCREEN))
    largest = np.square(exact[0, :, 4]).max(initial=1)
    np.testing.assert_allclose(
        screen_covariance(ellipses[0].astype(float)), screen_covariance(exact[0]), rtol=0, atol=64 * eps * largest
    )
    key_bound = 1 + 32 * eps * LAST_KEY
    assert np.all(np.abs(keys.astype(int) - exact_keys) <= key_bound)


def test_keys_order_splats_back_to_front_over_the_bounds() -> None:
    centres, covariance, opacities = random_splats(503)
    splats, keys, _ = project(centres, covariance, opacities, camera())
    depth = -(centres[splats] @ camera().view[2, :3] + camera().view[2, 3])
    corners = np.array(np.meshgrid(*BOX.T)).reshape(3, -1).T
    reach = -(corners @ camera().view[2, :3] + camera().view[2, 3])
    step = (reach.max() - reach.min()) / LAST_KEY
    expected = (reach.max() - depth) / step
    assert np.all(np.abs(keys - expected) <= 0.5 + 1e-6)


def test_what_lies_outside_the_bounds_takes_the_first_or_last_key() -> None:
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
    extent = half_extents(ellipses[0], opacities)
    marginal = np.sqrt(np.diagonal(screen_covariance(ellipses[0]), axis1=1, axis2=2))
    visible = marginal * np.sqrt(2 * np.log(opacities / LEAST_OPACITY))[:, None]
    assert np.all(extent >= visible)
