"""Adam within a budget: the same loop, loss and learning-rate schedule for every compared system."""

import time
from collections.abc import Callable

import torch
from torch import Tensor

from mua.errors import InputError
from mua.training.optimise import Progress, Report
from mua.training.schedule import cosine_decay
from mua_research.system import Budget

WARM_UP = 0.1  # share of the steps in which the learning rates rise

Groups = list[dict[str, object]]  # of parameters, each with the learning rate `lr` that it starts from


def optimise(
    loss: Callable[[Tensor], Tensor],  # of the rows of a batch
    groups: Groups,
    *,
    frames: int,
    budget: Budget,
    started: float,  # by time.monotonic
    stage: str,
    generator: torch.Generator,
    report: Report,
) -> int:
    """Run AdamW until the budget is spent; returns the steps taken.

    The learning rates warm up over the first tenth of the remaining budget and decay to zero along a cosine.
    Raises InputError for a budget without an end.
    """
    if budget.seconds is None and budget.steps is None:
        raise InputError("budget: neither seconds nor steps are given, expected one of them")
    optimizer = torch.optim.AdamW(groups, weight_decay=0.0)
    rates = [float(group["lr"]) for group in optimizer.param_groups]
    begun, step = time.monotonic(), 0
    before = _spent(budget, step, started)
    while (spent := _spent(budget, step, started)) < 1:
        done = (spent - before) / (1 - before)
        course = min(done / WARM_UP, 1.0) * cosine_decay(done)
        for group, rate in zip(optimizer.param_groups, rates, strict=True):
            group["lr"] = rate * course
        optimizer.zero_grad()
        value = loss(torch.randperm(frames, generator=generator)[: budget.batch])
        value.backward()
        optimizer.step()
        step += 1
        total = budget.steps or max(round(step / max(_spent(budget, step, started), 1e-9)), step)
        report(Progress(stage, step, total, float(value.detach()), step / max(time.monotonic() - begun, 1e-9)))
    return step


def _spent(budget: Budget, step: int, started: float) -> float:
    """The share of the budget that is gone; whichever limit comes first counts."""
    shares = [0.0]
    if budget.seconds is not None:
        shares.append((time.monotonic() - started) / budget.seconds if budget.seconds > 0 else 1.0)
    if budget.steps is not None:
        shares.append(step / budget.steps if budget.steps > 0 else 1.0)
    return max(shares)
