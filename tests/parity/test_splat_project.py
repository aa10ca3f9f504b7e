"""Projection against 4x4 matrices and a numerically differentiated Jacobian; culling and keys by behaviour."""

import numpy as np
import pytest
from packed_splats import assert_halves, unpacked
from projected import FILE, GROUP, UNWRITTEN, Projected, Scene, compact_on, project_on, scan_on
from splat_rounding import ULP, Bounds, exact_keys, eye_bounds

from mua import rotation
from mua.arrays import Array
from mua.camera import NEAR, Camera, orbit
from mua.gpu import Device, run
from mua.kernels.dq_skinning import covariances, pack_splats
from mua.kernels.splat_draw import splat_colors
from mua.kernels.splat_project import LAST_KEY, LEAST_OPACITY, eye_ellipses, half_extents, splat_project

GPU_COUNTS = [0, 1, GROUP - 1, GROUP, GROUP + 1, 4099, 300_007]

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


SEEN = 0x10000 + 7  # a flag: VISIBLE, and the key below it
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


def packed_splats(count: int, reach: float = 1.0) -> Array:
    rng = np.random.default_rng(count)
    centres, covariance, _ = random_splats(count)
    opacities = rng.uniform(0, 1, count) ** 3  # some below LEAST_OPACITY
    turns = np.concatenate([rotation.normalize(rng.normal(size=(count, 4))), np.zeros((count, 4))], axis=1)
    sh = rng.normal(size=(count, 12))
    return pack_splats(reach * centres, 0.1 * covariance, opacities, turns, sh)


def assert_as_the_reference(scene: Scene, found: Projected) -> None:
    """Visibility, ellipses, keys and colours, each within what float32 may take from it."""
    centres, covariance, opacities = scene.splats()
    bounds = [eye_bounds(centres, covariance, opacities, c) for c in scene.cameras]
    margin = np.max([b.margin for b in bounds], axis=0)
    seen = np.zeros(len(centres), bool)
    seen[found.visible] = True
    assert np.all(np.diff(found.visible.astype(int)) > 0)
    assert seen[margin > 1].all()
    assert not seen[margin < -1].any()

    for camera, bound, ellipses in zip(scene.cameras, bounds, found.ellipses[:, found.visible], strict=True):
        assert_ellipses(scene, camera, bound, found.visible, ellipses)
    views = np.stack([c.view for c in scene.cameras])
    exact, key_bound = exact_keys(centres[found.visible], views, scene.bounds)
    assert key_bound < 0.5  # so that keys differ by one at most, and that only beside a half
    assert np.all(np.abs(found.keys - exact) <= 0.5 + key_bound)
    assert_colors(scene, found)


def assert_ellipses(scene: Scene, camera: Camera, bound: Bounds, visible: Array, ellipses: Array) -> None:
    exact = eye_ellipses(*scene.splats()[:2], camera.view, camera.projection, camera.screen, NEAR)[visible]
    drawn = ellipses[:, 4] > 0
    margin = bound.margin[visible]
    assert drawn[margin > 1].all()
    assert not drawn[margin < -1].any()
    assert np.all(ellipses[~drawn, 4:] == 0)
    assert np.all(np.abs(ellipses[drawn, :2] - exact[drawn, :2]) <= bound.middle[visible][drawn])
    error = screen_covariance(ellipses[drawn].astype(float)) - screen_covariance(exact[drawn])
    # The axes and their lengths are rounded on top: 8 ulp of the unit vector, 5 of each deviation, each twice.
    spectral = 2 * (8 + 5) * ULP * exact[drawn, 4] ** 2
    assert np.all(np.linalg.norm(error, axis=(1, 2)) <= bound.variance[visible][drawn] + spectral)
    assert np.all(ellipses[:, 2] >= 0)
    assert np.all(ellipses[:, 4] >= ellipses[:, 5])


