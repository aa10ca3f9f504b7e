"""Put motion of one skeleton onto another by what every bone does in the world.

For a target joint t that follows source joint s:

    R_t(f) = W  R_s(f)  C_t  R_t(bind)

C_t says how t's bind pose lies in the space of s: by both rest poses where the source's shows a body (mua.motion.rest),
else by what the posed skeleton does (mua.motion.posed). W turns the result so that the source's rest faces where the
target's bind faces. The hips' path is scaled by the ratio of leg lengths and set so that standing feet keep the height
that they have in the bind pose (mua.motion.floor).
"""

from collections.abc import Mapping

import numpy as np

from mua import rotation
from mua.arrays import Array
from mua.motion.clip import Clip
from mua.motion.descriptor import heading_of
from mua.motion.floor import placed
from mua.motion.match import Matches, match_joints, missing_limbs, require_limbs
from mua.motion.posed import posed_calibrations
from mua.motion.resample import resample
from mua.motion.rest import IDENTITY, Rest, body_turn, rest_calibrations, rest_of
from mua.motion.source import SourceMotion
from mua.motion.trunk import stands
from mua.rig.skeleton import Skeleton

CONTRADICTS = 45.0  # degrees from which a rest pose is not what the posed skeleton shows
TELLING = ("hips", "spine", "left thigh", "right thigh", "left shin", "right shin")


def retarget(
    source: SourceMotion,
    target: Skeleton,
    *,
    mapping: Mapping[str, str] | None = None,
    rate: float = 30.0,
) -> tuple[Clip, tuple[str, ...]]:
    """Return the motion of `source` on `target` at `rate` frames per second, and notes worth telling the user.

    mapping: target joint names to source joint names, before any match by name. Joints that nothing matches keep their
    bind rotation. Errors: InputError if an arm, a leg or the spine is not matched and no `mapping` is given, or if
    `mapping` names an unknown joint.
    """
    matches = match_joints(source.skeleton, target, mapping, source_said=source.said)
    if not mapping:
        require_limbs(source.skeleton, target, matches)
    return retarget_matched(source, target, matches, rate=rate)


def retarget_matched(
    source: SourceMotion, target: Skeleton, matches: Matches, *, rate: float = 30.0
) -> tuple[Clip, tuple[str, ...]]:
    """The same for joints that are matched already; limbs that are not are noted."""
    rest = rest_of(source.skeleton, target, matches)
    clip = resample(source.clip, rate)
    turned, at = source.skeleton.world(clip.rotations, clip.translations)
    upright = body_turn(rest)
    facing = rotation.conjugate(heading_of(upright))
    calibrations = rest_calibrations(rest, upright)
    posed = posed_calibrations(rest, turned, at, rate)
    honest = stands(rest.source_places()) or not _contradicts(rest, calibrations, posed)
    if not honest:
        calibrations, facing = posed, IDENTITY
    rotations = _local_rotations(rest, calibrations, rotation.multiply(facing, turned))
    translations, notes = placed(rest, rotations, rotation.rotate(facing, at), rate=rate, honest=honest)
    notes = [f"{clip.name}: {note}" for note in notes]
    if missing := missing_limbs(source.skeleton, target, matches):
        notes.append(f"Nothing of the motion moves {' and '.join(missing)}.")
    if unmatched := len(target.names) - len(matches.chains):
        notes.append(
            f"{unmatched} of {len(target.names)} joints match none of the motion and keep their bind rotation."
        )
    return Clip(clip.name, rate, rotations, translations), (*source.notes, *notes)


def _contradicts(rest: Rest, by_rest: Mapping[int, Array], by_pose: Mapping[int, Array]) -> bool:
    """Whether the source's rest pose says something else about trunk and legs than its posed skeleton."""
    joints = [joint for role in TELLING for joint in rest.matches.roles.get(role, ()) if joint in by_pose]
    cosines = [abs(by_rest[joint] @ by_pose[joint]) for joint in joints]
    return any(cosine < np.cos(np.radians(CONTRADICTS) / 2) for cosine in cosines)


def _local_rotations(rest: Rest, calibrations: Mapping[int, Array], moved: Array) -> Array:
    """Local rotations [F, T, 4] of the target, from the world rotations [F, S, 4] of the source."""
    target = rest.target
    turned = np.empty((len(moved), len(target.names), 4))
    local = np.empty_like(turned)
    for joint, parent in enumerate(target.parents):
        above = turned[:, parent] if parent >= 0 else IDENTITY
        if joint in rest.matches.chains:
            bound = rotation.multiply(calibrations[joint], rest.target_turned[joint])
            turned[:, joint] = rotation.multiply(moved[:, rest.matches.chains[joint][1]], bound)
            local[:, joint] = rotation.normalize(rotation.multiply(rotation.conjugate(above), turned[:, joint]))
        else:
            local[:, joint] = target.bind_rotations[joint]
            turned[:, joint] = rotation.multiply(above, local[:, joint])
    return local
