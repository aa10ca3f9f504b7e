"""Turns a person upright who lies, or stands on the head, in the bind pose because the file states a wrong up axis."""

import numpy as np

from mua import rotation
from mua.arrays import Array
from mua.characters.bind_pose import Bind
from mua.characters.facing import roles_in
from mua.pose.joint_names import SIDES
from mua.scene import Scene

STRAIGHT = 45.0  # degrees between trunk and legs up to which a body is upright in itself, as no animal on four legs is
NEAR = np.cos(np.radians(30))  # to an axis within which it lies along it
FLOOR = 0.15  # of the body's extent along an axis: what stands on the floor is not higher above its lowest joint
ON_FOUR = 0.3  # of the trunk's length: hands and feet both this far below it carry an animal that stands
Y = np.array([0.0, 1, 0])


def upright_rotation(scene: Scene, bind: Bind) -> Array | None:
    """The rotation [3, 3] that makes a lying person stand; None where who stands, or names do not show a person."""
    found = roles_in(scene, bind)
    if _on_four_legs(found, bind.places):
        return None
    at_rest = scene.rest[bind.nodes, :3, 3]
    bound = _upright(found, bind.places)
    if bound is None:
        return None
    axis = np.sign(bound) * (np.abs(bound) == np.abs(bound).max())
    lies = bound @ axis >= NEAR and axis @ Y <= 0 and _lies(found, at_rest, axis)
    return rotation.to_matrix(rotation.between(axis, Y)) if lies else None


def _lies(found: dict[str, tuple[int, ...]], places: Array, axis: Array) -> bool:
    """Whether a body lies along an axis; one that is bent does, where it stands on its feet along that axis alone."""
    along = _upright(found, places)
    if along is None:
        return _on_feet(found, places, axis) and not _on_feet(found, places, Y)
    return bool(along @ axis >= NEAR)


def _on_feet(found: dict[str, tuple[int, ...]], places: Array, up: Array) -> bool:
    """Whether both feet, or their toes, are the lowest parts of a body, in a world where `up` [3] is."""
    heights = {name: float(places[joints[0]] @ up) for name, joints in found.items()}
    feet = [[heights[name] for name in (f"{side} foot", f"{side} toe") if name in heights] for side in SIDES]
    lowest = min(heights.values())
    return all(feet) and max(min(foot) for foot in feet) - lowest < FLOOR * (max(heights.values()) - lowest)


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
