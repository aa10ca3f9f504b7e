"""Turns a person upright who lies in the bind pose because the file states a wrong up axis."""

import numpy as np

from mua import rotation
from mua.arrays import Array
from mua.characters.bind_pose import Bind
from mua.characters.facing import roles_in
from mua.pose.joint_names import SIDES
from mua.scene import Scene

STRAIGHT = 45.0  # degrees between trunk and legs up to which a body is upright in itself, as no animal on four legs is
ALONG = 30.0  # degrees from a level axis within which it lies
ON_FOUR = 0.3  # of the trunk's length: hands and feet both this far below it carry an animal that stands
Y = np.array([0.0, 1, 0])


def upright_rotation(scene: Scene, bind: Bind) -> Array | None:
    """The rotation [3, 3] that makes a lying person stand; None where nobody lies, or names do not show a person."""
    found = roles_in(scene, bind)
    if _on_four_legs(found, bind.places):
        return None
    body = [_upright(found, places) for places in (bind.places, scene.rest[bind.nodes, :3, 3])]
    bound, rests = body
    if bound is None or rests is None:
        return None
    axis = np.where([True, False, True], np.sign(bound), 0) * (np.abs(bound) == np.abs(bound).max())
    near = np.cos(np.radians(ALONG))
    if bound @ axis < near or rests @ axis < near:
        return None
    return rotation.to_matrix(rotation.between(axis, Y))


def _on_four_legs(found: dict[str, tuple[int, ...]], places: Array) -> bool:
    """Whether all four limbs reach well below where they begin: short legs that are bent hang on a straight body."""
    top = found.get("neck") or found.get("head")
    limbs = [
        [next((found[f"{side} {part}"][0] for part in ends if f"{side} {part}" in found), None) for side in SIDES]
        for ends in (("upper_arm",), ("hand", "forearm"), ("thigh",), ("foot", "shin"))
    ]
    if top is None or any(joint is None for pair in limbs for joint in pair):
        return False
    shoulders, hands, hips, feet = (np.mean([places[joint] for joint in pair], axis=0) for pair in limbs)
    reach = ON_FOUR * np.linalg.norm(places[top[0]] - hips)
    return bool(min((shoulders - hands) @ Y, (hips - feet) @ Y) > reach)


def _upright(found: dict[str, tuple[int, ...]], places: Array) -> Array | None:
    """The unit direction [3] from feet to head of a body that is straight; None where it is bent or not known."""
    pairs = [[found.get(f"{side} {part}") for side in SIDES] for part in ("thigh", "shin")]
    top = found.get("head") or found.get("neck")
    if top is None or any(joints is None for pair in pairs for joints in pair):
        return None
    hips, knees = (np.mean([places[joints[0]] for joints in pair if joints], axis=0) for pair in pairs)
    trunk, legs = places[top[0]] - hips, hips - knees
    lengths = np.linalg.norm(trunk), np.linalg.norm(legs)
    if not all(lengths) or trunk @ legs < np.cos(np.radians(STRAIGHT)) * lengths[0] * lengths[1]:
        return None
    along = trunk / lengths[0] + legs / lengths[1]
    return np.asarray(along / np.linalg.norm(along))
