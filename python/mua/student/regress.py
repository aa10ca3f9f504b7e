"""Regression of a shallow MLP on closed-form coefficients: a warm start that takes minutes instead of hours."""

import math
from collections.abc import Callable
from functools import cache
from typing import NamedTuple

import torch
from torch import Tensor, nn

from mua.pose.components import INPUT_FLOOR
from mua.student.components import Components
from mua.student.conditioned import Conditioned
from mua.student.local import Locality
from mua.student.model import build_mlp, linear_layers
from mua.student.points import draw_close, draw_points
from mua.student.settings import Generalisation
from mua.training.kernel_regression import RIDGE, Smooth, Sum, Through, fit_beyond, fit_smoother
from mua.training.memory import release_memory
from mua.training.optimise import Run, optimise
from mua.training.processes import Share
from mua.training.schedule import Schedule

# Chosen on held-out walks and turns.
FIRST_LAYER = 0.3  # scale of the first layer's weights at the start: small ones make smooth functions
POINTS_AT_ONCE = 1 << 9
UNSHARED = 1e-3  # share of a direction that a part leaves to the others
UNSEEN = 1e-5  # share of the spread in the columns of the descriptor that a part does not look at
FORGONE = 1e-3  # share of the spread of a part's view of the descriptors
GENERALISATION = Generalisation()


class Fit(NamedTuple):
    """How closely the function follows the frames, and whether the MLP is fine-tuned on them afterwards."""

    beyond: float  # noise variance of frames beyond the user's motion: small where they follow from the pose alone
    fades: bool  # whether the function fades to the mean of these frames; else to that of the user's
    own: float = RIDGE  # noise variance of what the user's frames show besides
    final: bool = False  # whether nothing fits the MLP to the frames afterwards
    visits: int = 64  # uses of each point; the function's values there are computed once


POSED, SWUNG = Fit(0.1, fades=True), Fit(10.0, fades=False)  # light and cloth at rest; cloth that the range swings
MESH = Fit(POSED.beyond, fades=False, own=5e-4, final=True, visits=32)
SWUNG_MESH = MESH._replace(beyond=SWUNG.beyond)


