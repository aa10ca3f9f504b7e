"""The motion that an avatar plays: a clip of its file, or motion from another file."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from mua.arrays import Array
from mua.asset.avatar import Avatar
from mua.characters.messages import listed
from mua.errors import InputError
from mua.live.live_pose import Live
from mua.live.receiver import Receiver
from mua.motion.face import with_face
from mua.motion.load import counted, load_motions, unique_names
from mua.pose.clip import Clip
from mua.pose.expression_names import set_weights
from mua.pose.resample import resample

LIVE = "live"  # name of the clip that stands for what another program sends


def player_clips(
    avatar: Avatar,
    file: Path,  # the avatar's file, for error messages
    *,
    motion: Path | None,
    mapping: Mapping[str, str] | None,
    face: Path | None = None,
) -> tuple[list[Clip], tuple[str, ...]]:
    """All clips of `motion`, or of the avatar's own file, at the avatar's rate; and notes for the user.

    With `face`, each has the facial motion of that file.
    Errors: InputError where there is none, or where no joint of `motion` or expression of `face` matches.
    """
    clips, notes = _body_clips(avatar, file, motion=motion, mapping=mapping)
    if face is None:
        return clips, notes
    faces, unused = with_face(clips, face, avatar.expressions)
    return faces, (*notes, *unused)


def _body_clips(
    avatar: Avatar, file: Path, *, motion: Path | None, mapping: Mapping[str, str] | None
) -> tuple[list[Clip], tuple[str, ...]]:
    rate = avatar.encoding.rate
    if motion is not None:
        loaded = load_motions(motion, avatar.rig.skeleton, mapping=mapping, rate=rate, face=avatar.expressions)
        clips = [one.clip for one in loaded]
        return unique_names(clips), counted([note for one in loaded for note in one.notes], clips)
    if not avatar.clips:
        raise InputError(f"{file} holds no clips; mua-view needs one to pose the avatar")
    return [resample(clip, rate) for clip in avatar.clips], ()


def live_of(
    avatar: Avatar,
    file: Path,  # the avatar's file, for error messages
    receiver: Receiver,
    mapping: Mapping[str, str] | None,
) -> Live:
    """An avatar that follows what another program sends.

    Errors: InputError where no bone moves an arm or leg, or `mapping` names a joint or bone there is none of.
    """
    try:
        return Live(
            receiver.newest, avatar.rig.skeleton, avatar.encoding, mapping=mapping, expressions=avatar.expressions
        )
    except InputError as error:
        raise error.of(file) from error


def stance(live: Live, rate: float) -> Clip:
    """What stands for a live pose among clips: one frame, as the avatar stands before a sender begins."""
    pose = live.at_ease.pose
    return Clip(LIVE, rate, pose.rotations[None], pose.translations[None])


def require_frame(clip: Clip, frame: int) -> int:
    """Return the frame; raises InputError where the clip does not have it."""
    if not 0 <= frame < len(clip):
        raise InputError(f"--frame is {frame}; clip {clip.name!r} has frames 0 to {len(clip) - 1}")
    return frame


def named_clip(
    clips: Sequence[Clip],
    name: str | None,
    *,
    source: Path,  # source of the clips, for error messages
) -> Clip:
    """The clip of that name, or the first."""
    names = [clip.name for clip in clips]
    if name is not None and name not in names:
        raise InputError(f"--clip is {name!r}; {source} holds {', '.join(names)}")
    return clips[0 if name is None else names.index(name)]


def with_weights(
    names: Sequence[str],  # [E] of the avatar's expressions
    weights: Array | None,  # [E] of a clip's frame; None: all 0
    named: Mapping[str, float],
) -> Array | None:
    """The weights of a frame, but those that follow what is named; names that move nothing here do nothing."""
    set_here = set_weights(names, named)
    if not set_here:
        return weights
    held = np.zeros(len(names)) if weights is None else np.array(weights, dtype=float)
    for name, weight in set_here.items():
        held[names.index(name)] = weight
    return held


def expressed(clip: Clip, names: Sequence[str], named: Mapping[str, float]) -> Clip:
    """The clip with these weights in all of its frames."""
    if not named:
        return clip
    frames = [with_weights(names, clip.pose(index).expressions, named) for index in range(len(clip))]
    return replace(clip, expressions=np.stack([frame for frame in frames if frame is not None]))


def require_expressions(names: Sequence[str], named: Mapping[str, float], *, file: Path) -> None:
    """Raises InputError for an expression that moves none of those of the avatar of a file."""
    for name in named:
        if not set_weights(names, {name: 1.0}):
            held = listed(names) or "no expressions"
            raise InputError(f"--expressions has {name!r}; {file} has {held}")
