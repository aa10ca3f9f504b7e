"""What a comparison with a capture's images ends with: a table, every view's figures, and contact sheets."""

import csv
import io
import json
import math
from collections.abc import Sequence
from dataclasses import asdict
from pathlib import Path

import numpy as np
from PIL import Image
from rich.table import Table

from mua.arrays import Array
from mua.avatar.rendering import to_bytes
from mua.evaluation.capture_scores import IMAGE, SPLITS, FilmedEntry, Judged, Shot, Standing, mean_of
from mua.evaluation.report import DIGITS, HEADINGS, NOTHING, cell, finite, table_lines
from mua.evaluation.settings import OURS
from mua.fidelity.strips import GAIN, caption, difference
from mua.files.write import replacing

METRICS = ("psnr", "ssim", "flip", "lpips")
COSTS = ("M parameters", "MFLOP")
LEAST_WIDTH = 190  # pixels of an image under its caption
SHEET_ROWS = 6
NAMED = 4  # views without the person that are named of each camera


def rows(judged: Sequence[Judged], entries: Sequence[FilmedEntry]) -> list[list[str]]:
    """A row for each entry: its name, then PSNR, SSIM, FLIP and, if measured, LPIPS of each split, then its cost."""
    return [
        [one.name, *(figure for split in SPLITS for figure in _figures(judged, one.name, split)), *_costs(one)]
        for one in entries
    ]


def headings(judged: Sequence[Judged]) -> list[str]:
    """What stands over the columns."""
    return ["", *(f"{HEADINGS[metric]}, {split}" for split in SPLITS for metric in _metrics(judged)), *COSTS]


def table(judged: Sequence[Judged], entries: Sequence[FilmedEntry]) -> Table:
    """For a terminal."""
    made = Table(*headings(judged))
    for row in rows(judged, entries):
        made.add_row(*row)
    return made


def markdown(judged: Sequence[Judged], entries: Sequence[FilmedEntry], about: Sequence[str]) -> str:
    """The table below the sentences about it."""
    listed = [f"- {sentence}" for sentence in about]
    return "\n".join([*listed, "", *table_lines(headings(judged), rows(judged, entries)), ""])


def as_csv(judged: Sequence[Judged]) -> str:
    """A line for each view and entry."""
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(["split", "clip", "frame", "camera", "entry", *METRICS])
    for one in judged:
        for name, scores in one.scores.items():
            writer.writerow([*asdict(one.shot).values(), name, *(getattr(scores, metric) for metric in METRICS)])
    return text.getvalue()


def as_json(
    judged: Sequence[Judged], entries: Sequence[FilmedEntry], about: Sequence[str], found: Sequence[Standing]
) -> str:
    """Costs and means of every entry, the points of the curve, and how ours stands; null where there is no number."""
    rows = [
        {
            "name": one.name,
            "system": one.system or None,
            "scale": one.scale if one.system else None,
            **asdict(one.cost),
            "mean": {split: finite(mean_of(judged, one.name, split)) for split in SPLITS},
        }
        for one in entries
    ]
    whole = {"about": list(about), "entries": rows, "standings": [asdict(one) for one in found]}
    return json.dumps(whole, indent=1, allow_nan=False) + "\n"


def nobody_there(shots: Sequence[Shot]) -> list[str]:
    """A sentence for each camera of which some views show nobody."""
    sentences = []
    for camera in dict.fromkeys(shot.camera for shot in shots):
        own = [shot for shot in shots if shot.camera == camera]
        places = ", ".join(f"{shot.clip} {shot.frame}" for shot in own[:NAMED]) + (", ..." if len(own) > NAMED else "")
        counted = "1 view, which counts" if len(own) == 1 else f"{len(own)} views, which count"
        sentences.append(f"Camera {camera}: nobody is seen in {counted} nowhere: {places}.")
    return sentences


def write_images(folder: Path, one: Judged) -> None:
    """The captured image of a view and every entry's: clip/camera/frame_entry.png."""
    for name, picture in one.pictures.items():
        place = folder / one.shot.clip / one.shot.camera / f"{one.shot.frame:06d}_{name.replace(' ', '_')}.png"
        with replacing(place) as temporary:
            Image.fromarray(picture).save(temporary)


def sheet_shots(chosen: Sequence[Shot]) -> list[Shot]:
    """The views that contact sheets show: some of each split, evenly."""
    shown = []
    for split in SPLITS:
        own = [shot for shot in chosen if shot.split == split]
        places = np.unique(np.linspace(0, len(own) - 1, min(SHEET_ROWS, len(own))).astype(int))
        shown += [own[place] for place in places]
    return shown


def student_of(entries: Sequence[FilmedEntry]) -> FilmedEntry:
    """Whose difference from the image is shown: ours, or the last avatar, or what comes last."""
    ours = [one for one in entries if one.system == OURS and one.scale == 1]
    return (ours or [one for one in entries if not one.system] or list(entries))[-1]


def sheet_names(entries: Sequence[FilmedEntry], rival: str | None) -> list[str]:
    """Whose images stand beside the captured one: all that is no system, ours, and the rival."""
    shown = [one.name for one in entries if not one.system]
    return list(dict.fromkeys([*shown, student_of(entries).name, *([rival] if rival else [])]))


def contact_sheet(judged: Sequence[Judged], split: str, names: Sequence[str], student: str) -> Image.Image | None:
    """Captured image, entries and the student's difference, in the views of a split whose images are kept."""
    shown = [one for one in judged if one.shot.split == split and one.pictures]
    if not shown:
        return None
    width = max(LEAST_WIDTH, *(one.pictures[IMAGE].shape[1] for one in shown))
    return Image.fromarray(np.vstack([_strip(one, width, names, student) for one in shown]))


def _strip(one: Judged, width: int, names: Sequence[str], student: str) -> Array:
    image = one.pictures[IMAGE]
    differs = to_bytes(difference(one.pictures[student] / 255, image / 255))
    shown = [image, *(one.pictures[name] for name in names), differs]
    titles = [f"{one.shot.clip} {one.shot.frame} {one.shot.camera}", *names, f"{student}, difference x{GAIN}"]
    return np.vstack([caption(titles, width), np.hstack([_centred(picture, width) for picture in shown])])


def _centred(picture: Array, width: int) -> Array:
    left = (width - picture.shape[1]) // 2
    return np.pad(picture, ((0, 0), (left, width - picture.shape[1] - left), (0, 0)), constant_values=255)


def _metrics(judged: Sequence[Judged]) -> list[str]:
    lpips = any(not math.isnan(scores.lpips) for one in judged for scores in one.scores.values())
    return [metric for metric in METRICS if metric != "lpips" or lpips]


def _figures(judged: Sequence[Judged], name: str, split: str) -> list[str]:
    scores = mean_of(judged, name, split)
    return [cell(getattr(scores, metric), DIGITS[metric]) for metric in _metrics(judged)]


def _costs(entry: FilmedEntry) -> list[str]:
    cost = entry.cost
    return [
        NOTHING if cost.parameters is None else f"{cost.parameters / 1e6:.3f}",
        NOTHING if cost.flops is None else f"{cost.flops / 1e6:.2f}",
    ]
