"""What a camera sees of the template's outline: the opacity of a surfel on each triangle, against a mask."""

from dataclasses import dataclass

import numpy as np
import torch
from torch import Tensor

from mua import rotation
from mua.arrays import Array
from mua.splatting.projection import Eye, TorchSplats
from mua.splatting.rasterise import rasterise
from mua.teaching.mesh_losses import gather

SPREAD = 1.5  # standard deviation of a surfel over that of its triangle: together they leave no hole
OPACITY = 0.95
LEAST = 1e-5  # metres; triangles may have no area


@dataclass(frozen=True, eq=False)
class Surfels:
    """How the surfels of triangles lie and how wide they are; only their places have gradients."""

    rotations: Tensor  # [F, 4] unit
    scales: Tensor  # [F, 3] metres


def outline_surfels(
    posed: Tensor,  # [V, 3] world, metres
    faces: Tensor,  # [F, 3] int64
) -> Surfels:
    """A surfel in each triangle: x along its longest edge, as wide as the triangle is."""
    corners = np.asarray(posed.detach().double().cpu())[faces.cpu().numpy()]
    edges = np.roll(corners, -1, axis=1) - corners
    longest = np.argmax(np.linalg.norm(edges, axis=2), axis=1)
    x = _unit(edges[np.arange(len(edges)), longest], np.array([1.0, 0, 0]))
    z = np.cross(x, edges[np.arange(len(edges)), (longest + 1) % 3])
    z = _unit(z, np.cross(x, np.eye(3)[np.argmin(np.abs(x), axis=1)]))
    frames = np.stack([x, np.cross(z, x), z], axis=2)
    about = corners - corners.mean(axis=1, keepdims=True)
    extents = np.sqrt(np.square(about @ frames).sum(axis=1) / 12)  # of a triangle that is evenly covered
    extents[:, 2] = 0
    scales = np.maximum(SPREAD * extents, LEAST)
    return Surfels(torch.as_tensor(rotation.from_matrix(frames)).to(posed), torch.as_tensor(scales).to(posed))


def outline(
    posed: Tensor,  # [V, 3] world, metres
    faces: Tensor,  # [F, 3] int64
    surfels: Surfels,
    eye: Eye,
) -> Tensor:
    """How much of each pixel the template covers, [H, W] in 0..1."""
    centres = gather(posed, faces).mean(dim=1)
    count = len(centres)
    splats = TorchSplats(
        centres=centres,
        rotations=surfels.rotations,
        scales=surfels.scales,
        opacities=centres.new_full((count,), OPACITY),
        sh=centres.new_zeros(count, 12),
        turns=surfels.rotations,
    )
    bounds = torch.stack([centres.amin(dim=0), centres.amax(dim=0)]).detach()
    return rasterise(splats, eye, bounds)[..., 3]


def silhouette_error(
    posed: Tensor,  # [V, 3] world, metres
    faces: Tensor,  # [F, 3] int64
    eye: Eye,
    mask: Tensor,  # [H, W] in 0..1
) -> Tensor:
    """Mean squared difference of the outline from a mask of the same size."""
    return (outline(posed, faces, outline_surfels(posed, faces), eye) - mask).square().mean()


def _unit(vectors: Array, other: Array) -> Array:
    """Vectors [N, 3] of length 1; the other where they have none."""
    length = np.linalg.norm(vectors, axis=1, keepdims=True)
    solid = length > 1e-12
    chosen = np.where(solid, vectors, other)
    return np.asarray(chosen / np.linalg.norm(chosen, axis=1, keepdims=True))
