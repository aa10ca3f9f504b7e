"""The files that mua-export writes."""

import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import TypeVar

import typer
from rich.console import Console
from rich.progress import track

from mua.asset.read import read
from mua.errors import InputError
from mua.export.formats import SPLAT_FORMATS, frame_content, held, write_clip
from mua.export.frames import ExportFrames
from mua.export.kinds import Kind, is_directory
from mua.export.sequence import file_names, write_all
from mua.files.write import replacing
from mua.motion.mapping import read_mapping
from mua.player.motion import named_clip, player_clips
from mua.pose.clip import Clip

T = TypeVar("T")
NUMBERS = re.compile(r"(\d+)|(\d*):(\d*)(?::(?:0*([1-9]\d*))?)?")


@dataclass(frozen=True)
class Source:
    """An avatar and what moves it."""

    file: Path
    motion: Path | None = None  # in place of the file's own clips
    mapping: Path | None = None  # file that pairs the joints of both
    clip: str | None = None  # the first if None


def write(output: Path, kind: Kind, source: Source, *, frames: str | None, axes: str | None) -> None:
    """Write what was asked for, and say what was written.

    Errors: InputError where the avatar cannot be read, holds no such clip or frame, or nothing can be written.
    """
    exported = _frames(output, kind, source, frames)
    if kind.clip:
        paths = [output]
        with replacing(output) as temporary:
            posed = _with_progress(map(exported.splats, exported.numbers), output, len(exported.numbers))
            write_clip(kind, temporary, exported, posed)
    else:
        paths = _paths(output, kind, exported.numbers)
        down = kind.suffix in SPLAT_FORMATS if axes is None else axes == "y-down"
        contents = (frame_content(kind, exported, number, down=down) for number in exported.numbers)
        write_all(zip(paths, _with_progress(contents, output, len(paths)), strict=True))
    typer.echo(_written(paths, held(kind, exported)))


def parse_numbers(text: str, clip: Clip) -> range:
    """Frames of a clip from NUMBER, FIRST:END or FIRST:END:STEP; raises InputError where there is none of them."""
    asked = NUMBERS.fullmatch(text)
    if asked is None:
        raise InputError(f"--frames is {text!r}; expected NUMBER, FIRST:END or FIRST:END:STEP, such as 0:100:2")
    number, first, end, step = asked.groups()
    if number is not None:
        numbers = range(int(number), int(number) + 1)
    else:
        numbers = range(int(first or 0), int(end or len(clip)), int(step or 1))
    if not numbers or numbers.stop > len(clip):
        raise InputError(f"--frames is {text!r}; clip {clip.name!r} has frames 0 to {len(clip) - 1}")
    return numbers


def _frames(output: Path, kind: Kind, source: Source, frames: str | None) -> ExportFrames:
    """The frames to export; notes of the retargeting go to standard error."""
    mapping = None if source.mapping is None else read_mapping(source.mapping)
    avatar = read(source.file)
    clips, notes = player_clips(avatar, source.file, motion=source.motion, mapping=mapping)
    for note in notes:
        typer.echo(note, err=True)
    clip = named_clip(clips, source.clip, source=source.motion or source.file)
    if kind.clip and "%" in output.name:
        raise InputError(f"-o is {output}; a {kind.suffix} file of {kind.what} holds all frames, expected a plain name")
    many = kind.clip or is_directory(output) or "%" in output.name
    if frames is None:
        return ExportFrames(avatar, clip, range(len(clip) if many else 1))
    numbers = parse_numbers(frames, clip)
    if not many and len(numbers) > 1:
        raise InputError(
            f"-o is {output}, one file, but --frames {frames} names {len(numbers)} frames; "
            f"expected a directory or a name such as {_with_place(output, kind)}"
        )
    return ExportFrames(avatar, clip, numbers)


def _with_place(output: Path, kind: Kind) -> str:
    return f"{output.name[: -len(kind.suffix)]}_%04d{kind.suffix}"


def _paths(output: Path, kind: Kind, numbers: range) -> list[Path]:
    if is_directory(output) or "%" in output.name:
        return file_names(output, numbers, suffix=kind.suffix)
    return [output]


def _with_progress(contents: Iterator[T], output: Path, count: int) -> Iterator[T]:
    """Show a progress bar in a terminal while the contents are made."""
    console = Console(stderr=True)
    hidden = count == 1 or not console.is_terminal
    return iter(track(contents, description=output.name, total=count, console=console, disable=hidden))


def _written(paths: list[Path], content: str) -> str:
    """What was written, for the last line."""
    size = sum(path.stat().st_size for path in paths)
    shown = f"{size / 1e6:.1f} MB" if size >= 1e5 else f"{size / 1e3:.1f} KB"
    if len(paths) == 1:
        return f"{paths[0]}: {content}, {shown}"
    return f"{paths[0]} to {paths[-1].name}: {len(paths)} files of {content}, {shown}"
