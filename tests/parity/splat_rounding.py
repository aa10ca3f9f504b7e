"""How far splat_project may lie from float64 on a GPU: bounds for each splat, from the arithmetic that Vulkan asks for.

Sums and products are rounded to half a unit in the last place (an ulp), divisions to 2.5, square roots to 4.5.
"""

from dataclasses import dataclass

import numpy as np

from mua.arrays import Array
from mua.avatar.camera import NEAR, Camera
from mua.avatar.decode import Splats
from mua.kernels.dq_skinning import covariances
from mua.kernels.splat_project import (
    AWAY,
    GUARD,
    LAST_KEY,
    LEAST_OPACITY,
    REACH,
    eye_ellipses,
    facing,
    half_extents,
    wide_deviations,
)

ULP = float(np.finfo(np.float32).eps)


@dataclass(frozen=True)
class Bounds:
    """Bounds of one eye's rounding."""

    middle: Array  # [N, 2] column and row, pixels
    variance: Array  # [N] of the screen covariance (Frobenius norm), px^2
    margin: Array  # [N] by which a splat is in view, as a multiple of what rounding may take; negative where it is not


# A blend of three dual quaternions: a product and a sum for each, in it and in its norm; the norm's own 4 products, 4
# sums and root; a division. Rotations lie within pi / 4 of none, so that the sum's norm is at least cos(pi / 8).
TEXEL_BOUND = (2 * 3 + 4 + 4.5 + 2.5) / np.cos(np.pi / 8) * ULP
# A centre: four components off by TEXEL_BOUND make a quaternion off by twice that. A turn doubles it on a canonical
# point within 1.5 m; a translation 2 d q* takes it from both parts, d at most 0.9. The products and sums of the point
# (6), the turn (12) and the translation (8) are half an ulp each of at most 1.5 + 1.8 m.
CENTRE_BOUND = 2 * 2 * TEXEL_BOUND * (1.5 + 1 + 0.9) + 13 * ULP * (1.5 + 1.8)
# A logistic: the error of exp, at most 3 ulp of 1 at x = 0, counts in numerator and denominator; a sum, a division.
OPACITY_BOUND = (2 * 3 + 0.5 + 2.5) * ULP
LOGIT_BOUND = (3 + 2 * 6 + 3) * ULP  # relative, of an opacity near LEAST_OPACITY
# A covariance, relative to the largest variance: exp(-12..0), squared; the rotation's matrix (9 products and sums) is
# quadratic in the product (4 ulp) of the blend and the texel's own quaternion (9 ulp), and counts twice.
COVARIANCE_BOUND = 2 * (3 + 2 * 12 + 1) * ULP + 2 * 4 * (TEXEL_BOUND + 13 * ULP) + 2 * 9 * ULP
# How far a triangle is turned away: normal and direction turn as a quaternion does, twice as far as that is off;
# corners within 1 m are off by an ulp, and the cross product of their edges is 0.05 square metres or more; two turns of
# 9 products and sums, two lengths of 8, and 4 more.
FACING_BOUND = 2 * 2 * 2 * TEXEL_BOUND + 4 * ULP / 0.05 + (2 * 9 + 2 * 8 + 4) * ULP


