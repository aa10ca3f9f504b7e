"""Train one student by each option for unseen motion on one recording and set their losses side by side.

    python tools/research/compare_options.py RECORDING --preset tiny -o build/options
    python tools/research/compare_options.py RECORDING --leave 01_06 --leave 01_12 --leave 02_06 -o build/options_left

The second form leaves training clips out and measures errors on them, so that options are not chosen by the held-out
clips. Each option changes the default in one place. The loss is the paper's (5 |LL| + |D3| + |D2|, geometry plus
appearance, in units of each attribute's spread) over all recorded frames; the shares are of the unseen frames' variance
about the training mean that the student explains. All options share the bases, which are not timed. Rows that
OUTPUT/options.csv holds are kept, so that a comparison can be cut short and extended. Writes options.csv and
options.md.
"""

import csv
import tempfile
import time
from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path
from typing import Annotated

import numpy as np
import torch
import typer
from left_out import left_out, some
from torch import Tensor

import mua.cli  # noqa: F401 first of all: it sets how torch's threads wait
from mua.channels import APPEARANCE, ATTRIBUTES, CHANNELS, GEOMETRY
from mua.files.write import replacing
from mua.recording import Recording
from mua.student.distil import describe_frames, prepare
from mua.student.finetune import subband_loss
from mua.student.model import Student
from mua.student.paper_recipe import set_means
from mua.student.settings import Settings, preset
from mua.student.stages import BRANCHES, Samples, train
from mua.student.targets import channel_weights
from mua.training.checkpoint import Checkpoints, run_key
from mua.training.optimise import Progress
from mua.wavelets import Bands

CPU = torch.device("cpu")
BATCH = 64  # frames of a measurement
LONGER = 10  # times the steps of the fine-tuning

OPTIONS: dict[str, dict[str, float]] = {
    "default": {},
    "all joints alike": {"fade": 1.0},
    "fade 0.8": {"fade": 0.8},
    "fade 0.4": {"fade": 0.4},
    "no parts exchanged": {"exchanged": 0.0},
    "three quarters of the points": {"exchanged": 0.75},
    "all points": {"exchanged": 1.0},
    "no input noise": {"noise": 0.0, "exchanged_noise": 0.0},
    "input noise 0.3": {"exchanged_noise": 0.3},
    "input noise 1": {"noise": 1.0},
    "no weight decay": {"weight_decay": 0.0},
    "weight decay 0.01": {"weight_decay": 1e-2},
    "heading kept": {"remove_heading": False},
    "fine-tuned at 3e-4": {"lr": 3e-4},
    f"{LONGER}x fine-tuning": {"longer": LONGER},
}
SHARES = (*(f"{name}, %" for name in ATTRIBUTES), "mesh, %")


def main(
    recording: Annotated[Path, typer.Argument(help="Recording with held-out clips.")],
    preset_name: Annotated[str, typer.Option("--preset", help="Of the student.")] = "tiny",
    only: Annotated[list[str], typer.Option(help="Option to measure, may be repeated; all if left out.")] = [],  # noqa: B006
    leave: Annotated[list[str], typer.Option(help="Training clip to measure errors on instead; may be repeated.")] = [],  # noqa: B006
    output: Annotated[Path, typer.Option("--output", "-o", help="Directory of the tables.")] = Path("build/options"),
) -> None:
    """Measure what helps on motion that was not trained on."""
    opened = Recording(recording)
    settings = replace(preset(preset_name), texels=opened.rig.texels.size)
    output.mkdir(parents=True, exist_ok=True)
    unseen = "held-out loss" if not leave else f"loss of {', '.join(leave)}"
    columns = ("option", "training loss", unseen, *SHARES, "seconds")
    rows = read_rows(output / "options.csv", columns)
    weights = loss_weights(opened, settings)
    bases = Checkpoints(output / "bases", run_key((settings, leave, opened.fingerprint()), [weights]))
    for option in only or OPTIONS:
        if option not in rows:
            rows[option] = measure(opened, vary(settings, OPTIONS[option]), weights, leave=leave, bases=bases)
            write_rows(output / "options.csv", rows, columns)
            print(option, *rows[option], flush=True)
    text = as_markdown(rows, columns)
    (output / "options.md").write_text(text)
    print(text)


def vary(settings: Settings, change: dict[str, float]) -> Settings:
    """Settings with some fields of their generalisation changed, and fine-tuned `longer` times as long or at `lr`."""
    own = {name: value for name, value in change.items() if name not in ("longer", "lr")}
    longer, fine = change.get("longer", 1), settings.finetune
    return replace(
        settings,
        generalisation=replace(settings.generalisation, **own),  # type: ignore[arg-type]
        finetune=replace(
            fine,
            steps=int(longer * fine.steps),
            epochs=longer * fine.epochs,
            lr=change.get("lr", fine.lr),
        ),
    )


def loss_weights(recording: Recording, settings: Settings) -> Tensor:
    """The weight [23] of each channel's error, the same for all options."""
    student, samples = prepare(recording, settings)
    weights = []
    for branch, channels in zip(student.branches, (GEOMETRY, APPEARANCE), strict=True):

        def source(part: slice, rows: Tensor, start: int = channels.start) -> Bands:
            return samples.subbands(slice(start + part.start, start + part.stop), rows)

        weights.append(channel_weights(set_means(branch, source, frames=len(samples)), channels))
    return torch.cat(weights)


