"""The role of a joint by its name: a body part and a side behind every naming convention.

A role is a part ("hips", "spine", "neck", "head") or a side and a part ("left thigh"). Several joints of one chain
may share a role (CMU's lowerneck and upperneck are the neck); they are listed from the root outwards.
"""

import re
import unicodedata
from collections import Counter
from collections.abc import Mapping
from dataclasses import replace
from itertools import takewhile

from mua.pose.foreign_names import FOREIGN_CENTRAL, FOREIGN_SIDE, FOREIGN_SIDED, WIDE_CENTRAL, WIDE_SIDE, WIDE_SIDED
from mua.pose.skeleton import Skeleton

Roles = dict[str, tuple[int, ...]]

SIDES = ("left", "right")
FINGERS = ("thumb", "index", "middle", "ring", "pinky")
CENTRAL_PARTS = ("hips", "spine", "neck", "head")
SIDED_PARTS = ("shoulder", "upper_arm", "forearm", "hand", "thigh", "shin", "foot", "toe", *FINGERS)
LIMBS = frozenset(f"{side} {part}" for side in SIDES for part in ("upper_arm", "forearm", "thigh", "shin"))
LIMBS_NAMED = 6  # of these, which names that are understood tell at least
ROLES = (*CENTRAL_PARTS, *(f"{side} {part}" for side in SIDES for part in SIDED_PARTS))

_FINGER_NAMES = {
    "thumb": ("thumb",),
    "index": ("index", "pointer"),
    "middle": ("middle", "mid"),
    "ring": ("ring",),
    "pinky": ("pinky", "little"),
}
_SEGMENTS = ("", "proximal", "intermediate", "distal", "metacarpal")

_CENTRAL = {
    "hips": ("hips", "hip", "pelvis", "spinebase", "lowerbody"),
    "spine": (
        *("spine", "chest", "upperchest", "lowerchest", "thorax", "lowerback", "upperback", "back", "waist"),
        *("torso", "lowertorso", "uppertorso", "upperbody", "lowerspine", "middlespine", "upperspine"),
        *(
            "abdomen",
            "lowerabdomen",
            "upperabdomen",
            "ab",
            "stomach",
            "spinemid",
            "spinenavel",
            "spinechest",
            "spineshoulder",
        ),
    ),
    "neck": ("neck", "lowerneck", "upperneck", "necktwist"),
    "head": ("head", "skull"),
}
_SIDED = {
    "collar": ("collar", "clavicle", "clav", "scapula", "collarbone"),
    "shoulder": ("shoulder",),
    "upper_arm": ("arm", "upperarm", "uparm", "uarm", "humerus", "shldr", "bicep"),
    "forearm": ("forearm", "lowerarm", "lowarm", "loarm", "farm", "larm", "radius", "ulna", "elbow"),
    "hand": ("hand", "wrist", "handwrist", "fist"),
    "hip": ("hip",),
    "thigh": ("thigh", "upleg", "upperleg", "femur"),
    "shin": ("shin", "leg", "lowerleg", "lowleg", "loleg", "calf", "tibia", "shank", "knee"),
    "ankle": ("ankle",),
    "foot": ("foot", "footankle", "calcn"),
    "toe": ("toe", "toes", "toebase", "ball", "football"),
} | {
    part: tuple(
        f"{before}{name}{segment}" for name in names for before in ("", "hand", "f", "fng") for segment in _SEGMENTS
    )
    for part, names in _FINGER_NAMES.items()
}
_ANIMAL = {  # forelegs are the arms
    "shoulder": ("frontlegshoulder",),
    "upper_arm": ("frontlegupper",),
    "forearm": ("frontleglower",),
    "hand": ("frontlegankle", "frontlegfoot", "frontpaw"),
    "thigh": ("backlegupper",),
    "shin": ("backleglower",),
    "ankle": ("backlegankle",),
    "foot": ("backlegfoot", "backpaw"),
}
CENTRAL_PART = {name: part for part, names in _CENTRAL.items() for name in names} | FOREIGN_CENTRAL
SIDED_PART = {
    name: part for table in (_SIDED, _ANIMAL) for part, names in table.items() for name in names
} | FOREIGN_SIDED
SIDE = {"left": "left", "l": "left", "right": "right", "r": "right"}
NO_PART = {  # words that say nothing about where a joint is; a letter may count, as in spineA, spineB
    *("bind", "jnt", "joint", "bone", "bend", "stretch", "m", "x"),
    *"abcd",
}
_BELOW = {"upper_arm": "forearm", "forearm": "hand", "thigh": "shin", "shin": "foot"}

NAMESPACE = re.compile(r"^.*[:|]")
_RIG_PREFIX = re.compile(
    r"^(valvebiped\.)?((mixamorig\d*|bip\d+)[\s_.\-]?"
    r"|(cc_base|def|j_bip(_c)?|b|j|jnt|joint|character\d*|quickrigcharacter\d*|skeleton|armature)[\s_.\-])",
    re.IGNORECASE,
)
_WORD = re.compile(r"[A-Z]+(?=[A-Z][a-z])|[A-Z]?[a-z]+|[A-Z]+")
_FBX_ESCAPE = re.compile(r"FBXASC(\d{3})")  # Maya writes characters that names may not have by their code
_OWNER = re.compile(r"[^\W_]+[_\s.\-]+")  # the word before a joint's own name
_LAST_WORD = re.compile(r"([A-Z][a-z]*|[a-z]+)$")  # of what all names share: maybe the start of their own words
_NUMBERED_FINGER = re.compile(r"finger[\s_.\-]?(\d)", re.IGNORECASE)


