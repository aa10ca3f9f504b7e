"""Train one student by both recipes on one recording and set their losses against the clock.

    OMP_NUM_THREADS=1 python tools/research/compare_recipes.py RECORDING --preset tiny -o build/recipes

The loss is the paper's (5 |LL| + |D3| + |D2|, geometry plus appearance) over all frames, taken between the steps, with
the clock stopped. Two clocks run: on the wall, and the processor time of all threads of this process, which other work
on the machine does not lengthen. Each measurement goes to losses.csv at once; a recipe left out by --recipe is taken
from there. Writes recipes.png and recipes.md too.
"""

import argparse
import csv
import tempfile
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path
from typing import NamedTuple

import numpy as np
import torch

import mua.cli  # noqa: F401 first of all: it sets how torch's threads wait
from mua.arrays import Array
from mua.channels import APPEARANCE, GEOMETRY
from mua.files.write import replacing
from mua.recording import Recording
from mua.student.distil import describe_frames, prepare
from mua.student.finetune import subband_loss
from mua.student.model import Branch
from mua.student.paper_recipe import fit_branch_from_noise, set_means
from mua.student.settings import RECIPES, Settings, preset, with_recipe
from mua.student.source import Source, hold
from mua.student.stages import BRANCHES, fit_branch
from mua.student.targets import channel_weights
from mua.training.checkpoint import Checkpoints
from mua.training.optimise import Progress, Run
from mua.wavelets import Bands

PAPER_STEPS = 1_000_000
BATCH = 64  # frames of a measurement
POINTS = 60  # points of a curve
KINDS = ("training", "held-out")
STEPS, PROCESSOR, LOSSES = 0, 2, (3, 4)  # columns of a curve
CPU = torch.device("cpu")


@dataclass(frozen=True)
class Frames:
    """Frames of one kind as a branch sees them."""

    inputs: torch.Tensor  # [F, D] normalised descriptors
    source: Source  # subbands of the branch's channels, counted from 0


@dataclass(frozen=True)
class Task:
    """One branch to train."""

    name: str
    channels: slice
    kinds: dict[str, Frames]
    weights: torch.Tensor  # [C]


class Row(NamedTuple):
    """A measurement along the training of a branch, or of both one after the other."""

    steps: int
    seconds: float  # on the wall
    processor: float  # seconds, of all threads
    training: float  # loss
    held_out: float


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("recording", type=Path)
    parser.add_argument("--preset", default="tiny")
    parser.add_argument("--recipe", choices=RECIPES, action="append", help="to run; both if left out")
    parser.add_argument("--steps", type=int, default=PAPER_STEPS, help="of the paper's recipe, for each branch")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("-o", "--output", type=Path, default=Path("build/recipes"))
    arguments = parser.parse_args()
    recording = Recording(arguments.recording)
    settings = replace(preset(arguments.preset), texels=recording.rig.texels.size, seed=arguments.seed)
    short = with_recipe(settings, "paper")
    short = replace(short, finetune=replace(short.finetune, steps=arguments.steps))
    arguments.output.mkdir(parents=True, exist_ok=True)
    kept = Table(arguments.output / "losses.csv")
    tasks = make_tasks(recording, settings)
    for recipe, one in zip(RECIPES, (settings, short), strict=True):
        if recipe not in (arguments.recipe or RECIPES):
            continue
        kept.drop(recipe)
        for task in tasks:
            follow(task, recording, one, partial(kept.add, (recipe, task.name)))
    text = summary(kept)
    (arguments.output / "recipes.md").write_text(text)
    plot(arguments.output / "recipes.png", kept)
    print(text)


def make_tasks(recording: Recording, settings: Settings) -> list[Task]:
    """Both branches with their training and held-out frames in memory."""
    student, samples = prepare(recording, settings)
    held = torch.from_numpy(describe_frames(recording, student.encoding, held_out=True)).float()
    tasks = []
    for name, branch, channels in zip(BRANCHES, student.branches, (GEOMETRY, APPEARANCE), strict=True):
        kinds = {}
        for kind, descriptors, taken in zip(KINDS, (samples.descriptors, held), (False, True), strict=True):

            def subbands(part: slice, rows: torch.Tensor, taken: bool = taken) -> Bands:
                return recording.subbands(part, rows, held_out=taken)

            source = hold(subbands, channels, frames=len(descriptors), size=student.size)
            kinds[kind] = Frames(student.normalize(descriptors), source)
        variance = set_means(branch, kinds["training"].source, frames=len(samples))
        tasks.append(Task(name, channels, kinds, channel_weights(variance, channels)))
    return tasks


