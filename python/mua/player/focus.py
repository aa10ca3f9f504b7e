"""The target of a close-up: the surface that a joint moves, by the name of the joint or a part of the body."""

from dataclasses import dataclass
from difflib import get_close_matches

import numpy as np

from mua import rotation
from mua.arrays import Array
from mua.errors import InputError
from mua.pose.joint_names import NAMESPACE, Roles, roles
from mua.pose.skeleton import Skeleton
from mua.rig.rig import Rig

OFFERED = 8  # most names that the error message offers


@dataclass(frozen=True, eq=False)
class Focus:
    """A point that moves with a joint."""

    joint: int
    offset: Array  # [3] in the joint's own space, metres

    def places(
        self,
        skeleton: Skeleton,
        rotations: Array,  # [..., J, 4] local joint rotations
        translations: Array,  # [..., J, 3] local joint translations, metres
    ) -> Array:
        """Where the point is, [..., 3] metres."""
        turned, at = skeleton.world(rotations, translations)
        return np.asarray(at[..., self.joint, :] + rotation.rotate(turned[..., self.joint, :], self.offset))


def find_focus(rig: Rig, name: str) -> Focus:
    """The middle of what a joint moves of the surface, or the joint itself where it moves none.

    Errors: InputError where no joint has that name and no part of the body is called so.
    """
    weights = np.zeros((len(rig.skeleton.names), len(rig.mesh.vertices)))  # [J, V]
    np.add.at(weights, (rig.skin_indices, np.arange(len(rig.mesh.vertices))[:, None]), rig.skin_weights)
    joints = _named(rig.skeleton, name)
    joint = max(joints, key=lambda joint: weights[joint].sum())
    turned, at = rig.skeleton.world(rig.skeleton.bind_rotations, rig.skeleton.bind_translations)
    held = weights[joint].sum()
    middle = weights[joint] @ rig.mesh.vertices / held if held else at[joint]
    return Focus(joint, rotation.rotate(rotation.conjugate(turned[joint]), middle - at[joint]))


def _named(skeleton: Skeleton, name: str) -> list[int]:
    """Joints that a name may mean: an exact match, else a body part, else a match without case and namespace."""
    if name in skeleton.names:
        return [skeleton.names.index(name)]
    found: Roles = roles(skeleton)
    if joints := found.get(name.lower().replace("upper arm", "upper_arm")):
        return list(joints)
    alike = [joint for joint, known in enumerate(skeleton.names) if _plain(known) == _plain(name)]
    if alike:
        return alike
    near = get_close_matches(name, [*found, *skeleton.names], n=OFFERED, cutoff=0.5) or [*found, *skeleton.names]
    raise InputError(
        f"--look-at is {name!r}; expected a joint of the avatar or a part of the body, such as "
        f"{', '.join(dict.fromkeys(near[:OFFERED]))}"
    )


def _plain(name: str) -> str:
    return NAMESPACE.sub("", name).lower()
