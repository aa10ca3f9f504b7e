"""The clips that an avatar's file holds for playback: those that the user gave, whole, by their own names."""

from collections.abc import Iterable, Sequence

import numpy as np

from mua.baking.plan import ENDING
from mua.baking.settings import ALL, NONE
from mua.errors import InputError
from mua.pose.clip import Clip, is_range, show_one_pose
from mua.recording import RecordedClip

LOOKED_AT = 512  # frames, evenly over all clips, of which the most typical is pictured


def whole_clips(recorded: Iterable[RecordedClip]) -> list[Clip]:
    """The clips of a recording, each with its held-out end joined to it again; rest poses and those held out come last.

    A player begins with the first one, and what a teacher's program holds out is often a piece of a second. The
    built-in range of motion is for training, unless there is nothing else.
    """
    recorded = list(recorded)
    recorded = [clip for clip in recorded if not is_range(clip.name)] or recorded
    clips = {clip.name: clip for clip in sorted(filter(len, recorded), key=_begins_late)}
    ends = {name: beginning for name, clip in clips.items() if (beginning := _beginning(clip, clips)) is not None}
    joined = {beginning.name: clips[name] for name, beginning in ends.items()}
    plain = [Clip(name, own.rate, own.rotations, own.translations) for name, own in clips.items() if name not in ends]
    return [clip.then(joined[clip.name]) if clip.name in joined else clip for clip in plain]


def _begins_late(clip: RecordedClip) -> tuple[bool, bool]:
    return clip.held_out, show_one_pose([clip])


def range_clips(recorded: Iterable[RecordedClip], clips: Sequence[Clip]) -> list[Clip]:
    """The recorded clips of the built-in range of motion, where it is none of `clips`, those for playback."""
    own = {clip.name for clip in clips}
    return [clip for clip in recorded if is_range(clip.name) and not own & {clip.name, clip.name.removesuffix(ENDING)}]


def choose(clips: Sequence[Clip], wanted: Sequence[str]) -> tuple[Clip, ...]:
    """The clips that `--clips` means: some by name, or one of "all", "none" and a number of clips from the first on.

    Errors: InputError for a name that no clip has.
    """
    by_name = {clip.name: clip for clip in clips}
    if len(wanted) == 1 and wanted[0] not in by_name:
        (word,) = wanted
        if word in (ALL, NONE):
            return tuple(clips) if word == ALL else ()
        if word.isdecimal():
            return tuple(clips[: int(word)])
    for name in wanted:
        if name not in by_name:
            expected = f"{', '.join(by_name)}; or {ALL}, {NONE} or a number"
            raise InputError(f"--clips {name}: there is no such clip; expected {expected}")
    return tuple(by_name[name] for name in dict.fromkeys(wanted))


def held_out(recorded: Sequence[RecordedClip]) -> dict[str, int]:
    """From which frame on each clip that was held out of training was, by the clip's own name."""
    clips = {clip.name: clip for clip in recorded if len(clip)}
    starts = {}
    for name, clip in clips.items():
        beginning = _beginning(clip, clips)
        if beginning is not None:
            starts[beginning.name] = len(beginning)
        elif clip.held_out:
            starts[name] = 0
    return starts


def held_out_sentence(starts: dict[str, int]) -> str:
    """What was held out, for a person who reads it in the file."""
    clips = [name if start == 0 else f"{name} from frame {start}" for name, start in starts.items()]
    return f"held out of training: {', '.join(clips)}" if clips else "no clip was held out of training"


def typical_frame(
    clips: Sequence[Clip],
    *,
    root: int,  # joint whose heading does not count
) -> tuple[Clip, int]:
    """The clip and frame whose pose is nearest to the mean of all: what an image of the character shows."""
    owners = [(clip, frame) for clip in clips for frame in range(len(clip))]
    owners = owners[:: -(-len(owners) // LOOKED_AT)]
    rotations = np.stack([np.delete(clip.rotations[frame], root, axis=0) for clip, frame in owners])  # [F, J - 1, 4]
    rotations = np.where(np.sum(rotations * rotations[:1], axis=-1, keepdims=True) < 0, -rotations, rotations)
    away = np.square(rotations - rotations.mean(axis=0)).sum(axis=(1, 2))
    return owners[int(np.argmin(away))]


def _beginning(clip: RecordedClip, clips: dict[str, RecordedClip]) -> RecordedClip | None:
    """The clip whose held-out end `clip` is."""
    name = clip.name.removesuffix(ENDING)
    beginning = clips.get(name) if name != clip.name and clip.held_out else None
    return None if beginning is None or beginning.held_out else beginning