def follow(task: Task, recording: Recording, settings: Settings, add: Callable[[Row], None]) -> None:
    """Train one branch and `add` what is measured along the way, the clocks stopped meanwhile."""
    torch.manual_seed(settings.seed)
    student, samples = prepare(recording, settings)
    branch = student.geometry if task.name == "geometry" else student.appearance
    descends = settings.start == "random"
    clocks = (time.perf_counter, time.process_time)
    spent, started = [0.0, 0.0], [clock() for clock in clocks]

    def report(progress: Progress) -> None:
        nonlocal spent, started
        joint = progress.stage.endswith(("descent", "fine-tuning"))
        marks = np.unique(np.geomspace(1, progress.steps, POINTS).astype(int))
        if not joint or progress.step not in marks:
            return
        spent = [before + clock() - since for before, clock, since in zip(spent, clocks, started, strict=True)]
        seconds, processor = spent
        training, held_out = losses(branch, task)
        add(Row(progress.step, seconds, processor, training, held_out))
        started = [clock() for clock in clocks]

    with tempfile.TemporaryDirectory() as directory:
        run = Run(torch.Generator().manual_seed(settings.seed), Checkpoints(Path(directory), "compare"), report, CPU)
        fit: Callable[..., None] = fit_branch_from_noise if descends else partial(fit_branch, parts=samples.parts)
        frames = task.kinds["training"]
        own = run.alone(task.name)  # as in train()
        fit(branch, frames.inputs, frames.source, channels=task.channels, settings=settings, name=task.name, run=own)


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


class Table:
    """The rows of both recipes and branches, kept in a file."""

    def __init__(self, path: Path) -> None:
        self.path = path
        self.rows: list[tuple[str, str, Row]] = []
        if path.exists():
            with path.open(newline="") as file:
                _, *lines = csv.reader(file)
            self.rows = [(a, b, Row(int(steps), *map(float, rest))) for a, b, steps, *rest in lines]

    def drop(self, recipe: str) -> None:
        self.rows = [row for row in self.rows if row[0] != recipe]
        self._write()

    def add(self, key: tuple[str, str], row: Row) -> None:
        self.rows.append((*key, row))
        self._write()
        print(*key, row.steps, *(f"{x:.5g}" for x in row[1:]), flush=True)

    def _write(self) -> None:
        with replacing(self.path) as temporary, temporary.open("w", newline="") as file:
            table = csv.writer(file)
            table.writerow(("recipe", "branch", *Row._fields))
            table.writerows((a, b, *row) for a, b, row in self.rows)

    def curve(self, recipe: str) -> Array:
        """[n, 5] rows of both branches, trained one after the other for as many steps: all but the steps add up."""
        parts = [{r.steps: r for a, b, r in self.rows if (a, b) == (recipe, branch)} for branch in BRANCHES]
        both = sorted(parts[0].keys() & parts[1].keys())
        return np.array([(n, *(np.array(parts[0][n][1:]) + np.array(parts[1][n][1:]))) for n in both])


def summary(table: Table) -> str:
    """The figures as Markdown; nothing where a recipe has not been run."""
    ours, paper = (table.curve(recipe) for recipe in RECIPES)
    if not len(ours) or not len(paper):
        return ""
    lines = ["| recipe | steps | seconds | processor seconds | training loss | held-out loss |"]
    lines.append("| --- | --- | --- | --- | --- | --- |")
    end = paper[-1]
    rows = {"closed-form": ours[-1], "paper": end}
    for name, (steps, seconds, processor, training, held) in rows.items():
        lines.append(f"| {name} | {int(steps):,} | {seconds:.0f} | {processor:.0f} | {training:.4f} | {held:.4f} |")
    best = paper[np.argmin(paper[:, LOSSES[1]])]
    lines += [
        "",
        f"Lowest held-out loss of the paper's recipe: {best[LOSSES[1]]:.4f}, after {int(best[STEPS]):,} steps.",
        f"Time of its steps over that of the closed-form recipe: {end[1] / ours[-1, 1]:.0f} on the wall, "
        f"{end[2] / ours[-1, 2]:.0f} of the processor.",
    ]
    below = ours[ours[:, LOSSES[0]] <= end[LOSSES[0]]]
    if len(below):
        lines.append(
            f"Its last training loss is reached by the closed-form recipe after {below[0, PROCESSOR]:.0f} "
            f"processor seconds, 1/{end[PROCESSOR] / below[0, PROCESSOR]:.0f} of its own."
        )
    return "\n".join(lines) + "\n"


def plot(path: Path, table: Table) -> None:
    import matplotlib.pyplot as plt

    figure, panels = plt.subplots(1, 2, figsize=(10, 4), sharey=True, layout="constrained")
    for panel, kind, column in zip(panels, KINDS, LOSSES, strict=True):
        for recipe, colour in zip(RECIPES, ("tab:blue", "tab:orange"), strict=True):
            curve = table.curve(recipe)
            if len(curve):
                panel.plot(curve[:, PROCESSOR], curve[:, column], color=colour, label=recipe, marker=".", markersize=3)
        panel.set(xscale="log", xlabel="processor seconds", title=f"{kind} frames")
    panels[0].set_ylabel("5 |LL| + |D3| + |D2|")
    panels[0].legend()
    figure.savefig(path, dpi=120)


if __name__ == "__main__":
    main()
