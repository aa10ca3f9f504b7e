"""Degree-1 spherical harmonics of a splat's colour and their rotation between canonical and posed space.

The three linear coefficients of a colour channel are a vector: with a = (-c3, -c1, c2) the colour in direction d is
0.5 + C0 c0 + C1 (a . d), so a rotation of the splat rotates a.
"""

import numpy as np

from mua import rotation
from mua.arrays import Array
from mua.channels import SH_C0, SH_C1

LINEAR = ((1, -1), (2, 1), (0, -1))  # c1, c2, c3: which component of a, and its sign


def rotate(
    sh: Array,  # [N, 12] coefficient-major (coefficient, rgb)
    q: Array,  # [N, 4] unit, wxyz
) -> Array:
    """Coefficients [N, 12] of splats turned by q; the conjugate of R_tex brings posed ones to canonical space."""
    return from_linear(sh[:, :3], rotation.rotate(q[:, None, :], linear(sh)))


def linear(
    sh: Array,  # [N, 12]
) -> Array:
    """The vectors a [N, 3 rgb, 3 xyz] of the linear coefficients."""
    vectors = np.empty((len(sh), 3, 3), dtype=sh.dtype)
    for coefficient, (axis, sign) in enumerate(LINEAR, start=1):
        vectors[..., axis] = sign * sh[:, 3 * coefficient : 3 * coefficient + 3]
    return vectors


def from_linear(
    constant: Array,  # [N, 3 rgb] c0
    vectors: Array,  # [N, 3 rgb, 3 xyz]
) -> Array:
    """Coefficients [N, 12] of constant terms and vectors."""
    return np.concatenate([constant, *(sign * vectors[..., axis] for axis, sign in LINEAR)], axis=1)


def encode(
    color: Array,  # [N, 3 rgb] the mean over directions
    slope: Array,  # [N, 3 rgb, 3 xyz] change of colour with the unit direction from camera to splat
) -> Array:
    """Coefficients [N, 12] of the colour color + slope . direction."""
    return from_linear((color - 0.5) / SH_C0, slope / SH_C1)
