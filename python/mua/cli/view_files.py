"""The images, videos and animations that mua-view writes."""

from collections.abc import Callable, Iterator, Sequence
from contextlib import closing, contextmanager
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TypeAlias

import numpy as np
import typer
from PIL import Image
from rich.console import Console
from rich.progress import track

from mua.arguments import amount
from mua.arrays import Array
from mua.asset.avatar import Avatar
from mua.asset.read import read
from mua.avatar.camera import Camera
from mua.cli.option_values import is_video, parse_frame, parse_frames
from mua.cli.view_options import Kind
from mua.files.write import replacing
from mua.player.cpu_image import Reference, over
from mua.player.levels import FULL, Levels
from mua.player.motion import expressed, named_clip, player_clips, require_expressions
from mua.player.played_files import Source
from mua.player.shot import Look, film, full_turn
from mua.pose.clip import Clip

Painter: TypeAlias = Callable[[int, Sequence[Camera]], Array]  # a frame's premultiplied image [H, E W, 4]


@dataclass(frozen=True)
class _Take:
    """What is painted, image after image."""

    frames: list[int]  # frames of the clip
    cameras: list[tuple[Camera, ...]]
    rate: float  # images a second


def write(
    output: Path,
    kind: Kind,
    source: Source,  # the avatar of one file
    look: Look,
    *,
    frames: str | None,  # FIRST:END of a video
    device: str | None,
    reference: bool,  # computed on the CPU
) -> None:
    """Write an image or a video and say what was written.

    Errors: InputError where the avatar cannot be read or shown, or holds no such clip, frame or joint.
    """
    with _opened(source.files[0], device, look, reference=reference) as (avatar, painter):
        require_expressions(avatar.expressions, look.weights, file=source.files[0])
        clip = expressed(_chosen(avatar, source), avatar.expressions, look.weights)
        take = _take(kind, clip, avatar, source, look, frames=frames)
        paint = painter(clip)
        painted = (paint(frame, eyes) for frame, eyes in zip(take.frames, take.cameras, strict=True))
        _save(output, (over(picture, look.background) for picture in painted), take)
    typer.echo(_written(output, take))


@contextmanager
def _opened(
    file: Path, device: str | None, look: Look, *, reference: bool
) -> Iterator[tuple[Avatar, Callable[[Clip], Painter]]]:
    """The avatar, and what paints frames of a clip of it, for as long as the device is open."""
    if reference:
        avatar = read(file)
        levels = _levels(avatar, look)
        yield avatar, lambda clip: Reference(avatar, clip, levels=levels).picture
        return
    from mua.gpu import open_device  # here, as all that needs a device: images by the CPU do without
    from mua.player.buffers import AvatarBuffers
    from mua.player.offscreen import Offscreen

    with closing(open_device(device)) as opened:
        buffers = AvatarBuffers(opened, file)
        levels = _levels(buffers.avatar, look)
        yield buffers.avatar, lambda clip: Offscreen(opened, buffers, clip, look.toggles, levels=levels).picture


def _levels(avatar: Avatar, look: Look) -> Levels:
    """What chooses the level of detail; that there is none to choose goes to standard error."""
    levels = Levels(avatar, FULL if look.toggles.geometry else look.level)  # the surface has but one
    if levels.note:
        typer.echo(levels.note, err=True)
    return levels


def _chosen(avatar: Avatar, source: Source) -> Clip:
    """The clip to show; notes of the retargeting go to standard error."""
    file = source.files[0]
    clips, notes = player_clips(avatar, file, motion=source.motion, mapping=source.mapping, face=source.face)
    for note in notes:
        typer.echo(note, err=True)
    return named_clip(clips, source.clip, source=source.motion or file)


def _take(kind: Kind, clip: Clip, avatar: Avatar, source: Source, look: Look, *, frames: str | None) -> _Take:
    shown = list(parse_frames(frames, clip) if kind == "video" else parse_frame(source.frame, clip))
    shot, rate = look.shot, clip.rate
    if kind == "turntable":
        shot, count, rate = full_turn(shot)
        shown *= count
    filmed = replace(clip.cut(np.array(shown)), rate=rate)
    return _Take(shown, film(shot, avatar.rig, filmed), rate)


def _save(output: Path, pictures: Iterator[Array], take: _Take) -> None:
    """Write an image, or a video with a progress bar."""
    if is_video(output):
        from mua.player.video import write_video

        console = Console(stderr=True)
        count, hidden = len(take.frames), not console.is_terminal
        bar = track(pictures, description=output.name, total=count, console=console, disable=hidden)
        write_video(output, iter(bar), rate=take.rate)
    else:
        with replacing(output) as temporary:
            Image.fromarray(next(pictures)).save(temporary)


def _written(output: Path, take: _Take) -> str:
    """What was written, for the last line."""
    eyes = take.cameras[0]
    width, height = eyes[0].screen
    size = f"{len(eyes) * width} x {height} pixels"
    if not is_video(output):
        return f"{output}: {size}"
    count = len(take.frames)
    return f"{output}: {amount(count, 'frame')} of {size}, {count / take.rate:.1f} s"