def assert_colors(scene: Scene, found: Projected) -> None:
    fields = unpacked(scene.words)[found.visible]
    centres, sh = fields["centre"].astype(float), fields["sh"].astype(float)
    camera = np.mean([c.position for c in scene.cameras], axis=0)
    exact = splat_colors(centres, fields["turn"].astype(float), sh, camera)
    distance = np.linalg.norm(centres - camera, axis=1)
    # A direction: its difference, 8 ulp of a division by a norm; 12 products and sums of the turn, 8 of the colour.
    direction = ULP * ((np.abs(centres).max(axis=1, initial=0) + np.abs(camera).max()) / distance + 8)
    bound = np.abs(sh).sum(axis=1) * (direction + 20 * ULP) + ULP
    assert_halves(found.colors[found.visible, :3], exact, bound[:, None])
    assert_halves(found.colors[found.visible, 3], fields["opacity"].astype(float), 0)


def stereo(apart: float = 0.2) -> tuple[Camera, Camera]:
    """Two eyes beside each other, canted, whose projections are skewed."""
    eyes = []
    for side in (-1, 1):
        middle = orbit(BOX, screen=SCREEN, azimuth=0.7 + 0.1 * side, elevation=0.4)
        view, projection = middle.view.copy(), middle.projection.copy()
        view[:3, 3] -= [side * apart / 2, 0, side * apart / 4]
        projection[0, 2] = -0.3 * side
        eyes.append(Camera(view, projection, SCREEN))
    return eyes[0], eyes[1]


@pytest.mark.parametrize("eyes", [1, 2])
@pytest.mark.parametrize("count", GPU_COUNTS)
def test_hlsl_projects_as_the_reference(device: Device, count: int, eyes: int) -> None:
    scene = Scene(packed_splats(count, reach=1.6), stereo()[:eyes], 1.6 * BOX)
    found = project_on(device, scene)
    assert_as_the_reference(scene, found)
    if count > GROUP:
        assert 0 < len(found.visible) < count


