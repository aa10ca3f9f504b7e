"""Runs mua-bake over the characters of tools/gallery.toml and leaves one sheet and one table.

    python tools/gallery.py FOLDER              # mua-bake --check, seconds each
    python tools/gallery.py FOLDER --bake       # then a whole bake too: 384 texels, 120 frames

FOLDER holds the files, under the names that the manifest gives them; `--list` says where each is to be had. What was
done is kept in the output directory and not done again; every character runs in a process of its own, so that one that
fails is one row.
"""

import argparse
import json
import os
import subprocess
import sys
import time
import tomllib
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from PIL import Image, ImageDraw, ImageFont

ROOT = Path(__file__).resolve().parents[1]
MANIFEST = ROOT / "tools" / "gallery.toml"
SAMPLES = ROOT.parent / "shared" / "data"  # where the tests look for real data too
TEXELS, FRAMES = 384, 120
GOOD_IOU, GOOD_PSNR = 0.97, 30.0
SECONDS = 3600  # after which a run is ended
CHECKED = (0, 3)  # exit status of a check that found nothing wrong, and of one that did
STRIP = (1152, 534)  # width and height of one view in the image of a check, pixels
VIEWS = (3, 4)  # views of each character: three quarters of its own pose, and the first frame of its motion
HEADINGS = ("character", "motion", "overlap", "inside", "limbs", "facing", "explained", "size", "seconds", "memory")


@dataclass(frozen=True)
class Entry:
    """A character and its motion."""

    name: str
    file: str  # below the folder
    source: str  # where to get it
    licence: str
    motions: tuple[str, ...] = ()  # none: its own clips
    expected: str = ""  # why it is not as like as the others, where it is not

    def files(self) -> tuple[str, ...]:
        return (self.file, *self.motions)


@dataclass(frozen=True)
class Run:
    """One command and what it took."""

    status: int
    seconds: float
    megabytes: float  # at its most
    last_line: str


def read_manifest(path: Path = MANIFEST) -> tuple[Entry, ...]:
    """All entries in the order of the file."""
    with path.open("rb") as file:
        rows = tomllib.load(file)["character"]
    return tuple(Entry(**{**row, "motions": tuple(row.get("motions", ()))}) for row in rows)


def find(folder: Path, name: str) -> Path | None:
    """A file of the manifest, in the folder or among the sample data beside the checkout."""
    return next((path for path in (folder / name, SAMPLES / name) if path.exists()), None)


def run(arguments: list[str], log: Path) -> Run:
    """Run mua-bake with these arguments; all it says goes to `log`."""
    command = [sys.executable, "-c", "from mua.cli.bake import run; run()", *arguments]
    begun = time.monotonic()
    with log.open("wb") as output:
        child = subprocess.Popen(["timeout", str(SECONDS), *command], stdout=output, stderr=subprocess.STDOUT)
        _, status, usage = os.wait4(child.pid, 0)
        child.returncode = os.waitstatus_to_exitcode(status)
    lines = log.read_text(errors="replace").strip().splitlines() or [""]
    return Run(child.returncode, time.monotonic() - begun, usage.ru_maxrss / 1024, lines[-1])


def look_at(entry: Entry, folder: Path, out: Path, *, bake: bool) -> dict[str, Any]:
    """The figures of one entry, from an earlier run where there are any."""
    kept = out / f"{entry.name}_row.json"
    row: dict[str, Any] = json.loads(kept.read_text()) if kept.exists() else {"character": entry.name}
    paths = [find(folder, name) for name in entry.files()]
    missing = [name for name, path in zip(entry.files(), paths, strict=True) if path is None]
    if missing:
        return row | {"failed": f"not in the folder: {', '.join(missing)}"}
    character, *motions = (str(path) for path in paths)
    given = [character, *(part for motion in motions for part in ("--motion", motion))]
    given += ["--texels", str(TEXELS), "-o", str(out / f"{entry.name}.muaavatar")]
    if "check" not in row:
        figures = out / f"{entry.name}_check.json"
        done = run([*given, "--check", "--json", str(figures)], out / f"{entry.name}_check.log")
        row |= {"check": vars(done), "failed": "" if done.status in CHECKED else done.last_line}
        if done.status in CHECKED:
            row |= checked(json.loads(figures.read_text()))
    if bake and row.get("clips") and not row["failed"] and "bake" not in row:  # without motion there is nothing to bake
        done = run([*given, "--frames", str(FRAMES)], out / f"{entry.name}_bake.log")
        row |= {"bake": vars(done), "failed": done.last_line if done.status else ""}
        if not done.status:
            row |= baked(out, entry.name)
    kept.write_text(json.dumps(row, indent=1))
    return row


def checked(figures: dict[str, Any]) -> dict[str, Any]:
    """The figures of a check for the table."""
    fidelity, motion = figures["fidelity"] or {}, figures["motion"]
    facing = [m["facing_degrees"] for m in motion if m["facing_degrees"] is not None]
    return {
        "iou": fidelity.get("iou"),
        "psnr": fidelity.get("psnr"),
        "clips": len(motion),
        "limb_degrees": max((m["limb_degrees"] for m in motion), default=None),
        "facing_degrees": max(facing, default=None),
        "warnings": figures["warnings"],
    }


