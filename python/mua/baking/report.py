"""The figures that a bake ends with: errors beside two baselines, as a terminal table, Markdown and JSON."""

import json
import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from rich.markup import escape
from rich.table import Table

from mua.arguments import amount
from mua.baking.student_errors import MESH, PICTURES, TRAINING, UNITS, Errors, held_out_errors
from mua.channels import ATTRIBUTES

STAND_IN = "the teacher is a simulated stand-in, not a capture"
FILMED = "the teacher was trained on the images of a capture"
UNSAID = "the recording does not say whether its teacher is a capture or a simulation"
LEGEND = (
    "Errors are root mean squares of whole vectors. Mean: the mean texture of the training frames. Best: the best "
    "coefficients for the trained bases. Explained: share of the variance about the mean. Note: {teacher}."
)
BASELINES = ("mean", "best", "student")
SHORT = (
    *("", "frames", "colour\nexplained", "offset\nexplained"),
    *("colour\nerror\n/255", "offset\nerror\nmm", "mesh\nerror\nmm"),
)
SHORT_LEGEND = (
    "Explained: share of the variance about the mean texture of the training frames. Errors are root mean squares."
)
FAR = 0.25  # outside of training: from here on, the pose is the cause
HELD_OUT = "all held out"
ROUNDING = 0.01  # in an attribute's unit
NAMES = {"SH": "colour"}
HEADINGS = ("frames", "attribute", "unit", "mean", "best", "student", "explained")


@dataclass(frozen=True)
class Stored:
    """What the file holds for playback, and what that takes."""

    clips: int
    seconds: float  # that all clips together last
    clip_bytes: int
    file_bytes: int


def rows(groups: Mapping[str, Errors]) -> list[tuple[str, ...]]:
    """One row for each group and attribute, in the order of HEADINGS."""
    lines = []
    for name, errors in groups.items():
        for attribute, (unit, _) in UNITS.items():
            shown = ("mean", "student") if attribute == MESH else ("mean", "best", "student")
            rms = [f"{errors.rms(attribute, picture):.3g}" if picture in shown else "" for picture in BASELINES]
            lines.append((f"{name} ({errors.frames})", attribute, unit, *rms, percent(errors.explained(attribute))))
    return lines


def percent(share: float) -> str:
    return "nothing varies" if math.isnan(share) else f"{100 * share:.1f} %"


def table(groups: Mapping[str, Errors]) -> Table:
    """For the terminal: one line for training, for all held-out clips together and for each of them."""
    shown = Table(*SHORT, title="Errors of the student")
    shown.columns[0].overflow = "fold"
    for column in shown.columns[1:]:
        column.justify, column.no_wrap = "right", True
    held = held_out_errors(groups)
    clips = [(name, errors) for name, errors in groups.items() if name != TRAINING]
    if TRAINING in groups:
        shown.add_row(TRAINING, *_short(groups[TRAINING]))
    if held is not None:
        shown.add_row(HELD_OUT, *_short(held), end_section=True)
    for name, errors in clips if len(clips) > 1 else ():
        shown.add_row(f"  {escape(name)}", *_short(errors))
    return shown


def _short(errors: Errors) -> list[str]:
    explained = [percent(errors.explained(attribute)) for attribute in ("SH", "offset")]
    return [str(errors.frames), *explained, *(_figure(errors.rms(name, "student")) for name in ("SH", "offset", MESH))]


def _figure(value: float) -> str:
    """Three digits, also where the last are nought, so that a column can be read down."""
    return f"{value:#.3g}".rstrip(".")


def shortfalls(groups: Mapping[str, Errors]) -> list[str]:
    """A sentence for each group of frames of which the student explains less than nothing, and why."""
    found = []
    for name, errors in groups.items():
        shares = {attribute: errors.explained(attribute) for attribute in UNITS if seen(errors, attribute)}
        below = [f"{NAMES.get(name, name)} ({percent(share)})" for name, share in shares.items() if share < 0]
        if below:
            found.append(f"{name}: the mean texture is nearer to the teacher in {', '.join(below)}: {_cause(errors)}")
    return found


