"""Frames of a video, decoded by ffmpeg one at a time."""

import re
from collections.abc import Generator
from contextlib import closing
from pathlib import Path
from subprocess import DEVNULL, PIPE, Popen, run
from typing import IO

import numpy as np

from mua.arrays import Array
from mua.errors import InputError


class MissingImage(InputError):
    """Raised where a capture has no image of a frame: there is no such file, or a video ends before."""


VIDEOS = (".mp4", ".mov", ".mkv", ".avi", ".webm", ".m4v")
EARLIER = 0.5  # frames: rounding of times must not skip the frame that is looked for
EACH_ONCE = ("-fps_mode", "passthrough")  # none is left out or shown twice to keep a rate
AS_PICTURES = ("-f", "image2pipe", "-c:v", "ppm", "-pix_fmt", "rgb24", "-")


def video_frame(path: Path, number: int) -> Array:
    """A frame [H, W, 3] uint8 sRGB, counted from 0; it is found by its time, so the video needs a steady rate."""
    with closing(video_frames(path, number)) as frames:
        for frame in frames:
            return frame
    raise MissingImage(f"{path}: has {count_frames(path)} frames; frame {number}, counted from 0, is wanted")


def video_frames(path: Path, first: int = 0) -> Generator[Array, None, None]:
    """Frames [H, W, 3] uint8 sRGB from `first` on; raises InputError where the file is no video."""
    from imageio_ffmpeg import get_ffmpeg_exe

    start = max(first - EARLIER, 0) / video_rate(path)
    command = [get_ffmpeg_exe(), "-v", "error", "-ss", f"{start:.6f}", "-i", str(path), *EACH_ONCE, *AS_PICTURES]
    with Popen(command, stdin=DEVNULL, stdout=PIPE, stderr=DEVNULL) as decoder:
        assert decoder.stdout is not None  # as asked for
        try:
            while (frame := _ppm(decoder.stdout)) is not None:
                yield frame
        finally:
            decoder.kill()


def count_frames(path: Path) -> int:
    """How many frames a video has."""
    from imageio_ffmpeg import count_frames_and_secs

    return int(count_frames_and_secs(str(path))[0])


def video_rate(path: Path) -> float:
    """Frames a second; raises InputError where ffmpeg finds no video."""
    from imageio_ffmpeg import get_ffmpeg_exe

    probed = run([get_ffmpeg_exe(), "-hide_banner", "-i", str(path)], stdin=DEVNULL, capture_output=True, check=False)
    found = re.search(rb"Video: .* ([0-9.]+) fps", probed.stderr)
    if found is None or float(found[1]) <= 0:
        raise InputError(f"{path}: ffmpeg cannot read it as a video of a steady rate")
    return float(found[1])


def _ppm(stream: IO[bytes]) -> Array | None:
    """The next image of a stream of binary PPM, [H, W, 3] uint8; None at its end."""
    if stream.readline() != b"P6\n":
        return None
    width, height = (int(side) for side in stream.readline().split())
    stream.readline()  # the largest value, which is 255 for 8 bits
    content = stream.read(3 * width * height)
    return np.frombuffer(content, np.uint8).reshape(height, width, 3) if len(content) == 3 * width * height else None
