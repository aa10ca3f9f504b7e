"""What a camera sees of the template's outline: the opacity of discs spread over it, against a mask."""

import torch
from torch import Tensor

from mua.splatting.projection import Eye, TorchSplats
from mua.splatting.rasterise import rasterise
from mua.teaching.mesh_losses import Samples

SPREAD = 0.8  # standard deviation of a disc over the side of the square that is its share of the surface
FLATNESS = 0.1  # thickness over that
OPACITY = 0.95


def outline(
    posed: Tensor,  # [V, 3] world, metres
    samples: Samples,  # at equal shares of the area, each the middle of a disc
    eye: Eye,
) -> Tensor:
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
    return rasterise(splats, eye, bounds)[..., 3]


def silhouette_error(
    posed: Tensor,  # [V, 3] world, metres
    samples: Samples,
    eye: Eye,
    mask: Tensor,  # [H, W] in 0..1
) -> Tensor:
    """Squared difference of the outline from a mask of the same size, over what the mask covers."""
    return (outline(posed, samples, eye) - mask).square().sum() / mask.sum().clamp(min=1)


def facing(
    normals: Tensor,  # [N, 3] unit
) -> Tensor:
    """Unit quaternions [N, 4] that turn z to the normals: half way round the axis between them."""
    halfway = normals + normals.new_tensor([0.0, 0, 1])
    halfway = torch.where(halfway.norm(dim=1, keepdim=True) < 1e-6, normals.new_tensor([1.0, 0, 0]), halfway)
    halfway = torch.nn.functional.normalize(halfway, dim=1)
    return torch.cat([torch.zeros_like(halfway[:, :1]), halfway], dim=1)
