"""When feet stand: low and slow points of a foot, found in the motion as it was recorded."""

from collections.abc import Iterator

import numpy as np

from mua.arrays import Array

LOW = 0.06  # of the leg: how far above its lowest a standing point may be
SLOW = 0.35  # legs per second along the floor: faster points do not stand
ON_FLOOR = 0.1  # of the height: a rest pose whose lowest joint is this near to 0 stands on the floor
UNDER = 0.25  # of the height: how far below its lowest joint the soles of a figure without toes may be
STANDING = 0.05  # quantile over frames of a point's height that counts as standing
SHORTEST = 0.1  # seconds: a shorter contact is a passing foot


def planted(
    points: Array,  # [F, P, 3] metres
    rate: float,  # frames per second
    leg: float,  # metres
) -> Array:
    """Whether each point stands, [F, P] bool."""
    height = points[..., 1] - np.quantile(points[..., 1], STANDING, axis=0)
    stands = (height < LOW * leg) & (speed(points, rate) < SLOW * leg)
    for point in range(stands.shape[1]):
        for begin, end in spans(stands[:, point]):
            if end - begin < SHORTEST * rate:
                stands[begin:end, point] = False
    return stands


def speed(points: Array, rate: float) -> Array:
    """Speed along the floor [F, ...] of points [F, ..., 3], metres per second."""
    if len(points) < 2:
        return np.zeros(points.shape[:-1])
    return np.asarray(np.linalg.norm(np.gradient(points[..., [0, 2]], axis=0), axis=-1) * rate)


def spans(held: Array) -> Iterator[tuple[int, int]]:
    """Begin and end of every run of true values in [F] bool."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], held, [False]]).astype(int)))
    yield from zip(edges[::2].tolist(), edges[1::2].tolist(), strict=True)


def floor_of(at: Array, *, under: float = ON_FLOOR) -> float:
    """Height of the floor that a rest pose [J, 3] stands on: 0 where its lowest joint is near to it.

    under: of the height, how far the floor may be below that joint; UNDER for a character, which is there to its soles.
    """
    lowest, height = float(at[:, 1].min()), float(np.ptp(at[:, 1]))
    return 0.0 if -ON_FLOOR * height < lowest < under * height else lowest


def standing(heights: Array) -> float:
    """The height of standing feet, of heights [F, P]: the lower foot's in the lowest frames."""
    return float(np.quantile(heights.min(axis=1), STANDING))
