"""Distance of the template's points, and of the splats that carry them, from where they were tracked in a frame."""

from dataclasses import dataclass

import torch
from torch import Tensor

from mua.splatting.posing import rotate
from mua.splatting.projection import TorchSplats
from mua.teachers.trained.mesh_losses import REACH, gather


@dataclass(frozen=True, eq=False)
class Tracks:
    """Where points of the template were seen in a frame."""

    corners: Tensor  # [P, 3] int64 vertices about each
    barycentrics: Tensor  # [P, 3]
    points: Tensor  # [P, 3] world, metres
    weights: Tensor  # [P] 0 where a point was not seen
    directions: Tensor | None = None  # [P, 3] unit, of rays from `points` on which they were seen; 0: at `points`


@dataclass(frozen=True, eq=False)
class TexelTracks:
    """Where points of the template were seen in a frame, and which texels carry them."""

    tracks: Tracks
    texels: Tensor  # [P] int64 of the texture, the nearest of each

    def error(
        self,
        posed: Tensor,  # [V, 3] the template, world, metres
        splats: TorchSplats,
        offsets: Tensor,  # [N, 3] of the splats from the template, bind pose, metres
        *,
        size: float = 1.0,  # of the figure over that of a person
    ) -> Tensor:
        """Mean squared distance of the points from where they were seen, metres^2: each is offset as its splat is."""
        return missed(self.places(posed, splats, offsets), self.tracks, reach=REACH * size)

    def places(self, posed: Tensor, splats: TorchSplats, offsets: Tensor) -> Tensor:
        """The points [P, 3] as the texels carry them, world, metres; arguments as above."""
        turns, own = (values.index_select(0, self.texels) for values in (splats.turns, offsets))
        return _on(posed, self.tracks) + rotate(turns, own)


def track_error(
    posed: Tensor,  # [V, 3] world, metres
    tracks: Tracks,
    *,
    size: float = 1.0,  # of the figure over that of a person
) -> Tensor:
    """Mean squared distance of tracked points from where they were seen, metres^2; beyond REACH it grows linearly."""
    return missed(_on(posed, tracks), tracks, reach=REACH * size)


def missed(
    points: Tensor,  # [P, 3] world, metres
    tracks: Tracks,
    *,
    reach: float,  # metres
) -> Tensor:
    """The same loss for points anywhere; a point seen by one camera counts its distance from the ray."""
    tiny = torch.finfo(points.dtype).tiny
    apart = points - tracks.points
    if tracks.directions is not None:
        apart = apart - (apart * tracks.directions).sum(1, keepdim=True) * tracks.directions
    away = (apart.square().sum(1) + tiny).sqrt()
    error = torch.where(away < reach, away.square(), 2 * reach * away - reach**2)
    return (tracks.weights * error).sum() / tracks.weights.sum().clamp(min=1e-9)


def _on(posed: Tensor, tracks: Tracks) -> Tensor:
    """The points [P, 3] on the posed template."""
    return (tracks.barycentrics.to(posed)[..., None] * gather(posed, tracks.corners)).sum(1)
