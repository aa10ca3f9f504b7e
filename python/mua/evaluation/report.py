"""The table of a comparison, in the paper's columns: terminal, Markdown, CSV and JSON."""

import csv
import io
import json
import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass

from rich.console import Group
from rich.markup import escape
from rich.table import Table
from rich.text import Text

from mua.arguments import amount
from mua.evaluation.entries import MEAN
from mua.evaluation.metrics import METRICS, Scores
from mua.evaluation.scores import KINDS, Result

HEADINGS = {"psnr": "PSNR", "ssim": "SSIM", "ms_ssim": "MS-SSIM", "flip": "FLIP", "lpips": "LPIPS"}
DIGITS = {"psnr": 2, "ssim": 4, "ms_ssim": 4, "flip": 4, "lpips": 2}
COSTS = ("GFLOPs", "Param (M)", "MB", "FPS")
NOTHING = "-"
STORAGES = ("f32", "f16", "i8", "packed")


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
    covered: float  # share of an image that the figure covers, mean


def legend(results: Sequence[Result], setting: Setting) -> list[str]:
    """What the figures mean, in sentences: of what is in the table alone."""
    entries = [result.entry for result in results]
    costs = [entry.cost for entry in entries]
    files = [cost for cost in costs if cost.storage]
    counted = " and ".join(f"{count} {kind}" for kind, count in setting.frames.items() if count)
    budget = f"{setting.seconds:g} s" if setting.steps is None else amount(setting.steps, "step")
    sentences = [
        f"Means over {counted} frames of {setting.recording}, from {amount(setting.views, 'view')} of "
        f"{setting.size} x {setting.size} pixels, beside the teacher. "
        f"The figure covers {setting.covered:.0%} of an image, the rest is black.",
        "Drawn on the teacher's mesh of the frame"
        + (", but for rows that say own mesh." if any(_meshed(result) for result in results) else "."),
    ]
    if any(entry.picture and not entry.cost.storage and entry.name != MEAN for entry in entries):
        sentences.append(f"Systems were trained for {budget} each, at the sizes of preset {setting.preset}.")
    less = "FLIP and LPIPS" if setting.lpips else "FLIP"
    sentences.append(f"PSNR (dB), SSIM and MS-SSIM: more is nearer; {less}: less is nearer.")
    sentences.append("GFLOPs: of what turns a pose into a texture and a mesh; posing and drawing are left out.")
    sentences.append(f"MB: {'of a file; else ' if files else ''}4 bytes a parameter.")
    if any(cost.fps is not None for cost in costs):
        sentences.append(f"FPS: of files, with posing and drawing, on {setting.device}.")
    sentences.append(
        f"LPIPS: {setting.lpips}, times 1000." if setting.lpips else "LPIPS: no weights given (--lpips-weights FILE)."
    )
    return [*sentences, "The recording does not say whether its teacher is a capture or a simulation."]


def tables(results: Sequence[Result], setting: Setting) -> Group:
    """For the terminal: how near images come, what it costs, what failed, and what the figures mean."""
    failed = [f"{result.entry.name} failed: {result.failure}" for result in results if result.failure]
    texts = [Text(sentence) for sentence in (*failed, *legend(results, setting))]
    return Group(_scores_table(results, setting), _costs_table(results), *texts)


def _scores_table(results: Sequence[Result], setting: Setting) -> Table:
    shown = _table("system", "poses", *_metrics(setting).values(), title="Images beside the teacher's")
    kinds = [(kind, held_out) for kind, held_out in KINDS.items() if setting.frames.get(kind)]
    for result in results:
        if result.failure and not result.samples:
            continue
        for i, (kind, held_out) in enumerate(kinds):
            name = escape(result.entry.name) if i == 0 else ""
            shown.add_row(name, kind, *_figures(result, held_out, setting), end_section=i == len(kinds) - 1)
    return shown


def _costs_table(results: Sequence[Result]) -> Table:
    timed = any(result.entry.cost.fps is not None for result in results)
    heads = COSTS if timed else COSTS[:-1]
    shown = _table("system", *heads, title="What a frame and a file cost")
    for result in results:
        if not result.failure:
            shown.add_row(escape(result.entry.name), *costs_of(result)[: len(heads)])
    return shown


def _table(*heads: str, title: str) -> Table:
    """Names may take several lines, figures are never cut."""
    shown = Table(*heads, title=title)
    for column in shown.columns:
        if column.header not in ("system", "poses"):
            column.justify, column.no_wrap = "right", True
        else:
            column.overflow = "fold"
    return shown


def markdown(results: Sequence[Result], setting: Setting) -> str:
    """The paper's table, what failed, and what storage costs."""
    kinds = [f"{name}, {kind}" for kind in KINDS for name in _metrics(setting).values()]
    heads = ["system", *kinds, *COSTS]
    rows = []
    for result in results:
        figures = [figure for held_out in KINDS.values() for figure in _figures(result, held_out, setting)]
        rows.append([result.entry.name, *figures, *costs_of(result)])
    lines = table_lines(heads, rows)
    failed = [f"- {result.entry.name}: {result.failure}" for result in results if result.failure]
    if failed:
        lines += ["", "Failed:", "", *failed]
    stored = storage_costs(results)
    if stored:
        heads = ["file", "storage", "MB", *(f"{kind}, dB" for kind in KINDS)]
        lines += ["", "What storage costs:", "", *table_lines(heads, stored)]
    return "\n".join([*lines, "", *legend(results, setting), ""])


def table_lines(heads: Sequence[str], rows: Sequence[Sequence[str]]) -> list[str]:
    """A table in Markdown."""
    return [f"| {' | '.join(line)} |" for line in (heads, ["---"] * len(heads), *rows)]


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
            rows.append((result.entry.name, cost.storage, cell((cost.bytes or 0) / 1e6, 2), *gains))
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
    """Everything, every image's scores included; null where there is no number."""
    systems = [
        {
            "system": result.entry.name,
            "failure": result.failure,
            **asdict(result.entry.cost),
            "mean": {kind: finite(result.of(held_out)) for kind, held_out in KINDS.items()},
            "pictures": [{**asdict(s), "scores": finite(s.scores)} for s in result.samples],
        }
        for result in results
    ]
    return json.dumps({"setting": asdict(setting), "systems": systems}, indent=1, allow_nan=False)


def costs_of(result: Result) -> list[str]:
    """The cells under COSTS."""
    cost = result.entry.cost
    return [
        NOTHING if cost.flops is None else cell(cost.flops / 1e9, 3),
        NOTHING if cost.parameters is None else cell(cost.parameters / 1e6, 2),
        NOTHING if cost.bytes is None else cell(cost.bytes / 1e6, 1),
        NOTHING if cost.fps is None else cell(cost.fps, 1),
    ]


def _metrics(setting: Setting) -> dict[str, str]:
    """Headings by metric, of those that were measured."""
    return {name: heading for name, heading in HEADINGS.items() if name != "lpips" or setting.lpips}


def _figures(result: Result, held_out: bool, setting: Setting) -> list[str]:
    scores: Scores = result.of(held_out)
    return [cell(getattr(scores, metric), DIGITS[metric]) for metric in _metrics(setting)]


def _meshed(result: Result) -> bool:
    """Whether a row is drawn on its own mesh."""
    return result.entry.own_mesh


def cell(value: float, digits: int) -> str:
    """A number in a table."""
    return NOTHING if math.isnan(value) else f"{value:.{digits}f}"


def finite(scores: Scores) -> dict[str, float | None]:
    """Null where there is no number, for JSON."""
    return {name: value if math.isfinite(value) else None for name, value in asdict(scores).items()}
