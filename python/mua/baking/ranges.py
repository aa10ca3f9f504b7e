"""The built-in range of motion in a bake: what of it is recorded."""

from collections.abc import Iterator, Sequence
from dataclasses import replace

from mua.baking.plan import plan
from mua.baking.settings import BakeSettings
from mua.characters.rigid_skeleton import rest_pose
from mua.motion.range import motion_range
from mua.pose.clip import RANGE_OF_MOTION, REST, Clip, moved_by
from mua.recording import PlannedClip
from mua.rig.character import Character
from mua.student.settings import Settings

SHARE = 4  # a quarter as many frames of the range as the user asks for of their own motion
FEW_SHARE, FEW = 2, 75  # or half as many, up to so many
SHORT_SHARE = 3  # where that motion is shorter, its missing frames are of the range too, up to a third of those asked
FEWEST = 135  # for, or to so many


def settings_for(settings: BakeSettings, character: Character) -> Settings:
    """The settings of a bake: where the range of motion is the only motion, none of its frames is the user's."""
    if settings.motions or character.clips or settings.motion_range == "none":
        return settings.student
    return replace(settings.student, generalisation=replace(settings.student.generalisation, own=False))


def planned_range(
    settings: BakeSettings, character: Character, clips: Sequence[Clip], frames: int
) -> list[PlannedClip]:
    """What is recorded of the range of motion beside `frames` training frames of `clips`; none of it is kept whole."""
    if settings.motion_range == "none" or (clips and not settings.motions and not character.clips):
        return []
    count = range_frames(settings.student.frames, frames)
    made = motion_range(character, clips, frames=count, seed=settings.student.seed)
    return [replace(one, whole=frozenset()) for one in (*plan(made, [], frames=count), *_standing(character, made))]


def _standing(character: Character, made: Sequence[Clip]) -> Iterator[PlannedClip]:
    """One frame of the pose in which the character's file stands, of the joints that the range moves.

    Other joints are as the range has them, or all poses would be described by more joints for the sake of one.
    """
    if character.source is None:
        return
    still = made[0].cut(slice(1))
    rotations, moved = still.rotations.copy(), moved_by(made, range(len(character.skeleton.names)))
    rotations[0, moved] = rest_pose(character.source, character.skeleton).rotations[moved]
    clip = replace(still, name=f"{RANGE_OF_MOTION}{REST}", rotations=rotations)
    yield PlannedClip(clip, held_out=False, wanted=frozenset({0}))


def range_frames(asked: int, own: int) -> int:
    """How many frames of the range are recorded where `asked` were asked for and the user's motion gives `own`."""
    missing = min(asked - own, max(asked // SHORT_SHARE, FEWEST))
    return max(asked // SHARE, min(asked // FEW_SHARE, FEW), missing, 1)
