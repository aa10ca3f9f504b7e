"""Motion from files as clips on a character's own skeleton."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from mua.errors import InputError
from mua.motion.face import own_face
from mua.motion.leading_pose import without_leading_pose
from mua.motion.long_feet import put_down
from mua.motion.match import Matches, match_joints, require_limbs
from mua.motion.planted_feet import Feet, plant_feet
from mua.motion.read import read_motion
from mua.motion.retarget import retarget
from mua.motion.source_motion import SourceMotion
from mua.pose.clip import Clip
from mua.pose.resample import resample
from mua.pose.skeleton import Skeleton

POSES = 12  # frames that show what joints are, where neither names nor the rest pose do


@dataclass(frozen=True)
class LoadedMotion:
    """A clip on a character, and what it was made from."""

    clip: Clip
    source: SourceMotion
    matches: Matches
    notes: tuple[str, ...]  # worth telling the user, a sentence each


def load_motions(
    path: Path,
    skeleton: Skeleton,
    *,
    mapping: Mapping[str, str] | None,  # joint of `skeleton` to joint of the file, before any match by name
    rate: float,  # frames per second of the clips returned
    roles: Mapping[str, str] | None = None,  # joint of `skeleton` to role, where the character's file itself says it
    feet: Feet = "auto",  # whether standing feet are held in place
    refuse: bool = True,  # whether motion that moves no arm, leg or spine of the character is an error, else a note
    face: Sequence[str] = (),  # names of the character's expressions, which follow those of the motion
) -> list[LoadedMotion]:
    """The clips of a motion file, or of every file of a directory, on `skeleton`, each with what it was made from.

    Motion on the very same skeleton is taken as it stands; any other is retargeted.
    Errors: InputError naming the file where it cannot be read or moves no arm, leg or spine of the character.
    """
    return [
        replace(put, clip=own_face(source, put.clip, face))
        for source in map(without_leading_pose, read_motion(path))
        for put in [
            _put_on(
                path,
                source,
                skeleton,
                mapping=mapping,
                rate=rate,
                roles=roles,
                feet=feet,
                refuse=refuse and not mapping,
            )
        ]
    ]


def same_joints(a: Skeleton, b: Skeleton) -> bool:
    """Whether motion on one skeleton is motion on the other as it stands."""
    same = a.names == b.names and a.root == b.root and (a.parents == b.parents).all()
    return bool(same and abs(a.bind_translations - b.bind_translations).max() < 1e-4)


def unique_names(clips: Sequence[Clip]) -> list[Clip]:
    """The clips, with a number after every name that came before."""
    seen: dict[str, int] = {}
    named = []
    for clip in clips:
        count = seen[clip.name] = seen.get(clip.name, 0) + 1
        named.append(clip if count == 1 else replace(clip, name=f"{clip.name} {count}"))
    return named


def counted(notes: Sequence[str], clips: Sequence[Clip]) -> tuple[str, ...]:
    """Every sentence once; where several clips share one, it counts them instead of naming one."""
    names = {clip.name for clip in clips}
    by_sentence: dict[str, list[str]] = {}
    for note in notes:
        owner, _, sentence = note.partition(": ")
        by_sentence.setdefault(sentence if {owner, Path(owner).stem} & names else note, []).append(note)
    return tuple(own[0] if len(own) == 1 else f"{len(own)} clips: {sentence}" for sentence, own in by_sentence.items())


def _put_on(
    path: Path,
    source: SourceMotion,
    skeleton: Skeleton,
    *,
    mapping: Mapping[str, str] | None,
    rate: float,
    roles: Mapping[str, str] | None,
    feet: Feet,
    refuse: bool,
) -> LoadedMotion:
    try:
        same = same_joints(source.skeleton, skeleton)
        matches = match_joints(
            source.skeleton,
            skeleton,
            None if same else mapping,
            source_stated=source.stated,
            target_stated=roles,
            source_poses=source.places(POSES),
        )
        if same:
            return LoadedMotion(resample(source.clip, rate), source, matches, source.notes)
        if refuse:
            require_limbs(source.skeleton, skeleton, matches)
        clip, notes = retarget(source, skeleton, matches, rate=rate)
        clip, down = (clip, ()) if feet == "keep" else put_down(source, skeleton, clip, matches)
        clip, held = plant_feet(source, skeleton, clip, matches, feet=feet)
    except InputError as error:
        raise error.of(path) from error
    return LoadedMotion(clip, source, matches, (*notes, *down, *held))