def roles(
    skeleton: Skeleton,
    stated: Mapping[str, str] | None = None,  # joint name to one of ROLES, where the file states it
) -> Roles:
    """Joints of every role, from the root outwards: from the file where it states them, else from the names."""
    found: dict[str, list[int]] = {}
    filed, skeleton = skeleton, _without_owner(skeleton)
    first_finger = _first_finger(skeleton)
    for joint, name in enumerate(skeleton.names):
        role = _role(name, first_finger)
        if role is not None:
            found.setdefault(role, []).append(joint)
    for side in SIDES:
        _settle_side(found, side)
        _leave_out_targets(skeleton, found, side)
    chains = {role: _one_chain(skeleton, joints) for role, joints in found.items()}
    from_file = _stated(filed, stated or {})
    taken = {joint for joints in from_file.values() for joint in joints}
    left = {role: tuple(joint for joint in joints if joint not in taken) for role, joints in chains.items()}
    chains = {role: joints for role, joints in left.items() if joints and role not in from_file} | from_file
    _keep_to_limbs(skeleton, chains)
    _settle_legs(skeleton, chains)
    _settle_trunk(skeleton, chains)
    return chains


def _without_owner(skeleton: Skeleton) -> Skeleton:
    """The skeleton with its joints' names less the figure's own before them, as in UnityChan_LeftArm, LowManLeftArm.

    Only where the names tell arms and legs without it, and not with it.
    """
    starts = Counter(start[0] for name in skeleton.names if (start := _OWNER.match(name)))
    low, high = min(skeleton.names), max(skeleton.names)
    common = "".join(a for a, _ in takewhile(lambda pair: pair[0] == pair[1], zip(low, high, strict=False)))
    for owner in ("", common, _LAST_WORD.sub("", common), *(start for start, _ in starts.most_common(2))):
        bare = replace(skeleton, names=tuple(name.removeprefix(owner) or name for name in skeleton.names))
        first_finger = _first_finger(bare)
        if len(LIMBS & {_role(name, first_finger) for name in bare.names}) >= LIMBS_NAMED:
            return bare
    return skeleton


def limb_count(skeleton: Skeleton) -> int:
    """How many of the eight bones of arms and legs the joints' names identify."""
    found = roles(skeleton)
    return len(LIMBS & set(found))


def _stated(skeleton: Skeleton, stated: Mapping[str, str]) -> Roles:
    found: dict[str, list[int]] = {}
    for joint, name in enumerate(skeleton.names):
        if name in stated:
            found.setdefault(stated[name], []).append(joint)
    return {role: tuple(joints) for role, joints in found.items()}


def _role(name: str, first_finger: int) -> str | None:
    name = _without_accents(_FBX_ESCAPE.sub(lambda code: chr(int(code[1])), name))
    if not name.isascii():
        return _wide_role(name)
    bare = _RIG_PREFIX.sub("", NAMESPACE.sub("", name))
    words = [word.lower() for word in _WORD.findall(bare)]
    side_words = SIDE if SIDE.keys() & set(words) else FOREIGN_SIDE
    sides = [side_words[word] for word in words if word in side_words]
    kept = [word for word in words if word not in side_words and word not in NO_PART]
    part = "".join(kept)
    for side in SIDES:
        if not sides and part not in CENTRAL_PART and (part.startswith(side) or part.endswith(side)):
            sides, part = [side], part.removeprefix(side).removesuffix(side)
    if not sides and part[:1] in SIDE and part[1:] in SIDED_PART:  # lhumerus, rfoot, lindex
        sides, part = [SIDE[part[0]]], part[1:]
    if len(sides) != 1:
        return None if sides else CENTRAL_PART.get(part, CENTRAL_PART.get("".join(kept[::-1])))
    if numbered := _NUMBERED_FINGER.search(bare):
        finger = int(numbered[1]) - first_finger
        return f"{sides[0]} {FINGERS[finger]}" if 0 <= finger < len(FINGERS) else None
    found = SIDED_PART.get(part, SIDED_PART.get("".join(kept[::-1])))  # armUpper
    return None if found is None else f"{sides[0]} {found}"


def _without_accents(name: str) -> str:
    """The name in ASCII where only accents and the German ß are not."""
    plain = "".join(letter for letter in unicodedata.normalize("NFKD", name.replace("ß", "ss")) if letter.isascii())
    return plain if len(plain) >= len(name) else name


def _wide_role(name: str) -> str | None:
    """The role of a Chinese or Japanese name, whose digits may be wide ones; longer names are helper joints."""
    part = unicodedata.normalize("NFKC", name).strip().rstrip("0123456789")
    side = WIDE_SIDE.get(part[:1])
    if side is None:
        return WIDE_CENTRAL.get(part)
    found = WIDE_SIDED.get(part[1:])
    return None if found is None else f"{side} {found}"


