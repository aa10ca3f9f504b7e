"""mua-view: an avatar in a window, or as a picture or a video."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import closing, contextmanager
from functools import partial
from pathlib import Path
from typing import Annotated, TypeAlias

import numpy as np
import typer
from PIL import Image
from rich.console import Console
from rich.progress import track

from mua.arrays import Array
from mua.asset.avatar import Avatar
from mua.asset.read import read
from mua.camera import EYE_DISTANCE, Camera
from mua.cli.choices import is_video, parse_color, parse_frame, parse_frames, parse_screen, require_format
from mua.cli.failure import refusing
from mua.cli.inputs import require_file, require_motion
from mua.errors import InputError
from mua.files import replacing
from mua.motion.clip import Clip
from mua.motion.mapping import read_mapping
from mua.player.motion import named_clip, player_clips
from mua.player.shot import Shot, film
from mua.player.toggles import Toggles, parse_toggles

Painter: TypeAlias = Callable[[int, Sequence[Camera]], Array]  # a frame's premultiplied picture [H, E W, 4]


def _list_devices(wanted: bool) -> None:
    """Print every graphics device and stop, before FILE is asked for."""
    if wanted:
        from mua.gpu import adapters  # here, as all that needs a device: pictures by the CPU do without

        for index, adapter in enumerate(adapters()):
            print(f"{index}: {adapter}, {adapter.kind}")
        raise typer.Exit


def view(
    files: Annotated[list[Path], typer.Argument(help="A .muaavatar file; several to switch between in the window.")],
    clip: Annotated[str | None, typer.Option(help="Name of a clip in the file; the first if left out.")] = None,
    frame: Annotated[int | None, typer.Option(help="Frame of a picture at the avatar's rate, from 0.")] = None,
    frames: Annotated[str | None, typer.Option(help="Frames of a video, FIRST:END; all if left out.")] = None,
    motion: Annotated[Path | None, typer.Option(help="Motion file in place of the avatar's own clips.")] = None,
    mapping: Annotated[Path | None, typer.Option(help="JSON or TOML: avatar's joint to joint of the motion.")] = None,
    output: Annotated[
        Path | None, typer.Option("--output", "-o", help="Picture (.png ...) or video (.mp4) to write, no window.")
    ] = None,
    size: Annotated[str, typer.Option(help="WIDTHxHEIGHT of an eye in pixels, or one number.")] = "640x960",
    azimuth: Annotated[float, typer.Option(help="Degrees round it to its left; 0 is the front of its bind pose.")] = 0,
    elevation: Annotated[float, typer.Option(help="Degrees from which the camera looks down.")] = 0,
    orbit: Annotated[float, typer.Option(help="Degrees per second by which a video's camera goes round.")] = 0,
    follow: Annotated[bool, typer.Option("--follow", help="The camera goes along with the figure.")] = False,
    stereo: Annotated[bool, typer.Option("--stereo", help="Left and right eye side by side.")] = False,
    ipd: Annotated[float, typer.Option(help="Metres between the eyes.")] = EYE_DISTANCE,
    background: Annotated[str, typer.Option(help="Colour name or #rrggbb.")] = "white",
    device: Annotated[str | None, typer.Option(help="Part of the name of a graphics device, or its number.")] = None,
    list_devices: Annotated[
        bool, typer.Option("--list-devices", is_eager=True, callback=_list_devices, help="Number and name them.")
    ] = False,
    show: Annotated[
        str, typer.Option(help="Some of splats,geometry,template,skeleton,shadow, separated by commas.")
    ] = "splats",
    reference: Annotated[
        bool, typer.Option("--reference", help="Compute on the CPU in numpy; needs no device.")
    ] = False,
) -> None:
    """Show FILES in a window, or with -o write a picture or a video of one."""
    for file in files:
        require_file(file)
    if motion is not None:
        require_motion(motion)
    joints = None if mapping is None else read_mapping(mapping)
    if output is None:
        from mua.gpu import open_device
        from mua.player.window import show as show_window  # here, because pictures need no window system

        show_window(files, open_device(device), clip=clip, motion=motion, mapping=joints)
        return
    if len(files) > 1:
        raise InputError(f"-o is {output}; expected one FILE to picture, found {len(files)}")
    require_format(output)
    video = is_video(output)
    if (frame if video else frames) is not None:
        raise InputError(f"-o is {output}; a video takes --frames FIRST:END, a picture --frame")
    shot = Shot(
        parse_screen(size, even=video),
        azimuth=np.radians(azimuth),
        elevation=np.radians(elevation),
        turning=np.radians(orbit),
        follow=follow,
        eyes=ipd if stereo else None,
    )
    color, toggles = parse_color(background), parse_toggles(show)
    if reference and toggles != Toggles():
        raise InputError(f"--show is {show!r}; --reference draws splats alone")
    from mua.player.offscreen import over  # here, because it loads wgpu: a wrong option costs no time

    with _opened(files[0], device, toggles, reference=reference) as (avatar, painter):
        chosen = _chosen(avatar, files[0], clip, motion=motion, mapping=joints)
        shown = parse_frames(frames, chosen) if video else parse_frame(frame, chosen)
        paint, cameras = painter(chosen), film(shot, avatar.rig, _part(chosen, shown))
        pictures = [partial(paint, index, eyes) for index, eyes in zip(shown, cameras, strict=True)]
        _save(output, (over(picture(), color) for picture in pictures), count=len(pictures), rate=chosen.rate)


def run() -> None:
    """Entry point of the command."""
    refusing(view)


@contextmanager
def _opened(
    file: Path, device: str | None, toggles: Toggles, *, reference: bool
) -> Iterator[tuple[Avatar, Callable[[Clip], Painter]]]:
    """The avatar, and what paints frames of a clip of it, for as long as the device is open."""
    from mua.gpu import open_device
    from mua.player.buffers import AvatarBuffers
    from mua.player.offscreen import Offscreen, reference_picture

    if reference:
        avatar = read(file)
        yield avatar, lambda clip: partial(reference_picture, avatar, clip)
        return
    with closing(open_device(device)) as opened:
        buffers = AvatarBuffers(opened, file)
        yield buffers.avatar, lambda clip: Offscreen(opened, buffers, clip, toggles).picture


def _chosen(
    avatar: Avatar, file: Path, name: str | None, *, motion: Path | None, mapping: Mapping[str, str] | None
) -> Clip:
    """The clip to show; what retargeting has to tell goes to standard error."""
    clips, notes = player_clips(avatar, file, motion=motion, mapping=mapping)
    for note in notes:
        typer.echo(note, err=True)
    return named_clip(clips, name, source=motion or file)


def _part(clip: Clip, frames: range) -> Clip:
    kept = slice(frames.start, frames.stop)
    return clip.cut(kept)


def _save(output: Path, pictures: Iterator[Array], *, count: int, rate: float) -> None:
    """Write a picture, or a video with a progress bar."""
    if is_video(output):
        from mua.player.offscreen import write_video

        bar = track(pictures, description=output.name, total=count, console=Console(stderr=True))
        write_video(output, iter(bar), rate=rate)
    else:
        with replacing(output) as temporary:
            Image.fromarray(next(pictures)).save(temporary)
