"""The template's silhouette in a camera: the opacity of discs spread over it, against a mask."""

from collections.abc import Sequence
from dataclasses import dataclass

import torch
from torch import Tensor

from mua.splatting.projection import Eye, TorchSplats
from mua.splatting.rasterise import rasterise_views
from mua.teachers.trained.mesh_losses import Samples

SPREAD = 0.8  # standard deviation of a disc over the side of the square that is its share of the surface
FLATNESS = 0.1  # thickness over that
OPACITY = 0.95


@dataclass(frozen=True, eq=False)
class Outline:
    """A mask of the person."""

    eye: Eye
    mask: Tensor  # [H, W] in 0..1


def outlines(
    posed: Tensor,  # [V, 3] world, metres
    samples: Samples,  # at equal shares of the area, each the middle of a disc
    eyes: Sequence[Eye],
) -> list[Tensor]:
    """How much of each pixel the template covers, [H, W] in 0..1; gradients move the discs, and do not turn them."""
    centres, normals = samples.on(posed)
    count, wide, turns = len(centres), SPREAD * samples.spacing, facing(normals.detach())
    splats = TorchSplats(
        centres=centres,
        rotations=turns,
        scales=centres.new_tensor([wide, wide, FLATNESS * wide]).expand(count, 3),
        opacities=centres.new_full((count,), OPACITY),
        sh=centres.new_zeros(count, 12),
        turns=turns,
    )
    bounds = torch.stack([centres.amin(dim=0), centres.amax(dim=0)]).detach()
    return [image[..., 3] for image in rasterise_views(splats, eyes, bounds)]


def silhouette_error(
    posed: Tensor,  # [V, 3] world, metres
    samples: Samples,
    seen: Sequence[Outline],
) -> Tensor:
    """Squared difference of the outlines from their masks, over what each mask covers; the mean."""
    drawn = outlines(posed, samples, [one.eye for one in seen])
    errors = [
        (own - one.mask).square().sum() / one.mask.sum().clamp(min=1) for own, one in zip(drawn, seen, strict=True)
    ]
    return torch.stack(errors).mean()


def facing(
    normals: Tensor,  # [N, 3] unit
) -> Tensor:
    """Unit quaternions [N, 4] that turn z to the normals: half way round the axis between them."""
    halfway = normals + normals.new_tensor([0.0, 0, 1])
    halfway = torch.where(halfway.norm(dim=1, keepdim=True) < 1e-6, normals.new_tensor([1.0, 0, 0]), halfway)
    halfway = torch.nn.functional.normalize(halfway, dim=1)
    return torch.cat([torch.zeros_like(halfway[:, :1]), halfway], dim=1)
