"""Random splats to draw, and places in their quads."""

import numpy as np
from scipy.linalg import sqrtm

from mua.arrays import Array
from mua.kernels.splat_project import PIXEL_VARIANCE, REACH


def random_scene(count: int, screen: tuple[int, int]) -> tuple[Array, Array, Array, Array]:
    """Ellipses in and around the screen, colours, opacities and a back-to-front order."""
    rng = np.random.default_rng(count)
    angle = rng.uniform(-np.pi, np.pi, count)
    deviations = -np.sort(-np.exp(rng.uniform(-2, 2, (count, 2))), axis=1)
    middle = rng.uniform(-0.3, 1.3, (count, 2)) * screen
    ellipses = np.concatenate([middle, np.cos(angle)[:, None], np.sin(angle)[:, None], deviations], axis=1)
    return ellipses, rng.random((count, 3)), rng.uniform(0.01, 1, count), rng.permutation(count)


def places_in_quad(ellipse: Array, offsets: Array) -> Array:
    """(u, v) [..., 2] of offsets [..., 2] from the middle, by scipy's square root of the covariance."""
    axes = np.array([[ellipse[2], -ellipse[3]], [ellipse[3], ellipse[2]]])
    root = sqrtm(axes @ np.diag(ellipse[4:] ** 2 + PIXEL_VARIANCE) @ axes.T)
    return np.asarray(offsets @ np.linalg.inv(REACH * root))
