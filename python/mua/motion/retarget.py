"""Put motion of one skeleton onto another by what every bone does in the world.

For a target joint t that follows source joint s:

    R_t(f) = W  R_s(f)  C_t  R_t(bind)

C_t says how t's bind pose lies in the space of s: by both rest poses where the source's shows a body and its frames
turn the trunk as that body stands (mua.motion.rest_alignment), else by what the posed skeleton does
(mua.motion.posed_alignment), or by the joints' axes where both rigs have them alike. W turns the result so that the
source's rest faces where the target's bind faces. The hips' path is scaled by the ratio of leg lengths and set so that
standing feet keep the height that they have in the bind pose (mua.motion.floor).
"""

from collections.abc import Mapping

import numpy as np

from mua import rotation
from mua.arrays import Array
from mua.motion.detached import detached_joints
from mua.motion.floor import placed
from mua.motion.match import Matches, missing_limbs
from mua.motion.posed_alignment import posed_calibrations
from mua.motion.rest_alignment import IDENTITY, LIMBS, Rest, body_turn, rest_calibrations, rest_of
from mua.motion.source_motion import SourceMotion
from mua.motion.trunk import SIDES, degrees, on_all_fours, stands, trunk_of, unit
from mua.pose.clip import Clip
from mua.pose.descriptor import heading_of
from mua.pose.resample import resample
from mua.pose.skeleton import Skeleton

ALIKE = 30.0  # degrees within which an estimate agrees
MOST = 0.75  # share of the joints that must agree
TURNED = 45.0  # degrees between where hips or chest are and where their joint's turn since rest would have them
CHECKED = (
    *("hips", "spine"),
    *(f"{side} {part}" for side in SIDES for part in ("upper_arm", "forearm", "thigh", "shin")),
)


def retarget(source: SourceMotion, target: Skeleton, matches: Matches, *, rate: float) -> tuple[Clip, tuple[str, ...]]:
    """Return the motion of `source` on `target` at `rate` frames per second, and notes worth telling the user.

    Joints that nothing matches keep their bind rotation; limbs of that kind are noted.
    """
    rest = rest_of(source.skeleton, target, matches)
    clip = resample(source.clip, rate)
    turned, at = source.skeleton.world(clip.rotations, clip.translations)
    calibrations, facing, honest = _calibrations(rest, turned, at, rate)
    rotations = local_rotations(rest, calibrations, rotation.multiply(facing, turned))
    translations, notes = placed(rest, rotations, rotation.rotate(facing, at), rate=rate, honest=honest)
    notes = [f"{clip.name}: {note}" for note in notes]
    if missing := missing_limbs(source.skeleton, target, matches):
        notes.append(f"The motion does not move {' and '.join(missing)}.")
    if unmatched := len(target.names) - len(matches.chains):
        notes.append(
            f"{unmatched} of {len(target.names)} joints match no joint of the motion and keep their bind rotation."
        )
    return Clip(clip.name, rate, rotations, translations), (*source.notes, *matches.notes, *notes)


def calibrations_at_rest(rest: Rest) -> tuple[dict[int, Array], Array]:
    """C_t by target joint and W [4], where the source's rest pose shows a body."""
    upright = body_turn(rest)
    return rest_calibrations(rest, upright), rotation.conjugate(heading_of(upright))


def _calibrations(rest: Rest, turned: Array, at: Array, rate: float) -> tuple[dict[int, Array], Array, bool]:
    """C_t by target joint, W [4], and whether they come from the source's rest pose, which then gives heights too."""
    by_rest, facing = calibrations_at_rest(rest)
    honest = (stands(rest.source_places()) or _both_on_all_fours(rest)) and not _turned_otherwise(rest, turned, at)
    by_pose = {} if honest else posed_calibrations(rest, turned, at, rate)
    if not by_pose:
        return by_rest, facing, True
    by_frames = {joint: rotation.conjugate(rest.target_turned[joint]) for joint in rest.matches.chains}
    if not _same_frames(rest, by_frames, by_pose):
        return by_pose, IDENTITY, False
    return by_frames | _along_bones(rest, by_frames, by_pose), IDENTITY, False


