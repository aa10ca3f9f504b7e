"""The table of a comparison, in the paper's columns: terminal, Markdown, CSV and JSON."""

import csv
import io
import json
import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass

from rich.markup import escape
from rich.table import Table

from mua.compare.judge import KINDS, Result
from mua.compare.metrics import METRICS, Scores

HEADINGS = {"psnr": "PSNR", "ssim": "SSIM", "ms_ssim": "MS-SSIM", "flip": "FLIP", "lpips": "LPIPS"}
DIGITS = {"psnr": 2, "ssim": 4, "ms_ssim": 4, "flip": 4, "lpips": 2}
COSTS = ("GFLOPs", "Param (M)", "MB", "FPS")
NO_WEIGHTS = "no weights given"
NOTHING = "-"
STORAGES = ("f32", "f16", "i8")


@dataclass(frozen=True)
class Setting:
    """What a comparison was made with."""

    recording: str
    device: str
    frames: dict[str, int]  # by kind
    views: int
    size: int  # pixels
    seconds: float | None  # of training for each system
    steps: int | None  # of Adam for each system, where it has no seconds
    preset: str
    lpips: str | None  # network
    covered: float  # share of a picture that the figure covers, mean


def legend(setting: Setting) -> str:
    """What the figures mean, in sentences."""
    counted = ", ".join(f"{count} {kind}" for kind, count in setting.frames.items())
    perceived = (
        f"LPIPS: {setting.lpips}, times 1000." if setting.lpips else "LPIPS: no weights given (--lpips-weights FILE)."
    )
    budget = f"{setting.seconds:g} s" if setting.steps is None else f"{setting.steps} steps"
    return (
        f"Means over {counted} frames of {setting.recording} from {setting.views} views of {setting.size} x "
        f"{setting.size} pixels, against the teacher drawn alike; whole picture on black, {setting.covered:.0%} of it "
        "figure. No view is left out of training, because teachers and students are textures and learn from no view. "
        "All lie on the teacher's mesh of the frame, but for rows named own mesh. Systems were trained for "
        f"{budget} each at the sizes of preset {setting.preset}. GFLOPs leave out posing and drawing; FPS "
        f"have decoding, posing and drawing, of files alone, on {setting.device}. MB: the file, or 4 bytes a "
        f"parameter. {perceived} "
        "The teacher may be a simulated stand-in: see its recording."
    )


def table(results: Sequence[Result], setting: Setting) -> Table:
    """For the terminal: two lines for each entry."""
    shown = Table("system", "poses", *HEADINGS.values(), *COSTS, title="against the teacher", caption=legend(setting))
    for column in shown.columns[2:]:
        column.justify = "right"
    for result in results:
        for i, (kind, held_out) in enumerate(KINDS.items()):
            last = i == len(KINDS) - 1
            costs = costs_of(result) if i == 0 else [""] * len(COSTS)
            name = escape(result.entry.name) if i == 0 else ""
            shown.add_row(name, kind, *_figures(result, held_out, setting), *costs, end_section=last)
        if result.failure:
            shown.add_row("", f"[red]{escape(result.failure)}[/red]", end_section=True)
    return shown


def markdown(results: Sequence[Result], setting: Setting) -> str:
    """The paper's table, what failed, and what storage costs."""
    kinds = [f"{name}, {kind}" for kind in KINDS for name in HEADINGS.values()]
    heads = ["system", *kinds, *COSTS]
    lines = ["| " + " | ".join(heads) + " |", "|" + " --- |" * len(heads)]
    for result in results:
        figures = [cell for held_out in KINDS.values() for cell in _figures(result, held_out, setting)]
        lines.append("| " + " | ".join([result.entry.name, *figures, *costs_of(result)]) + " |")
    failed = [f"- {result.entry.name}: {result.failure}" for result in results if result.failure]
    if failed:
        lines += ["", "Failed:", "", *failed]
    stored = storage_costs(results)
    if stored:
        heads = ["file", "storage", "MB", *(f"{kind}, dB" for kind in KINDS)]
        lines += ["", "What storage costs:", "", "| " + " | ".join(heads) + " |", "|" + " --- |" * len(heads)]
        lines += ["| " + " | ".join(row) + " |" for row in stored]
    return "\n".join([*lines, "", legend(setting), ""])


def storage_costs(results: Sequence[Result]) -> list[tuple[str, ...]]:
    """File, storage, MB and the PSNR (dB, by kind) above that of the widest stored file of as many parameters."""
    files = [r for r in results if r.entry.cost.storage in STORAGES and not r.failure]
    rows = []
    for result in files:
        cost = result.entry.cost
        same = [r for r in files if (r.entry.cost.parameters, _meshed(r)) == (cost.parameters, _meshed(result))]
        widest = min(same, key=lambda r: STORAGES.index(r.entry.cost.storage))
        if len(same) > 1:
            gains = [f"{result.of(kind).psnr - widest.of(kind).psnr:+.3f}" for kind in KINDS.values()]
            rows.append((result.entry.name, cost.storage, _cell((cost.bytes or 0) / 1e6, 2), *gains))
    return rows


def as_csv(results: Sequence[Result]) -> str:
    """A line for each entry, unrounded."""
    stream = io.StringIO()
    lines = csv.writer(stream, lineterminator="\n")
    kinds = [f"{kind} {metric}" for kind in KINDS for metric in METRICS]
    lines.writerow(["system", *kinds, "flops", "parameters", "bytes", "fps", "storage", "failure"])
    for result in results:
        cost = result.entry.cost
        means = [getattr(result.of(held_out), metric) for held_out in KINDS.values() for metric in METRICS]
        costs = [cost.flops, cost.parameters, cost.bytes, cost.fps]
        cells = ["" if value is None or not math.isfinite(value) else value for value in [*means, *costs]]
        lines.writerow([result.entry.name, *cells, cost.storage, result.failure])
    return stream.getvalue()


def as_json(results: Sequence[Result], setting: Setting) -> str:
    """Everything, every picture's scores included; null where there is no number."""
    told = [
        {
            "system": result.entry.name,
            "failure": result.failure,
            **asdict(result.entry.cost),
            "mean": {kind: _finite(asdict(result.of(held_out))) for kind, held_out in KINDS.items()},
            "pictures": [{**asdict(s), "scores": _finite(asdict(s.scores))} for s in result.samples],
        }
        for result in results
    ]
    return json.dumps({"setting": asdict(setting), "systems": told}, indent=1, allow_nan=False)


def costs_of(result: Result) -> list[str]:
    """The cells under COSTS."""
    cost = result.entry.cost
    return [
        NOTHING if cost.flops is None else _cell(cost.flops / 1e9, 3),
        NOTHING if cost.parameters is None else _cell(cost.parameters / 1e6, 2),
        NOTHING if cost.bytes is None else _cell(cost.bytes / 1e6, 1),
        NOTHING if cost.fps is None else _cell(cost.fps, 1),
    ]


def _figures(result: Result, held_out: bool, setting: Setting) -> list[str]:
    scores: Scores = result.of(held_out)
    cells = [_cell(getattr(scores, metric), DIGITS[metric]) for metric in METRICS]
    if setting.lpips is None:
        cells[METRICS.index("lpips")] = NO_WEIGHTS
    return cells


def _meshed(result: Result) -> bool:
    """Whether a row is drawn on its own mesh."""
    return result.entry.own_mesh


def _cell(value: float, digits: int) -> str:
    return NOTHING if math.isnan(value) else f"{value:.{digits}f}"


def _finite(values: dict[str, float]) -> dict[str, float | None]:
    return {name: value if math.isfinite(value) else None for name, value in values.items()}
