"""The body that the built-in motion is written for: 1.75 m high, its arms hanging, its joints' axes the world's."""

import numpy as np

from mua import rotation
from mua.arrays import Array
from mua.motion.range.angles import INDEX
from mua.pose.joint_names import FINGERS, SIDES
from mua.pose.skeleton import Skeleton

X, Y, Z = np.eye(3)
MIRROR = np.array([1.0, 1, -1, -1])  # brings a quaternion to the other side of the body
# name, role, parent, where it begins in metres; of limbs, the left one
_TRUNK = (
    ("hips", "hips", "", (0, 0.95, 0)),
    ("spine", "spine", "hips", (0, 1.05, 0)),
    ("spine 2", "spine", "spine", (0, 1.17, 0)),
    ("spine 3", "spine", "spine 2", (0, 1.29, 0)),
    ("neck", "neck", "spine 3", (0, 1.47, 0)),
    ("head", "head", "neck", (0, 1.56, 0)),
)
_LIMBS = (
    ("shoulder", "shoulder", "spine 3", (0.03, 1.42, 0)),
    ("upper_arm", "upper_arm", "shoulder", (0.17, 1.42, 0)),
    ("forearm", "forearm", "upper_arm", (0.17, 1.13, 0)),
    ("hand", "hand", "forearm", (0.17, 0.88, 0)),
    ("thigh", "thigh", "hips", (0.09, 0.91, 0)),
    ("shin", "shin", "thigh", (0.09, 0.49, 0)),
    ("foot", "foot", "shin", (0.09, 0.08, 0)),
    ("toe", "toe", "foot", (0.09, 0.02, 0.14)),
)
_FINGER = {"thumb": 0.045, "index": 0.03, "middle": 0.01, "ring": -0.01, "pinky": -0.03}  # how far ahead, metres
_KNUCKLES = (("", 0.79), (" 2", 0.755), (" 3", 0.73))  # heights, metres
THUMB_HIGHER = 0.05  # metres


def _rows() -> list[tuple[str, str, str, Array]]:
    rows: list[tuple[str, str, str, Array]] = []
    rows += [(name, role, parent, np.array(place, dtype=float)) for name, role, parent, place in _TRUNK]
    trunk = {name for name, *_ in _TRUNK}
    for side, out in zip(SIDES, (1.0, -1.0), strict=True):
        for name, role, parent, begin in _LIMBS:
            above = parent if parent in trunk else f"{side} {parent}"
            rows.append((f"{side} {name}", f"{side} {role}", above, np.array(begin) * [out, 1, 1]))
        for finger in FINGERS:
            above = f"{side} hand"
            for number, height in _KNUCKLES:
                place = np.array([out * 0.17, height + THUMB_HIGHER * (finger == "thumb"), _FINGER[finger]])
                rows.append((f"{side} {finger}{number}", f"{side} {finger}", above, place))
                above = rows[-1][0]
    return rows


def _skeleton() -> Skeleton:
    places = np.array([place for *_, place in _ROWS])
    parents = np.array([JOINT.get(parent, -1) for _, _, parent, _ in _ROWS], dtype=np.int32)
    local = np.where(parents[:, None] < 0, places, places - places[parents])
    return Skeleton(tuple(JOINT), parents, np.tile([1.0, 0, 0, 0], (len(JOINT), 1)), local, root=0)


_ROWS = _rows()
JOINT = {name: joint for joint, (name, *_) in enumerate(_ROWS)}
ROLES = {name: role for name, role, *_ in _ROWS}
BODY = _skeleton()


def rotations(
    angles: Array,  # [F, A] degrees (mua.motion.range.angles)
) -> Array:
    """Local rotations [F, J, 4] of the body's joints."""

    def turn(axis: Array, name: str, share: float = 1.0) -> Array:
        return rotation.from_axis_angle(axis, np.radians(share * angles[:, INDEX[name]]))

    local = np.tile(BODY.bind_rotations, (len(angles), 1, 1))
    local[:, JOINT["hips"]] = _after(turn(Y, "turn"), turn(Z, "tilt"), turn(X, "lean"), turn(Y, "roll"))
    for name in ("spine", "spine 2", "spine 3"):
        local[:, JOINT[name]] = _after(turn(Y, "twist", 1 / 3), turn(Z, "side", 1 / 3), turn(X, "bend", 1 / 3))
    for name in ("neck", "head"):
        local[:, JOINT[name]] = _after(turn(Y, "look", 1 / 2), turn(Z, "ear", 1 / 2), turn(X, "nod", 1 / 2))
    for side, mirror in zip(SIDES, (np.ones(4), MIRROR), strict=True):
        for name, own in _limb(angles, side).items():
            local[:, JOINT[f"{side} {name}"]] = own * mirror
    return local


def _limb(angles: Array, side: str) -> dict[str, Array]:
    """Rotations [F, 4] by joint of the arm and leg of a side, as if it were the left one."""

    def turn(axis: Array, name: str, share: float = 1.0) -> Array:
        return rotation.from_axis_angle(axis, np.radians(share * angles[:, INDEX[f"{side} {name}"]]))

    plane = np.radians(angles[:, INDEX[f"{side} plane"]])
    across = np.stack([-np.sin(plane), np.zeros_like(plane), np.cos(plane)], axis=-1)
    half = turn(-Y, "pronate", 0.5)  # the forearm's bones turn about each other along its length
    found = {
        "shoulder": _after(turn(-Y, "push"), turn(Z, "shrug")),
        "upper_arm": _after(turn(across, "lift"), turn(-Y, "arm_roll")),
        "forearm": _after(turn(-X, "elbow"), half),
        "hand": _after(half, turn(-Z, "wrist"), turn(X, "wrist_side")),
        "thigh": _after(turn(-X, "thigh"), turn(Z, "out"), turn(-Y, "thigh_roll")),
        "shin": turn(X, "knee"),
        "foot": _after(turn(-X, "foot"), turn(Z, "foot_roll")),
        "toe": turn(-X, "toe"),
    }
    for finger, ahead in _FINGER.items():
        if finger == "thumb":
            found[finger] = _after(turn(-Z, "curl", 0.3), turn(-X, "spread"))
            found |= {f"{finger}{number}": turn(-Z, "curl", 0.5) for number in (" 2", " 3")}
            continue
        found[finger] = _after(turn(-X, "spread", ahead / 0.03), turn(-Z, "curl"))
        found |= {f"{finger}{number}": turn(-Z, "curl") for number in (" 2", " 3")}
    return found


def _after(*turns: Array) -> Array:
    """Each rotation [F, 4] after those that follow it."""
    first, *others = turns
    for other in others:
        first = rotation.multiply(first, other)
    return first
