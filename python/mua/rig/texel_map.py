"""Which triangle and which point of it each texel of the texture space shows."""

from dataclasses import dataclass

from mua.arrays import Array


@dataclass(frozen=True)
class TexelMap:
    """The valid texels of a square texture, in row-major order; texel centres lie at (col + 0.5, row + 0.5) / size."""

    size: int  # H = W
    texels: Array  # [N] int32, row * size + col, ascending
    triangles: Array  # [N] int32 into the mesh's faces
    barycentrics: Array  # [N, 3] float32, sum 1, all >= 0
    claimed_twice: int  # texels that more than one triangle covers (beyond shared edges)