def _first_finger(skeleton: Skeleton) -> int:
    """The number of the thumb where fingers are numbered: 0 in bipeds of 3ds Max, else 1."""
    numbers = [int(found[1]) for name in skeleton.names if (found := _NUMBERED_FINGER.search(name))]
    return min(numbers, default=1)


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


def _leave_out_targets(skeleton: Skeleton, found: dict[str, list[int]], side: str) -> None:
    """Drop IK targets: joints that share a name with joints of the limb but do not hang on the limb above."""
    for upper, lower in _BELOW.items():
        above = set(found.get(f"{side} {upper}", []))
        hanging = [j for j in found.get(f"{side} {lower}", []) if above & set(skeleton.ancestors(j))]
        if hanging:
            found[f"{side} {lower}"] = hanging


def _keep_to_limbs(skeleton: Skeleton, chains: Roles) -> None:
    """Leave twist joints out of a limb: they share its name but are not on the way to its end."""
    for role, joints in chains.items():
        side, _, part = role.rpartition(" ")
        below = chains.get(f"{side} {_BELOW.get(part)}")
        if below:
            way = set(skeleton.ancestors(below[0]))
            kept = tuple(joint for joint in joints if joint in way)
            chains[role] = kept or joints


def _settle_legs(skeleton: Skeleton, chains: Roles) -> None:
    """A leg above a knee is the thigh, and the last of several joints of a foot its toe, where no name says so.

    So is a leg that hangs on what carries the other one too: it is a leg of one bone.
    """
    shins = [chains[role][0] for role in (f"{side} shin" for side in SIDES) if role in chains]
    carrying = set.intersection(*(set(skeleton.ancestors(joint)) for joint in shins)) if len(shins) == 2 else set()
    for side in SIDES:
        shin, foot = (chains.get(f"{side} {part}", ()) for part in ("shin", "foot"))
        if f"{side} thigh" not in chains and (len(shin) > 1 or (shin and skeleton.parents[shin[0]] in carrying)):
            chains[f"{side} thigh"], chains[f"{side} shin"] = shin[:1], shin[1:]
        if not chains.get(f"{side} shin"):
            chains.pop(f"{side} shin", None)
        if len(foot) > 1 and f"{side} toe" not in chains:
            chains[f"{side} foot"], chains[f"{side} toe"] = foot[:-1], foot[-1:]


def _settle_trunk(skeleton: Skeleton, chains: Roles) -> None:
    """Hips carry both legs and the spine; the spine ends where the arms begin, and neck and head go on from there."""
    legs = [chains[role][0] for role in ("left thigh", "right thigh") if role in chains]
    arms = [chains[role][0] for role in ("left upper_arm", "right upper_arm") if role in chains]
    spine = chains.get("spine", ())
    carrying = set.intersection(*(set(skeleton.ancestors(joint)) for joint in legs)) if len(legs) == 2 else set()
    below = tuple(joint for joint in spine if joint in carrying)
    if below and "hips" not in chains:
        chains["hips"] = below
    hips = chains.get("hips", (skeleton.root,))
    if carrying and not carrying & set(hips):
        above = set.intersection(carrying, skeleton.ancestors(hips[0]))
        hips = (max(above), *hips) if above else hips
    chains["hips"] = hips
    spine = tuple(joint for joint in spine if joint not in hips)
    reach = set.union(*(set(skeleton.ancestors(joint)) for joint in arms)) if arms else set(spine)
    beyond = tuple(joint for joint in spine if joint not in reach) if reach & set(spine) else ()
    if len(beyond) > 1 and "neck" not in chains and "head" not in chains:
        chains["neck"] = beyond
        spine = tuple(joint for joint in spine if joint not in beyond)
    neck = chains.get("neck", ())
    if len(neck) > 1 and "head" not in chains:
        chains["neck"], chains["head"] = neck[:-1], neck[-1:]
    spine = spine or _unnamed_spine(skeleton, chains, arms)
    if spine:
        chains["spine"] = spine
    else:
        chains.pop("spine", None)


def _unnamed_spine(skeleton: Skeleton, chains: Roles, arms: list[int]) -> tuple[int, ...]:
    """The joints from the hips to where both arms branch off, which are the spine whatever they are called.

    So is a body that carries the arms and the hips.
    """
    if len(arms) < 2:
        return ()
    hips = chains["hips"][-1]
    carrying = set.intersection(*(set(skeleton.ancestors(joint)) for joint in arms))
    known = {joint for joints in chains.values() for joint in joints}
    above = tuple(sorted(j for j in carrying - known if hips in skeleton.ancestors(j)))
    if above or not carrying or max(carrying) not in skeleton.ancestors(hips):
        return above
    return (max(carrying),)


def _one_chain(skeleton: Skeleton, joints: list[int]) -> tuple[int, ...]:
    chain = joints[:1]
    for joint in joints[1:]:
        if chain[-1] in skeleton.ancestors(joint):
            chain.append(joint)
    return tuple(chain)
