"""One resumable run of Adam: the loop that all stages with gradient descent share."""

import hashlib
import time
from collections.abc import Callable
from dataclasses import dataclass, replace

import torch
from torch import Tensor, nn

from mua.training.checkpoint import Checkpoints
from mua.training.processes import ALONE, Processes
from mua.training.schedule import Schedule

CHECKPOINT_STEPS = 200


@dataclass(frozen=True)
class Progress:
    """The progress of a stage."""

    stage: str
    step: int  # finished steps
    steps: int
    loss: float | None  # None in closed-form stages
    rate: float  # steps per second of this stage


Report = Callable[[Progress], None]


@dataclass(frozen=True)
class Run:
    """The parts that all stages of a training share."""

    generator: torch.Generator
    checkpoints: Checkpoints
    report: Report
    device: torch.device
    processes: Processes = ALONE
    size: float = 1.0  # size of the figure over that of a person

    def alone(self, stage: str) -> "Run":
        """The run with a generator of the stage's own, which draws the same numbers alone as after other stages."""
        digest = hashlib.sha256(f"{self.generator.initial_seed()} {stage}".encode()).digest()
        return replace(self, generator=torch.Generator().manual_seed(int.from_bytes(digest[:7], "little")))

    def once(self, stage: str, solve: Callable[[], dict[str, Tensor]]) -> dict[str, Tensor]:
        """The result of `solve`, equal in all processes and kept for a resumed run.

        Directions are found up to their sign, which another machine or number of threads chooses anew: what was trained
        on the old ones must not be read by the new.
        """
        kept = self.checkpoints.load(stage)
        if kept is None:
            tensors = solve()
            self.processes.broadcast(*tensors.values())
            self.checkpoints.save(stage, {"tensors": tensors, "generator": self.generator.get_state()})
            return tensors
        self.generator.set_state(kept["generator"])
        return {name: tensor.to(self.device) for name, tensor in kept["tensors"].items()}


def optimise(
    module: nn.Module,
    loss: Callable[[nn.Module], Tensor],  # loss of the wrapped `module` over this process's share
    *,
    schedule: Schedule,
    parameters: list[dict[str, object]],
    stage: str,
    run: Run,
    every: int | None = None,  # steps between checkpoints; None: CHECKPOINT_STEPS
) -> None:
    """Run AdamW over `schedule` from the stage's last checkpoint; a group's `lr` is relative to the schedule's.

    After a kill, a resumed run ends in the same bytes: model, optimiser and generator continue from the same state.
    """
    relative = [float(group.pop("lr", 1.0)) for group in parameters]  # type: ignore[arg-type]
    optimizer = torch.optim.AdamW(parameters, lr=schedule.lr, fused=True)  # one kernel over all weights
    first = _restore(module, optimizer, stage=stage, run=run)
    model = run.processes.wrap(module)
    started = time.monotonic()
    for step in range(first, schedule.steps):
        for group, factor in zip(optimizer.param_groups, relative, strict=True):
            group["lr"] = schedule.lr_at(step) * factor
        optimizer.zero_grad()
        value = loss(model)
        value.backward()
        optimizer.step()
        done = step + 1
        if done % (every or CHECKPOINT_STEPS) == 0 or done == schedule.steps:
            _keep(module, optimizer, done, finished=done == schedule.steps, stage=stage, run=run)
        pace = (done - first) / max(time.monotonic() - started, 1e-9)
        run.report(Progress(stage, done, schedule.steps, run.processes.mean(value), pace))


def _restore(module: nn.Module, optimizer: torch.optim.Optimizer, *, stage: str, run: Run) -> int:
    kept = run.checkpoints.load(stage)
    if kept is None:
        return 0
    module.load_state_dict(kept["module"])
    optimizer.load_state_dict(kept["optimizer"])
    run.generator.set_state(kept["generator"])
    return int(kept["step"])


def _keep(
    module: nn.Module,
    optimizer: torch.optim.Optimizer,
    step: int,
    *,
    finished: bool,
    stage: str,
    run: Run,
) -> None:
    state = {
        "module": module.state_dict(),
        "optimizer": optimizer.state_dict(),
        "generator": run.generator.get_state(),
        "step": step,
        "finished": finished,
    }
    run.checkpoints.save(stage, state)
