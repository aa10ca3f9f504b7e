"""Random joints, vertices and texels to skin."""

import numpy as np

from mua import rotation
from mua.arrays import Array

JOINTS = 5

# Bounds of float32 on a GPU, whose arithmetic is as Vulkan asks: sums and products half a unit in the last place (an
# ulp, eps of the largest term), division 2.5 ulp, square roots 4.5, exp 3 + 2 |x|.
ULP = float(np.finfo(np.float32).eps)

# A blend: a product and a sum for each term, in it and in its norm; the norm's own 4 products, 4 sums and root; a
# division. The rotations lie within pi / 4 of none, so that the sum's norm is at least cos(pi / 8).
NORM_AND_DIVISION = 4 + 4.5 + 2.5

BLEND_BOUND = (2 * 8 + NORM_AND_DIVISION) / np.cos(np.pi / 8) * ULP


def random_joints(rng: np.random.Generator, count: int = JOINTS) -> Array:
    """Rigid transforms [count, 8] within a quarter turn of each other, so that every blend is well-conditioned."""
    axes = rotation.normalize(rng.normal(size=(count, 3)))
    turns = rotation.from_axis_angle(axes, rng.uniform(0, np.pi / 4, count))
    return rotation.dual_from_rigid(turns, rng.uniform(-1, 1, (count, 3)))


def random_influences(rng: np.random.Generator, points: int, joints: int = JOINTS) -> tuple[Array, Array]:
    """Indices and weights [points, 8], largest first, those beyond the number of joints empty."""
    indices, weights = np.zeros((points, 8), np.int32), np.zeros((points, 8), np.float32)
    weights[:, :joints] = -np.sort(-rng.dirichlet(np.ones(joints), points), axis=1)
    indices[:, :joints] = np.argsort(rng.random((points, joints)), axis=1)
    return indices, weights
