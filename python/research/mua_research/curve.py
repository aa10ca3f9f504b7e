"""The curve of a comparison with images: PSNR of every system at every size against what it costs."""

from collections.abc import Callable, Sequence

import matplotlib
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from mua.evaluation.capture_scores import SPLITS, TEACHER, FilmedEntry, Judged, mean_of
from mua.evaluation.plots import against_cost, png
from mua.evaluation.settings import OURS, SYSTEM_NAMES

COSTS: dict[str, Callable[[FilmedEntry], float]] = {
    "million parameters": lambda entry: (entry.cost.parameters or 0) / 1e6,
    "million operations a frame": lambda entry: (entry.cost.flops or 0) / 1e6,
}
MARKS = "osv^D<>P"


def curve(judged: Sequence[Judged], entries: Sequence[FilmedEntry]) -> bytes:
    """PNG: a row for each split that has views, a column for each cost; a line for each system, dashed the teacher."""
    splits = [split for split in SPLITS if any(one.shot.split == split for one in judged)]
    figure = Figure(figsize=(12, 4.5 * len(splits)), layout="constrained")
    panels = figure.subplots(len(splits), len(COSTS), sharex="col", sharey="row", squeeze=False)
    for row, split in zip(panels, splits, strict=True):
        for panel, (unit, cost) in zip(row, COSTS.items(), strict=True):
            _lines(panel, judged, entries, split=split, cost=cost)
            against_cost(panel, split, unit)
    handles, labels = panels[0][0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside lower center", ncols=5, fontsize=9)
    return png(figure)


def points(
    judged: Sequence[Judged],
    entries: Sequence[FilmedEntry],
    system: str,
    split: str,
    cost: Callable[[FilmedEntry], float],
) -> list[tuple[float, float]]:
    """Cost and PSNR of a system's sizes in a split, the cheapest first."""
    return sorted((cost(one), mean_of(judged, one.name, split).psnr) for one in entries if one.system == system)


def _lines(
    panel: Axes,
    judged: Sequence[Judged],
    entries: Sequence[FilmedEntry],
    *,
    split: str,
    cost: Callable[[FilmedEntry], float],
) -> None:
    palette = matplotlib.colormaps["tab10"]
    for place, name in enumerate(SYSTEM_NAMES):
        line = points(judged, entries, name, split, cost)
        if line:
            width = 2.5 if name == OURS else 1.2
            panel.plot(*zip(*line, strict=True), f"{MARKS[place]}-", color=palette(place), linewidth=width, label=name)
    if any(one.name == TEACHER for one in entries):
        panel.axhline(mean_of(judged, TEACHER, split).psnr, color="0.3", linestyle="--", linewidth=1, label=TEACHER)
