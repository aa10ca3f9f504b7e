"""mua-train in a test: a preset of a few steps, run within the test or as a process of its own."""

import sys
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path

import pytest
from commands import Ended

from mua.cli.display import UNEXPLAINED
from mua.student import optimise
from mua.student.settings import PRESETS, Ranks, Schedule

FINISHED = (0, UNEXPLAINED)  # statuses of a training that wrote its avatar: one of a few steps explains little
Training = Callable[..., Ended]  # the fixture `mua_train`
SMALL = replace(
    PRESETS["tiny"],
    geometry=Ranks(4, 3, 2),
    appearance=Ranks(4, 3, 2),
    components=4,
    hidden=16,
    sweeps=1,
    regression=Schedule(steps=40, batch=8, lr=1e-3),
    finetune=Schedule(steps=20, batch=4, lr=1e-4),
    pictures=2,
)
STAGE_NAMES = (
    "coarse mesh",
    *("geometry bases", "geometry coefficients", "geometry fine-tuning"),
    *("appearance bases", "appearance coefficients", "appearance fine-tuning"),
)


def arguments(recording: Path, output: Path) -> list[str]:
    return [str(recording), "-o", str(output), "--preset", "small", "--storage", "f32", "--device", "cpu"]


def process(recording: Path, output: Path) -> list[str]:
    """The command line of a process that does the same as `mua_train`, and checkpoints as often."""
    code = (
        f"import sys; sys.path.insert(0, {str(Path(__file__).parent)!r}); import trainings; from mua.cli import train;"
        "trainings.PRESETS['small'] = trainings.SMALL; trainings.optimise.CHECKPOINT_STEPS = 5; train.run()"
    )
    return [sys.executable, "-c", code, *arguments(recording, output)]


def be_small(monkeypatch: pytest.MonkeyPatch) -> None:
    """Add the preset, and keep checkpoints often."""
    monkeypatch.setitem(PRESETS, "small", SMALL)
    monkeypatch.setattr(optimise, "CHECKPOINT_STEPS", 5)


def one_by_one(tasks: Sequence[Callable[[], None]], *, stop: Callable[[], None]) -> None:
    """In the place of `mua.threads.together`: one task after the other."""
    for task in tasks:
        task()
