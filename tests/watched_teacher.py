"""mua-teach as a process that waits for its parent after each step, so that it can be killed at a place of choice.

    python tests/watched_teacher.py CAPTURE OUTPUT

It prints "stage|step" and goes on when a line arrives. Stages have few steps, and a checkpoint after every second one.
"""

import sys
from dataclasses import replace
from pathlib import Path

from taught import FEW

import mua
from mua.baking import lessons
from mua.student import optimise
from mua.student.settings import Schedule
from mua.teaching import settings, train
from mua.teaching.template_training import TemplateSettings

STEPS = 6  # of each stage
STAGES = ("template nodes", "template offsets", "mean texture", "texels")
FEW_STEPS = replace(TemplateSettings(), nodes=Schedule(STEPS, 1, 1e-2), offsets=Schedule(STEPS, 1, 1e-2))


class Watched:
    """A listener whose parent says when to go on."""

    def __init__(self) -> None:
        self._stage = ""

    def stage(self, name: str) -> None:
        self._stage = name

    def step(self, done: int, total: int, *, detail: str = "") -> None:
        print(f"{self._stage}|{done}", flush=True)
        sys.stdin.readline()

    def note(self, sentence: str) -> None: ...


def main(capture: Path, output: Path) -> None:
    lessons.TEMPLATE = FEW_STEPS
    optimise.CHECKPOINT_STEPS = train.CHECKPOINT_STEPS = 2
    settings.PRESETS["tiny"] = replace(FEW, mean=replace(FEW.mean, steps=STEPS))
    mua.teach(capture, output=output, steps=STEPS, texels=64, drivable=True, device="cpu", listener=Watched())


if __name__ == "__main__":
    main(Path(sys.argv[1]), Path(sys.argv[2]))
