"""Principal components of the motion descriptor, limited to the range of training: the input of the networks.

ReLU networks extrapolate linearly, and live motion always leaves the poses of training. Along the principal components
of what a joint does in a window the range of training is a tight box.
"""

import numpy as np

from mua.arrays import Array
from mua.pose.encoding import Components, Normalization

INPUT_FLOOR = 1.0  # variance added to each direction of the normalised descriptors; measured on held-out CMU walks
FORGONE = 1e-3  # share of the variance that networks see; the weakest directions that hold it are dropped
MARGIN = 0.1  # margin as a share of a component's range
JITTER = np.radians(1.0)  # in each joint, and as many metres in each length: the least margin of every component


def principal_components(
    descriptors: Array,  # [N, D] of the training frames
    normalization: Normalization,
    units: Array,  # [D] from `mua.pose.descriptor.units_of`
    groups: Array,  # [D] the group of each number, from `mua.pose.descriptor.groups_of`
) -> Components:
    """The whitened components of training descriptors and their ranges, rounded as a file stores them.

    A window's poses are nearly alike; velocities are its weak directions, and a network that sees the descriptor as it
    is fits them last. The floor keeps directions that hold only noise from being raised to the others' level. Every
    joint has components of its own, so that an arm in a new pose bounds nothing of the legs; those of how it is turned
    in the world are apart from those of its angles, so that a network can follow either.
    """
    normal = (descriptors - normalization.mean) / normalization.scale
    variance, directions = _directions(normal, groups)
    seen = np.maximum(variance, 0) / (np.maximum(variance, 0) + INPUT_FLOOR)
    kept = np.cumsum(seen) > FORGONE * seen.sum()
    kept |= np.arange(len(kept)) == len(kept) - 1  # the largest, where nothing moves
    turn = (directions[:, kept] / np.sqrt(np.maximum(variance[kept], 0) + INPUT_FLOOR)).T[::-1].astype(np.float16)
    found = normal @ turn.astype(float).T
    ranges = np.stack([found.min(axis=0), found.max(axis=0)])
    jitter = np.linalg.norm(turn.astype(float) * (JITTER * units / normalization.scale), axis=1)
    margins = MARGIN * (ranges[1] - ranges[0]) + jitter
    return Components(normalization, *(part.astype(np.float32) for part in (turn, ranges, margins)))


def _directions(
    normal: Array,  # [N, D]
    groups: Array,  # [D]
) -> tuple[Array, Array]:
    """Variances [D], ascending, and directions [D, D] of the numbers of each group."""
    variances: Array = np.zeros(len(groups))
    directions: Array = np.zeros((len(groups), len(groups)))
    for group in np.unique(groups):
        own = np.flatnonzero(groups == group)
        variances[own], directions[np.ix_(own, own)] = np.linalg.eigh(
            np.cov(normal[:, own].T, bias=True).reshape(len(own), -1)
        )
    order = np.argsort(variances, kind="stable")
    return variances[order], directions[:, order]


def read_components(
    components: Components,
    descriptors: Array,  # [..., D]
) -> tuple[Array, Array]:
    """The networks' input [..., K] for descriptors, and how far outside of training each is [...], 0 to 1.

    The second is the share of a pose that training did not show: the length of what the ranges take off its components,
    relative to the components' own; 0 within them.
    """
    normal = (descriptors - components.normalization.mean) / components.normalization.scale
    found = normal @ components.directions.astype(float).T
    held = hold(found, components)
    length = np.linalg.norm(found, axis=-1)
    return held, np.linalg.norm(found - held, axis=-1) / np.where(length > 0, length, 1)


def hold(found: Array, components: Components) -> Array:
    """Components [..., K], unchanged within their ranges and softly limited to the margins beyond."""
    low, high = components.ranges
    nearest = np.clip(found, low, high)
    beyond = np.abs(found - nearest)
    margins = components.margins
    reach = beyond * margins / np.where(beyond > 0, beyond + margins, 1)
    return np.asarray(nearest + np.sign(found - nearest) * reach)
