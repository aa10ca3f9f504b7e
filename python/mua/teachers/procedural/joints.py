"""The skeleton of the procedural figure, in an A-pose, and the weights along its chains."""

import numpy as np

from mua.arrays import Array
from mua.pose.skeleton import Skeleton
from mua.teachers.procedural.grid import smoothstep

ARM_DIRECTION = np.array([np.sqrt(0.5), -np.sqrt(0.5), 0.0])  # left arm of the A-pose, 45 degrees below the horizontal
UPPER_ARM, FOREARM = 0.265, 0.235  # metres

_SHOULDER = np.array([0.158, 1.372, -0.014])
# name, parent, bind position in world space (metres) of the trunk and the left side
_TRUNK = (
    ("Hips", "", (0.0, 0.94, 0.0)),
    ("Spine", "Hips", (0.0, 1.03, -0.005)),
    ("Spine1", "Spine", (0.0, 1.13, -0.01)),
    ("Spine2", "Spine1", (0.0, 1.24, -0.015)),
    ("Neck", "Spine2", (0.0, 1.425, -0.02)),
    ("Head", "Neck", (0.0, 1.505, -0.005)),
)
_LEFT = (
    ("Shoulder", "Spine2", (0.03, 1.385, -0.014)),
    ("Arm", "Shoulder", tuple(_SHOULDER)),
    ("ForeArm", "Arm", tuple(_SHOULDER + UPPER_ARM * ARM_DIRECTION)),
    ("Hand", "ForeArm", tuple(_SHOULDER + (UPPER_ARM + FOREARM) * ARM_DIRECTION)),
    ("UpLeg", "Hips", (0.085, 0.9, 0.0)),
    ("Leg", "UpLeg", (0.079, 0.485, 0.004)),
    ("Foot", "Leg", (0.074, 0.085, -0.02)),
    ("ToeBase", "Foot", (0.086, 0.02, 0.105)),
)


def _table() -> list[tuple[str, str, Array]]:
    table = [(name, parent, np.array(place)) for name, parent, place in _TRUNK]
    trunk = {name for name, _, _ in _TRUNK}
    for side, flip in (("Left", 1.0), ("Right", -1.0)):
        for name, parent, place in _LEFT:
            above = parent if parent in trunk else side + parent
            table.append((side + name, above, np.array(place) * [flip, 1, 1]))
    return table


_JOINTS = _table()
NAMES = tuple(name for name, _, _ in _JOINTS)
PLACES = {name: place for name, _, place in _JOINTS}
INDEX = {name: j for j, name in enumerate(NAMES)}


def build_skeleton() -> Skeleton:
    """Joints whose local axes are the world's in the bind pose."""
    parents = np.array([INDEX.get(parent, -1) for _, parent, _ in _JOINTS], dtype=np.int32)
    places = np.array([place for _, _, place in _JOINTS])
    local = np.where(parents[:, None] < 0, places, places - places[parents])
    rotations = np.tile([1.0, 0, 0, 0], (len(NAMES), 1))
    return Skeleton(NAMES, parents, rotations, local, root=0)


def chain_weights(
    along: Array,  # [...] position along the chain
    links: tuple[tuple[str, float, float], ...],  # joint, where it takes over, half the width of the blend
) -> Array:
    """Weights [..., J] that pass from joint to joint along a chain; the first link's joint holds all before it."""
    weights = np.zeros((*along.shape, len(NAMES)))
    taken = [np.ones(along.shape), *[smoothstep(at - half, at + half, along) for _, at, half in links[1:]]]
    for (name, _, _), mine, following in zip(links, taken, [*taken[1:], np.zeros(along.shape)], strict=True):
        weights[..., INDEX[name]] += mine - following
    return weights
