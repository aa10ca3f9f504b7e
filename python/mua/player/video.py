"""Videos and animations from images, written atomically."""

import re
from collections.abc import Iterator
from contextlib import suppress
from itertools import chain
from pathlib import Path
from subprocess import DEVNULL, PIPE, Popen
from tempfile import TemporaryFile

import imageio_ffmpeg

from mua.arrays import Array
from mua.errors import InputError
from mua.files.write import replacing

PART = re.compile(r"\[\S+ @ 0x[0-9a-f]+\]")  # by which the encoder names its parts
BT709 = "bt709"  # colour space that players assume for videos larger than SD; the encoder is set to it
MARKED = ("-colorspace", BT709, "-color_primaries", BT709, "-color_trc", BT709)
SCALED = f"scale=out_color_matrix={BT709}:out_range=tv"
MP4 = (
    *("-c:v", "libx264", "-pix_fmt", "yuv420p", "-crf", "18"),  # visually lossless
    *("-vf", SCALED, *MARKED),
    *("-movflags", "+faststart"),  # a browser may start before it has all of the file
)
WEBM = (
    *("-c:v", "libvpx-vp9", "-crf", "20", "-b:v", "0"),  # constant quality
    *("-row-mt", "1", "-deadline", "good", "-cpu-used", "4"),
    *("-vf", SCALED, *MARKED),
)
OPAQUE_WEBM = (*WEBM, "-pix_fmt", "yuv420p")
CLEAR_WEBM = (*WEBM, "-pix_fmt", "yuva420p", "-auto-alt-ref", "0")  # which VP9 refuses beside transparency
GIF_RATE = 50  # images a second beyond which viewers slow an animation down
# A palette for every image: one for all of them would keep the whole video in memory until the last is there.
PALETTES = "split[a][b];[a]palettegen=stats_mode=single[p];[b][p]paletteuse=new=1:dither=sierra2_4a"
GIF = ("-vf", f"fps=min(source_fps\\,{GIF_RATE}),{PALETTES}", "-loop", "0")
ENCODINGS = {  # by suffix: of opaque images, and of those with transparency
    ".mp4": (MP4, None),
    ".webm": (OPAQUE_WEBM, CLEAR_WEBM),
    ".gif": (GIF, GIF),
}


def write_video(
    path: Path,  # its suffix, one of ENCODINGS, says which kind
    pictures: Iterator[Array],  # [H, W, 3 or 4] uint8, at least one; H and W even but for a GIF; straight alpha
    *,
    rate: float,  # images per second
) -> None:
    """Write a video or an animation that repeats.

    Errors: InputError where the encoder stops, with what it printed.
    """
    first = next(pictures)
    height, width, channels = first.shape
    encoding = ENCODINGS[path.suffix.lower()][channels - 3]
    assert encoding is not None, "options were checked"
    layout = "rgba" if channels == 4 else "rgb24"
    source = ("-f", "rawvideo", "-pix_fmt", layout, "-s", f"{width}x{height}", "-r", str(rate), "-i", "-")
    with replacing(path) as temporary, TemporaryFile() as log:
        command = [imageio_ffmpeg.get_ffmpeg_exe(), "-y", "-v", "error", *source, *encoding, str(temporary)]
        encoder = Popen(command, stdin=PIPE, stdout=DEVNULL, stderr=log)
        with suppress(BrokenPipeError), encoder:  # the encoder may stop, and has then printed why
            assert encoder.stdin is not None  # it is piped above
            for picture in chain([first], pictures):
                encoder.stdin.write(picture.tobytes())
        if encoder.returncode:
            log.seek(0)
            said = PART.sub("", log.read().decode()).split()
            raise InputError(f"{path}: the encoder stopped: {' '.join(said)}")
