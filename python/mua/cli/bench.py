"""mua-bench: the time that each kernel of a frame takes on a graphics device."""

import json
import tempfile
from contextlib import closing
from dataclasses import astuple
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
from rich.box import SIMPLE_HEAD
from rich.table import Table
from rich.text import Text

from mua.arguments import amount
from mua.asset.write import write
from mua.avatar.camera import EYE_DISTANCE
from mua.bench.devices import DEVICES, model_device
from mua.cli.console import printer
from mua.cli.failure import run_command
from mua.cli.option_values import parse_screen
from mua.cli.options import choice
from mua.errors import InputError
from mua.files import write as files
from mua.files.inputs import require_file
from mua.student.settings import PRESETS, preset

if TYPE_CHECKING:  # loads wgpu
    from mua.bench.counts import Counts, Face, Part
    from mua.bench.measure import Measured, Timing
    from mua.bench.work import Work
    from mua.gpu import Device

SIZE = "1024"  # pixels
COLUMNS = ("kernel", "ms", "spread", "MB", "GB/s", "copy", "MFLOP", "GFLOP/s")


def bench(
    context: typer.Context,
    file: Annotated[Path | None, typer.Argument(metavar="FILE", help="Avatar file (.muaavatar).")] = None,
    preset_name: Annotated[
        str | None,
        choice(tuple(PRESETS), "--preset", help="Measure an avatar of random numbers with this preset's sizes."),
    ] = None,
    device: Annotated[str | None, typer.Option(help="Graphics device: its number or part of its name.")] = None,
    frames: Annotated[int, typer.Option(min=1, help="Number of frames to measure.")] = 20,
    size: Annotated[str, typer.Option(help="Image size per eye in pixels: WIDTHxHEIGHT or one number.")] = SIZE,
    stereo: Annotated[bool, typer.Option("--stereo", help="Draw left and right eye side by side.")] = False,
    counts: Annotated[
        bool, typer.Option("--counts", help="Count bytes, operations, dispatches and fragments; measure no time.")
    ] = False,
    model: Annotated[
        str | None, choice(tuple(DEVICES), "--model", help="Model a frame's milliseconds on a device that is not here.")
    ] = None,
    output: Annotated[Path | None, typer.Option("--json", help="JSON file to write the figures to.")] = None,
) -> None:
    """Measure time, memory traffic and operations of each kernel in a frame of FILE."""
    if (file is None) == (preset_name is None):
        raise InputError("mua-bench measures a FILE or a --preset; expected one of the two")
    if model is not None:
        model_device(model)
    if counts and model is not None:
        raise InputError("--counts and --model are given; expected one of the two")
    if counts or model is not None:
        _require_used(context, "--counts" if counts else "--model")
    screen, eyes = parse_screen(size), EYE_DISTANCE if stereo else None
    if file is not None:
        require_file(file)

    from mua.bench.measure import measure  # here, so that a wrong name fails at once
    from mua.bench.random_avatar import random_avatar
    from mua.bench.report import as_json
    from mua.gpu import open_device

    with closing(open_device(device)) as opened, tempfile.TemporaryDirectory() as scratch:
        path = file or Path(scratch) / "random.muaavatar"
        if preset_name is not None:
            write(path, random_avatar(preset(preset_name)))
        if model is not None:
            _model(opened, path, model, frames, output)
            return
        if counts:
            _count(opened, path, output)
            return
        measured = measure(opened, path, frames=frames, screen=screen, eyes=eyes)
    if output is not None:
        files.write_bytes(output, json.dumps(as_json(measured), indent=2).encode() + b"\n")
    console = printer()
    for part in (Text(_heading(measured)), _table(measured), *map(Text, _legend(measured))):
        console.print(part)
    if output is not None:
        console.print(output, highlight=False, soft_wrap=True)


def _require_used(context: typer.Context, kind: str) -> None:
    """Raises InputError for an option that counting a frame would ignore."""
    for name in ("size", "stereo", *(["frames"] if kind == "--counts" else [])):
        source = context.get_parameter_source(name)
        if source is not None and source.name == "COMMANDLINE":
            raise InputError(f"--{name} is given, but {kind} counts one frame of one eye at sizes of its own")


def _count(device: "Device", path: Path, output: Path | None) -> None:
    """Print what a frame must do, and write it where that was asked for."""
    from mua.bench.counts import as_json, count

    counted = count(device, path)
    figures = as_json(counted)
    if output is not None:
        files.write_bytes(output, json.dumps(figures, indent=2).encode() + b"\n")
    table = Table("frame", "MB", "MFLOP", "dispatches", box=SIMPLE_HEAD, padding=(0, 0, 0, 1))
    for name, work in counted.kernels.items():
        table.add_row(name, f"{work.bytes / 1e6:.1f}", f"{work.flops / 1e6:.0f}", "")
    table.add_section()
    for number, part in enumerate(counted.decode, 1):
        moved, done = part.work.bytes / 1e6, part.work.flops / 1e6
        table.add_row(f"decode, part {number}", f"{moved:.1f}", f"{done:.0f}", str(part.dispatches))
    table.add_section()
    for name in ("decode", "pose", "peak_frame"):
        moved, done = figures["bytes"][name] / 1e6, figures["operations"][name] / 1e6
        table.add_row(name.replace("_", " "), f"{moved:.1f}", f"{done:.0f}", str(figures["dispatches"].get(name, "")))
    table.add_row("rest", "", "", str(counted.rest))
    if counted.face is not None:
        table.add_row(*_share(counted.face, counted.whole))
    views = Table("metres", "triangles", "fragments", "overdraw", box=SIMPLE_HEAD, padding=(0, 0, 0, 1))
    for seen in counted.drawn:
        views.add_row(str(seen.distance), f"{seen.triangles:,}", f"{seen.fragments:,}", f"{seen.overdraw:.1f}")
    for shown in (Text(f"{counted.avatar}: {counted.splats:,} splats, one eye."), table, views, _levels(counted)):
        printer().print(shown)


