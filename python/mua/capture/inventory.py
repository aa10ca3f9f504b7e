"""Which files of a capture are there, without opening the pictures."""

from collections.abc import Iterator
from pathlib import Path

from mua.capture.capture import FRAME, Capture, CaptureClip
from mua.capture.video import VIDEOS, count_frames, video_rate
from mua.errors import InputError

NAMED = 3  # files that a sentence names


def missing_files(capture: Capture) -> Iterator[str]:
    """A sentence for each camera and clip of which pictures or masks are not there."""
    for field in ("images", "masks", "backgrounds"):
        pattern = getattr(capture, field)
        for camera in capture.cameras if pattern is not None else ():
            for clip in capture.clips if field != "backgrounds" else capture.clips[:1]:
                told = _missing(capture, pattern, clip, camera.name)
                if told is not None:
                    yield f"Camera {camera.name}, clip {clip.name}: {told}."


def _missing(capture: Capture, pattern: str, clip: CaptureClip, camera: str) -> str | None:
    """What is missing of one camera and clip; None where all files are there."""
    numbers = range(clip.frames) if FRAME in pattern else range(1)
    places = [capture.place(pattern, clip=clip.name, camera=camera, frame=number) for number in numbers]
    absent = [number for number, place in zip(numbers, places, strict=True) if not place.is_file()]
    if len(absent) == len(places):
        others = f", nor any of the {len(places) - 1} frames after it" if len(places) > 1 else ""
        return f"there is no {places[0]}{others}"
    if absent:
        more = f" and {len(absent) - NAMED} more" if len(absent) > NAMED else ""
        named = ", ".join(str(places[number]) for number in absent[:NAMED])
        return f"{len(absent)} of {clip.frames} frames are missing ({named}{more})"
    return _too_short(places[0], clip) if places[0].suffix.lower() in VIDEOS else None


def _too_short(video: Path, clip: CaptureClip) -> str | None:
    try:
        video_rate(video)
    except InputError as error:
        return str(error)
    frames, wanted = count_frames(video), clip.first_image + clip.frames
    return None if frames >= wanted else f"{video} has {frames} frames; {wanted} are wanted"
