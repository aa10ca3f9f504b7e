"""What SplatProject leaves against the reference, each part within what float32 and half floats may take from it."""

import numpy as np
from packed_splats import color_scales, colors_of, opacities_of, screen_covariance
from projected import Projected, Scene
from splat_rounding import CENTRE_BOUND, OPACITY_BOUND, TEXEL_BOUND, ULP, Bounds, exact_keys, eye_bounds

from mua.arrays import Array
from mua.avatar.camera import NEAR, Camera
from mua.kernels.dq_skinning import covariances
from mua.kernels.splat_draw import splat_colors
from mua.kernels.splat_project import COLOR_SCALES, HIDDEN, eye_ellipses


def covariance_of(ellipses: Array) -> Array:
    """[M, 2, 2] from the ellipses' axes."""
    cosine, sine, major, minor = ellipses[:, 2:6].T
    axes = np.stack([np.stack([cosine, -sine], 1), np.stack([sine, cosine], 1)], 1)
    return axes * np.stack([major, minor], 1)[:, None] ** 2 @ axes.swapaxes(1, 2)


def assert_as_the_reference(scene: Scene, found: Projected) -> None:
    """Places, visibility, ellipses, keys and colours, each within what float32 may take from it."""
    exact, splats = scene.texels.splats, found.splats[: len(scene.texels)]
    bounds = [eye_bounds(exact, c) for c in scene.cameras]
    margin = np.max([b.margin for b in bounds], axis=0)
    seen = found.keys[: len(exact)] != HIDDEN
    np.testing.assert_allclose(splats["centre"], exact.centres, rtol=0, atol=CENTRE_BOUND)
    assert seen[margin > 1].all()
    assert not seen[margin < -1].any()
    assert np.all(found.keys[len(exact) :] == HIDDEN)
    for eye in (0, 1):
        which = min(eye, len(bounds) - 1)
        assert_ellipses(scene, scene.cameras[which], bounds[which], seen, splats, eye)
    views = np.stack([c.view for c in scene.cameras])
    keys, key_bound = exact_keys(exact.centres[seen], views, scene.bounds)
    assert key_bound < 1 or not seen.any()
    assert np.all(np.abs(found.keys[: len(exact)][seen] - keys) <= 0.5 + key_bound)
    assert_colors(scene, splats[seen], seen)


def assert_ellipses(scene: Scene, camera: Camera, bound: Bounds, seen: Array, splats: Array, eye: int) -> None:
    exact = scene.texels.splats
    covariance = covariances(exact.rotations, exact.scales)
    ellipses = eye_ellipses(exact.centres, covariance, camera.view, camera.projection, camera.screen, NEAR)
    drawn = seen & (splats["minors"][:, eye] > 0)
    assert drawn[bound.margin > 1].all()
    assert not drawn[bound.margin < -1].any()
    error = screen_covariance(splats[drawn], eye) - covariance_of(ellipses[drawn])
    # The axes and their lengths are rounded on top: 8 ulp of the unit vector, 5 of each deviation, each twice; then
    # both coordinates of the major axis and the minor deviation to half floats, at most 1/1024 off, and twice.
    spectral = 2 * ((8 + 5) * ULP + (2**0.5 + 1) * 2**-10) * ellipses[drawn, 4] ** 2
    assert np.all(np.linalg.norm(error, axis=(1, 2)) <= bound.variance[drawn] + spectral)


def assert_colors(scene: Scene, splats: Array, seen: Array) -> None:
    frame = scene.texels.splats
    centres, sh = frame.centres[seen], frame.sh[seen]
    eyes = [c.position for c in (scene.cameras[0], scene.cameras[-1])]
    exact = np.stack([splat_colors(centres, frame.texel_dq[seen], sh, eye) for eye in eyes])
    nearest = np.min([np.linalg.norm(centres - eye, axis=1) for eye in eyes], axis=0)
    bound = color_bound(centres, sh, nearest, np.abs(eyes).max())
    step = color_scales(splats) / 1023
    # The mean and half the difference are each rounded to a step.
    held = np.minimum(exact, COLOR_SCALES[-1])
    tints = np.abs(exact[0] - exact[1]).max(axis=1) / 2
    near = tints < 63 / 1023 * COLOR_SCALES[-1]
    error = np.abs(colors_of(splats) - held)
    assert np.all((error <= (bound + step)[:, None])[:, near])
    needed = np.maximum(exact.mean(axis=0).max(axis=1), 1023 / 63 * tints)
    assert np.all(step * 1023 <= COLOR_SCALES[np.searchsorted(COLOR_SCALES[:-1], needed + 17 * bound)])
    assert np.all(np.abs(opacities_of(splats) - frame.opacities[seen]) <= OPACITY_BOUND + 0.5 / 2047)


def color_bound(centres: Array, sh: Array, distance: Array, eye: float) -> Array:
    """What float32 may take from colours [N] towards an eye at a distance."""
    # A direction: its difference, 8 ulp of a division by a norm; 12 products and sums of the turn, 8 of the colour;
    # what the centre is off; what the turn is off, which counts twice in each of two vectors.
    # The eye's position comes from its view: three products and sums.
    distance = np.maximum(distance, CENTRE_BOUND)
    direction = ULP * ((np.abs(centres).max(axis=1, initial=0) + 4 * eye) / distance + 8)
    direction += np.sqrt(3) * CENTRE_BOUND / distance + 4 * TEXEL_BOUND
    return np.asarray(np.abs(sh).sum(axis=1) * (direction + 20 * ULP) + ULP)
