"""Shared by all training of teachers: which parameters get gradients, and sums that a resumed run repeats."""

from collections.abc import Iterator, Sequence
from contextlib import contextmanager

import torch
from torch import nn


@contextmanager
def gradients_for(module: nn.Module, parameters: Sequence[nn.Parameter]) -> Iterator[None]:
    """Gradients for these parameters alone; processes exchange no others."""
    chosen = {id(parameter) for parameter in parameters}
    for parameter in module.parameters():
        parameter.requires_grad_(id(parameter) in chosen)
    yield
    module.requires_grad_(True)


@contextmanager
def deterministic() -> Iterator[None]:
    """Sums in one order, where torch has one: a resumed run adds up the same numbers."""
    before = torch.are_deterministic_algorithms_enabled()
    torch.use_deterministic_algorithms(True, warn_only=True)
    try:
        yield
    finally:
        torch.use_deterministic_algorithms(before)