def baked(out: Path, name: str) -> dict[str, Any]:
    """Size and explained share of a finished bake; the share is that of the offsets, held out where there are such."""
    groups = json.loads((out / f"{name}_errors.json").read_text())["groups"]
    group = next((g for title, g in groups.items() if title.startswith("held")), next(iter(groups.values())))
    size = (out / f"{name}.muaavatar").stat().st_size
    return {"explained": group["explained"]["offset"]["student"], "bytes": size}


def good(row: dict[str, Any]) -> bool:
    """Whether every pose is as like its source as it should be."""
    return not row.get("failed") and (row.get("iou") or 0) >= GOOD_IOU and (row.get("psnr") or 0) >= GOOD_PSNR


def table(entries: Iterable[Entry], rows: Iterable[dict[str, Any]]) -> str:
    """Markdown: a line for each entry, and below it notes on those that fall short."""
    lines = ["| " + " | ".join(HEADINGS) + " |", "|" + " --- |" * len(HEADINGS)]
    notes = []
    pairs = list(zip(entries, rows, strict=True))
    for entry, row in pairs:
        lines.append("| " + " | ".join(_cells(entry, row)) + " |")
        if not good(row):
            words = [row.get("failed", ""), entry.expected, *row.get("warnings", [])[:2]]
            notes.append(f"- {entry.name}: {' '.join(sentence for sentence in words if sentence)}")
    count = sum(good(row) for _, row in pairs)
    ending = f"{count} of {len(pairs)} reach {GOOD_IOU:.2f} and {GOOD_PSNR:.0f} dB in every pose."
    return "\n".join([*lines, "", ending, "", *notes, ""])


def _cells(entry: Entry, row: dict[str, Any]) -> list[str]:
    runs = [row[kind] for kind in ("check", "bake") if kind in row]
    motion = ", ".join(Path(name).stem for name in entry.motions) or f"own ({row.get('clips', 0)})"
    return [
        entry.name,
        motion,
        _shown(row, "iou", lambda v: f"{100 * v:.1f} %"),
        _shown(row, "psnr", lambda v: f"{v:.1f} dB"),
        _shown(row, "limb_degrees", lambda v: f"{v:.1f}°"),
        _shown(row, "facing_degrees", lambda v: f"{v:.0f}°"),
        _shown(row, "explained", lambda v: f"{100 * v:.0f} %"),
        _shown(row, "bytes", lambda v: f"{v / 1e6:.1f} MB"),
        " + ".join(f"{r['seconds']:.0f}" for r in runs),
        f"{max(r['megabytes'] for r in runs) / 1000:.1f} GB" if runs else "",
    ]


def _shown(row: dict[str, Any], name: str, shape: Callable[[float], str]) -> str:
    value = row.get(name)
    return "" if value is None else shape(value)


def sheet(entries: Iterable[Entry], rows: Iterable[dict[str, Any]], out: Path) -> Image.Image:
    """Source, splats and difference of two views of every character that was checked."""
    width, height = STRIP[0] // 2, STRIP[1] // 2
    font = ImageFont.load_default(14)
    lines = []
    for entry, row in zip(entries, rows, strict=True):
        path = out / f"{entry.name}_check.png"
        line = Image.new("RGB", (len(VIEWS) * width, height + 20), "white")
        figures = " ".join(_cells(entry, row)[2:4]) or row.get("failed", "")[:120]
        ImageDraw.Draw(line).text((4, 2), f"{entry.name}: {figures}", fill="black", font=font)
        if path.exists():
            with Image.open(path) as picture:
                for column, view in enumerate(VIEWS):
                    left, top = STRIP[0] * (view % 2), STRIP[1] * (view // 2)
                    if top < picture.height:
                        cut = picture.crop((left, top, left + STRIP[0], top + STRIP[1]))
                        line.paste(cut.resize((width, height)), (column * width, 20))
        lines.append(np.asarray(line))
    return Image.fromarray(np.vstack(lines))


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("folder", type=Path, help="where the files lie")
    parser.add_argument("--bake", action="store_true", help="bake too, not only check")
    parser.add_argument("--out", type=Path, default=ROOT / "build" / "gallery", help="where sheet and table go")
    parser.add_argument("--only", action="append", default=[], help="name of an entry, may be repeated")
    parser.add_argument("--list", action="store_true", help="say where the files are to be had, and do nothing")
    options = parser.parse_args()
    entries = [entry for entry in read_manifest() if not options.only or entry.name in options.only]
    if options.list:
        for entry in entries:
            there = "" if all(find(options.folder, name) for name in entry.files()) else " (not here)"
            print(f"{entry.file}{there}: {entry.source}; {entry.licence}")
        return
    options.out.mkdir(parents=True, exist_ok=True)
    rows = []
    for entry in entries:
        rows.append(look_at(entry, options.folder, options.out, bake=options.bake))
        print(" | ".join(_cells(entry, rows[-1])), rows[-1].get("failed", ""), flush=True)
    (options.out / "gallery.md").write_text(table(entries, rows))
    (options.out / "gallery.json").write_text(json.dumps(rows, indent=1))
    sheet(entries, rows, options.out).save(options.out / "gallery.png")
    print(table(entries, rows).split("\n\n")[1])
    print(options.out / "gallery.md", options.out / "gallery.png", sep="\n")


if __name__ == "__main__":
    main()
