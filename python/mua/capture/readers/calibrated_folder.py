"""Captures that were calibrated with a public tool: a folder of videos or images for each camera, and its file."""

import re
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path, PurePosixPath

import numpy as np

from mua.arrays import Array
from mua.capture.capture import Capture, CaptureClip
from mua.capture.pictures import picture_size
from mua.capture.readers.avatarrex import below
from mua.capture.readers.calibrations import read_cameras
from mua.capture.readers.calibrations.calibrated import Calibrated
from mua.capture.readers.numbered import complete_frames, number_of, numbered_files, numbered_pattern, whole_runs
from mua.capture.video import VIDEOS, count_frames, video_frame, video_rate
from mua.errors import InputError

IMAGES = ("images", "imgs", "rgbs", "videos", "video")
MASKS = ("masks", "mask", "mask_cihp")
RATE = 30.0  # frames per second of images, where it is not given


@dataclass(frozen=True)
class _Filmed:
    """The images or videos of one kind, by camera."""

    folder: Path
    cameras: tuple[str, ...]
    pattern: str  # of files below the folder

    @property
    def is_video(self) -> bool:
        return "{frame" not in self.pattern

    def first(self) -> Path:
        return self.folder / self.pattern.format(camera=self.cameras[0], frame=self.numbers()[0])

    def numbers(self) -> range:
        """Numbers of the frames that the first camera has."""
        name = self.cameras[0]
        if self.is_video:
            return range(min(count_frames(self.folder / self.pattern.format(camera=one)) for one in self.cameras))
        files = numbered_files((self.folder / self.pattern.format(camera=name, frame=0)).parent)
        return range(number_of(files[0]), number_of(files[-1]) + 1)

    def size(self, camera: str, like: tuple[int, int] | None) -> tuple[int, int]:
        """Width and height of a camera's images, which was calibrated for those of a size `like`."""
        if self.is_video:
            frame = video_frame(self.folder / self.pattern.format(camera=camera), 0)
            return frame.shape[1], frame.shape[0]
        files = numbered_files((self.folder / self.pattern.format(camera=camera, frame=0)).parent)
        return picture_size(files[0], like=like)


def read_calibrated(
    source: Path,
    folder: Path,
    *,
    calibration: Path,
    template: Path,
    motion: Path,
    rate: float | None = None,  # frames per second; None: that of the videos
    scale: float = 1.0,  # metres in one unit of the calibration
    axes: Array | None = None,  # [3, 3] from our world to the calibration's
    height: float | None = None,
    leave_out: Sequence[str] = (),
) -> Capture:
    """The capture of a folder whose images or videos lie in images/ or videos/, masks in masks/.

    Frames of which a camera lacks image or mask are left out: each run of frames that all have is a clip.
    Errors: InputError with one sentence.
    """
    calibrated = read_cameras(calibration)
    images, masks = (_filmed(_folders(source, names)) for names in (IMAGES, MASKS))
    if images is None:  # in ZJU-MoCap, folders of cameras lie in that of the capture
        known = {_short(one.name) for one in calibrated}
        images = _numbered(source, [path for path in _folders(source, ("*",)) if _short(path.name) in known])
    if images is None:
        raise InputError(
            f"{source}: found no images; looked for videos/cam00.mp4 and images/cam00/000000.jpg: a folder or a video "
            "for each of several cameras that stand still"
        )
    pairs = _paired(calibrated, images, calibration)
    turned = np.eye(3) if axes is None else axes
    cameras = tuple(one.camera(images.size(name, one.size), name=name, scale=scale, axes=turned) for one, name in pairs)
    return Capture(
        folder=folder,
        name=source.absolute().name,
        rate=rate or (video_rate(images.first()) if images.is_video else RATE),
        template=template,
        cameras=cameras,
        clips=_clips(images, masks, motion),
        images=below(images.folder, images.pattern),
        masks=None if masks is None else below(masks.folder, masks.pattern),
        template_height=height,
        leave_out=tuple(leave_out),
    )


def _folders(source: Path, names: Sequence[str]) -> list[Path]:
    return [path for name in names for path in sorted(source.glob(name)) if path.is_dir()]


def _filmed(folders: Sequence[Path]) -> _Filmed | None:
    for folder in folders:
        videos = sorted(file for file in folder.iterdir() if file.suffix.lower() in VIDEOS)
        if videos:
            suffix = videos[0].suffix
            names = tuple(file.stem for file in videos if file.suffix == suffix)
            return _Filmed(folder, names, f"{{camera}}{suffix}")
        if found := _numbered(folder, _folders(folder, ("*",))):
            return found
    return None


def _numbered(folder: Path, cameras: Sequence[Path]) -> _Filmed | None:
    names = tuple(path.name for path in cameras if numbered_files(path))
    pattern = numbered_pattern(folder, "{camera}", names)
    return _Filmed(folder, names, pattern) if pattern else None


def _paired(calibrated: Sequence[Calibrated], images: _Filmed, calibration: Path) -> list[tuple[Calibrated, str]]:
    """Every camera that has images, with their name: by name, or in order where no name is the same."""
    named = {_short(one.name): one for one in calibrated}
    if len(named) < len(calibrated):
        names = [_short(one.name) for one in calibrated]
        twice = next(one for one in calibrated if names.count(_short(one.name)) > 1)
        raise InputError(f"{twice.where}: two cameras are called {_short(twice.name)}; expected one for each")
    alike = [name for name in images.cameras if _short(name) in named]
    if not alike and len(images.cameras) == len(calibrated):
        return list(zip(calibrated, images.cameras, strict=True))
    missing = next((name for name in images.cameras if name not in alike), None)
    if missing is not None:
        raise InputError(
            f"{calibration}: has no camera called {missing}, as images in {images.folder} are; "
            f"it has {', '.join(one.name for one in calibrated)}"
        )
    return [(named[_short(name)], name) for name in images.cameras]


def _short(name: str) -> str:
    """A camera's name without what tools write differently: cam_01, Cam01 and cam01/000000 are the same."""
    folder = PurePosixPath(name).parts[0]
    return re.sub(r"[^0-9a-z]", "", folder.lower())


def _clips(images: _Filmed, masks: _Filmed | None, motion: Path) -> tuple[CaptureClip, ...]:
    numbers = images.numbers()
    kinds = [one for one in (images, masks) if one is not None and not one.is_video]
    found = [complete_frames(one.folder, (one.pattern,), images.cameras, numbers) for one in kinds]
    runs = whole_runs([all(one[i] for one in found) for i in range(len(numbers))])
    if not runs:
        there = (
            one.folder / one.pattern.format(camera=name, frame=i)
            for i in numbers
            for one in kinds
            for name in images.cameras
        )
        missing = next((file for file in there if not file.is_file()), None)
        raise InputError(
            f"{images.folder}: no two frames in a row have images and masks of all {len(images.cameras)} cameras"
            + ("" if missing is None else f"; {missing} is the first that is not there")
        )
    names = [f"frames_{numbers[first]:06d}" for first, _ in runs] if len(runs) > 1 else ["all"]
    return tuple(
        CaptureClip(name, motion, first, frames, first_image=numbers[first])
        for name, (first, frames) in zip(names, runs, strict=True)
    )
