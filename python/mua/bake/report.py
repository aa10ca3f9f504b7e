"""The figures that a bake ends with: errors beside two baselines, as a terminal table, Markdown and JSON."""

import json
import math
from collections.abc import Mapping

from rich.table import Table

from mua.evaluate import MESH, PICTURES, UNITS, Errors
from mua.texture.channels import ATTRIBUTES

STAND_IN = "the teacher is a simulated stand-in, not a capture"
UNSAID = "the recording does not say whether its teacher is a capture or a simulation"
LEGEND = (
    "Errors are root mean squares of whole vectors. Mean: the mean texture of the training frames. Best: the best "
    "coefficients for the learnt bases. Explained: of the variance about the mean. Note: {teacher}."
)
BASELINES = ("mean", "best", "student")
HEADINGS = ("frames", "attribute", "unit", "mean", "best", "student", "explained")


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


def table(groups: Mapping[str, Errors], *, teacher: str) -> Table:
    """For the terminal."""
    shown = Table(*HEADINGS, title="RMS error", caption=LEGEND.format(teacher=teacher))
    last = ""
    for name, *cells in rows(groups):
        shown.add_row("" if name == last else name, *cells, end_section=cells[0] == MESH)
        last = name
    return shown


def markdown(groups: Mapping[str, Errors], *, teacher: str) -> str:
    """The table, and what the student misses split by cause, in shares of the variance about the mean texture."""
    lines = ["| " + " | ".join(HEADINGS) + " |", "|" + " --- |" * len(HEADINGS)]
    lines += ["| " + " | ".join(row) + " |" for row in rows(groups)]
    lines += ["", "| frames | attribute | D1 and D0 left out | bases too small | mispredicted |", "|" + " --- |" * 5]
    for name, errors in groups.items():
        lines += [f"| {name} | {attribute} | {' | '.join(missed(errors, attribute))} |" for attribute in ATTRIBUTES]
    return "\n".join([*lines, "", LEGEND.format(teacher=teacher), ""])


def missed(errors: Errors, attribute: str) -> tuple[str, str, str]:
    """Shares of the variance that are lost to the static bands, to the bases and to the MLP."""
    bands, best, student = (errors.explained(attribute, picture) for picture in ("bands", "best", "student"))
    return percent(1 - bands), percent(bands - best), percent(best - student)


def as_json(groups: Mapping[str, Errors], *, teacher: str) -> str:
    """Every figure, unrounded."""
    told = {
        name: {
            "frames": errors.frames,
            "rms": {a: {p: errors.rms(a, p) for p in PICTURES} for a in ATTRIBUTES},
            "explained": {a: {p: errors.explained(a, p) for p in PICTURES} for a in ATTRIBUTES},
            "mesh mm": {p: errors.rms(MESH, p) for p in ("mean", "student")},
        }
        for name, errors in groups.items()
    }
    return json.dumps({"teacher": teacher, "groups": told}, indent=1)
