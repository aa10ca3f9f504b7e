"""Measure everything that a graphics card makes faster, and write a page of tables for docs/research.

python tools/measure_gpu.py [--quick] [-o PAGE]: distils, teaches, draws for training and plays, on the processor and,
where torch finds one, on the card. The page grows row by row. --quick takes the smallest sizes, to see that it runs.
What fails stands in the table with its last line, and the rest goes on.
"""

import argparse
import json
import platform
import re
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from dataclasses import dataclass
from datetime import date
from importlib.util import find_spec
from pathlib import Path
from time import perf_counter

import checkout  # noqa: F401
import torch
from drawn_capture import film

from mua.files.write import write_bytes

ROOT = Path(__file__).resolve().parents[1]
CLIPS = {"dance": False, "walk": True}  # of the teacher's capture; whether they are held out
RASTERISER = ROOT / "tools" / "research" / "bench_rasteriser.py"
STAGES = {
    "decode": ("MlpMatmul", "MlpMatmulTransposed", "BlendLl", "BlendDetail", "InverseDwt", "UpsampleTexels"),
    "project": ("SplatProject",),
    "sort": ("CountDigits", "ScanDigits", "ScatterDigits"),
}


@dataclass(frozen=True)
class Sizes:
    """How large everything is that is measured."""

    frames: int  # that the bake records
    steps: int  # of the teacher's training
    side: int  # pixels of the teacher's and of the rasteriser's images
    filmed: int  # frames of each clip of the capture
    presets: tuple[str, ...]  # of the avatars that are played
    played: int  # frames


FULL = Sizes(frames=60, steps=200, side=512, filmed=4, presets=("tiny", "preview", "paper"), played=40)
QUICK = Sizes(frames=8, steps=5, side=64, filmed=2, presets=("tiny",), played=2)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help="the smallest sizes, to see that it runs")
    parser.add_argument(
        "-o", "--output", type=Path, default=ROOT / "docs" / "research" / "gpu.md", help="page to write"
    )
    given = parser.parse_args()
    sizes = QUICK if given.quick else FULL
    tables: dict[str, list[str]] = {"training": [], "frames": []}
    with tempfile.TemporaryDirectory() as scratch:
        for table, measured in measurements(Path(scratch), sizes):
            tables[table].append(measured)
            write_bytes(given.output, page(sizes, **tables).encode())  # what stops it leaves what was measured
    print(given.output)


def measurements(folder: Path, sizes: Sizes) -> Iterator[tuple[str, str]]:
    """The table that a row belongs to, and the row; of a card first, which takes less time."""
    devices = ("cuda", "cpu") if torch.cuda.is_available() else ("cpu",)
    yield from (("frames", play(folder, preset, sizes)) for preset in sizes.presets)
    yield "training", bake(folder, sizes)
    for device in devices:
        yield from (("training", measure(folder, device, sizes)) for measure in (distil, rasterise, teach))


def bake(folder: Path, sizes: Sizes) -> str:
    """The procedural figure, recorded and distilled on the processor; its recording is kept."""
    command = ["--preset", "tiny", "--frames", str(sizes.frames), "--device", "cpu", "--work", str(folder / "work")]
    seconds, said, _ = run("-m", "mua.cli.bake", *command, "-o", str(avatar_of(folder)))
    return row(
        f"bake the demo's figure, {sizes.frames} frames", "cpu", seconds, "" if avatar_of(folder).exists() else said
    )


def distil(folder: Path, device: str, sizes: Sizes) -> str:
    """The same recording, on each device."""
    (largest,) = sorted((folder / "work").glob("recording-*"), key=used)[-1:] or [folder]
    output = folder / f"{device}.muaavatar"
    seconds, said, _ = run(
        "-m", "mua.cli.train", str(largest), "--preset", "tiny", "--device", device, "-o", str(output)
    )
    if output.exists():
        errors = json.loads((folder / f"{device}_errors.json").read_text())["groups"]["training"]["rms"]
        said = f"offsets off by {errors['offset']['student']:.3f} mm"
    return row(f"distil it, {sizes.frames} frames", device, seconds, said)


def avatar_of(folder: Path) -> Path:
    return folder / "figure.muaavatar"


