"""Captures in the layout of UMA and its family: one video for each camera, and a calibration file of their tools.

Their characters and poses are not read: template and motion are given. Untried on real downloads.
"""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from mua.capture.avatarrex import below
from mua.capture.calibration_files import read_calibration
from mua.capture.capture import Capture, CaptureClip
from mua.capture.video import VIDEOS, count_frames, video_frame, video_rate
from mua.errors import InputError

STREAMS, MASKS = "stream*", "foregroundSegmentation"
CALIBRATIONS = ("cameras.calib", "*.calibration")


def is_streams(source: Path) -> bool:
    """Whether a folder has this layout."""
    return bool(_videos(source)) and bool(_calibrations(source))


def read_streams(
    source: Path,
    folder: Path,
    *,
    template: Path,
    motion: Path,
    height: float | None = None,
    leave_out: Sequence[str] = (),
) -> Capture:
    """The capture that a folder of this layout is; cameras and videos are paired in the order of both.

    Errors: InputError with one sentence.
    """
    videos, (calibration, *others) = _videos(source), _calibrations(source)
    if others:
        raise InputError(f"{source}: holds {calibration.name} and {others[0].name}; expected one calibration")
    first = video_frame(videos[0], 0)
    cameras = read_calibration(calibration, size=(first.shape[1], first.shape[0]))
    if len(cameras) != len(videos):
        raise InputError(f"{source}: has {len(videos)} videos, {calibration.name} has {len(cameras)} cameras")
    frames = min(count_frames(video) for video in videos)
    return Capture(
        folder=folder,
        name=source.name,
        rate=video_rate(videos[0]),
        template=template,
        cameras=tuple(replace(camera, name=video.stem) for camera, video in zip(cameras, videos, strict=True)),
        clips=(CaptureClip("all", motion, 0, frames),),
        images=below(videos[0].parent, f"{{camera}}{videos[0].suffix}"),
        masks=_masks(source, videos),
        template_height=height,
        leave_out=tuple(leave_out),
    )


def _videos(source: Path) -> list[Path]:
    """The videos of the cameras, in order."""
    folders = [source, *sorted(path for path in source.iterdir() if path.is_dir() and path.name != MASKS)]
    found = ([file for file in sorted(folder.glob(STREAMS)) if file.suffix.lower() in VIDEOS] for folder in folders)
    return next((videos for videos in found if videos), [])


def _calibrations(source: Path) -> list[Path]:
    return [file for pattern in CALIBRATIONS for file in sorted([*source.glob(pattern), *source.glob(f"*/{pattern}")])]


def _masks(source: Path, videos: Sequence[Path]) -> str:
    """The pattern of the masks: videos called as those of the cameras, or folders of pictures that count from 0."""
    folder, name = source / MASKS, videos[0].stem
    for suffix in VIDEOS:
        if (folder / f"{name}{suffix}").is_file():
            return below(folder, f"{{camera}}{suffix}")
    for file in sorted((folder / name).glob("[0-9]*")):
        if file.stem.isdecimal() and int(file.stem) == 0:
            return below(folder, f"{{camera}}/{{frame:0{len(file.stem)}d}}{file.suffix}")
        if file.stem.isdecimal():
            raise InputError(
                f"{file}: is the first mask of {name}; expected masks that are counted from 0, as frames are"
            )
    raise InputError(f"{folder}: found no masks of {name}; expected a video or a folder of that name")