def regress(
    inputs: Tensor,  # [F, D] normalised descriptors
    targets: Tensor,  # [F, K]
    *,
    components: Components,
    hidden: int,
    schedule: Schedule,
    stage: str,
    run: Run,
    expand: Tensor | None = None,  # [K, M]
    locality: Locality | None = None,
    own: Tensor | None = None,  # [F] bool, the frames of the user's motion; None: all
    fit: Fit = POSED,
    generalisation: Generalisation = GENERALISATION,
) -> Conditioned:
    """An MLP from components to targets, or to targets @ expand, fitted to the smooth function through them.

    It is fitted to values of that function at points around the frames. With `locality` the function is a sum over body
    parts, each of the joints near it, and the points go where parts are as in different frames. In a final fit a third
    of the points are close to the user's frames, and the error is absolute: the few frames in which cloth follows its
    history must not blur all others.
    """
    schedule = schedule.over(len(inputs))
    z = components(inputs)
    if not generalisation.own:
        own = torch.zeros(len(targets), dtype=torch.bool, device=targets.device)
    unit = (targets if own is None or not own.any() else targets[own]).square().sum(1).mean().sqrt()
    unit = unit.clamp(min=torch.finfo(targets.dtype).tiny)
    goal = targets / unit
    mlp = seeded_mlp(z.shape[1], hidden, goal.shape[1], run=run)
    count = max(schedule.steps * schedule.batch // fit.visits, 1)
    close = count // 3 if fit.final else 0
    error = absolute_error if fit.final else squared_error

    @cache  # computed when first used: not at all where a finished stage is resumed
    def samples() -> dict[range, tuple[Tensor, Tensor]]:
        generator = run.alone(f"{stage} points").generator
        smooth = fit_local(inputs, goal, components, locality, generator=generator, own=own, fit=fit)
        points = draw_points(
            inputs,
            components,
            count - close,
            steps=None if locality is None else locality.steps,
            generalisation=generalisation,
            generator=generator,
        )
        if close:
            frames = z if own is None or not own.any() else z[own]
            points = torch.cat([points, draw_close(frames, close, generator=generator).half()])
        release_memory()
        parts = {part: points[part.start :: part.step] for part in run.processes.parts(count)}
        return {part: (at, _values(smooth, at, width=goal.shape[1])) for part, at in parts.items()}

    def loss(model: nn.Module) -> Tensor:
        def part(share: Share) -> Tensor:
            points, values = samples()[share.held]
            places = ((share.rows - share.held.start) // share.held.step).to(points.device)
            return error(model(points[places].to(values)), values[places])

        drawn = torch.randint(count, (schedule.batch,), generator=run.generator)
        return run.processes.mean_loss(drawn, part, frames=count)

    groups: list[dict[str, object]] = [{"params": list(mlp.parameters()), "weight_decay": generalisation.weight_decay}]
    optimise(mlp, loss, schedule=schedule, parameters=groups, stage=stage, run=run)
    if expand is None:
        expand = torch.eye(goal.shape[1], device=goal.device)
    return Conditioned(mlp, unit * expand)


def _values(smooth: Callable[[Tensor], Tensor], points: Tensor, *, width: int) -> Tensor:
    """A function's values [n, width], float32, at points [n, D], computed in chunks."""
    values = points.new_empty(len(points), width, dtype=torch.float32)
    for own, some in zip(values.split(POINTS_AT_ONCE), points.split(POINTS_AT_ONCE), strict=True):
        own.copy_(smooth(some.to(values)))
    return values


def fit_local(
    inputs: Tensor,  # [F, D] normalised descriptors
    goal: Tensor,  # [F, K]
    components: Components,
    locality: Locality | None,
    *,
    generator: torch.Generator,
    own: Tensor | None = None,  # [F] bool
    fit: Fit = POSED,
) -> Smooth:
    """The smooth function of components through `goal`; with `locality` a sum over parts with views of their own."""
    z, back = components(inputs), components.back()

    sizes = goal.norm(dim=1)

    def through(x: Tensor, goal: Tensor) -> Smooth:
        if own is None:
            return fit_smoother(x, goal, generator=generator, noise=fit.own)
        return fit_beyond(
            x, goal, own, beyond=fit.beyond, ridge=fit.own, fades=fit.fades, sizes=sizes, generator=generator
        )

    if locality is None:
        return through(z, goal)
    turns, terms = [], []
    for reach, share in zip(*locality.fewer(goal), strict=True):
        seen = visible(inputs * reach)
        turn = (back * reach)[:, seen] @ whitening((inputs * reach)[:, seen])
        turn = turn[:, leading(z @ turn)]
        turns.append(turn)
        narrow, wide = factors(share)
        terms.append(Through(through(z @ turn, goal @ narrow), wide))
        release_memory()
    return Sum(tuple(terms), tuple(turns))


def factors(
    share: Tensor,  # [K, K] symmetric, eigenvalues in 0..1
) -> tuple[Tensor, Tensor]:
    """Matrices [K, R] and [R, K] whose product is `share`: a part's samples vary in few of the K directions."""
    values, vectors = torch.linalg.eigh(share.double())
    held = values >= values[-1].clamp(max=UNSHARED)
    some = vectors[:, held]
    return (some * values[held]).to(share), some.T.to(share)


def whitening(
    inputs: Tensor,  # [F, D]
) -> Tensor:
    """The map [D, min(F, D)] to directions of equal variance, with a floor that does not raise noise to their level."""
    away = (inputs - inputs.mean(0)).double() / len(inputs) ** 0.5
    if len(inputs) < inputs.shape[1]:  # in other directions nothing varies
        _, spread, rows = torch.linalg.svd(away, full_matrices=False)
        variance, directions = spread.square(), rows.T
    else:
        variance, directions = torch.linalg.eigh(away.T @ away)
    return (directions / (variance.clamp(min=0) + INPUT_FLOOR).sqrt()).to(inputs)


def visible(
    inputs: Tensor,  # [F, D] as a part sees them
) -> Tensor:
    """Columns [D], bool, without those of distant joints that add next to nothing to the distances between frames."""
    variance = inputs.var(0, correction=0)
    return _largest(variance, UNSEEN * (variance / (variance + INPUT_FLOOR)).sum() * INPUT_FLOOR)


def leading(
    z: Tensor,  # [F, D]
) -> Tensor:
    """Columns [D], bool, that hold nearly all variance between frames, which makes distances several times cheaper."""
    spread = z.var(0, correction=0)
    return _largest(spread, FORGONE * spread.sum())


def _largest(spread: Tensor, forgone: Tensor) -> Tensor:
    """Which numbers [D] are left if the smallest are dropped whose sum is at most `forgone`."""
    ascending, order = spread.sort()
    held = torch.empty_like(order, dtype=torch.bool)
    held[order] = ascending.cumsum(0) > forgone
    return held


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
    """Squared error summed over coordinates: 1 minus the explained variance where the goal has unit energy."""
    return (predicted - goal).square().sum(1).mean()


def absolute_error(predicted: Tensor, goal: Tensor) -> Tensor:
    """Absolute error summed over coordinates (paper, Eq. L_coarse)."""
    return (predicted - goal).abs().sum(1).mean()
