"""What a comparison with a capture's pictures ends with: a table, every view's figures, and contact sheets."""

import csv
import io
import math
from collections.abc import Sequence
from dataclasses import asdict

import numpy as np
from PIL import Image
from rich.table import Table

from mua.arrays import Array
from mua.compare.filmed import IMAGE, SPLITS, Judged, Likeness, mean
from mua.fidelity.strips import GAIN, caption, difference
from mua.rendering import to_bytes

DIGITS = {"psnr": 2, "ssim": 4, "flip": 4, "lpips": 2}
HEADINGS = {"psnr": "PSNR", "ssim": "SSIM", "flip": "FLIP", "lpips": "LPIPS"}
LEAST_WIDTH = 190  # pixels of a picture under its caption
SHEET_ROWS = 6


def rows(judged: Sequence[Judged], names: Sequence[str]) -> list[list[str]]:
    """A row for each entry: its name, then PSNR, SSIM, FLIP and, if measured, LPIPS of each split."""
    return [[name, *(cell for split in SPLITS for cell in _cells(mean(judged, name, split), judged))] for name in names]


def headings(judged: Sequence[Judged]) -> list[str]:
    """What stands over the columns."""
    return ["", *(f"{HEADINGS[metric]}, {split}" for split in SPLITS for metric in _metrics(judged))]


def table(judged: Sequence[Judged], names: Sequence[str]) -> Table:
    """For a terminal."""
    made = Table(*headings(judged))
    for row in rows(judged, names):
        made.add_row(*row)
    return made


def markdown(judged: Sequence[Judged], names: Sequence[str], about: str) -> str:
    """The table under a sentence."""
    heads = headings(judged)
    lines = [heads, ["---"] * len(heads), *rows(judged, names)]
    return f"{about}\n\n" + "\n".join(f"| {' | '.join(line)} |" for line in lines) + "\n"


def as_csv(judged: Sequence[Judged]) -> str:
    """A line for each view and entry."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(["split", "clip", "frame", "camera", "entry", *DIGITS])
    for one in judged:
        for name, scores in one.scores.items():
            writer.writerow([*asdict(one.shot).values(), name, *asdict(scores).values()])
    return text.getvalue()


def contact_sheet(judged: Sequence[Judged], split: str) -> Image.Image | None:
    """Image, every entry and how the last differs from the image, for some views of a split; None where it has none."""
    own = [one for one in judged if one.shot.split == split]
    if not own:
        return None
    chosen = [own[i] for i in np.unique(np.linspace(0, len(own) - 1, min(SHEET_ROWS, len(own))).astype(int))]
    width = max(LEAST_WIDTH, *(one.pictures[IMAGE].shape[1] for one in chosen))
    return Image.fromarray(np.vstack([_strip(one, width) for one in chosen]))


def _strip(one: Judged, width: int) -> Array:
    last = list(one.pictures.values())[-1]
    shown = [*one.pictures.values(), difference(last, one.pictures[IMAGE])]
    titles = [f"{one.shot.clip} {one.shot.frame} {one.shot.camera}", *list(one.pictures)[1:], f"difference x{GAIN}"]
    return np.vstack([caption(titles, width), np.hstack([to_bytes(_centred(picture, width)) for picture in shown])])


def _centred(picture: Array, width: int) -> Array:
    left = (width - picture.shape[1]) // 2
    return np.pad(picture, ((0, 0), (left, width - picture.shape[1] - left), (0, 0)), constant_values=1)


def _metrics(judged: Sequence[Judged]) -> list[str]:
    lpips = any(not math.isnan(scores.lpips) for one in judged for scores in one.scores.values())
    return [metric for metric in DIGITS if metric != "lpips" or lpips]


def _cells(scores: Likeness | None, judged: Sequence[Judged]) -> list[str]:
    return ["-" if scores is None else f"{getattr(scores, metric):.{DIGITS[metric]}f}" for metric in _metrics(judged)]
