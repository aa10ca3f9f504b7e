"""Where a posed figure shows its front, whatever the axes of its joints and of the file that its motion comes from."""

import numpy as np

from mua import rotation
from mua.arrays import Array
from mua.motion.rest_alignment import frame
from mua.motion.trunk import AROUND, nearest_axis, trunk_of, unit
from mua.pose.descriptor import heading_of
from mua.pose.joint_names import SIDES, Roles, roles
from mua.pose.skeleton import Skeleton

AHEAD = np.array([0.0, 0, 1])  # where a bind pose faces that does not show a trunk


def front_of(
    skeleton: Skeleton,
    rotations: Array,  # [J, 4] local joint rotations
    translations: Array,  # [J, 3] local joint translations, metres
) -> float:
    """Azimuth from which a pose is seen from the front, radians as of mua.avatar.camera.orbit.

    It is the heading alone: a figure that bends down or lies on its back keeps the front that it had while it stood.
    """
    found = roles(skeleton)
    bound_turns, bound_at = skeleton.world(skeleton.bind_rotations, skeleton.bind_translations)
    turns, at = skeleton.world(rotations, translations)
    bound, posed = _body(found, bound_at), _body(found, at)
    if bound is None or posed is None:
        ahead = AHEAD
        turn = rotation.multiply(turns[skeleton.root], rotation.conjugate(bound_turns[skeleton.root]))
    else:
        ahead = nearest_axis(bound[:, 2] * [1, 0, 1]) * _forwards(found, bound_at, bound[:, 2])  # as figures are built
        turn = rotation.from_matrix(posed @ bound.T)
    x, _, z = rotation.rotate(heading_of(turn), ahead)
    return float(np.arctan2(x, z))


def _body(
    found: Roles,
    at: Array,  # [J, 3]
) -> Array | None:
    """Left, up and forward of a trunk as columns [3, 3], None where the joints do not show one."""
    trunk = trunk_of({role: at[found[role][0]] for role in AROUND if role in found})
    if trunk is None:
        return None
    left = trunk.hips + trunk.chest
    return frame(trunk.up, unit(left)) if np.cross(left, trunk.up).any() else None


def _forwards(
    found: Roles,
    at: Array,  # [J, 3]
    ahead: Array,  # [3]
) -> int:
    """-1 where toes point backwards, or without toes away from +Z: such a rig calls its left side right."""
    pairs = [[found.get(f"{side} {part}") for part in ("foot", "toe")] for side in SIDES]
    toes = [at[toe[0]] - at[foot[0]] for foot, toe in pairs if foot and toe]
    shown = np.sum(toes, axis=0) if toes else AHEAD
    return -1 if shown @ nearest_axis(ahead * [1, 0, 1]) < 0 else 1
