"""Programs that several processes run at once, for tests."""

import multiprocessing
import os
import signal
import socket
import sys
import time
import warnings
from dataclasses import replace
from datetime import timedelta
from multiprocessing.process import BaseProcess
from pathlib import Path
from unittest.mock import patch

import torch
import torch._dynamo  # which the first optimiser of a process would import
from recordings import RATE, FormulaTeacher, plan
from swinging import SETTINGS as TEMPLATE
from swinging import outlines, swinging, tube_rig
from swinging import trained as trained_template
from synthetic_avatar import synthetic_rig
from synthetic_student import SETTINGS, quick, train_in
from taught import taught

from mua.errors import InputError
from mua.processes import ALONE, Processes, joined
from mua.recording.parts import record_together
from mua.student import optimise
from mua.student.model import Student
from mua.student.optimise import Progress
from mua.student.settings import Schedule, Settings

PAPER = replace(
    quick(),
    start="random",
    regression=Schedule(steps=12, batch=3, lr=1e-3, cosine=False),
    finetune=Schedule(steps=12, batch=1, lr=1e-3, cosine=False),
)
RECIPES: dict[str, Settings] = {
    "closed form": replace(SETTINGS, regression=replace(SETTINGS.regression, steps=20, batch=65)),
    "paper": PAPER,
    "quick": quick(),
}
SILENCE = timedelta(seconds=3)
DIES_AT = 9  # the step, of all stages counted through, in which a process dies


def start(program: str, directory: Path, count: int = 2) -> list[BaseProcess]:
    """Start `count` processes as torchrun would, without the agent that ends all when one ends."""
    directory.mkdir(exist_ok=True)
    with socket.socket() as free:
        free.bind(("127.0.0.1", 0))
        port = free.getsockname()[1]
    shared = {"MASTER_ADDR": "127.0.0.1", "MASTER_PORT": str(port), "WORLD_SIZE": str(count)}
    context = multiprocessing.get_context("forkserver")  # imports once, and forks while it has no threads
    context.set_forkserver_preload(["together"])
    imports = patch.dict(os.environ, PYTHONPATH=os.pathsep.join(sys.path))  # of the server that the first start starts
    started: list[BaseProcess] = []
    for rank in range(count):
        process = context.Process(target=run, args=(program, directory, {**shared, "RANK": str(rank)}), daemon=True)
        with imports:
            process.start()
        started.append(process)
    return started


def errors(processes: list[BaseProcess], program: str, directory: Path) -> list[str]:
    """What each process wrote to standard error, once all have ended."""
    for process in processes:
        process.join(timeout=60)
        assert process.exitcode is not None
    return [(directory / f"{program}.{rank}.log").read_text() for rank in range(len(processes))]


def trained(
    name: str, directory: Path, processes: Processes = ALONE
) -> tuple[Student, dict[tuple[str, int], float | None]]:
    """A student trained by one of RECIPES, and the loss that was reported of each stage and step."""
    losses: dict[tuple[str, int], float | None] = {}

    def report(progress: Progress) -> None:
        losses[progress.stage, progress.step] = progress.loss

    return train_in(directory, RECIPES[name], report, processes=processes), losses


def template_losses(
    directory: Path, processes: Processes = ALONE
) -> tuple[dict[str, torch.Tensor], dict[tuple[str, int], float | None]]:
    """What a template learns from outlines by cameras that are drawn, and the loss of each stage and step."""
    losses: dict[tuple[str, int], float | None] = {}
    rig, few = tube_rig(), Schedule(steps=8, batch=3, lr=1e-2)
    seen = replace(swinging(rig, outlines(rig)), drawn=1)

    def report(progress: Progress) -> None:
        losses[progress.stage, progress.step] = progress.loss

    settings = replace(TEMPLATE, nodes=few, offsets=few)
    return trained_template(seen, rig, settings, directory, report, processes=processes).state_dict(), losses


def _train(directory: Path, processes: Processes, *names: str) -> None:
    for name in names:
        student, losses = trained(name, directory / name, processes)
        torch.save((student.state_dict(), losses), directory / f"{name}.{processes.rank}.pt")


def _end_in(processes: Processes, ending: str) -> None:
    """Let the second process end, or fall silent, in one of its steps."""
    optimise.CHECKPOINT_STEPS = 2
    mean, steps = Processes.mean, 0

    def dying(self: Processes, value: torch.Tensor) -> float:
        nonlocal steps
        steps += 1
        if steps == DIES_AT and processes.rank == 1:
            if ending == "killed":
                os.kill(os.getpid(), signal.SIGKILL)
            time.sleep(60)
        return mean(self, value)

    Processes.mean = dying  # type: ignore[method-assign]


def main(program: str, directory: Path) -> None:
    with joined(SILENCE) if program == "silent" else joined() as processes:
        if program == "compare":
            _train(directory, processes, *RECIPES)
        elif program == "resumed":
            _train(directory, processes, "quick")
        elif program in ("killed", "silent"):
            _end_in(processes, program)
            _train(directory, processes, "quick")
        elif program == "teach":
            losses: dict[tuple[str, int], float | None] = {}
            lesson = taught(
                directory / "teacher", lambda one: losses.update({(one.stage, one.step): one.loss}), processes=processes
            )
            torch.save((lesson.state_dict(), losses), directory / f"teach.{processes.rank}.pt")
        elif program == "template":
            torch.save(template_losses(directory / "template", processes), directory / f"template.{processes.rank}.pt")
        elif program == "record":
            teacher = FormulaTeacher(synthetic_rig())
            record_together(teacher, plan(teacher.rig), directory / "recording", processes=processes, rate=RATE)


def run(program: str, directory: Path, environment: dict[str, str]) -> None:
    """One process: standard error goes to a file, an InputError is a sentence there and exit status 1."""
    os.environ.update(environment)
    os.dup2(os.open(directory / f"{program}.{environment['RANK']}.log", os.O_CREAT | os.O_WRONLY | os.O_TRUNC), 2)
    warnings.simplefilter("error")
    torch.set_num_threads(1)
    try:
        main(program, directory)
    except InputError as error:
        print(f"error: {error}", file=sys.stderr)
        sys.exit(1)
