"""Replaces a rest pose that is an arbitrary moment of a clip by the start of a clip.

Some files are saved in the middle of a clip, with a head that looks backwards, say. This matters only if the skins do
not state the bind pose.
"""

import numpy as np

from mua.arrays import Array
from mua.scene import Scene

TURNED_ABOUT = np.cos(np.radians(120))  # a joint that most clips begin further than this from the rest pose


def plausible_rest(
    scene: Scene,
    nodes: Array,  # [J] int nodes of the scene that are joints
) -> Array:
    """Node-to-world matrices [nodes, 4, 4]: at rest, else of the clips' first frames the one most like the others."""
    if not scene.motions:
        return scene.rest
    firsts = np.stack([motion.worlds[0] for motion in scene.motions])
    turned, rest = (_local(worlds, scene.parents)[:, nodes] for worlds in (firsts, scene.rest[None]))
    if (np.median(_cosines(turned, rest), axis=0) > TURNED_ABOUT).all():
        return scene.rest
    similarity = [float(_cosines(turned, one[None]).sum()) for one in turned]
    return np.asarray(firsts[int(np.argmax(similarity))])


def _local(worlds: Array, parents: Array) -> Array:
    """Linear parts [F, nodes, 3, 3] relative to the parent, without their scale."""
    linear = worlds[..., :3, :3] / np.maximum(np.linalg.norm(worlds[..., :3, :3], axis=-2, keepdims=True), 1e-30)
    child = np.flatnonzero(parents >= 0)
    local = linear.copy()
    local[:, child] = np.swapaxes(linear[:, parents[child]], -1, -2) @ linear[:, child]
    return local


def _cosines(turned: Array, rest: Array) -> Array:
    """Cosine [F, J] of the angle between rotations [F, J, 3, 3] and [1, J, 3, 3]."""
    return np.asarray((np.sum(turned * rest, axis=(-1, -2)) - 1) / 2)
