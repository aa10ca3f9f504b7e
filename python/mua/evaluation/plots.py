"""The figures of a comparison: error by frame, rate and distortion, contact sheets with the worst place of a frame."""

import io
import math
from collections.abc import Callable, Sequence

import matplotlib
import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import LogLocator, MaxNLocator, NullFormatter
from PIL import Image, ImageDraw, ImageOps
from scipy.ndimage import uniform_filter

from mua.arrays import Array
from mua.avatar.rendering import to_bytes
from mua.evaluation.images import Studio
from mua.evaluation.metrics import compare
from mua.evaluation.scores import KINDS, Result
from mua.fidelity.strips import caption
from mua.recording import WholeFrame

DPI = 120
LABEL_GAP = 0.055  # of an axis' height, between labels
Colour = tuple[float, float, float, float]
Point = tuple[float, float, str, Colour]  # cost, PSNR, name

PALETTES = ("tab10", "tab20")  # the second where the first has too few colours
CELL = 300  # pixels along a cell's longer side
CROP = 6  # the zoomed square has so small a part of an image's side
MARGIN = 0.04  # of an image's side, around the figure
SHEET_FRAMES = 2  # of a kind: the worst and the median
SHOWN_FLIP = 0.3  # white on the map


def error_by_frame(results: Sequence[Result]) -> bytes:
    """PNG: PSNR of every frame, mean over views, training and held-out frames side by side."""
    figure = Figure(figsize=(12, 4.5), layout="constrained")
    panels = figure.subplots(1, len(KINDS), sharey=True)
    for panel, (kind, held_out) in zip(panels, KINDS.items(), strict=True):
        for colour, result in zip(_colours(len(results)), results, strict=True):
            values = _by_frame(result, held_out)
            panel.plot(range(len(values)), list(values.values()), ".-", color=colour, label=result.entry.name)
        _mark_clips(panel, next((_by_frame(r, held_out) for r in results if _by_frame(r, held_out)), {}))
        panel.set(title=f"{kind} poses", xlabel="frame, by clip")
        panel.xaxis.set_major_locator(MaxNLocator(integer=True))
        panel.grid(alpha=0.3)
    panels[0].set_ylabel("PSNR, dB")
    handles, labels = panels[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside right center", fontsize=8)
    return png(figure)


def rate_distortion(results: Sequence[Result]) -> bytes:
    """PNG: PSNR on training and held-out poses against size and against operations."""
    costs: dict[str, Callable[[Result], float | None]] = {
        "MB": lambda r: None if r.entry.cost.bytes is None else r.entry.cost.bytes / 1e6,
        "GFLOPs a frame": lambda r: None if r.entry.cost.flops is None else r.entry.cost.flops / 1e9,
    }
    figure = Figure(figsize=(12, 9), layout="constrained")
    panels = figure.subplots(len(KINDS), len(costs), sharex="col", sharey="row")
    for row, (kind, held_out) in zip(panels, KINDS.items(), strict=True):
        points = [_scatter(panel, results, cost, held_out) for panel, cost in zip(row, costs.values(), strict=True)]
        for panel, unit, own in zip(row, costs, points, strict=True):
            _label(panel, own)
            against_cost(panel, f"{kind} poses", unit)
    return png(figure)


def against_cost(panel: Axes, title: str, unit: str) -> None:
    """Axes of PSNR over a cost, on a logarithm."""
    panel.set(title=title, xlabel=unit, ylabel="PSNR, dB", xscale="log")
    panel.xaxis.set_major_locator(LogLocator(subs=(1, 2, 5)))
    panel.xaxis.set_major_formatter("{x:g}")
    panel.xaxis.set_minor_formatter(NullFormatter())
    panel.grid(alpha=0.3, which="both")


def contact_sheet(studio: Studio, frames: Sequence[WholeFrame], results: Sequence[Result]) -> Image.Image:
    """For each frame, teacher and entries beside each other; below each image its worst place and its FLIP map."""
    strips = [_strip(studio, frame, results) for frame in frames]
    widest = max(strip.shape[1] for strip in strips)
    padded = [np.pad(s, ((0, 0), (0, widest - s.shape[1]), (0, 0)), constant_values=255) for s in strips]
    return Image.fromarray(np.vstack(padded))


def sheet_frames(frames: Sequence[WholeFrame], results: Sequence[Result], *, held_out: bool) -> list[WholeFrame]:
    """The worst and the median frame of a kind, by PSNR over all entries."""
    tables = [_by_frame(result, held_out) for result in results]
    own = [frame for frame in frames if frame.clip.held_out == held_out]
    totals = [sum(table.get((f.clip.name, f.index), 0.0) for table in tables) for f in own]
    order = np.argsort(totals, kind="stable")
    picked = dict.fromkeys([int(order[0]), int(order[len(order) // 2])][:SHEET_FRAMES]) if len(order) else {}
    return [own[i] for i in picked]


def _by_frame(result: Result, held_out: bool) -> dict[tuple[str, int], float]:
    """PSNR of each frame of a kind, mean over views, in order."""
    values: dict[tuple[str, int], list[float]] = {}
    for sample in result.samples:
        if sample.held_out == held_out:
            values.setdefault((sample.clip, sample.frame), []).append(sample.scores.psnr)
    return {frame: float(np.mean(own)) for frame, own in values.items()}


def _mark_clips(panel: Axes, frames: dict[tuple[str, int], float]) -> None:
    """A line and a name where each clip begins."""
    last = None
    for place, (clip, _) in enumerate(frames):
        if clip != last:
            panel.axvline(place - 0.5, color="0.8", linewidth=0.8, zorder=0)
            panel.text(place, 0.01, clip, rotation=90, fontsize=7, color="0.4", transform=panel.get_xaxis_transform())
            last = clip


def _scatter(
    panel: Axes, results: Sequence[Result], cost: Callable[[Result], float | None], held_out: bool
) -> list[Point]:
    points = []
    for colour, result in zip(_colours(len(results)), results, strict=True):
        x, y = cost(result), result.of(held_out).psnr
        if x and math.isfinite(y):  # a cost of 0 has no place on a logarithm
            panel.plot(x, y, "o", color=colour)
            points.append((x, y, result.entry.name, colour))
    panel.set_xscale("log")
    panel.margins(x=0.15, y=0.12)
    return points


def _label(panel: Axes, points: Sequence[Point]) -> None:
    """Names at the right edge, in the order of the points' heights and apart, each with a line to its point."""
    if not points:
        return
    low, high = panel.get_ylim()
    points = sorted(points, key=lambda point: point[1])
    heights = np.array([(y - low) / (high - low) for _, y, _, _ in points])
    for i in range(1, len(heights)):
        heights[i] = max(heights[i], heights[i - 1] + LABEL_GAP)
    heights[-1] = min(heights[-1], 1.0)
    for i in range(len(heights) - 2, -1, -1):
        heights[i] = min(heights[i], heights[i + 1] - LABEL_GAP)
    for (x, y, name, colour), height in zip(points, heights, strict=True):
        panel.annotate(
            name,
            (x, y),
            xytext=(1.02, height),
            textcoords="axes fraction",
            fontsize=8,
            va="center",
            color=colour,
            annotation_clip=False,
            arrowprops={"arrowstyle": "-", "linewidth": 0.5, "color": colour},
        )


def _strip(studio: Studio, frame: WholeFrame, results: Sequence[Result]) -> Array:
    """One frame from its worst view [h, w, 3] uint8."""
    truths = studio.draw(frame, frame.texture)
    drawn: dict[str, list[Array]] = {}
    for result in results:
        if not result.failure and result.entry.picture is not None:
            shown = result.entry.picture(frame)
            drawn[result.entry.name] = studio.draw(frame, shown.texture, mesh=shown.mesh)
    flips = {name: [compare(p, t)[1] for p, t in zip(own, truths, strict=True)] for name, own in drawn.items()}
    total = np.sum([np.stack(own) for own in flips.values()], axis=0) if flips else np.zeros((1, *truths[0].shape[:2]))
    view = int(total.mean(axis=(1, 2)).argmax())
    pictures = {"teacher": truths[view], **{name: own[view] for name, own in drawn.items()}}
    maps = {name: own[view] for name, own in flips.items()}
    figure, worst = _figure_box(list(pictures.values())), _worst_box(total[view])
    magma = matplotlib.colormaps["magma"]
    kind = "held out" if frame.clip.held_out else "trained on"
    columns = []
    for name, picture in pictures.items():
        marked = _marked(to_bytes(picture), worst)[figure]
        height = CELL * marked.shape[0] // max(marked.shape[:2])
        width = max(CELL * marked.shape[1] // max(marked.shape[:2]), CELL // 2)
        shown_map = to_bytes(magma(np.clip(maps[name] / SHOWN_FLIP, 0, 1))[..., :3]) if name in maps else None
        blank = np.full((height, width, 3), 255, np.uint8)
        rows = [
            caption([name], width),
            _fit(marked, width, height),
            _fit(to_bytes(picture)[worst], width, width),
            blank if shown_map is None else _fit(shown_map[figure], width, height),
        ]
        columns.append(np.pad(np.vstack(rows), ((0, 0), (0, 2), (0, 0)), constant_values=255))
    strip = np.hstack(columns)
    about = f"{frame.clip.name}, frame {frame.index} ({kind}); below: the marked square, FLIP from 0 to {SHOWN_FLIP}"
    return np.vstack([caption([about], strip.shape[1]), strip])


Box = tuple[slice, slice]  # rows, columns


def _figure_box(pictures: Sequence[Array]) -> Box:
    """Rows and columns that hold what is not black in any image."""
    lit = np.max([picture.max(axis=2) for picture in pictures], axis=0) > 1 / 255
    sides = []
    for axis, length in enumerate(lit.shape):
        hit = np.flatnonzero(lit.any(axis=1 - axis))
        pad = int(MARGIN * length)
        low, high = (hit[0], hit[-1] + 1) if hit.size else (0, length)
        sides.append(slice(max(low - pad, 0), min(high + pad, length)))
    return sides[0], sides[1]


def _worst_box(error: Array) -> Box:
    """The square in which an error map [H, W] has its largest mean."""
    side = max(error.shape[0] // CROP, 1)
    smooth = uniform_filter(error, size=side, mode="constant")
    centre = np.unravel_index(int(smooth.argmax()), smooth.shape)
    starts = [min(max(int(c) - side // 2, 0), length - side) for c, length in zip(centre, error.shape, strict=True)]
    return slice(starts[0], starts[0] + side), slice(starts[1], starts[1] + side)


def _marked(picture: Array, box: Box) -> Array:
    """The image with the square outlined."""
    image = Image.fromarray(picture)
    rows, columns = box
    corners = (columns.start, rows.start, columns.stop - 1, rows.stop - 1)
    ImageDraw.Draw(image).rectangle(corners, outline="white")
    return np.asarray(image)


def _fit(picture: Array, width: int, height: int) -> Array:
    """The image as large as it fits, in the middle of a black cell."""
    return np.asarray(ImageOps.pad(Image.fromarray(picture), (width, height), Image.Resampling.LANCZOS, color="black"))


def _colours(count: int) -> list[Colour]:
    palette = matplotlib.colormaps[PALETTES[count > matplotlib.colormaps[PALETTES[0]].N]]
    return [palette(i % palette.N) for i in range(count)]


def png(figure: Figure) -> bytes:
    """The bytes of a file, the same for the same figure."""
    stream = io.BytesIO()
    figure.savefig(stream, format="png", dpi=DPI, metadata={"Software": None})
    return stream.getvalue()