ROLL = np.array([[0.0, -1, 0, 0], [1, 0, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])
SHIFT = np.eye(4) + 2.0 * np.eye(4, k=3)
CAMERAS = {
    "inside the body": Camera(np.eye(4), camera().projection, SCREEN),
    "looking past its side": Camera(SHIFT @ camera().view, camera().projection, SCREEN),
    "one pixel": orbit(BOX, screen=(1, 1)),
    "rolled by a right angle": Camera(ROLL @ camera().view, camera().projection, SCREEN),
}


@pytest.mark.parametrize("place", CAMERAS)
def test_hlsl_projects_from_wherever_the_camera_is(device: Device, place: str) -> None:
    scene = Scene(packed_splats(4099), (CAMERAS[place],), BOX)
    found = project_on(device, scene)
    assert_as_the_reference(scene, found)
    assert 0 < len(found.visible) < 4099


def test_hlsl_culls_before_the_near_plane_in_each_eye(device: Device) -> None:
    depths = np.array([-1, 0, 0.5, 0.99, 1.01, 2]) * NEAR
    centres = np.stack([np.zeros(6), np.zeros(6), -depths], axis=1)
    words = pack_splats(centres, SMALL.repeat(6, axis=0), np.ones(6), np.ones((6, 8)), np.zeros((6, 12)))
    back = np.eye(4)
    back[2, 3] = -0.5
    eyes = tuple(Camera(view, camera().projection, SCREEN) for view in (back, np.eye(4)))
    for seen_by, visible in ((eyes[1:], [4, 5]), (eyes, range(6))):
        scene = Scene(words, seen_by, BOX)
        found = project_on(device, scene)
        np.testing.assert_array_equal(found.visible, visible)
        assert_as_the_reference(scene, found)
        assert np.isfinite(found.ellipses).all()


def test_hlsl_sees_nothing_behind_the_camera(device: Device) -> None:
    away = camera().view.copy()
    away[[0, 2]] *= -1
    found = project_on(device, Scene(packed_splats(503), (Camera(away, camera().projection, SCREEN),), BOX))
    np.testing.assert_array_equal(found.arguments, [0, 2, 0, 0, 0, 1, 1, 0])


def test_hlsl_sees_all_that_lies_before_the_camera(device: Device) -> None:
    words = pack_splats(*random_splats(503), np.ones((503, 8)), np.zeros((503, 12)))
    found = project_on(device, Scene(words, stereo(), BOX))
    np.testing.assert_array_equal(found.visible, np.arange(503))


@pytest.mark.parametrize("difference", [1.0, -1.0, 0.0])
@pytest.mark.parametrize("b", [0.0, 1e-9, -1e-9, 1.0])
def test_hlsl_turns_the_axis_of_any_covariance(device: Device, difference: float, b: float) -> None:
    """Upright, level, slanting and round ellipses, through a camera that keeps x and y apart."""
    covariance = np.array([[2 + difference, b, 0, 2 - difference, 0, 0]]) * 1e-4
    words = pack_splats(np.array([[0, 0, -2.0]]), covariance, np.ones(1), np.ones((1, 8)), np.zeros((1, 12)))
    scene = Scene(words, (Camera(np.eye(4), np.diag([1.0, 97 / 61, -1, 0]), SCREEN),), 3 * BOX)
    assert_as_the_reference(scene, project_on(device, scene))


@pytest.mark.parametrize("count", [*GPU_COUNTS, 1_000_003])
def test_hlsl_scans_counts_and_writes_the_arguments(device: Device, count: int) -> None:
    groups = -(-count // GROUP)
    group_counts = np.random.default_rng(count).integers(0, GROUP + 1, groups, dtype=np.uint32)
    arguments, scanned = scan_on(device, group_counts, count)
    total = int(group_counts.sum())
    np.testing.assert_array_equal(scanned, np.cumsum(group_counts) - group_counts)
    np.testing.assert_array_equal(arguments, [6 * total, 2, 0, 0, -(-total // 2048), 1, 1, total])


@pytest.mark.parametrize("total", [2048, 2049])
def test_hlsl_asks_for_as_many_sorting_groups_as_hold_the_splats(device: Device, total: int) -> None:
    group_counts = np.full(-(-total // GROUP), GROUP, np.uint32)
    group_counts[-1] -= len(group_counts) * GROUP - total
    arguments, _ = scan_on(device, group_counts, total)
    assert arguments[4] == -(-total // 2048)


@pytest.mark.parametrize("share", [0.0, 0.3, 1.0])
@pytest.mark.parametrize("count", GPU_COUNTS)
def test_hlsl_compacts_in_order(device: Device, count: int, share: float) -> None:
    rng = np.random.default_rng(count)
    flags = (rng.random(count) < share) * (0x10000 + rng.integers(0, 0x10000, count))
    padded = np.append(flags, np.zeros(-count % GROUP, int)).reshape(-1, GROUP)
    group_counts = np.count_nonzero(padded, axis=1)
    before = (np.cumsum(group_counts) - group_counts).astype(np.uint32)
    visible, keys = compact_on(device, flags.astype(np.uint32), before)
    expected = np.flatnonzero(flags)
    np.testing.assert_array_equal(visible[: len(expected)], expected)
    np.testing.assert_array_equal(keys[: len(expected)], flags[expected] & 0xFFFF)
    assert np.all(visible[len(expected) :] == UNWRITTEN)
    assert np.all(keys[len(expected) :] == UNWRITTEN)


@pytest.mark.parametrize("count", [GROUP - 1, GROUP + 1])
def test_a_flag_behind_the_last_splat_is_not_looked_at(device: Device, count: int) -> None:
    groups = -(-count // GROUP)
    unwritten = np.full(count + 1, UNWRITTEN, np.uint32)
    buffers = {
        "flags": np.full(count + 1, SEEN, np.uint32),
        "group_counts": (GROUP * np.arange(groups)).astype(np.uint32),
        "visible": unwritten,
        "keys": unwritten,
    }
    found = run(device, FILE, "SplatCompact", (groups, 1, 1), buffers, splat_count=count)
    np.testing.assert_array_equal(found["visible"], [*range(count), UNWRITTEN])
    np.testing.assert_array_equal(found["keys"], [*[SEEN & 0xFFFF] * count, UNWRITTEN])