def seen(errors: Errors, attribute: str) -> bool:
    """Whether an attribute varies by more than rounding."""
    return errors.rms(attribute, "mean") > ROUNDING


def _cause(errors: Errors) -> str:
    if errors.mean_outside > FAR:
        outside = percent(errors.mean_outside)
        return f"{outside} of its poses lies outside of training; add motion of that kind with --motion"
    return "its poses are like those of training, but too few frames show what moves; add motion or raise --frames"


def legend(*, teacher: str) -> tuple[str, ...]:
    """What holds for all of the table, in sentences."""
    return SHORT_LEGEND, f"{teacher[:1].upper()}{teacher[1:]}."


def markdown(groups: Mapping[str, Errors], *, teacher: str) -> str:
    """The table, and what the student misses split by cause, in shares of the variance about the mean texture."""
    lines = ["| " + " | ".join(HEADINGS) + " |", "|" + " --- |" * len(HEADINGS)]
    held = held_out_errors(groups)
    together = {} if held is None else {HELD_OUT: held}
    groups = {name: groups[name] for name in groups if name == TRAINING} | together | dict(groups)
    lines += ["| " + " | ".join(row) + " |" for row in rows(groups)]
    lines += ["", "| frames | attribute | D1 and D0 left out | bases too small | mispredicted |", "|" + " --- |" * 5]
    for name, errors in groups.items():
        lines += [f"| {name} | {attribute} | {' | '.join(missed(errors, attribute))} |" for attribute in ATTRIBUTES]
    return "\n".join([*lines, "", LEGEND.format(teacher=teacher), ""])


def missed(errors: Errors, attribute: str) -> tuple[str, str, str]:
    """Shares of the variance that are lost to the static bands, to the bases and to the MLP."""
    bands, best, student = (errors.explained(attribute, picture) for picture in ("bands", "best", "student"))
    return percent(1 - bands), percent(bands - best), percent(best - student)


def as_json(groups: Mapping[str, Errors], *, teacher: str, held_out: Mapping[str, int]) -> str:
    """Every figure, unrounded; `held_out` says from which frame on each clip was held out of training."""
    content: dict[str, object] = {"teacher": teacher, "held_out_from": dict(held_out)}
    content["groups"] = {name: _figures(errors) for name, errors in groups.items()}
    held = held_out_errors(groups)
    if held is not None:
        content["held_out"] = _figures(held)
    return json.dumps(content, indent=1)


def _figures(errors: Errors) -> dict[str, object]:
    return {
        "frames": errors.frames,
        "outside": errors.mean_outside,
        "rms": {a: {p: errors.rms(a, p) for p in PICTURES} for a in ATTRIBUTES},
        "explained": {a: {p: errors.explained(a, p) for p in PICTURES} for a in ATTRIBUTES},
        "mesh mm": {p: errors.rms(MESH, p) for p in ("mean", "student")},
    }


def closing(stored: Stored, output: Path) -> str:
    """What was written, for the last lines of a bake."""
    size = f"{output}: {stored.file_bytes / 1e6:.1f} MB"
    if not stored.clips:
        return f"{size}, no clip stored for playback"
    held = f"{stored.clip_bytes / 1e6:.1f} MB" if stored.clip_bytes >= 1e6 else f"{stored.clip_bytes / 1e3:.0f} kB"
    together = " together" if stored.clips > 1 else ""
    return f"{size}, of which {held} are {amount(stored.clips, 'clip')} ({duration(stored.seconds)}{together})"


def duration(seconds: float) -> str:
    """Such as 8 min 28 s."""
    minutes, rest = divmod(round(seconds), 60)
    return f"{minutes} min {rest} s" if minutes else f"{seconds:.1f} s"
