"""What a joint is, by its name: a body part and a side behind every naming habit.

A role is a part ("hips", "spine", "neck", "head") or a side and a part ("left thigh"). Several joints of one chain
may share a role (CMU's lowerneck and upperneck are the neck); they are listed from the root outwards.
"""

import re

from mua.rig.skeleton import Skeleton

Roles = dict[str, tuple[int, ...]]

_FINGERS = {"thumb": "thumb", "index": "index", "middle": "middle", "mid": "middle", "ring": "ring"}
_FINGERS |= {"pinky": "pinky", "little": "pinky"}
_SEGMENTS = ("", "proximal", "intermediate", "distal", "metacarpal")

_CENTRAL = {
    "hips": ("hips", "hip", "pelvis"),
    "spine": ("spine", "chest", "upperchest", "thorax", "lowerback", "upperback", "back", "abdomen", "waist", "torso"),
    "neck": ("neck", "lowerneck", "upperneck"),
    "head": ("head", "skull"),
}
_SIDED = {
    "collar": ("collar", "clavicle"),
    "shoulder": ("shoulder",),
    "upper_arm": ("arm", "upperarm", "uparm", "humerus", "shldr"),
    "forearm": ("forearm", "lowerarm", "lowarm", "radius", "elbow"),
    "hand": ("hand", "wrist"),
    "hip": ("hip",),
    "thigh": ("thigh", "upleg", "upperleg", "femur"),
    "shin": ("shin", "leg", "lowerleg", "lowleg", "calf", "tibia", "knee"),
    "ankle": ("ankle",),
    "foot": ("foot",),
    "toe": ("toe", "toes", "toebase", "ball"),
} | {
    part: tuple(
        f"{before}{name}{segment}"
        for name, finger in _FINGERS.items()
        if finger == part
        for before in ("", "hand", "f")
        for segment in _SEGMENTS
    )
    for part in sorted(set(_FINGERS.values()))
}
_CENTRAL_PART = {name: part for part, names in _CENTRAL.items() for name in names}
_SIDED_PART = {name: part for part, names in _SIDED.items() for name in names}
_SIDE = {"left": "left", "l": "left", "right": "right", "r": "right"}
_ASF_SIDED = ("clavicle", "humerus", "radius", "wrist", "hand", "femur", "tibia", "foot", "toes")  # lhumerus, rfoot

NAMESPACE = re.compile(r"^.*[:|]")
_RIG_PREFIX = re.compile(
    r"^(mixamorig\d*|bip\d+|cc_base|def|j_bip(_c)?|b|jnt|joint|character\d*)[\s_.\-]", re.IGNORECASE
)
_WORD = re.compile(r"[A-Z]+(?=[A-Z][a-z])|[A-Z]?[a-z]+|[A-Z]+")


def roles(skeleton: Skeleton) -> Roles:
    """Joints of every role that the names of `skeleton` give away, from the root outwards."""
    found: dict[str, list[int]] = {}
    for joint, name in enumerate(skeleton.names):
        role = _role(name)
        if role is not None:
            found.setdefault(role, []).append(joint)
    for side in ("left", "right"):
        _settle_side(found, side)
    found.setdefault("hips", [skeleton.root])
    return {role: _one_chain(skeleton, joints) for role, joints in found.items()}


def _role(name: str) -> str | None:
    words = [word.lower() for word in _WORD.findall(_RIG_PREFIX.sub("", NAMESPACE.sub("", name)))]
    sides = [_SIDE[word] for word in words if word in _SIDE]
    part = "".join(word for word in words if word not in _SIDE)
    for prefix in ("left", "right"):
        if not sides and part.startswith(prefix):
            sides, part = [prefix], part.removeprefix(prefix)
    if not sides and part[:1] in _SIDE and part[1:] in _ASF_SIDED:
        sides, part = [_SIDE[part[0]]], part[1:]
    if len(sides) == 1 and part in _SIDED_PART:
        return f"{sides[0]} {_SIDED_PART[part]}"
    return None if sides else _CENTRAL_PART.get(part)


def _settle_side(found: dict[str, list[int]], side: str) -> None:
    """Settle names whose part depends on their neighbours: SMPL's foot is the toe, its shoulder the upper arm."""

    def rename(old: str, new: str) -> None:
        joints = found.pop(f"{side} {old}", [])
        if joints:
            found[f"{side} {new}"] = sorted(found.get(f"{side} {new}", []) + joints)

    if f"{side} ankle" in found:
        rename("foot", "toe")
        rename("ankle", "foot")
    if f"{side} upper_arm" not in found:
        rename("shoulder", "upper_arm")
    rename("collar", "shoulder")
    if f"{side} thigh" not in found:
        rename("hip", "thigh")
    found.pop(f"{side} hip", None)


def _one_chain(skeleton: Skeleton, joints: list[int]) -> tuple[int, ...]:
    chain = joints[:1]
    for joint in joints[1:]:
        if chain[-1] in _ancestors(skeleton, joint):
            chain.append(joint)
    return tuple(chain)


def _ancestors(skeleton: Skeleton, joint: int) -> list[int]:
    found = []
    while (joint := int(skeleton.parents[joint])) >= 0:
        found.append(joint)
    return found