def _share(face: "Face", decode: "Part") -> tuple[str, ...]:
    """What expressions add to a decode, as shares of it."""
    moved, done = (f"+{own / all:.1%}" for own, all in zip(astuple(face.work), astuple(decode.work), strict=True))
    return "expressions, to decode", moved, done, str(face.dispatches)


def _levels(counted: "Counts") -> Table:
    """What each level of detail costs, and from where on it is chosen."""
    from mua.bench.counts import added

    titles = ("texels", "splats", "from metres", "decode MB", "pose MB", f"fragments at {counted.drawn[0].distance} m")
    table = Table(*titles, box=SIMPLE_HEAD, padding=(0, 0, 0, 1))
    for level in counted.levels:
        moved = [f"{work.bytes / 1e6:.1f}" for work in (added(level.decode), level.pose.work)]
        fragments = f"{level.drawn.fragments:,}"
        table.add_row(str(level.texels), f"{level.splats:,}", f"{level.chosen:.1f}", *moved, fragments)
    return table


def _model(device: "Device", path: Path, name: str, frames: int, output: Path | None) -> None:
    """Print what a frame would take elsewhere, and what it takes here."""
    from mua.bench.counts import count
    from mua.bench.crowd import SCENES, crowd
    from mua.bench.frame_model import model
    from mua.bench.instructions import fragment_instructions
    from mua.bench.measure import measure
    from mua.cli.model_table import crowd_table, measured_line, model_json, model_legend, model_table

    chosen, instructions = model_device(name), fragment_instructions()
    counted = count(device, path)
    modelled = model(chosen, counted, instructions)
    crowds = [crowd(chosen, counted, instructions, metres) for metres in SCENES]
    measured = measure(device, path, frames=frames, screen=parse_screen(SIZE), eyes=None)
    if output is not None:
        figures = model_json(name, chosen, instructions, modelled, measured, crowds)
        files.write_bytes(output, json.dumps(figures, indent=2).encode() + b"\n")
    legend = (*model_legend(chosen, instructions), measured_line(measured))
    for part in (model_table(modelled), crowd_table(crowds), *map(Text, legend)):
        printer().print(part)


def run() -> None:
    """Entry point of the command."""
    run_command(bench)


def _table(measured: "Measured") -> Table:
    from mua.bench.report import total_milliseconds, total_work

    table = Table(*COLUMNS, box=SIMPLE_HEAD, padding=(0, 0, 0, 1))
    for column in table.columns:
        column.justify, column.no_wrap = ("left" if column.header == "kernel" else "right"), True
    for name, timing in measured.kernels.items():
        table.add_row(name, *_figures(timing.median, _spread(timing), measured.work[name], measured.copy_bandwidth))
    table.add_section()
    whole = _figures(total_milliseconds(measured), "", total_work(measured), measured.copy_bandwidth)
    table.add_row("frame, sorted", *whole)
    table.add_row("draw", f"{measured.draw.median:.3f}", _spread(measured.draw))
    return table


def _heading(measured: "Measured") -> str:
    width, height = measured.screen
    frames = "1 frame" if measured.frames == 1 else f"medians of {measured.frames} frames"
    eyes = amount(measured.eyes, "eye")
    return (
        f"{measured.avatar} on {measured.device}: {frames}, {eyes} of {width} x {height} pixels, "
        f"{measured.visible:,} of {measured.splats:,} splats visible."
    )


def _legend(measured: "Measured") -> tuple[str, ...]:
    return (
        "spread: time between the fastest tenth of the frames and the slowest tenth.",
        f"copy: GB/s as a share of the {measured.copy_bandwidth / 1e9:.1f} GB/s that copying a large buffer reaches.",
    )


def _figures(milliseconds: float, spread: str, work: "Work", copy_bandwidth: float) -> tuple[str, ...]:
    from mua.bench.report import rate

    moved = rate(work.bytes, milliseconds)
    operations = (f"{work.flops / 1e6:.2f}", f"{rate(work.flops, milliseconds) / 1e9:.3g}") if work.flops else ()
    moving = (f"{work.bytes / 1e6:.2f}", f"{moved / 1e9:.3g}", f"{moved / copy_bandwidth:.1%}")
    return f"{milliseconds:.3f}", spread, *moving, *operations


def _spread(timing: "Timing") -> str:
    return f"{timing.high - timing.low:.3f}"


if __name__ == "__main__":
    run()