def used(folder: Path) -> int:
    """Bytes of the files in a folder."""
    return sum(file.stat().st_size for file in folder.rglob("*"))


def teach(folder: Path, device: str, sizes: Sizes) -> str:
    """A teacher, from images that are drawn of the avatar baked on the processor."""
    what, capture, avatar = f"teach, {sizes.steps} steps", folder / "capture", avatar_of(folder)
    if not avatar.exists():
        return row(what, device, 0, "nothing was baked that it could film")
    if not capture.exists():
        capture.mkdir()
        template = capture / "template.glb"
        run("-m", "mua.cli.export", str(avatar), "--what", "mesh", "--frames", "0", "-o", str(template))
        film(avatar, template, capture, clips=CLIPS, frames=sizes.filmed, side=sizes.side)
    sized = ["--steps", str(sizes.steps), "--device", device]
    command = ["-m", "mua.cli.teach", str(capture), *sized, "-o", str(folder / f"teacher_{device}")]
    seconds, said, works = run(*command, lines=sizes.steps)
    spent = re.findall(r"[\d.]+ s\b", said)  # by stage
    return row(what, device, seconds, f"{spent[-1]} in its last stage" if works and spent else said.split("; ")[-1])


def rasterise(folder: Path, device: str, sizes: Sizes) -> str:
    """One image and its gradients, on a card beside gsplat where it is installed."""
    beside = ["--gsplat"] if device == "cuda" and find_spec("gsplat") else []
    shown = [str(avatar_of(folder)), "--side", str(sizes.side), "--device", device, *beside]
    seconds, said, _ = run(str(RASTERISER), *shown, lines=4)
    return row(f"draw {sizes.side} x {sizes.side} with gradients", device, seconds, said)


def play(folder: Path, preset: str, sizes: Sizes) -> str:
    """A frame of an avatar of random numbers, by stages."""
    output = folder / f"{preset}.json"
    _, said, works = run(
        *("-m", "mua.cli.bench", "--preset", preset, "--stereo", "--frames", str(sizes.played), "--json", str(output))
    )
    if not works:
        return f"| `{preset}` | {said} |" + " |" * (len(STAGES) + 2)
    found = json.loads(output.read_text())
    spent = {name: each["milliseconds"]["median"] for name, each in found["kernels"].items()}
    stages = [sum(spent.get(kernel, 0.0) for kernel in kernels) for kernels in STAGES.values()]
    rest = sum(spent.values()) - sum(stages)
    figures = (*stages, rest, found["draw_milliseconds"]["median"])
    return f"| `{preset}` | {found['device']} | " + " | ".join(f"{each:.2f}" for each in figures) + " |"


def run(*command: str, lines: int = 1) -> tuple[float, str, bool]:
    """Seconds that a Python command takes, the last lines of what it says, and whether it works."""
    began = perf_counter()
    done = subprocess.run([sys.executable, *command], capture_output=True, text=True, check=False, cwd=ROOT)
    said = [
        line.strip() for line in (done.stdout if done.returncode == 0 else done.stderr).splitlines() if line.strip()
    ]
    return perf_counter() - began, "; ".join(said[-lines:]).replace("|", "/"), done.returncode == 0


def row(what: str, device: str, seconds: float, said: str) -> str:
    name = torch.cuda.get_device_name() if device == "cuda" else platform.processor() or platform.machine()
    return f"| {what} | {device}: {name} | {seconds:.1f} | {said} |"


def page(sizes: Sizes, training: list[str], frames: list[str]) -> str:
    """The page's Markdown."""
    quick = "" if sizes == FULL else " --quick"
    lines = [
        "# On a graphics card",
        "",
        f"    python tools/measure_gpu.py{quick}",
        "",
        f"On {date.today()}, {platform.platform()}, Python {platform.python_version()}, torch {torch.__version__}.",
        "",
        "| training | device | seconds | |",
        "| --- | --- | ---: | --- |",
        *training,
        "",
        f"A frame for two eyes of 1024 x 1024 pixels, the median of {sizes.played}, milliseconds:",
        "",
        f"| preset | device | {' | '.join(STAGES)} | rest | draw |",
        "| --- | --- |" + " ---: |" * (len(STAGES) + 2),
        *frames,
        "",
    ]
    return "\n".join(lines)


if __name__ == "__main__":
    main()
