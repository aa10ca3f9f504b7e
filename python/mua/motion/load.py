"""Motion from files as clips on a character's own skeleton."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

from mua.errors import InputError
from mua.motion.clip import Clip
from mua.motion.read import read_motion
from mua.motion.resample import resample
from mua.motion.retarget import retarget
from mua.motion.source import SourceMotion
from mua.rig.skeleton import Skeleton


def load_motion(
    path: Path,
    skeleton: Skeleton,
    *,
    mapping: Mapping[str, str] | None,  # joint of `skeleton` to joint of the file, before any match by name
    rate: float,  # frames per second of the clips returned
) -> tuple[list[Clip], tuple[str, ...]]:
    """The clips of a motion file, or of every file of a directory, on `skeleton`, and notes worth telling the user.

    Motion on the very same skeleton is taken as it stands; any other is retargeted.
    Errors: InputError naming the file where it cannot be read or none of its joints is matched.
    """
    clips: list[Clip] = []
    notes: list[str] = []
    for source in read_motion(path):
        if same_joints(source.skeleton, skeleton):
            clip, told = resample(source.clip, rate), source.notes
        else:
            clip, told = _retargeted(path, source, skeleton, mapping=mapping, rate=rate)
        clips.append(clip)
        notes += told
    return clips, tuple(dict.fromkeys(notes))


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


def _retargeted(
    path: Path, source: SourceMotion, skeleton: Skeleton, *, mapping: Mapping[str, str] | None, rate: float
) -> tuple[Clip, tuple[str, ...]]:
    try:
        return retarget(source, skeleton, mapping=mapping, rate=rate)
    except InputError as error:
        raise InputError(f"{path}: {error}") from error
