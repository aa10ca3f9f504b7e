"""The body part of each triangle, by the joints that move it."""

from collections.abc import Mapping
from typing import Literal, TypeAlias, get_args

import numpy as np

from mua.arrays import Array
from mua.pose.joint_names import roles
from mua.pose.skeleton import Skeleton

BodyPart: TypeAlias = Literal["head", "hands", "arms", "body", "legs", "feet"]

BODY_PARTS: tuple[BodyPart, ...] = get_args(BodyPart)
_BODY = BODY_PARTS.index("body")
_OF_ROLE: dict[str, BodyPart] = {
    "head": "head",
    "hand": "hands",
    "upper_arm": "arms",
    "forearm": "arms",
    "thigh": "legs",
    "shin": "legs",
    "foot": "feet",
    "toe": "feet",
}


def body_parts(
    skeleton: Skeleton,
    faces: Array,  # [F, 3]
    skin_indices: Array,  # [V, 8]
    skin_weights: Array,  # [V, 8]
    *,
    stated: Mapping[str, str] | None = None,  # joint to role, where the file states it
) -> Array:
    """The part of each triangle [F], as an index of BODY_PARTS: the part of the joints that move it most.

    A joint without a part of its own belongs to its parent's, so that fingers are hands and eyes are the head.
    """
    part = _parts_of_joints(skeleton, stated)
    shares = np.zeros((len(skin_indices), len(BODY_PARTS)))
    np.add.at(shares, (np.arange(len(skin_indices))[:, None], part[skin_indices]), skin_weights)
    return np.asarray(shares[faces].sum(axis=1).argmax(axis=1))


def _parts_of_joints(skeleton: Skeleton, stated: Mapping[str, str] | None) -> Array:
    """The part of each joint [J]; joints with unknown names are the body."""
    named = {
        joint: _OF_ROLE.get(role.split()[-1]) for role, joints in roles(skeleton, stated).items() for joint in joints
    }
    part = np.full(len(skeleton.names), _BODY)
    for joint, parent in enumerate(skeleton.parents):
        own = named.get(joint)
        part[joint] = BODY_PARTS.index(own) if own else part[parent] if parent >= 0 else _BODY
    return part
