"""What the model of a device says of a frame, as a table and as JSON."""

from dataclasses import asdict
from typing import Any

from rich.box import SIMPLE_HEAD
from rich.table import Table

from mua.bench.crowd import Crowd
from mua.bench.devices import ModelDevice
from mua.bench.frame_model import Modelled, Stages
from mua.bench.measure import Measured
from mua.bench.work import POSING

COLUMNS = (
    "avatars",
    "eyes",
    "metres",
    "decode",
    "part",
    "pose",
    "triangles",
    "fragments",
    "rest",
    "plain frame",
    "spread frame",
    "decode frame",
)


def model_table(modelled: list[Modelled]) -> Table:
    """Milliseconds by stage; of whole frames also from the best to the worst."""
    table = Table(*COLUMNS, box=SIMPLE_HEAD, padding=(0, 0, 0, 1))
    for column in table.columns:
        column.justify, column.no_wrap = "right", True
    for each in modelled:
        stages = (f"{milliseconds:.1f}" for milliseconds in asdict(each.likely).values())
        frames = (_ranged(each, name) for name in ("plain", "spread", "whole"))
        table.add_row(str(each.avatars), str(each.eyes), f"{each.distance:g}", *stages, *frames)
    return table


def crowd_table(crowds: list[Crowd]) -> Table:
    """The longest frame of several avatars, in milliseconds, and how old what is shown becomes."""
    titles = ("metres of each", "decode", "longest frame", "parts", "splats", "oldest")
    table = Table(*titles, box=SIMPLE_HEAD, padding=(0, 0, 0, 1))
    for each in crowds:
        table.add_row(", ".join(f"{away:g}" for away in each.metres), "together", f"{each.together:.1f}")
        for name, played in (("in turns", each.turns), ("in turns, budget", each.budget)):
            figures = (str(played.parts), f"{played.splats:,}", f"{played.oldest:.0f}")
            table.add_row("", name, f"{played.longest:.1f}", *figures)
    return table


def model_legend(device: ModelDevice, instructions: int) -> tuple[str, ...]:
    return (
        f"Milliseconds on {device.title}: modelled from counts, not measured; in brackets best to worst.",
        "together: all decode half in one frame; in turns: one part of one decode; budget: as many parts and splats as "
        "fit 13.9 ms. oldest: milliseconds by which a shown decode is behind its pose.",
        f"A fragment computes {instructions} instructions. No avatar hides another; both eyes are drawn one by one.",
        *device.sources,
        f"Assumed, without a source: {device.assumed}.",
    )


def measured_line(measured: Measured) -> str:
    """The stages as measured, beside the modelled ones."""
    width, height = measured.screen
    decode, pose, draw = measured_stages(measured).values()
    return (
        f"Measured on {measured.device}: decode {decode:.1f} ms, pose {pose:.1f} ms, drawing {draw:.1f} ms; "
        f"one avatar, one eye of {width} x {height} pixels, the whole figure in view."
    )


def measured_stages(measured: Measured) -> dict[str, float]:
    """Milliseconds."""
    pose = sum(measured.kernels[name].median for name in POSING)
    decode = sum(timing.median for name, timing in measured.kernels.items() if name not in POSING)
    return {"decode": decode, "pose": pose, "draw": measured.draw.median}


def model_json(
    name: str,
    device: ModelDevice,
    instructions: int,
    modelled: list[Modelled],
    measured: Measured,
    crowds: list[Crowd],
) -> dict[str, Any]:
    """Milliseconds."""
    return {
        "model": name,
        "device": asdict(device),
        "fragment_instructions": instructions,
        "frames": [
            {
                "avatars": each.avatars,
                "eyes": each.eyes,
                "metres": each.distance,
                **{end: _milliseconds(stages) for end, stages in each.ends.items()},
            }
            for each in modelled
        ],
        "crowds": [asdict(each) for each in crowds],
        "measured": {"device": measured.device, **measured_stages(measured)},
    }


def _milliseconds(stages: Stages) -> dict[str, float]:
    return {**asdict(stages), "plain_frame": stages.plain, "spread_frame": stages.spread, "decode_frame": stages.whole}


def _ranged(each: Modelled, frame: str) -> str:
    best, likely, worst = (getattr(each.ends[end], frame) for end in ("best", "likely", "worst"))
    return f"{likely:.1f} ({best:.1f}-{worst:.1f})"
