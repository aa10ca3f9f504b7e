"""When the frames of a clip are that a file states by its keys."""

import numpy as np

from mua.arrays import Array
from mua.errors import InputError

MOST = 10_000_000  # matrices of one clip: 100 joints for an hour at 30 frames per second, and 1.3 GB


def frame_times(start: float, end: float, rate: float, *, nodes: int, where: str) -> Array:
    """The times [F] in seconds of the frames from the first key to the last, of `nodes` matrices each.

    Raises InputError, which begins with `where`, for a clip that is longer than any motion.
    """
    count = np.floor((end - start) * rate + 1e-3) + 1
    if not count * nodes <= MOST:
        raise InputError(
            f"{where} lasts {end - start:g} s, which makes {count:g} frames of {nodes} nodes, "
            f"expected at most {MOST:,} in all"
        )
    return np.asarray(start + np.arange(int(count)) / rate)
