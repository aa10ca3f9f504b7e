"""Which joint of a motion's skeleton moves which joint of a character: by a mapping, by roles, by equal names."""

import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

from mua.arrays import Array
from mua.errors import InputError
from mua.motion.joint_places import roles_by_place
from mua.motion.whole_limbs import with_whole_limbs
from mua.pose.joint_names import FINGERS, NAMESPACE, SIDES, Roles
from mua.pose.joint_names import roles as find_roles
from mua.pose.sides import SWAPPED, true_sides
from mua.pose.skeleton import Skeleton


@dataclass(frozen=True)
class Matches:
    """The source joints that move each target joint, and what the target's joints are."""

    chains: Mapping[int, tuple[int, int]]  # target joint -> first and last source joint of the chain that moves it
    roles: Roles  # of the target
    notes: tuple[str, ...] = ()  # what was recognised by other means than names, a sentence each
    source_roles: Roles = field(default_factory=dict)

    def joint(self, role: str) -> int | None:
        """The first matched target joint of a role."""
        return next((joint for joint in self.roles.get(role, ()) if joint in self.chains), None)

    def ends(self, role: str) -> tuple[int, int] | None:
        """The target and the source joint where a role begins, None if it is not matched."""
        joint = self.joint(role)
        return None if joint is None else (joint, self.chains[joint][0])


def match_joints(
    source: Skeleton,
    target: Skeleton,
    mapping: Mapping[str, str] | None = None,  # target to source joint names
    *,
    source_stated: Mapping[str, str] | None = None,  # joint name to role, where the source's file itself says it
    target_stated: Mapping[str, str] | None = None,
    source_poses: Array | None = None,  # [P, J, 3] places of the source's joints in some frames
) -> Matches:
    """Find the source chain that moves each target joint: by `mapping`, then by role, then by equal names.

    Roles that a file states take precedence over the joints' names.
    Chains of different length share their joints in proportion. A thumb without fingers, as optical motion capture has
    it, is one marker that a solver turned wildly: it moves nothing.
    Errors: InputError if `mapping` names an unknown joint.
    """
    chains = _match_equal_names(source, target)
    source_roles, source_notes = _roles(source, source_stated, "motion", source_poses)
    target_roles, target_notes = _roles(target, target_stated, "character")
    for side in SIDES:
        thumb, *fingers = (f"{side} {finger}" for finger in FINGERS)
        if not any(finger in source_roles for finger in fingers):
            source_roles = {role: joints for role, joints in source_roles.items() if role != thumb}
    for role, joints in target_roles.items():
        chain = source_roles.get(role, ())
        for i, joint in enumerate(joints):
            if chain:
                first, end = i * len(chain) // len(joints), -(-(i + 1) * len(chain) // len(joints))
                chains[joint] = chain[first], chain[end - 1]
    target_roles = _with_mapped(source, target, target_roles, source_roles, mapping or {})
    for target_name, source_name in (mapping or {}).items():
        chosen = _index(source, source_name, "source")
        chains[_index(target, target_name, "target")] = chosen, chosen
    return Matches(chains, target_roles, (*source_notes, *target_notes), source_roles)


def _roles(
    skeleton: Skeleton, stated: Mapping[str, str] | None, owner: str, poses: Array | None = None
) -> tuple[Roles, tuple[str, ...]]:
    """Joints of every role by the file and by names, and by places and lengths where these leave out limbs."""
    found = find_roles(skeleton, stated)
    notes: tuple[str, ...] = ()
    if placed := _placed(skeleton, found, poses):
        listed = ", ".join(f"{name} the {role.replace('_', ' ')}" for name, role in placed.items() if " " in role)
        found = find_roles(skeleton, {**placed, **(stated or {})})
        notes = (f"The {owner}'s joints are recognised by their positions, because their names are unknown: {listed}.",)
    found, mended = with_whole_limbs(skeleton, found, poses)
    if mended:
        listed = ", ".join(
            f"{skeleton.names[found[role][0]]} the {role.replace('_', ' ')}"
            for limb in mended
            for role in LIMBS[limb]
            if role in found
        )
        notes += (f"The {owner}'s {_listed(mended)} {_are(mended)} recognised by the lengths of the bones: {listed}.",)
    sides = found if stated or poses is None else true_sides(skeleton.names, found, poses)
    return (found, notes) if sides is found else (sides, (*notes, SWAPPED.format(owner)))


def _are(words: tuple[str, ...]) -> str:
    return "is" if len(words) == 1 else "are"


def _placed(skeleton: Skeleton, found: Roles, poses: Array | None) -> dict[str, str]:
    """Joint name to role by places, for limbs that names leave out; for the trunk too where they name no limb."""
    known = {limb for limb in LIMBS if limb != "spine" and any(role in found for role in LIMBS[limb])}
    if len(known) == len(LIMBS) - 1:
        return {}
    placed = roles_by_place(skeleton, poses)
    if not known:
        return placed
    named = {skeleton.names[joint]: role for role, joints in found.items() for joint in joints}
    sides = [placed[name].split()[0] == role.split()[0] for name, role in named.items() if " " in placed.get(name, "")]
    if not sides or not all(sides):
        return {}
    missing = {role for limb in BEYOND.keys() - known for role in (*LIMBS[limb], *BEYOND[limb])}
    return {name: role for name, role in placed.items() if role in missing and name not in named}


