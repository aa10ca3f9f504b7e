"""Training points of the MLPs: around the frames, and where a body part is as in another frame.

An MLP follows a function at its training points, and little beyond. Unseen poses lie as far from the nearest frame as
frames lie from each other, and most of them are seen parts in combinations that are not: an arm of one frame, the legs
of another. With points there too, the MLP follows the function where unseen motion goes
(docs/research/unseen_motion.md).
"""

import torch
from torch import Tensor

from mua.student.components import Components
from mua.student.settings import Generalisation

FARTHEST = 16.0  # factor of a point's own distance from the mean
BLEND = 0.5  # points lie up to this far on the way to a frame
CLOSE = 0.05  # noise of points close to frames, in spreads of each direction
AT_ONCE = 1 << 12  # points: several copies of theirs are in memory while they are drawn
RADII = 4  # a random joint is exchanged with those within a random radius of fewer than this many joints


def draw_points(
    inputs: Tensor,  # [F, D] normalised descriptors
    components: Components,
    count: int,
    *,
    steps: Tensor | None,  # [P, D] int64, joints between a part and each entry; without them no part is exchanged
    generalisation: Generalisation,
    generator: torch.Generator,
) -> Tensor:
    """Random points [count, K]: frames, some with a part of another, moved towards a third, and noise; some far out.

    They are float16, as they take most of a regression's memory; what is fitted there is computed at these.
    """
    points = inputs.new_empty(count, len(components), dtype=torch.float16)
    z = components(inputs)
    for some in points.split(AT_ONCE):
        some.copy_(_draw(inputs, z, components, len(some), steps, generalisation, generator))
    return points


def _draw(
    inputs: Tensor,  # [F, D]
    z: Tensor,  # [F, K] their components
    components: Components,
    count: int,
    steps: Tensor | None,
    generalisation: Generalisation,
    generator: torch.Generator,
) -> Tensor:
    exchanged = 0 if steps is None else round(generalisation.exchanged * count)
    around = scatter(pick(z, count - exchanged, generator=generator), z, generalisation.noise, generator=generator)
    if steps is not None and exchanged:
        mixed = components(exchange(inputs, steps, exchanged, generator=generator))
        around = torch.cat([around, scatter(mixed, z, generalisation.exchanged_noise, generator=generator)])
    outward(around, round(generalisation.outside * count), generator=generator)
    return components.hold(around)


def draw_close(
    z: Tensor,  # [F, K] components of frames
    count: int,
    *,
    generator: torch.Generator,
) -> Tensor:
    """Random frames [count, K], moved by little noise."""
    drawn = torch.randn(count, z.shape[1], generator=generator).to(z)
    return pick(z, count, generator=generator).add_(drawn.mul_(CLOSE * z.std(0, correction=0)))


def outward(
    points: Tensor,  # [count, K]
    number: int,
    *,
    generator: torch.Generator,
) -> None:
    """Move this share of the points away from the mean, up to FARTHEST times their distance."""
    chosen = torch.randperm(len(points), generator=generator)[:number].to(points.device)
    times = FARTHEST ** torch.rand(number, 1, generator=generator).to(points)
    points[chosen] *= times


def exchange(
    inputs: Tensor,  # [F, D] normalised descriptors
    steps: Tensor,  # [P, D]
    count: int,
    *,
    generator: torch.Generator,
) -> Tensor:
    """Descriptors [count, D] of frames in which a random joint, and those near it, are as in another frame."""
    part = torch.randint(len(steps), (count,), generator=generator).to(inputs.device)
    radius = torch.randint(RADII, (count, 1), generator=generator).to(inputs.device)
    one, other = (pick(inputs, count, generator=generator) for _ in range(2))
    few = steps.to(inputs.device, torch.int16)  # a small type, because [count, D] of them is large
    return torch.where(few[part] <= radius, one, other)


def scatter(
    points: Tensor,  # [count, D]
    z: Tensor,  # [F, D] of the frames
    noise: float,  # up to this share of the spread of each direction
    *,
    generator: torch.Generator,
) -> Tensor:
    """Points moved up to BLEND of the way towards random frames, then by noise of random strength."""
    along, off = torch.rand(2, len(points), 1, generator=generator).to(z)
    drawn = torch.randn(points.shape, generator=generator).to(z)
    target = pick(z, len(points), generator=generator)
    drawn.mul_(noise * off * z.std(0, correction=0))  # in place, because all of this is large
    target.sub_(points).mul_(BLEND * along)
    return target.add_(points).add_(drawn)


def pick(rows: Tensor, count: int, *, generator: torch.Generator) -> Tensor:
    """Random rows."""
    return rows[torch.randint(len(rows), (count,), generator=generator).to(rows.device)]