def eye_bounds(splats: Splats, camera: Camera) -> Bounds:
    """Bounds for splats [N], posed by texels as above, in one eye."""
    centres, opacities = splats.centres, splats.opacities
    covariance = covariances(splats.rotations, splats.scales)
    spread_error = COVARIANCE_BOUND * np.square(splats.scales).max(axis=1, initial=0)
    half, focal = np.array(camera.screen) / 2, np.diagonal(camera.projection)[:2]
    skew = np.abs(camera.projection[:2, 2])
    place = centres @ camera.view[:3, :3].T + camera.view[:3, 3]
    place_error = 3 * ULP * (np.abs(centres) @ np.abs(camera.view[:3, :3]).T + np.abs(camera.view[:3, 3]))
    place_error += CENTRE_BOUND * np.abs(camera.view[:3, :3]).sum(axis=1)
    depth = np.maximum(-place[:, 2:], NEAR)
    slope = np.abs(place[:, :2]) / depth
    relative = place_error.max(axis=1, keepdims=True) / depth
    middle = half * (focal * relative * (1 + slope) + 6 * ULP * (focal * slope + skew + 1))

    held = np.minimum(slope, (GUARD + 2 * skew) / focal)
    jacobian2 = np.sum((half * focal / depth) ** 2 * (1 + held**2), axis=1)
    sigma = np.linalg.norm(covariance[:, [0, 1, 2, 1, 3, 4, 2, 4, 5]], axis=1)
    # A row of the Jacobian: the magnification, and the slope that is at most 1.5 times as sensitive; it counts twice.
    variance = jacobian2 * (sigma * (2 * 2.5 * (relative[:, 0] + 6 * ULP) + 6 * ULP) + spread_error)

    ellipses = eye_ellipses(centres, covariance, camera.view, camera.projection, camera.screen, NEAR)
    reach_error = _extent_error(ellipses, variance)
    extent = half_extents(ellipses)
    beside = np.minimum(ellipses[:, :2] + extent, np.array(camera.screen) - ellipses[:, :2] + extent)
    beside /= middle + reach_error[:, None]
    before = (-place[:, 2] - NEAR) / (place_error[:, 2] + ULP * NEAR)
    solid = (opacities - LEAST_OPACITY) / (LOGIT_BOUND * LEAST_OPACITY)
    margins = [*beside.T, before, solid]
    if splats.normals is not None:
        distance = np.linalg.norm(place, axis=1)
        error = FACING_BOUND + np.linalg.norm(place_error, axis=1) / np.maximum(distance, ULP)
        margins.append((AWAY - facing(centres, splats.normals, camera.view)) / error)
    return Bounds(middle, variance, np.minimum.reduce(margins))


def _extent_error(ellipses: Array, variance: Array) -> Array:
    """Bound [N] of the rounding of half_extents, pixels."""
    deviations = np.maximum(ellipses[:, 4:6], np.sqrt(variance)[:, None])
    deviation_error = (variance[:, None] / np.maximum(deviations, 1e-30) + 5 * ULP * deviations).max(axis=1)
    spread = (ellipses[:, 4] ** 2 - ellipses[:, 5] ** 2) / 2
    turn_error = np.minimum(variance / np.maximum(spread, 1e-30), np.pi / 2) + 8 * ULP
    wide = wide_deviations(ellipses[:, 4:6])
    lengths, longer = REACH * wide.sum(axis=1), REACH * (wide[:, 0] - wide[:, 1])
    # The box grows with the difference of both by at most 2.5 for an angle.
    return 2 * REACH * deviation_error + 2.5 * longer * turn_error + 14 * ULP * lengths


def exact_keys(centres: Array, views: Array, bounds: Array) -> tuple[Array, float]:
    """Keys [N] before they are rounded to whole ones, and the bound of their rounding.

    Depths are those of the eyes' mean; the box's are found at its corners, and half its diagonal further out.
    """
    mean = -views[:, 2].mean(axis=0)
    corners = np.stack(np.meshgrid(*bounds.T)).reshape(3, -1).T
    reach = corners @ mean[:3] + mean[3]
    spare = np.linalg.norm(np.ptp(bounds, axis=0)) / 2
    farthest, nearest = reach.max() + spare, max(reach.min() - spare, NEAR)
    depths = centres @ mean[:3] + mean[3]
    span = max(farthest - nearest, 1e-30)
    keys = np.clip((farthest - depths) / span, 0, 1) * LAST_KEY
    largest = max(np.abs(centres).max(initial=0), np.abs(bounds).max()) * np.abs(mean[:3]).sum() + abs(mean[3])
    moved = CENTRE_BOUND * np.abs(mean[:3]).sum()
    return keys, LAST_KEY * (((3 * 4 * largest + 4 * spare) * ULP + moved) / span + 4 * ULP)