def _both_on_all_fours(rest: Rest) -> bool:
    target = {role: rest.target_at[pair[0]] for role in rest.matches.roles if (pair := rest.matches.ends(role))}
    return on_all_fours(target) and on_all_fours(rest.source_places())


def _turned_otherwise(rest: Rest, turned: Array, at: Array) -> bool:
    """Whether hips or chest of the source do not turn with their joint from where the rest pose has them.

    Rotations that a solver made up of joints' places are of that kind: a joint whose children all begin where it does
    may be turned in any way.
    """
    ends = {role: pair[1] for role in rest.matches.roles if (pair := rest.matches.ends(role)) is not None}
    rests = trunk_of({role: rest.source_at[joint] for role, joint in ends.items()})
    moves = trunk_of({role: at[:, joint] for role, joint in ends.items()})
    chest = rest.matches.roles.get("spine", ())[-1:]
    if rests is None or moves is None:
        return False
    asked = [(ends.get("hips"), rests.hips, moves.hips)]
    asked += [
        (rest.matches.chains[joint][1], rests.chest, moves.chest) for joint in chest if joint in rest.matches.chains
    ]
    for joint, left, seen in asked:
        if joint is not None:
            since = rotation.multiply(turned[:, joint], rotation.conjugate(rest.source_turned[joint]))
            if np.median(degrees(rotation.rotate(since, left), seen)) > TURNED:
                return True
    return False


def _same_frames(rest: Rest, by_frames: dict[int, Array], by_pose: dict[int, Array]) -> bool:
    """Whether both skeletons have their joints' axes alike, as rigs of one maker do: then rotations can be copied."""
    joints = [joint for role in CHECKED if (joint := rest.joint(role)) is not None]
    cosines = np.array([abs(by_frames[joint] @ by_pose[joint]) for joint in joints])
    return bool(np.mean(cosines > np.cos(np.radians(ALIKE) / 2)) > MOST)


def _along_bones(rest: Rest, by_frames: dict[int, Array], by_pose: dict[int, Array]) -> dict[int, Array]:
    """`by_frames` of limbs, turned to where the source's bones are, which estimates know exactly."""
    found = {}
    for role, end in ((f"{side} {part}", f"{side} {end}") for part, end in LIMBS.items() for side in SIDES):
        joint, below = rest.joint(role), rest.joint(end)
        if joint is not None and below is not None:
            bone = unit(rest.target_at[below] - rest.target_at[joint])
            lies, seen = (rotation.rotate(turns[joint], bone) for turns in (by_frames, by_pose))
            found[joint] = rotation.multiply(rotation.between(lies, seen), by_frames[joint])
    return found


def local_rotations(rest: Rest, calibrations: Mapping[int, Array], moved: Array) -> Array:
    """Local rotations [F, T, 4] of the target, from the world rotations [F, S, 4] of the source."""
    target, chains = rest.target, rest.matches.chains
    matched = np.array(sorted(chains), int)
    local = np.tile(target.bind_rotations, (len(moved), 1, 1))
    turned = np.empty_like(local)
    if len(matched):
        calibrated = np.array([calibrations[joint] for joint in matched])
        bound = rotation.multiply(calibrated, rest.target_turned[matched])
        turned[:, matched] = rotation.multiply(moved[:, [chains[joint][1] for joint in matched]], bound)
    is_matched = np.isin(np.arange(len(target.names)), matched)
    for joints, parents in target.generations:
        above = np.where(parents[:, None] < 0, IDENTITY, turned[:, parents])
        led, free = is_matched[joints], ~is_matched[joints]
        turned[:, joints[free]] = rotation.multiply(above[:, free], local[:, joints[free]])
        wanted = rotation.multiply(rotation.conjugate(above[:, led]), turned[:, joints[led]])
        local[:, joints[led]] = rotation.normalize(wanted)
    for joint, carrier in detached_joints(rest).items():
        since = rotation.multiply(turned[:, carrier], rotation.conjugate(rest.target_turned[carrier]))
        wanted = rotation.multiply(since, rest.target_turned[joint])
        local[:, joint] = rotation.multiply(rotation.conjugate(turned[:, target.parents[joint]]), wanted)
    return local
