"""Train one student by both recipes on one recording and set their losses against wall-clock time.

    python tools/compare_recipes.py RECORDING --preset tiny --steps 100000 -o build/recipes

The loss is the paper's (5 |LL| + |D3| + |D2|, geometry plus appearance) over all frames, taken between the steps, with
the clock stopped. Where the paper's recipe is run for fewer than its million steps, its end is extrapolated from its
own curve by the power law through the last decade of steps; the plot shows both. Writes losses.csv, recipes.png and
recipes.md.
"""

import argparse
import csv
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path

import numpy as np
import torch
from scipy.optimize import curve_fit

import mua.cli  # noqa: F401 first of all: it sets how torch's threads wait
from mua.arrays import Array
from mua.recording import Recording
from mua.student.checkpoint import Checkpoints
from mua.student.descend import descend_branch, set_means
from mua.student.distil import describe_frames, prepare
from mua.student.finetune import subband_loss
from mua.student.model import Bands, Branch
from mua.student.optimise import Progress, Run
from mua.student.settings import RECIPES, Settings, preset, with_recipe
from mua.student.source import Source, hold
from mua.student.targets import channel_weights
from mua.student.train import fit_branch
from mua.texture.channels import APPEARANCE, GEOMETRY

PAPER_STEPS = 1_000_000
BATCH = 64  # frames of a measurement
POINTS = 25  # of a curve
KINDS = ("training", "held-out")
CPU = torch.device("cpu")


@dataclass(frozen=True)
class Frames:
    """Frames of one kind as a branch sees them."""

    inputs: torch.Tensor  # [F, k D] normalised descriptors
    source: Source  # of the branch's channels, counted from 0


@dataclass(frozen=True)
class Task:
    """One branch to train."""

    name: str
    channels: slice
    kinds: dict[str, Frames]
    weights: torch.Tensor  # [C]


@dataclass
class Curve:
    """Losses of one recipe: rows of seconds, steps and the loss of each kind, both branches together."""

    rows: list[tuple[float, int, float, float]] = field(default_factory=list)

    def array(self) -> Array:
        return np.array(self.rows)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("recording", type=Path)
    parser.add_argument("--preset", default="tiny")
    parser.add_argument("--steps", type=int, default=100_000, help="of the paper's recipe, for each branch")
    parser.add_argument("--fine-tuning", type=int, help="steps of the closed-form recipe's; the preset's if left out")
    parser.add_argument("--batch", type=int, help="frames of each of them; the preset's if left out")
    parser.add_argument("--rate", type=float, help="of the first of them; the preset's if left out")
    parser.add_argument("-o", "--output", type=Path, default=Path("build/recipes"))
    arguments = parser.parse_args()
    recording = Recording(arguments.recording)
    settings = replace(preset(arguments.preset), texels=recording.rig.texels.size)
    given = {"steps": arguments.fine_tuning, "batch": arguments.batch, "rate": arguments.rate}
    change = {name: value for name, value in given.items() if value is not None}
    settings = replace(settings, finetune=replace(settings.finetune, **change))
    tasks = make_tasks(recording, settings)
    short = with_recipe(settings, "paper")
    short = replace(short, finetune=replace(short.finetune, steps=arguments.steps))
    curves = {}
    for recipe, one in zip(RECIPES, (settings, short), strict=True):
        parts = [follow(task, recording, one) for task in tasks]
        curves[recipe] = join(parts)
        print(recipe, *(f"{x:.4g}" for x in curves[recipe].rows[-1]), flush=True)
    arguments.output.mkdir(parents=True, exist_ok=True)
    write_csv(arguments.output / "losses.csv", curves)
    text = summary(curves)
    (arguments.output / "recipes.md").write_text(text)
    plot(arguments.output / "recipes.png", curves)
    print(text)


def make_tasks(recording: Recording, settings: Settings) -> list[Task]:
    """Both branches with their training and held-out frames in memory."""
    student, samples = prepare(recording, settings)
    held = torch.from_numpy(describe_frames(recording, student.encoding, held_out=True)).float()
    tasks = []
    for name, branch, channels in zip(
        ("geometry", "appearance"), student.branches, (GEOMETRY, APPEARANCE), strict=True
    ):
        kinds = {}
        for kind, descriptors, taken in zip(KINDS, (samples.descriptors, held), (False, True), strict=True):

            def subbands(part: slice, rows: torch.Tensor, taken: bool = taken) -> Bands:
                return Bands(*recording.subbands(part, rows, held_out=taken))

            source = hold(subbands, channels, frames=len(descriptors), size=student.size)
            kinds[kind] = Frames(student.normalize(descriptors), source)
        variance = set_means(branch, kinds["training"].source, frames=len(samples))
        tasks.append(Task(name, channels, kinds, channel_weights(variance, channels)))
    return tasks


def follow(task: Task, recording: Recording, settings: Settings) -> list[tuple[float, int, float, float]]:
    """Train one branch; (seconds, step, training loss, held-out loss) along the way, the clock stopped to measure."""
    torch.manual_seed(settings.seed)
    student, samples = prepare(recording, settings)
    branch = student.geometry if task.name == "geometry" else student.appearance
    descends = settings.start == "random"
    steps = settings.finetune.steps
    marks = set(np.unique(np.geomspace(1, steps, POINTS).astype(int)).tolist())
    rows: list[tuple[float, int, float, float]] = []
    spent, started = 0.0, time.perf_counter()

    def report(progress: Progress) -> None:
        nonlocal spent, started
        joint = progress.stage.endswith(("descent", "fine-tuning"))
        if not joint or progress.step not in marks:
            return
        spent += time.perf_counter() - started
        rows.append((spent, progress.step, *losses(branch, task)))
        started = time.perf_counter()

    with tempfile.TemporaryDirectory() as directory:
        run = Run(torch.Generator().manual_seed(settings.seed), Checkpoints(Path(directory), "compare"), report, CPU)
        fit: Callable[..., None] = descend_branch if descends else partial(fit_branch, parts=samples.parts)
        frames = task.kinds["training"]
        own = run.alone(task.name)  # as train() has it
        fit(branch, frames.inputs, frames.source, channels=task.channels, settings=settings, name=task.name, run=own)
    return rows