def measure(
    recording: Recording, settings: Settings, weights: Tensor, *, leave: list[str], bases: Checkpoints
) -> list[float]:
    """Train one option and score it: the figures of a row, without its name."""
    student, samples = prepare(recording, settings)
    samples, unseen = part(recording, student, samples, leave=leave)
    with tempfile.TemporaryDirectory() as directory:
        checkpoints = Checkpoints(Path(directory), "compare")
        if not bases.finished(f"{BRANCHES[-1]} bases"):
            train(student, samples, settings=settings, checkpoints=bases, device=CPU, report=_silent, only="bases")
        lend_bases(bases, checkpoints)
        started = time.perf_counter()
        train(student, samples, settings=settings, checkpoints=checkpoints, device=CPU, report=_silent)
        seconds = time.perf_counter() - started
    return [*score(student, samples, unseen, weights), seconds]


def part(recording: Recording, student: Student, samples: Samples, *, leave: list[str]) -> tuple[Samples, Samples]:
    """The frames to train on and those to score it on: the clips that are left out, or else those held out."""
    if not leave:
        descriptors = torch.from_numpy(describe_frames(recording, student.encoding, held_out=True)).float()
        held = replace(
            samples,
            descriptors=descriptors,
            meshes=torch.from_numpy(recording.meshes(np.arange(len(descriptors)), held_out=True)),
            subbands=lambda channels, rows: recording.subbands(channels, rows, held_out=True),
        )
        return samples, held
    left = left_out(recording, leave)
    return some(samples, (~left).nonzero()[:, 0]), some(samples, left.nonzero()[:, 0])


def _silent(_: Progress) -> None:
    pass


def lend_bases(owner: Checkpoints, borrower: Checkpoints) -> None:
    """Give one training the finished bases of another."""
    for name in BRANCHES:
        state = owner.load(f"{name} bases")
        if state is not None:
            borrower.save(f"{name} bases", state)


@torch.no_grad()
def score(student: Student, samples: Samples, unseen: Samples, weights: Tensor) -> list[float]:
    """Losses over all training and unseen frames; explained shares of the latter by attribute, then of the mesh."""
    scale = weights[:, None, None]
    mean = [torch.cat([branch.ll_mean for branch in student.branches])]
    mean += [torch.cat([getattr(branch, name).mean for branch in student.branches], dim=1) for name in ("d3", "d2")]
    losses, missed, spread = [], torch.zeros(CHANNELS), torch.zeros(CHANNELS)
    for kind in (samples, unseen):
        total = 0.0
        for rows in torch.arange(len(kind)).split(BATCH):
            truth, found = kind.subbands(slice(0, CHANNELS), rows), student.predict(kind.descriptors[rows])
            for branch in (GEOMETRY, APPEARANCE):
                one, other = (Bands(*(band * scale for band in bands)).of(branch) for bands in (found, truth))
                total += len(rows) * float(subband_loss(one, other))
            if kind is unseen:
                missed += sum(by_channel(a - b) for a, b in zip(found, truth, strict=True))
                spread += sum(by_channel(a - b) for a, b in zip(truth, mean, strict=True))
        losses.append(total / max(len(kind), 1))
    shares = [100 * (1 - float(missed[own].sum() / spread[own].sum())) for own in ATTRIBUTES.values()]
    left = (student.mesh(unseen.descriptors) - unseen.meshes).square().sum()
    left /= (unseen.meshes - samples.meshes.mean(0)).square().sum()
    return [*losses, *shares, 100 * (1 - float(left))]


def by_channel(band: Tensor) -> Tensor:
    """Sum of squares [C] of a band [F, ..., C, n, n]."""
    return band.square().movedim(-3, 0).flatten(1).sum(1)


def read_rows(path: Path, columns: tuple[str, ...]) -> dict[str, list[float]]:
    """Rows of earlier measurements with the same columns."""
    if not path.exists():
        return {}
    with path.open(newline="") as file:
        head, *rows = csv.reader(file)
    if tuple(head) != columns:
        raise typer.BadParameter(f"{path}: holds {', '.join(head)}, expected {', '.join(columns)}; give another -o")
    return {row[0]: [float(value) for value in row[1:]] for row in rows}


def write_rows(path: Path, rows: dict[str, list[float]], columns: tuple[str, ...]) -> None:
    with replacing(path) as temporary, temporary.open("w", newline="") as file:
        table = csv.writer(file)
        table.writerow(columns)
        table.writerows((option, *values) for option, values in rows.items())


def as_markdown(rows: dict[str, list[float]], columns: tuple[str, ...]) -> str:
    """The table; losses to four digits, shares to a tenth."""

    def line(cells: Iterable[str]) -> str:
        return "| " + " | ".join(cells) + " |\n"

    text = line(columns) + line(["---"] * len(columns))
    for option in (name for name in OPTIONS if name in rows):
        losses, shares, seconds = rows[option][:2], rows[option][2:-1], rows[option][-1]
        text += line([option, *(f"{x:.3f}" for x in losses), *(f"{x:.1f}" for x in shares), f"{seconds:.0f}"])
    return text


if __name__ == "__main__":
    typer.run(main)
