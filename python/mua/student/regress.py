"""Regression of a shallow MLP on closed-form coefficients: a warm start that takes minutes instead of hours."""

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import cache

import torch
from torch import Tensor, nn

from mua.student.local import Locality
from mua.student.model import build_mlp, linear_layers
from mua.student.optimise import Run, optimise
from mua.student.settings import Generalisation, Schedule
from mua.student.smoother import Sum, fit_smoother

# Measured on held-out CMU walks and turns, see docs/accuracy.md.
INPUT_FLOOR = 1.0  # variance added to each direction of the normalised descriptors when they are whitened
BLEND = 0.5  # points lie up to this far on the way from one frame to another
FIRST_LAYER = 0.3  # scale of the first layer's weights at the start: small ones make smooth functions
VISITS = 16  # to each point: the function's values there are computed once
POINTS_AT_ONCE = 1 << 10
GENERALISATION = Generalisation()


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
    locality: Locality | None = None,
    generalisation: Generalisation = GENERALISATION,
) -> nn.Sequential:
    """An MLP from normalised descriptors to targets, taught the smooth function that goes through them.

    It learns the values of that function at points around the frames, on whitened descriptors; the whitening is folded
    into its first layer. With `locality` the function is a sum over body parts, each of the joints near it.
    """
    white = whitening(inputs)
    run.processes.agree(white.mean, white.turn)
    z = (inputs - white.mean) @ white.turn
    unit = targets.square().sum(1).mean().sqrt().clamp(min=torch.finfo(targets.dtype).tiny)
    goal = targets / unit
    mlp = seeded_mlp(z.shape[1], hidden, goal.shape[1], run=run)
    count = max(schedule.steps * schedule.batch // VISITS, 1)

    @cache  # and not at all where a finished stage is taken up
    def lesson() -> tuple[Tensor, Tensor]:
        generator = run.alone(f"{stage} points").generator
        smooth = fit_local(inputs, z, goal, white, locality, generator=generator)
        own = run.processes.held(count)
        points = draw_around(z, count, noise=generalisation.noise, generator=generator)[own.start :: own.step]
        return points, torch.cat([smooth(some) for some in points.split(POINTS_AT_ONCE)])

    def loss(model: nn.Module) -> Tensor:
        points, values = lesson()
        drawn = torch.randint(count, (schedule.batch,), generator=run.generator)
        share, own = run.processes.share(drawn, frames=count), run.processes.held(count)
        places = ((share.rows - own.start) // own.step).to(points.device)
        return share.weight * criterion(model(points[places]), values[places])

    groups: list[dict[str, object]] = [{"params": list(mlp.parameters()), "weight_decay": generalisation.weight_decay}]
    optimise(mlp, loss, schedule=schedule, parameters=groups, stage=stage, run=run)
    first, *_, last = linear_layers(mlp)
    with torch.no_grad():
        first.weight.copy_(first.weight @ white.turn.T)
        first.bias.sub_(first.weight @ white.mean)
        last.weight.mul_(unit)
        last.bias.mul_(unit)
    return mlp


def fit_local(
    inputs: Tensor,  # [F, k D] normalised descriptors
    z: Tensor,  # [F, k D] whitened
    goal: Tensor,  # [F, K]
    white: Whitening,
    locality: Locality | None,
    *,
    generator: torch.Generator,
) -> Callable[[Tensor], Tensor]:
    """The smooth function of z through `goal`; with `locality` a sum over parts, each as it sees the descriptor."""
    if locality is None:
        return fit_smoother(z, goal, generator=generator)
    turns, smoothers = [], []
    for reach, share in zip(locality.reach, locality.shares, strict=True):
        own = whitening(inputs * reach)
        turn = torch.linalg.solve(white.turn.double(), reach[:, None].double() * own.turn.double()).to(z)
        one = fit_smoother(z @ turn, goal, generator=generator)
        turns.append(turn)
        smoothers.append(replace(one, values=one.values @ share))
    return Sum(torch.stack(turns), tuple(smoothers))


def draw_around(
    z: Tensor,  # [F, D] whitened descriptors
    count: int,
    *,
    noise: float,
    generator: torch.Generator,
) -> Tensor:
    """Random points [count, D] around the frames and between them."""
    one, other = torch.randint(len(z), (2, count), generator=generator).to(z.device)
    along, off = torch.rand(2, count, 1, generator=generator).to(z)
    drawn = torch.randn(count, z.shape[1], generator=generator).to(z)
    return z[one] + BLEND * along * (z[other] - z[one]) + noise * off * z.std(0, correction=0) * drawn


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
        hidden_layers[0].weight.mul_(FIRST_LAYER)
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
