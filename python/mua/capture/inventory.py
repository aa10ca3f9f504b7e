"""Which files of a capture are there, without opening the images."""

from collections.abc import Iterator
from pathlib import Path

from mua.capture.capture import FRAME, Capture, CaptureClip
from mua.capture.video import VIDEOS, count_frames, video_rate
from mua.errors import InputError


def missing_files(capture: Capture) -> Iterator[str]:
    """A sentence for each camera of which images, masks or the background are not there or end too early."""
    for camera in capture.cameras:
        for field, what in (("images", "images"), ("masks", "masks"), ("backgrounds", "backgrounds")):
            pattern = getattr(capture, field)
            if pattern is not None:
                yield from (
                    f"Camera {camera.name}: {problem}." for problem in _missing(capture, pattern, camera.name, what)
                )


def _missing(capture: Capture, pattern: str, camera: str, what: str) -> Iterator[str]:
    """Sentences on the files that one camera lacks."""
    wanted = {
        capture.place(pattern, clip=clip.name, camera=camera, frame=frame): (clip, frame)
        for clip in capture.clips
        for frame in (range(clip.frames) if FRAME in pattern else range(1))
    }
    absent = [place for place in wanted if not place.is_file()]
    if len(absent) == len(wanted):
        yield f"has no {what}: there is no {absent[0]}"
    elif absent:
        clip, frame = wanted[absent[0]]
        first = f"{absent[0]} of clip {clip.name}, frame {frame}" if FRAME in pattern else f"{absent[0]}"
        yield f"{len(absent)} of {len(wanted)} {what} are missing, first {first}"
    for place, (clip, _) in wanted.items():
        if place.suffix.lower() in VIDEOS and place not in absent:
            yield from _too_short(place, clip)


def _too_short(video: Path, clip: CaptureClip) -> Iterator[str]:
    try:
        video_rate(video)
    except InputError as error:
        yield str(error)
        return
    frames, wanted = count_frames(video), clip.first_image + clip.frames
    if frames < wanted:
        yield f"clip {clip.name} needs {wanted} frames of {video}, which has {frames}"