def _with_mapped(
    source: Skeleton, target: Skeleton, found: Roles, source_roles: Roles, mapping: Mapping[str, str]
) -> Roles:
    """The target's roles, with those that mapped joints take over from the source joint that moves them."""
    parts = {source.names[joint]: role for role, joints in source_roles.items() for joint in joints}
    known = {joint for joints in found.values() for joint in joints}
    added: dict[str, list[int]] = {}
    for target_name, source_name in mapping.items():
        role = parts.get(source_name)
        if role and target_name in target.names and (joint := target.names.index(target_name)) not in known:
            added.setdefault(role, []).append(joint)
    return found | {role: tuple(sorted(joints)) for role, joints in added.items() if role not in found}


LIMBS = {
    **{f"{side} arm": (f"{side} upper_arm", f"{side} forearm") for side in SIDES},
    **{f"{side} leg": (f"{side} thigh", f"{side} shin") for side in SIDES},
    "spine": ("spine",),
}
BEYOND = {
    limb: tuple(f"{limb.split()[0]} {part}" for part in (("hand",) if "arm" in limb else ("foot", "toe")))
    for limb in LIMBS
    if limb != "spine"
}
END = re.compile(r"(end|nub|tip)[_\d]*$", re.IGNORECASE)  # joints that only mark where a bone ends
SAME_RIG = 0.8  # of the target's joints: with as many equal names, motion and character are of one kind of rig


def missing_limbs(source: Skeleton, target: Skeleton, matches: Matches) -> tuple[str, ...]:
    """Limbs without which motion is no likeness of its source; none between rigs of one kind, people or not."""
    if len(_match_equal_names(source, target)) >= SAME_RIG * len(target.names):
        return ()
    missing = [
        limb
        for limb, roles in LIMBS.items()
        if any(matches.ends(role) is None for role in _asked(target, matches.roles, roles))
    ]
    if "spine" in missing and "spine" not in matches.roles and _has_no_spine(target, matches.roles):
        missing.remove("spine")
    return tuple(missing)


def require_limbs(source: Skeleton, target: Skeleton, matches: Matches) -> None:
    """Errors: InputError that names the limbs of the character that nothing of the motion moves."""
    missing = missing_limbs(source, target, matches)
    if not set(matches.chains) - set(matches.roles["hips"]) and _plain(source) != _plain(target):
        problem = "no joint name of it matches one of the character"
    elif missing:
        problem = f"nothing of it is known to move the {_listed(missing)} of the character"
    else:
        return
    raise InputError(
        f"motion: {problem}; pair their joints in a mapping file and give it with --mapping "
        "(mua-bake --check writes one to start from, --verbose lists the joints)",
        f"joints of the motion: {', '.join(source.names)}\njoints of the character: {', '.join(target.names)}",
    )


def _asked(skeleton: Skeleton, found: Roles, limb: tuple[str, ...]) -> tuple[str, ...]:
    """The roles of a limb that must be matched: the first alone where the limb is one bone, as of block figures."""
    upper, lower = limb[0], limb[-1]
    if upper not in found or lower in found:
        return limb
    known = {joint for joints in found.values() for joint in joints}
    below = [joint for joint in range(len(skeleton.names)) if found[upper][-1] in skeleton.ancestors(joint)]
    return limb if any(joint not in known and not END.search(skeleton.names[joint]) for joint in below) else limb[:1]


def _has_no_spine(skeleton: Skeleton, found: Roles) -> bool:
    """Whether arms or head grow straight out of the hips."""
    tops = [found[role][0] for role in ("left shoulder", "left upper_arm", "neck", "head") if role in found]
    return bool(tops) and all(int(skeleton.parents[joint]) in found["hips"] for joint in tops[:1])


def _listed(words: tuple[str, ...]) -> str:
    return " and ".join(filter(None, [", ".join(words[:-1]), words[-1]]))


@dataclass(frozen=True)
class JointPair:
    """A joint of the character and what moves it."""

    target: str
    source: str  # the first joint of the chain that moves it
    role: str  # "left thigh"; empty where the two were matched by their names alone


def joint_pairs(source: Skeleton, target: Skeleton, matches: Matches) -> tuple[JointPair, ...]:
    """Matched joints in the order of the target's."""
    parts = {joint: role for role, joints in matches.roles.items() for joint in joints}
    return tuple(
        JointPair(target.names[joint], source.names[matches.chains[joint][0]], parts.get(joint, ""))
        for joint in sorted(matches.chains)
    )


def unmatched_target(
    target: Skeleton,
    matches: Matches,
    weighted: Iterable[int] | Array,  # joints that carry skin weight
) -> tuple[str, ...]:
    """Names of those joints of the target that nothing moves."""
    return tuple(target.names[joint] for joint in sorted(map(int, weighted)) if joint not in matches.chains)


def _match_equal_names(source: Skeleton, target: Skeleton) -> dict[int, tuple[int, int]]:
    places = {name: joint for joint, name in enumerate(_plain(source))}
    return {joint: (places[name], places[name]) for joint, name in enumerate(_plain(target)) if name in places}


def _plain(skeleton: Skeleton) -> list[str]:
    return [re.sub(r"[^a-z0-9]", "", NAMESPACE.sub("", name).lower()) for name in skeleton.names]


def _index(skeleton: Skeleton, name: str, side: str) -> int:
    if name not in skeleton.names:
        raise InputError(f"mapping: {side} joint {name!r} does not exist; expected one of {_sample(skeleton)}")
    return skeleton.names.index(name)


def _sample(skeleton: Skeleton) -> str:
    shown = ", ".join(skeleton.names[:6])
    return shown if len(skeleton.names) <= 6 else f"{shown}, ... {len(skeleton.names)} in all"
