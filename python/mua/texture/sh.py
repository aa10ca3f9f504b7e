"""Degree-1 spherical harmonics of a splat's colour and their rotation between canonical and posed space.

The three linear coefficients of a colour channel are a vector: with a = (-c3, -c1, c2) the colour in direction d is
0.5 + C0 c0 + C1 (a . d), so a rotation of the splat rotates a.
"""

import numpy as np

from mua import rotation
from mua.arrays import Array
from mua.texture.channels import SH_C0, SH_C1


def rotate(
    sh: Array,  # [N, 12] coefficient-major (coefficient, rgb)
    q: Array,  # [N, 4] unit, wxyz
) -> Array:
    """Coefficients [N, 12] of splats turned by q; the conjugate of R_tex brings posed coefficients to canonical space."""
    return from_linear(sh[:, :3], rotation.rotate(q[:, None, :], linear(sh)))


def linear(
    sh: Array,  # [N, 12]
) -> Array:
    """The vectors a [N, 3 rgb, 3 xyz] of the linear coefficients."""
    c1, c2, c3 = sh[:, 3:6], sh[:, 6:9], sh[:, 9:12]
    return np.stack([-c3, -c1, c2], axis=-1)


def from_linear(
    constant: Array,  # [N, 3 rgb] c0
    vectors: Array,  # [N, 3 rgb, 3 xyz]
) -> Array:
    """Coefficients [N, 12] of constant terms and vectors."""
    return np.concatenate([constant, -vectors[..., 1], vectors[..., 2], -vectors[..., 0]], axis=1)


def encode(
    color: Array,  # [N, 3 rgb] the mean over directions
    slope: Array,  # [N, 3 rgb, 3 xyz] change of colour with the unit direction from camera to splat
) -> Array:
    """Coefficients [N, 12] of the colour color + slope . direction."""
    return from_linear((color - 0.5) / SH_C0, slope / SH_C1)
