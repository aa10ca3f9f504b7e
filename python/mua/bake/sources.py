"""What a bake starts from: a character, and clips of motion on its skeleton."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Literal

from mua.errors import InputError
from mua.motion.clip import Clip
from mua.motion.read import read_motion
from mua.motion.resample import resample
from mua.motion.retarget import retarget
from mua.motion.source import SourceMotion
from mua.rig.character import Character
from mua.rig.read import read_character
from mua.rig.skeleton import Skeleton
from mua.teachers.procedural import procedural_character

RATE = 30.0  # frames per second of every clip, and of the window that the student sees
ATLAS = 1024  # texels of the base-colour atlas along a side


def load_character(path: Path | None, *, uv: Literal["keep", "unwrap", "auto"], seed: int) -> Character:
    """The character in the file at `path`, or the procedural one where no path is given."""
    return procedural_character(seed=seed) if path is None else read_character(path, uv=uv, atlas_size=ATLAS)


def load_clips(
    character: Character,
    motions: Sequence[Path],
    *,
    mapping: Mapping[str, str] | None,
) -> tuple[list[Clip], list[str]]:
    """The clips of `motions` put on the character, or the character's own; and what is worth telling of them.

    Clips of one name are told apart by a number. Errors: InputError where there is no motion at all.
    """
    if not motions:
        if not character.clips:
            raise InputError(f"{character.name}: holds no animation: give --motion a file or directory")
        return [resample(clip, RATE) for clip in character.clips], []
    clips: list[Clip] = []
    notes: list[str] = []
    for path in motions:
        for source in read_motion(path):
            if same_joints(source.skeleton, character.skeleton):
                clip, told = resample(source.clip, RATE), source.notes
            else:
                clip, told = _retargeted(path, source, character.skeleton, mapping=mapping)
            clips.append(clip)
            notes += told
    return unique_names(clips), list(dict.fromkeys(notes))


def _retargeted(
    path: Path, source: SourceMotion, skeleton: Skeleton, *, mapping: Mapping[str, str] | None
) -> tuple[Clip, tuple[str, ...]]:
    try:
        return retarget(source, skeleton, mapping=mapping, rate=RATE)
    except InputError as error:
        raise InputError(f"{path}: {error}") from error


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
