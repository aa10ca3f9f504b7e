"""Distances between joints along the skeleton."""

import numpy as np

from mua.arrays import Array
from mua.pose.skeleton import Skeleton


def joint_steps(skeleton: Skeleton, seen: list[int]) -> Array:
    """Steps from each of `seen` to each other along the skeleton, [n, n] int64, counting joints of `seen` only.

    What has none of `seen` above it hangs on the first of them.
    """
    steps = np.full((len(seen), len(seen)), len(seen))  # longer than any path along the tree
    np.fill_diagonal(steps, 0)
    carrier = nearest_encoded(skeleton, seen)
    for column, joint in enumerate(seen[1:], start=1):
        parent = int(skeleton.parents[joint])
        above = carrier[parent] if parent >= 0 else 0
        steps[column, above] = steps[above, column] = 1
    for via in range(len(seen)):  # Floyd-Warshall
        steps = np.minimum(steps, steps[:, via, None] + steps[via])
    return steps


def nearest_encoded(skeleton: Skeleton, seen: list[int]) -> Array:
    """For each joint [J] the column of the nearest of `seen` at or above it; the first where there is none."""
    columns = np.zeros(len(skeleton.parents), dtype=np.int64)
    for joint, parent in enumerate(skeleton.parents):  # parents come before children
        columns[joint] = seen.index(joint) if joint in seen else columns[parent] if parent >= 0 else 0
    return columns
