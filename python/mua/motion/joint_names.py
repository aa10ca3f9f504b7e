"""Which joint of one skeleton is which of another, by name: a body part and a side behind every naming habit.

A role is a part ("hips", "spine", "neck", "head") or a side and a part ("left thigh"). Several joints of one chain
may share a role (CMU's lowerneck and upperneck are the neck); they are listed from the root outwards.
"""

import json
import re
import tomllib
from collections.abc import Mapping
from pathlib import Path

from mua.errors import InputError
from mua.rig.skeleton import Skeleton

Roles = dict[str, tuple[int, ...]]
Matches = dict[int, tuple[int, int]]  # target joint -> first and last source joint of the chain that moves it

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

_NAMESPACE = re.compile(r"^.*[:|]")
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


def match_joints(source: Skeleton, target: Skeleton, mapping: Mapping[str, str] | None = None) -> Matches:
    """Find the source chain that moves each target joint: by `mapping`, then by role, then by equal names.

    `mapping` goes from target to source joint names. Chains of different length share their joints in proportion.
    Errors: InputError if `mapping` names an unknown joint or if nothing but the root matches.
    """
    matches = _match_equal_names(source, target)
    source_roles, target_roles = roles(source), roles(target)
    for role, joints in target_roles.items():
        chain = source_roles.get(role, ())
        for i, joint in enumerate(joints):
            if chain:
                first, end = i * len(chain) // len(joints), -(-(i + 1) * len(chain) // len(joints))
                matches[joint] = chain[first], chain[end - 1]
    for target_name, source_name in (mapping or {}).items():
        chosen = _index(source, source_name, "source")
        matches[_index(target, target_name, "target")] = chosen, chosen
    if not mapping and not set(matches) - set(target_roles["hips"]) and _plain(source) != _plain(target):
        raise InputError(
            f"motion: no joint name of the source ({_sample(source)}) matches one of the character "
            f"({_sample(target)}); give a mapping file of target and source joint names"
        )
    return matches


def read_mapping(path: Path) -> dict[str, str]:
    """Read a mapping file, `{"target_joint": "source_joint"}` as JSON or TOML, by suffix.

    Errors: InputError if it cannot be read, parsed, or holds anything but strings.
    """
    parse = tomllib.loads if path.suffix.lower() == ".toml" else json.loads
    try:
        mapping = parse(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        raise InputError(f"{path}: cannot be read as a mapping of joint names: {error}") from error
    if not isinstance(mapping, dict):
        raise InputError(f"{path}: expected a table from target to source joint names, found {type(mapping).__name__}")
    for target, source in mapping.items():
        if not isinstance(source, str):
            raise InputError(f"{path}: {target}: expected the name of a source joint, found {source!r}")
    return mapping


def _role(name: str) -> str | None:
    words = [word.lower() for word in _WORD.findall(_RIG_PREFIX.sub("", _NAMESPACE.sub("", name)))]
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


def _match_equal_names(source: Skeleton, target: Skeleton) -> Matches:
    places = {name: joint for joint, name in enumerate(_plain(source))}
    return {joint: (places[name], places[name]) for joint, name in enumerate(_plain(target)) if name in places}


def _plain(skeleton: Skeleton) -> list[str]:
    return [re.sub(r"[^a-z0-9]", "", _NAMESPACE.sub("", name).lower()) for name in skeleton.names]


def _index(skeleton: Skeleton, name: str, side: str) -> int:
    if name not in skeleton.names:
        raise InputError(f"mapping: {side} joint {name!r} does not exist; expected one of {_sample(skeleton)}")
    return skeleton.names.index(name)


def _sample(skeleton: Skeleton) -> str:
    shown = ", ".join(skeleton.names[:6])
    return shown if len(skeleton.names) <= 6 else f"{shown}, ... {len(skeleton.names)} in all"
