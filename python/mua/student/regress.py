"""Regression of a shallow MLP on closed-form coefficients: a warm start that takes minutes instead of hours."""

import math
from collections.abc import Callable
from dataclasses import dataclass

import torch
from torch import Tensor, nn

from mua.student.model import build_mlp, linear_layers
from mua.student.optimise import Run, draw_batch, optimise
from mua.student.settings import Schedule

INPUT_FLOOR = 1e-3  # variance added to each direction of the normalised descriptors when they are whitened
INPUT_NOISE = 0.1  # standard deviation of the noise on whitened descriptors
WEIGHT_DECAY = 1e-2


@dataclass(frozen=True)
class Whitening:
    """An affine map of descriptors whose directions vary alike: x -> (x - mean) @ turn."""

    mean: Tensor  # [k D]
    turn: Tensor  # [k D, k D]


def whitening(inputs: Tensor) -> Whitening:
    """The whitening of normalised descriptors [F, k D].

    A window's poses are nearly alike; velocities are its weak directions, and a network that sees the descriptor as it
    is learns them last. The floor keeps directions that hold only noise from being raised to the others' level.
    """
    mean = inputs.mean(0)
    variance, directions = torch.linalg.eigh(torch.cov(inputs.double().T, correction=0).reshape(inputs.shape[1], -1))
    return Whitening(mean, (directions / (variance.clamp(min=0) + INPUT_FLOOR).sqrt()).to(inputs))


def regress(
    inputs: Tensor,  # [F, k D] normalised descriptors
    targets: Tensor,  # [F, K]
    *,
    hidden: int,
    criterion: Callable[[Tensor, Tensor], Tensor],
    schedule: Schedule,
    stage: str,
    run: Run,
) -> nn.Sequential:
    """An MLP from normalised descriptors to targets, trained on whitened, noisy ones; the whitening is folded in."""
    white = whitening(inputs)
    z = (inputs - white.mean) @ white.turn
    unit = targets.square().sum(1).mean().sqrt().clamp(min=torch.finfo(targets.dtype).tiny)
    goal = targets / unit
    mlp = seeded_mlp(z.shape[1], hidden, goal.shape[1], run=run)

    def loss() -> Tensor:
        batch = draw_batch(len(z), schedule.batch, run.generator).to(z.device)
        noise = torch.randn(len(batch), z.shape[1], generator=run.generator).to(z)
        return criterion(mlp(z[batch] + INPUT_NOISE * noise), goal[batch])

    groups: list[dict[str, object]] = [{"params": list(mlp.parameters()), "weight_decay": WEIGHT_DECAY}]
    optimise(mlp, loss, schedule=schedule, parameters=groups, stage=stage, run=run)
    first, *_, last = linear_layers(mlp)
    with torch.no_grad():
        first.weight.copy_(first.weight @ white.turn.T)
        first.bias.sub_(first.weight @ white.mean)
        last.weight.mul_(unit)
        last.bias.mul_(unit)
    return mlp


def seeded_mlp(inputs: int, hidden: int, outputs: int, *, run: Run) -> nn.Sequential:
    """An MLP whose hidden weights are drawn from the run's generator (He et al. 2015, https://arxiv.org/abs/1502.01852).

    The last layer starts at zero: the targets' mean, not a random guess.
    """
    mlp = build_mlp(inputs, hidden, outputs)
    *hidden_layers, last = linear_layers(mlp)
    with torch.no_grad():
        last.weight.zero_()
        last.bias.zero_()
        for layer in hidden_layers:
            layer.weight.normal_(0, math.sqrt(2 / layer.in_features), generator=run.generator)
            layer.bias.zero_()
    return mlp.to(run.device)


def squared_error(predicted: Tensor, goal: Tensor) -> Tensor:
    """Summed over coordinates: one less the explained variance where the goal has unit energy."""
    return (predicted - goal).square().sum(1).mean()


def absolute_error(predicted: Tensor, goal: Tensor) -> Tensor:
    return (predicted - goal).abs().sum(1).mean()


def unfold_last_layer(
    mlp: nn.Sequential,
    expand: Tensor,  # [K, M]
) -> nn.Sequential:
    """The MLP to M coefficients, from one to K coordinates: the linear map becomes part of the last layer."""
    first, *_, last = linear_layers(mlp)
    wide = build_mlp(first.in_features, first.out_features, expand.shape[1]).to(expand.device)
    state = mlp.state_dict()
    *_, weight, bias = state
    state[weight], state[bias] = expand.T @ last.weight.detach(), expand.T @ last.bias.detach()
    wide.load_state_dict(state)
    return wide
