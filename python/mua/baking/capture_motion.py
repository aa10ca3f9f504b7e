"""What a teacher trained on a capture is recorded on, and what its student reads of it.

Its light stands still in the world, so that colours depend on the heading: the student's descriptor keeps it, as the
paper's does (Data Assumption), and training clips are recorded facing other ways as well.
"""

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from mua import rotation
from mua.baking.plan import HeldOut, plan
from mua.baking.sources import load_clips
from mua.capture import Capture
from mua.motion.planted_feet import Feet
from mua.pose.clip import Clip
from mua.pose.encoding import RATE
from mua.pose.resample import resample
from mua.pose.skeleton import Skeleton
from mua.recording import PlannedClip
from mua.rig.character import Character
from mua.rig.rig import Rig
from mua.student.settings import Settings

UP = np.array([0.0, 1, 0])
HEADINGS = 4  # that training clips are recorded at, the filmed one included


def filmed_settings(settings: Settings, texels: int) -> Settings:
    """Settings of a student of such a teacher."""
    return replace(settings, texels=texels, generalisation=replace(settings.generalisation, remove_heading=False))


def filmed_clips(capture: Capture) -> list[Clip]:
    """The motion of a capture's clips, held-out ones too, at the rate of recordings."""
    return [resample(capture.moving(clip.name), RATE) for clip in capture.clips]


def put_on(
    rig: Rig,
    roles: Mapping[str, str],
    motions: Sequence[Path],
    *,
    mapping: Mapping[str, str] | None = None,
    feet: Feet = "auto",
) -> tuple[list[Clip], list[str]]:
    """The clips of motion files on a teacher's skeleton, and notes on them."""
    if not motions:
        return [], []
    moved = Character(  # as the skeleton that motion is put on
        "teacher",
        rig.skeleton,
        rig.mesh,
        rig.skin_indices,
        rig.skin_weights,
        base_color=np.zeros((1, 1, 4), np.uint8),
        roles=roles,
    )
    return load_clips(moved, motions, mapping=mapping, feet=feet)


def plan_headings(
    skeleton: Skeleton,
    training: Sequence[Clip],
    held: Sequence[HeldOut],
    *,
    filmed: Collection[str],  # names of the training clips that cameras have seen
    frames: int,
) -> list[PlannedClip]:
    """Record `frames` training frames: of filmed clips and of others, as they are and turned to other headings.

    Filmed clips as they are get up to half of the frames, the other three an equal share of the rest each; what one of
    these has no need of goes to the others.
    """
    parts = [[clip for clip in training if (clip.name in filmed) == own] for own in (True, False)]
    groups = [group for part in parts if part for group in (part, _other_headings(skeleton, part))]
    first, *others = [sum(map(len, group)) for group in groups]
    first = min(first, frames - frames // 2)
    counts = [first, *_share(frames - first, others)]
    planned = [plan(group, [], frames=count) for group, count in zip(groups, counts, strict=True) if count]
    return [clip for group in (*planned, plan([], held, frames=frames)) for clip in group]


def turned(clip: Clip, skeleton: Skeleton, angle: float) -> Clip:
    """A clip turned about the world's Y axis by an angle in radians."""
    turn = rotation.from_axis_angle(UP, angle)
    tops = np.flatnonzero(skeleton.parents < 0)
    rotations, translations = clip.rotations.copy(), clip.translations.copy()
    rotations[:, tops] = rotation.multiply(turn, rotations[:, tops])
    translations[:, tops] = rotation.rotate(turn, translations[:, tops])
    return replace(clip, rotations=rotations, translations=translations)


def _other_headings(skeleton: Skeleton, clips: Sequence[Clip]) -> list[Clip]:
    return [
        replace(
            turned(clip, skeleton, 2 * np.pi * part / HEADINGS), name=f"{clip.name} ({360 * part // HEADINGS} degrees)"
        )
        for part in range(1, HEADINGS)
        for clip in clips
    ]


def _share(total: int, needs: Sequence[int]) -> list[int]:
    """`total` shared alike among parts, none of which gets more than it needs while another lacks any."""
    given = [0] * len(needs)
    for place, part in enumerate(sorted(range(len(needs)), key=needs.__getitem__)):
        given[part] = min(needs[part], (total - sum(given)) // (len(needs) - place))
    return given
