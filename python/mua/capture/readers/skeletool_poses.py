"""Characters and poses of Skeletool where UMA and its family keep them, as clips of a capture."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from mua.capture.capture import Capture, CaptureClip
from mua.characters.animation import Animation
from mua.characters.formats import SKELETOOL, SKELETOOL_MOTION
from mua.characters.skeletool.motion import first_frame
from mua.characters.skeletool.read import read_skeletool_motion
from mua.errors import InputError
from mua.motion.poses_file import write_poses

DEPTH = 3  # folders below which a character is looked for
POSES = "poseAngles.motion"  # the poses in the world; the files beside it have them relative to others
TRAINING, TESTING = "skeletoolToGTPose", "skeletoolToGTPose_test"


def find_character(roots: Sequence[Path]) -> Path:
    """The only .character in some folders; raises InputError where there is none, or several."""
    patterns = ["*/" * depth + f"*{SKELETOOL}" for depth in range(DEPTH)]
    found = [path for root in roots for pattern in patterns for path in sorted(root.glob(pattern))]
    if not found:
        listed = " and ".join(str(root) for root in roots)
        raise InputError(f"{listed}: found no {SKELETOOL} of the person; give --template and --motion")
    if len(found) > 1:
        raise InputError(f"found {found[0]} and {found[1]}; give one of them with --template")
    return found[0]


def find_poses(character: Path, *, held_out: bool) -> Path:
    """The poses of the training frames, or those that are held out, that lie with a character."""
    folder = character.parent
    places = [folder / TESTING / POSES] if held_out else [folder / TRAINING / POSES, folder / POSES]
    found = next((place for place in places if place.is_file()), None)
    if found is None:
        raise InputError(f"{places[0]}: there is no such file with the poses; give them with --motion")
    return found


def with_poses(capture: Capture, character: Path | None) -> Capture:
    """The capture with poses of Skeletool written below its folder, one for each frame; other motion stays as it is.

    Frames of the videos have the numbers that the .motion says; those without a pose are left out. Poses are those of
    `character`; None: of the one that lies with them. Errors: InputError that names file and line.
    """
    read = [_posed(clip, capture.rate, character) for clip in capture.clips]
    for clip, posed in read:
        if posed is not None:
            write_poses(_file(capture, clip), posed.skeleton, posed.clips[0])
    return replace(
        capture,
        clips=tuple(clip if posed is None else replace(clip, motion=_file(capture, clip)) for clip, posed in read),
    )


def _file(capture: Capture, clip: CaptureClip) -> Path:
    return capture.folder / "motion" / f"{clip.name}.npz"


def _posed(clip: CaptureClip, rate: float, character: Path | None) -> tuple[CaptureClip, Animation | None]:
    """The clip with the frames that have a pose, and its poses; None for motion that is not Skeletool's."""
    if clip.motion.suffix.lower() != SKELETOOL_MOTION:
        return clip, None
    posed, first = read_skeletool_motion(clip.motion, character=character, rate=rate), first_frame(clip.motion)
    frames = min(clip.frames - first, len(posed.clips[0]))
    if frames < 1:
        raise InputError(f"{clip.motion}: begins with frame {first}, the videos of {clip.name!r} have {clip.frames}")
    return replace(clip, frames=frames, first_image=first), posed
