"""The bones that senders of VMC know: Unity's HumanBodyBones, below the model's root, at rest as of VRM 0.

At rest a figure stands in T-pose and no bone is turned. Places here are those of a person of 1.7 m, metres, Y up,
facing +Z, the left at +X; they stand in for what a sender leaves out, who may send a few bones or no lengths at all.
"""

from collections.abc import Iterator

import numpy as np

from mua import rotation
from mua.arrays import Array
from mua.pose.skeleton import Skeleton

ROOT = "Root"
_CENTRAL = {
    ROOT: ("", (0, 0, 0)),
    "Hips": (ROOT, (0, 0.94, 0)),
    "Spine": ("Hips", (0, 1.02, 0)),
    "Chest": ("Spine", (0, 1.14, 0)),
    "UpperChest": ("Chest", (0, 1.26, 0)),
    "Neck": ("UpperChest", (0, 1.42, -0.01)),
    "Head": ("Neck", (0, 1.51, 0)),
    "Jaw": ("Head", (0, 1.53, 0.03)),
}
_SIDED = {
    "Eye": ("Head", (0.03, 1.58, 0.07)),
    "Shoulder": ("UpperChest", (0.03, 1.38, 0)),
    "UpperArm": ("Shoulder", (0.16, 1.38, 0)),
    "LowerArm": ("UpperArm", (0.42, 1.38, 0)),
    "Hand": ("LowerArm", (0.66, 1.38, 0)),
    "UpperLeg": ("Hips", (0.09, 0.88, 0)),
    "LowerLeg": ("UpperLeg", (0.09, 0.49, 0)),
    "Foot": ("LowerLeg", (0.09, 0.08, -0.02)),
    "Toes": ("Foot", (0.09, 0.02, 0.1)),
}
_KNUCKLES = {
    "Thumb": (0.69, 1.37, 0.03),
    "Index": (0.75, 1.38, 0.025),
    "Middle": (0.75, 1.38, 0.0),
    "Ring": (0.745, 1.38, -0.02),
    "Little": (0.735, 1.375, -0.04),
}
_SEGMENTS = ("Proximal", "Intermediate", "Distal")
_SEGMENT = 0.03  # metres
_NEEDED = ("Hips", "Spine", "Head", "UpperArm", "LowerArm", "Hand", "UpperLeg", "LowerLeg", "Foot")  # of any humanoid
ARMS_DOWN = np.radians(70.0)  # from the T-pose to a stance at ease


def _all() -> Iterator[tuple[str, str, tuple[float, ...]]]:
    """Name, parent and place of every bone, parents first."""
    yield from ((name, parent, place) for name, (parent, place) in _CENTRAL.items())
    for side, way in (("Left", 1), ("Right", -1)):
        sided = dict(_SIDED)
        for finger, (x, y, z) in _KNUCKLES.items():
            for number, segment in enumerate(_SEGMENTS):
                above = f"{finger}{_SEGMENTS[number - 1]}" if number else "Hand"
                sided[f"{finger}{segment}"] = (above, (x + number * _SEGMENT, y, z))
        for name, (parent, (x, y, z)) in sided.items():
            yield f"{side}{name}", f"{side}{parent}" if parent in sided else parent, (way * x, y, z)


_BONES = tuple(_all())
BONES = tuple(name for name, _, _ in _BONES)
INDEX = {name.lower(): bone for bone, name in enumerate(BONES)}
PARENTS = tuple(BONES.index(parent) if parent else -1 for _, parent, _ in _BONES)
PLACES = np.array([place for _, _, place in _BONES])  # [B, 3]
NEEDED = np.array([name.removeprefix("Left").removeprefix("Right") in (ROOT, *_NEEDED) for name in BONES])  # [B]
AT_REST = np.tile([1.0, 0, 0, 0], (len(BONES), 1))  # [B, 4]
GIVEN = 1e-3  # metres: a shorter offset of a bone is left out by its sender


def _at_ease() -> Array:
    turned = AT_REST.copy()
    for side, way in (("left", -1), ("right", 1)):
        turned[INDEX[f"{side}upperarm"]] = rotation.from_axis_angle(np.array([0.0, 0, 1]), way * ARMS_DOWN)
    return turned


AT_EASE = _at_ease()  # local rotations [B, 4] of a figure that stands with its arms down


def sender_skeleton(
    known: Array,  # [B] bool, bones that are sent
    offsets: Array,  # [B, 3] metres in their parents; 0 where they are left out
) -> tuple[Skeleton, Array]:
    """The sender's figure at rest, and which of BONES its joints are [S].

    Bones that are not sent are left out unless every humanoid has them.
    """
    present = np.flatnonzero(known | NEEDED)
    joint = {int(bone): index for index, bone in enumerate(present)}
    parents = np.array([joint.get(_above(int(bone), joint), -1) for bone in present], np.int32)
    usual = PLACES[present] - np.where(parents[:, None] < 0, 0, PLACES[present][parents])
    given = np.linalg.norm(offsets[present], axis=-1, keepdims=True) > GIVEN
    places = np.where(given, offsets[present], usual)
    hips = joint[BONES.index("Hips")]
    for moving in (0, hips):  # where these are says how the figure goes, not how it is built
        places[moving] = usual[moving]
    names = tuple(BONES[bone] for bone in present)
    return Skeleton(names, parents, AT_REST[present], places, hips), present


def _above(bone: int, present: dict[int, int]) -> int:
    """The nearest bone above one that is present; -1 above the root."""
    parent = PARENTS[bone]
    while parent >= 0 and parent not in present:
        parent = PARENTS[parent]
    return parent
