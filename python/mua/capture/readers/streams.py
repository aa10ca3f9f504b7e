"""Captures in the layout of UMA and its family: one video for each camera, a calibration file of their tools, masks,
and the person as a Skeletool character with poses. Untried on real downloads.

    Subject_0/
      training/stream000.mp4 ...     with foregroundSegmentation/ and recon_neus2/000000.ply ... beside them
      testing/                       the same, held out
    Subject_0_metadata/              or inside Subject_0/
      cameras.calib
      ddc_character/ddc.character    with skeletoolToGTPose/ and skeletoolToGTPose_test/
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

from mua.capture.camera import CaptureCamera
from mua.capture.capture import Capture, CaptureClip
from mua.capture.readers.avatarrex import below
from mua.capture.readers.calibration_files import read_calibration
from mua.capture.readers.skeletool_poses import find_character, find_poses, with_poses
from mua.capture.video import VIDEOS, count_frames, video_frame, video_rate
from mua.characters.formats import SKELETOOL
from mua.errors import InputError

STREAMS, MASKS, MESHES = "stream*", "foregroundSegmentation", "recon_neus2"
CALIBRATIONS = ("cameras.calib", "*.calibration")
METADATA = "_metadata"  # how the name of the folder ends that has calibration and character
TESTS = "test"  # how the name of a folder begins that is held out


@dataclass(frozen=True)
class _Take:
    """One recording by all cameras at once."""

    name: str
    folder: Path
    videos: tuple[Path, ...]

    @property
    def held_out(self) -> bool:
        return self.name.lower().startswith(TESTS)


def is_streams(source: Path) -> bool:
    """Whether a folder has this layout."""
    return bool(_takes(source)) and bool(_calibrations(source))


def read_streams(
    source: Path,
    folder: Path,
    *,
    template: Path | None = None,  # None: the character that lies with the videos
    motion: Path | None = None,  # None: the poses that lie with the character
    rate: float | None = None,  # frames per second; None: that of the videos
    height: float | None = None,
    leave_out: Sequence[str] = (),
) -> Capture:
    """The capture that a folder of this layout is; cameras and videos are paired in the order of both.

    Poses of Skeletool are written below `folder`. Errors: InputError with one sentence.
    """
    takes = _takes(source)
    if motion is not None and len(takes) > 1:
        names = " and ".join(take.name for take in takes)
        raise InputError(f"--motion {motion}: {source} holds {names}, which cannot share it; describe one of them")
    given = template if template is not None and template.suffix.lower() == SKELETOOL else None
    if motion is not None and template is not None:
        shown, motions = template, [motion]
    else:
        character = given or find_character(_roots(source))
        shown = template or character
        motions = [motion or find_poses(character, held_out=take.held_out) for take in takes]
    capture = Capture(
        folder=folder,
        name=source.name,
        rate=rate or video_rate(takes[0].videos[0]),
        template=shown,
        cameras=_cameras(source, takes),
        clips=tuple(
            CaptureClip(take.name, poses, 0, min(map(count_frames, take.videos)), held_out=take.held_out)
            for take, poses in zip(takes, motions, strict=True)
        ),
        images=_pattern(source, takes, f"{{camera}}{takes[0].videos[0].suffix}"),
        masks=_masks(source, takes),
        meshes=_meshes(source, takes),
        template_height=height,
        leave_out=tuple(leave_out),
    )
    return with_poses(capture, given)


def _takes(source: Path) -> list[_Take]:
    """The folder itself where the videos lie in it; else those of its folders that hold some, held-out ones last."""
    if own := _videos(source):
        return [_Take("all", source, own)]
    folders = [path for path in sorted(source.iterdir()) if path.is_dir() and path.name != MASKS]
    takes = [_Take(path.name, path, videos) for path in folders if (videos := _videos(path))]
    return sorted(takes, key=lambda take: take.held_out)


def _videos(folder: Path) -> tuple[Path, ...]:
    return tuple(file for file in sorted(folder.glob(STREAMS)) if file.suffix.lower() in VIDEOS)


def _roots(source: Path) -> list[Path]:
    """Where calibration and character may lie."""
    beside = source.absolute().with_name(source.absolute().name + METADATA)
    return [root for root in (source, beside) if root.is_dir()]


def _calibrations(source: Path) -> list[Path]:
    patterns = [f"{depth}{name}" for name in CALIBRATIONS for depth in ("", "*/")]
    return [file for root in _roots(source) for pattern in patterns for file in sorted(root.glob(pattern))]


def _cameras(source: Path, takes: Sequence[_Take]) -> tuple[CaptureCamera, ...]:
    """The cameras under the names of their videos."""
    calibration, *others = _calibrations(source)
    if others:
        raise InputError(f"{source}: holds {calibration.name} and {others[0].name}; expected one calibration")
    first = video_frame(takes[0].videos[0], 0)
    cameras = read_calibration(calibration, size=(first.shape[1], first.shape[0]))
    for take in takes:
        if len(cameras) != len(take.videos):
            raise InputError(
                f"{take.folder}: has {len(take.videos)} videos, {calibration.name} has {len(cameras)} cameras"
            )
    return tuple(replace(camera, name=video.stem) for camera, video in zip(cameras, takes[0].videos, strict=True))


def _pattern(source: Path, takes: Sequence[_Take], name: str) -> str:
    """The pattern of files that lie alike beside the videos of each take."""
    return below(takes[0].folder, name) if len(takes) == 1 else below(source, f"{{clip}}/{name}")


def _masks(source: Path, takes: Sequence[_Take]) -> str:
    """The pattern of the masks, which must be the same for all takes."""
    first, *others = [_mask_name(take) for take in takes]
    for take, name in zip(takes[1:], others, strict=True):
        if name != first:
            raise InputError(f"{take.folder / MASKS}: masks are called {name}, those of {takes[0].name} {first}")
    return _pattern(source, takes, f"{MASKS}/{first}")


def _mask_name(take: _Take) -> str:
    """How the masks of a take are called: videos as those of the cameras, or folders of images that count from 0."""
    folder, name = take.folder / MASKS, take.videos[0].stem
    for suffix in VIDEOS:
        if (folder / f"{name}{suffix}").is_file():
            return f"{{camera}}{suffix}"
    for file in sorted((folder / name).glob("[0-9]*")):
        if file.stem.isdecimal() and int(file.stem) == 0:
            return f"{{camera}}/{{frame:0{len(file.stem)}d}}{file.suffix}"
        if file.stem.isdecimal():
            raise InputError(
                f"{file}: is the first mask of {name}; expected masks that are counted from 0, as frames are"
            )
    raise InputError(f"{folder}: found no masks of {name}; expected a video or a folder of that name")


def _meshes(source: Path, takes: Sequence[_Take]) -> str | None:
    """The pattern of a surface for each frame; None where a take has none."""
    name = f"{MESHES}/{{frame:06d}}.ply"
    there = all((take.folder / name.format(frame=0)).is_file() for take in takes if not take.held_out)
    return _pattern(source, takes, name) if there else None
