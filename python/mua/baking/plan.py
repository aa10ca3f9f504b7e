"""Which clips are held out and which frames are recorded."""

from collections.abc import Collection, Sequence
from dataclasses import dataclass, replace

import numpy as np

from mua.arguments import amount
from mua.errors import InputError
from mua.pose.clip import Clip, is_range
from mua.pose.skeleton import Pose
from mua.recording import PlannedClip

HELD_SHARE = 5  # without --hold-out, the last fifth of every clip is held out
HELD_FRAMES = 40  # recorded of each held-out clip at most, all of them whole
HELD_PART = 4  # all held-out clips together get at most a quarter as many frames as training
HELD_MOST = 200  # nor more than so many: errors are means over them
WHOLE_FRAMES = 60  # training frames kept whole to measure the error on
SHORTEST = 2 * HELD_SHARE  # frames of a clip that is worth cutting
RUN_UP = 2.0  # seconds before a held-out end that a teacher plays first, so that its cloth is in motion
USUAL_POSES = 4  # of the motion that is trained on, for what is alike in all of it
ENDING = " (end)"  # after a clip's name: its held-out end, recorded as a clip of its own


@dataclass(frozen=True)
class HeldOut:
    """A clip that is held out, and what of a training clip comes before it."""

    clip: Clip
    run_up: Clip | None = None


def split(clips: Sequence[Clip], hold_out: Collection[str]) -> tuple[list[Clip], list[HeldOut]]:
    """Training and held-out clips: those named, or the end of every clip where none is.

    Errors: InputError for a name that no clip has, or where nothing is left to train on.
    """
    names = [clip.name for clip in clips]
    for name in hold_out:
        if name not in names:
            raise InputError(f"--hold-out {name}: there is no such clip; expected {', '.join(names)}")
    if not hold_out:
        return _cut(clips)
    training = [clip for clip in clips if clip.name not in hold_out]
    if not training:
        raise InputError(f"--hold-out {' '.join(hold_out)}: leaves no clip to train on")
    return training, [HeldOut(clip) for clip in clips if clip.name in hold_out]


def _cut(clips: Sequence[Clip]) -> tuple[list[Clip], list[HeldOut]]:
    names = {clip.name for clip in clips}
    training, held = [], []
    for clip in clips:
        at, end = len(clip) - len(clip) // HELD_SHARE, clip.name + ENDING
        if len(clip) < SHORTEST or end in names:  # a clip that already has that name: both stay whole
            training.append(clip)
            continue
        training.append(clip.cut(slice(at)))
        run_up = clip.cut(slice(max(at - round(RUN_UP * clip.rate), 0), at))
        held.append(HeldOut(replace(clip.cut(slice(at, None)), name=end), run_up))
    return training, held


def plan(training: Sequence[Clip], held: Sequence[HeldOut], *, frames: int) -> list[PlannedClip]:
    """Record `frames` training frames, evenly over all training clips, and up to a quarter as many held-out ones.

    These are no more than HELD_MOST. Every held-out clip gets its share of them; some get none where there are more
    clips than frames.
    """
    if frames < 1:
        raise InputError(f"--frames {frames}: expected at least 1")
    starts = np.cumsum([0, *(len(clip) for clip in training)])
    chosen = _evenly(int(starts[-1]), frames)
    kept = chosen[_evenly(len(chosen), WHOLE_FRAMES)]
    planned = []
    for clip, start, stop in zip(training, starts[:-1], starts[1:], strict=True):
        wanted, whole = (frozenset((f[(f >= start) & (f < stop)] - start).tolist()) for f in (chosen, kept))
        planned.append(PlannedClip(clip, held_out=False, wanted=wanted, whole=whole))
    for own, count in zip(held, _shares(min(max(frames // HELD_PART, 1), HELD_MOST), len(held)), strict=True):
        wanted = frozenset(_evenly(len(own.clip), min(count, HELD_FRAMES)).tolist())
        planned.append(PlannedClip(own.clip, held_out=True, wanted=wanted, whole=wanted, run_up=own.run_up))
    return planned


def describe_plan(planned: Sequence[PlannedClip], ranges: Sequence[PlannedClip], *, asked: int) -> str:
    """How many frames are recorded of `planned` clips and of the built-in range of motion, and why."""
    training, held = ([clip for clip in planned if clip.held_out is held_out] for held_out in (False, True))
    wanted, there = sum(len(clip.wanted) for clip in training), sum(len(clip.clip) for clip in training)
    asks = f"the preset or --frames asks for {asked:,}"
    own = f"{wanted:,} of {there:,} training frames, spread evenly over {_clips(training)} ({asks})"
    if wanted == there:
        own = f"all {there:,} training frames of {_clips(training)} ({asks})"
    parts = [own]
    if count := sum(len(clip.wanted) for clip in held):
        parts.append(f"{amount(count, 'held-out frame')} to measure errors on")
    if count := sum(len(clip.wanted) for clip in ranges):
        parts.append(f"{amount(count, 'frame')} of the built-in range of motion (--motion-range none leaves them out)")
    return f"Recorded are {', '.join(parts[:-1])}{' and ' if len(parts) > 1 else ''}{parts[-1]}."


def usual_poses(planned: Sequence[PlannedClip]) -> list[Pose]:
    """A few poses of the motion that is trained on, evenly spaced; none of the built-in range of motion."""
    training = [item for item in planned if not item.held_out and not is_range(item.clip.name)]
    frames = [(item.clip, frame) for item in training for frame in sorted(item.wanted)]
    return [clip.pose(frame) for clip, frame in (frames[at] for at in _evenly(len(frames), USUAL_POSES))]


def _clips(planned: Sequence[PlannedClip]) -> str:
    return amount(len(planned), "clip")


def _shares(total: int, parts: int) -> list[int]:
    """`total` as that many whole numbers, alike but for one."""
    return [total * (part + 1) // parts - total * part // parts for part in range(parts)]


def _evenly(count: int, wanted: int) -> np.ndarray:
    """At most `wanted` of `count` indices, ascending, each in the middle of its share."""
    wanted = min(count, wanted)
    return ((np.arange(wanted) + 0.5) * count / wanted).astype(int)
