"""The clips of the built-in range of motion, on a character's own skeleton."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from mua import rotation
from mua.arrays import Array
from mua.motion.load import unique_names
from mua.motion.match import Matches, match_joints
from mua.motion.range.any_rig import alone, swung, together
from mua.motion.range.body import BODY, ROLES
from mua.motion.range.mixed import mixed
from mua.motion.range.moves import MOVES, STAND, other_side
from mua.motion.range.played import RATE, played
from mua.motion.retarget import retarget
from mua.motion.source_motion import SourceMotion
from mua.motion.trunk import trunk_of
from mua.pose.clip import RANGE_OF_MOTION, Clip, moved_by
from mua.pose.joint_names import SIDES
from mua.pose.skeleton import Skeleton
from mua.rig.character import Character
from mua.rig.skinning import moving_joints

ROUND = 160  # frames recorded of all clips, after which another round of them shows more than more of these
PLAYED = 10  # frames for each that is recorded, at most
UPRIGHT = 0.7  # cosine of the lean of a person's trunk in the bind pose


def motion_range(
    character: Character, clips: Sequence[Clip], *, frames: int, seed: int, short: bool = False
) -> list[Clip]:
    """Clips of what the character's joints can do, as many as `frames` recorded frames show; the seed chooses them.

    With `short`, clips are cut where so few frames are recorded that playing all of them would take most time. Joints
    that it does not move, and bones whose length the `clips` of the user set, are as these have them on the average.
    """
    rng = np.random.default_rng(seed)
    skeleton, rest = character.skeleton, _rest(character.skeleton, clips)
    moving = np.flatnonzero(moving_joints(character))
    matches = match_joints(BODY, skeleton, source_stated=ROLES, target_stated=character.roles)
    made: list[Clip] = []
    for number in range(max(-(-frames // ROUND), 1)):
        own = np.random.default_rng(rng.integers(2**63))
        if _is_person(skeleton, matches):
            extra = [j for j in moved_by(clips, moving) if j != skeleton.root and j not in matches.chains]
            found = _person(number, own)
            found = _shortened(found, frames) if short else found
            made += [_put_on(clip, skeleton, matches, rest, extra, own) for clip in found]
        else:
            joints = [int(joint) for joint in moving if joint != skeleton.root]
            found = _any_rig(skeleton, joints, rest, own)
            made += _shortened(found, frames) if short else found
    return unique_names([replace(clip, name=f"{RANGE_OF_MOTION}{clip.name}") for clip in made])


def standing(character: Character) -> list[Clip]:
    """A clip of a person who stands at ease and breathes, and ends as it begins; none for a rig that is no person."""
    skeleton = character.skeleton
    matches = match_joints(BODY, skeleton, source_stated=ROLES, target_stated=character.roles)
    if not _is_person(skeleton, matches):
        return []
    return [_put_on(played("stand", STAND), skeleton, matches, _rest(skeleton, ()), (), np.random.default_rng(0))]


def _shortened(clips: Sequence[Clip], frames: int) -> list[Clip]:
    """The beginnings of clips, of which PLAYED frames are played for each recorded one, or all of them."""
    share = min(PLAYED * frames / sum(len(clip) for clip in clips), 1.0)
    return [clip.cut(slice(max(round(share * len(clip)), 1))) for clip in clips]


def _person(number: int, rng: np.random.Generator) -> list[Clip]:
    """One round of clips of the body: all moves, each second time by the other side, and random poses."""
    moves = {name: other_side(keys) if number % 2 else keys for name, keys in MOVES.items()}
    return [*(played(name, keys) for name, keys in moves.items()), mixed("any pose", rng)]


def _any_rig(skeleton: Skeleton, joints: list[int], rest: Clip, rng: np.random.Generator) -> list[Clip]:
    still = rest.rotations[0]
    found = [together("joints together", skeleton, joints, still, rng) for _ in range(2)]
    if joints:
        found = [alone("joints alone", skeleton, joints, still, rng), *found]
    return [replace(clip, translations=np.tile(rest.translations, (len(clip), 1, 1))) for clip in found]


def _is_person(skeleton: Skeleton, matches: Matches) -> bool:
    """Whether the rig stands upright in its bind pose and has both arms or both legs."""
    _, at = skeleton.world(skeleton.bind_rotations, skeleton.bind_translations)
    trunk = trunk_of({role: at[joints[0]] for role, joints in matches.roles.items() if joints})
    pairs = (("upper_arm", "forearm"), ("thigh", "shin"))
    whole = [all(f"{side} {part}" in matches.roles for side in SIDES for part in pair) for pair in pairs]
    return trunk is not None and bool(trunk.up[1] > UPRIGHT) and any(whole)


def _put_on(
    clip: Clip, skeleton: Skeleton, matches: Matches, rest: Clip, extra: Sequence[int], rng: np.random.Generator
) -> Clip:
    """A clip of the body on the character; `extra` joints, which the body lacks, swing about where they rest."""
    moved, _ = retarget(SourceMotion(BODY, clip), skeleton, matches, rate=RATE)
    turned, _ = skeleton.world(moved.rotations, moved.translations)
    local, translations = moved.rotations.copy(), moved.translations.copy()
    above = np.empty_like(turned)
    for joint, parent in enumerate(skeleton.parents):
        base = above[:, parent] if parent >= 0 else np.broadcast_to([1.0, 0, 0, 0], turned[:, 0].shape)
        if joint in matches.chains or parent < 0 or not _is_at_rest(moved.rotations[:, joint]):
            local[:, joint] = rotation.multiply(rotation.conjugate(base), turned[:, joint])
        else:
            local[:, joint] = rest.rotations[0, joint]
        above[:, joint] = rotation.multiply(base, local[:, joint])
    led = np.ptp(moved.translations, axis=0).max(axis=-1) > 0
    led[skeleton.root] = True
    translations[:, ~led] = rest.translations[0, ~led]
    put = Clip(clip.name, RATE, local, translations)
    return swung(skeleton, put, extra, rng) if extra else put


def _is_at_rest(turns: Array) -> bool:
    return bool(np.all(np.abs(np.sum(turns * turns[:1], axis=-1)) > 1 - 1e-9))


def _rest(skeleton: Skeleton, clips: Sequence[Clip]) -> Clip:
    """One frame: how joints are on the average of the user's clips, or in the bind pose without any."""
    if not clips:
        return Clip("rest", RATE, skeleton.bind_rotations[None], skeleton.bind_translations[None])
    turns = np.concatenate([clip.rotations for clip in clips])
    aligned = np.where(np.sum(turns * turns[:1], axis=-1, keepdims=True) < 0, -turns, turns)
    places = np.concatenate([clip.translations for clip in clips]).mean(axis=0)
    return Clip("rest", RATE, rotation.normalize(aligned.mean(axis=0))[None], places[None])