@torch.no_grad()
def losses(branch: Branch, task: Task) -> tuple[float, float]:
    """The paper's loss over all frames of either kind; the branch is in the scale that it is trained in."""
    scale = task.weights[:, None, None]
    found = []
    for kind in KINDS:
        frames = task.kinds[kind]
        total = 0.0
        for rows in torch.arange(len(frames.inputs)).split(BATCH):
            truth = Bands(*(band * scale for band in frames.source(slice(0, branch.channels), rows)))
            total += len(rows) * float(subband_loss(branch(frames.inputs[rows]), truth))
        found.append(total / max(len(frames.inputs), 1))
    return found[0], found[1]


def join(parts: list[list[tuple[float, int, float, float]]]) -> Curve:
    """Both branches, trained one after the other for as many steps: seconds and losses add up."""
    a, b = (np.array(part) for part in parts)
    assert (a[:, 1] == b[:, 1]).all()
    rows = np.column_stack([a[:, 0] + b[:, 0], a[:, 1], a[:, 2:] + b[:, 2:]])
    return Curve([(float(r[0]), int(r[1]), float(r[2]), float(r[3])) for r in rows])


@dataclass(frozen=True)
class Tail:
    """loss = floor + height steps^-power, through the last decade of a curve."""

    floor: float
    height: float
    power: float

    def __call__(self, steps: Array) -> Array:
        return self.floor + self.height * np.asarray(steps, dtype=float) ** -self.power


def tail(curve: Curve, column: int) -> Tail:
    table = curve.array()
    last = table[table[:, 1] >= table[-1, 1] / 10]
    low = last[:, column].min()
    start = (0.5 * low, (last[0, column] - 0.5 * low) * last[0, 1] ** 0.3, 0.3)
    found, _ = curve_fit(
        lambda x, floor, height, power: floor + height * x**-power,
        last[:, 1], last[:, column], p0=start, bounds=([0, 0, 0.01], [low, np.inf, 3]), maxfev=20000,
    )  # fmt: skip
    return Tail(*map(float, found))


def summary(curves: dict[str, Curve]) -> str:
    """The figures as Markdown."""
    ours, paper = curves["closed-form"].array()[-1], curves["paper"].array()
    pace = paper[-1, 0] / paper[-1, 1]
    lines = ["| recipe | steps | seconds | training loss | held-out loss |", "| --- | --- | --- | --- | --- |"]
    lines.append(f"| closed-form | {int(ours[1])} | {ours[0]:.0f} | {ours[2]:.4f} | {ours[3]:.4f} |")
    lines.append(
        f"| paper, as run | {int(paper[-1, 1]):,} | {paper[-1, 0]:.0f} | {paper[-1, 2]:.4f} | {paper[-1, 3]:.4f} |"
    )
    ends = [float(tail(curves["paper"], column)(np.array(PAPER_STEPS))) for column in (2, 3)]
    lines.append(
        f"| paper, extrapolated | {PAPER_STEPS:,} | {pace * PAPER_STEPS:.0f} | {ends[0]:.4f} | {ends[1]:.4f} |"
    )
    best = paper[np.argmin(paper[:, 3])]
    lines += [
        "",
        f"Lowest held-out loss of the paper's recipe: {best[3]:.4f}, after {int(best[1]):,} steps.",
        f"Wall-clock time of a million steps over that of the closed-form recipe: {pace * PAPER_STEPS / ours[0]:.0f}.",
    ]
    return "\n".join(lines) + "\n"


def write_csv(path: Path, curves: dict[str, Curve]) -> None:
    with path.open("w", newline="") as file:
        table = csv.writer(file)
        table.writerow(("recipe", "seconds", "steps", *KINDS))
        for recipe, curve in curves.items():
            table.writerows((recipe, *row) for row in curve.rows)


def plot(path: Path, curves: dict[str, Curve]) -> None:
    import matplotlib.pyplot as plt

    figure, panels = plt.subplots(1, 2, figsize=(10, 4), sharey=True, layout="constrained")
    for panel, kind, column in zip(panels, KINDS, (2, 3), strict=True):
        for recipe, colour in zip(RECIPES, ("tab:blue", "tab:orange"), strict=True):
            table = curves[recipe].array()
            panel.plot(table[:, 0], table[:, column], color=colour, label=recipe, marker=".", markersize=3)
        paper = curves["paper"].array()
        pace = paper[-1, 0] / paper[-1, 1]
        steps = np.geomspace(paper[-1, 1] / 10, PAPER_STEPS, 50)
        law = tail(curves["paper"], column)
        panel.plot(pace * steps, law(steps), "--", color="tab:orange", linewidth=1, label="its power law")
        panel.set(xscale="log", xlabel="seconds of training", title=f"{kind} frames")
    panels[0].set_ylabel("5 |LL| + |D3| + |D2|")
    panels[0].legend()
    figure.savefig(path, dpi=120)


if __name__ == "__main__":
    main()
