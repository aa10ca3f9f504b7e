"""Splats as a .ply of the layout that 3D Gaussian Splatting introduced, which most viewers read.

One vertex for each splat: x, y, z; the spherical harmonics f_dc_* (constant) and f_rest_* (all linear coefficients of
red, then of green, then of blue); opacity before the logistic function; scales as logarithms; rotation as wxyz.
"""

import numpy as np

from mua.arrays import Array
from mua.export.splats import WorldSplats

# Our renderer filters splats over pixels, as Mip-Splatting does: viewers that know the comment do so too.
COMMENTS = ("made by mua-export; metres", "SplatRenderMode: mip")
FIELDS = (
    *("x", "y", "z"),
    *(f"f_dc_{k}" for k in range(3)),
    *(f"f_rest_{k}" for k in range(9)),
    "opacity",
    *(f"scale_{k}" for k in range(3)),
    *(f"rot_{k}" for k in range(4)),
)
TYPES = {"<f4": "float", "<u4": "uint", "|u1": "uchar"}


def ply_bytes(splats: WorldSplats) -> bytes:
    """The content of a .ply."""
    table = np.column_stack(
        [splats.centres, splats.sh[:, :3], by_channel(splats.sh), splats.logits, splats.log_scales, splats.rotations]
    )
    return written(("vertex", FIELDS, table.astype("<f4")))


def by_channel(
    coefficients: Array,  # [N, 12] coefficient-major
) -> Array:
    """The linear coefficients [N, 9], all of red first."""
    return coefficients[:, 3:].reshape(-1, 3, 3).swapaxes(1, 2).reshape(-1, 9)


def written(
    *elements: tuple[str, tuple[str, ...], Array],  # name, its properties, [rows, properties] of one of TYPES
) -> bytes:
    """A binary .ply of elements whose properties are of one type each."""
    lines = ["ply", "format binary_little_endian 1.0", *(f"comment {comment}" for comment in COMMENTS)]
    for name, properties, rows in elements:
        kind = TYPES[rows.dtype.str]
        lines += [f"element {name} {len(rows)}", *(f"property {kind} {each}" for each in properties)]
    header = "\n".join([*lines, "end_header\n"]).encode()
    return b"".join([header, *(rows.tobytes() for _, _, rows in elements)])
