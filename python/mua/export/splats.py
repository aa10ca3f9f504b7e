"""Splats as other programs read them: everything in world space, colours included.

An avatar's spherical harmonics are in canonical space, so that a player turns the viewing direction back for every
splat. Other viewers know one space for all splats; here the coefficients are turned instead, which for degree 1 is
exact: the colour from any direction stays the same.
"""

from dataclasses import dataclass

import numpy as np

from mua import rotation
from mua.arrays import Array
from mua.avatar.decode import Splats
from mua.channels import ATTRIBUTES, SH_C0
from mua.kernels.dq_skinning import LARGEST_LOG_SCALE
from mua.texture import sh

HALF_TURN_Z = np.array([0.0, 0, 0, 1])  # Y up to Y down, as the viewers that take Y down turn it back


@dataclass(frozen=True, eq=False)
class WorldSplats:
    """N splats, float32; Y up and right-handed, in metres, unless they were turned."""

    centres: Array  # [N, 3]
    rotations: Array  # [N, 4] unit, wxyz
    log_scales: Array  # [N, 3] natural logarithms of the standard deviations
    logits: Array  # [N] opacity before the logistic function
    sh: Array  # [N, 12] degree 1, coefficient-major (coefficient, rgb); colour = 0.5 + C0 c0 + C1 (-y c1 + z c2 - x c3)

    def __len__(self) -> int:
        return len(self.centres)

    @property
    def scales(self) -> Array:
        """Standard deviations [N, 3]."""
        return np.asarray(np.exp(self.log_scales))

    @property
    def opacities(self) -> Array:
        """Opacities [N] in 0..1."""
        return np.asarray(0.5 + 0.5 * np.tanh(0.5 * self.logits))

    @property
    def mean_colors(self) -> Array:
        """sRGB [N, 3], averaged over all directions."""
        return mean_colors(self.sh)


def mean_colors(
    coefficients: Array,  # [N, 12]
) -> Array:
    """sRGB [N, 3] of spherical harmonics, averaged over all directions; may lie outside of 0..1."""
    return np.asarray(0.5 + SH_C0 * coefficients[:, :3])


def world_splats(splats: Splats) -> WorldSplats:
    """The splats with their spherical harmonics in world space."""
    raw = splats.texture
    return WorldSplats(
        centres=splats.centres.astype(np.float32),
        rotations=splats.rotations.astype(np.float32),
        log_scales=np.minimum(raw[:, ATTRIBUTES["scale"]], LARGEST_LOG_SCALE).astype(np.float32),
        logits=raw[:, ATTRIBUTES["opacity"]][:, 0].astype(np.float32),
        sh=sh.rotate(splats.sh, splats.texel_dq[:, :4]).astype(np.float32),
    )


def turned(
    splats: WorldSplats,
    q: Array,  # [4] unit, wxyz
) -> WorldSplats:
    """The splats turned about the origin, with their colours."""
    turn = np.broadcast_to(q.astype(np.float32), (len(splats), 4))
    return WorldSplats(
        centres=rotation.rotate(turn, splats.centres),
        rotations=rotation.multiply(turn, splats.rotations),
        log_scales=splats.log_scales,
        logits=splats.logits,
        sh=sh.rotate(splats.sh, turn),
    )


def morton_order(
    points: Array,  # [N, 3]
) -> Array:
    """An order [N] in which neighbours in space come near each other: cells of a 1024-cube along a Z-shaped curve."""
    low = points.min(axis=0)
    size = max(float(np.ptp(points, axis=0).max()), np.finfo(np.float32).tiny)
    cells = np.minimum((points - low) / size * 1024, 1023).astype(np.uint32)
    code = np.zeros(len(points), np.uint32)
    for bit in range(10):
        for axis in range(3):
            code |= (cells[:, axis] >> bit & 1) << (3 * bit + axis)
    return np.argsort(code, kind="stable")
