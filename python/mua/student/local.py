"""Local coefficients: the look of a body part follows the joints near it more than distant ones.

The parts are the joints that the descriptor encodes, each with the samples of subbands and mesh that hang on it most.
For the samples of a part, the descriptor's entries count the less the more joints lie between. Only the function that
the coefficient MLPs fit is made of parts: bases, MLP, file and player stay as they are.
"""

from dataclasses import dataclass

import numpy as np
import torch
from scipy.ndimage import distance_transform_edt
from torch import Tensor

from mua.arrays import Array
from mua.channels import COARSE_TEXELS, FINE_TEXELS
from mua.pose.encoding import PoseEncoding
from mua.pose.joint_steps import joint_steps, nearest_encoded
from mua.rig.rig import Rig
from mua.student.model import Branch
from mua.student.targets import Targets

POSE_FOR_LIGHT = 0.25  # weight of joints' local rotations relative to their rotations in the world
NEGLIGIBLE = 2e-3  # share of all variation; a part that has less of it is fitted with the one above it


@dataclass(frozen=True, eq=False)
class Parts:
    """P body parts: the part of each sample, and how many joints lie between a part and each descriptor entry."""

    steps: Tensor  # [P, D] int64
    world: Tensor  # [D] bool, the entries of how joints are turned in the world
    coarse: Tensor  # [n, n] int64, the part of each sample of LL and D3
    fine: Tensor  # [2n, 2n] int64, of D2
    vertices: Tensor  # [V] int64
    above: Tensor  # [P] int64, the part of the joint above, which comes before it; the first has none

    def reach(self, fade: float, *, light: bool = False) -> Tensor:
        """Factors [P, D] of the descriptor's entries as each part sees them; 1 for its own joint.

        Parts that follow the `light` also see how joints are turned in the world; shape follows them in their parents.
        """
        sees = torch.where(self.world, float(light), POSE_FOR_LIGHT if light else 1.0)
        return fade ** self.steps.float() * sees

    def texel_owners(
        self,
        texels: Tensor,  # [N] int64, row * size + col
    ) -> Tensor:
        """The part [N] of texels."""
        size = FINE_TEXELS * len(self.fine)
        return self.fine.to(texels.device)[texels // size // FINE_TEXELS, texels % size // FINE_TEXELS]


@dataclass(frozen=True, eq=False)
class Locality:
    """How the targets of a regression are a sum over body parts."""

    steps: Tensor  # [P, D] int64, of the parts
    above: Tensor  # [P] int64, of the parts
    reach: Tensor  # [P, D]
    shares: Tensor  # [P, K, K]; coordinates @ shares[p] are the coordinates of part p's samples alone

    def fewer(
        self,
        goal: Tensor,  # [F, K]
    ) -> tuple[Tensor, Tensor]:
        """Reach and shares of the parts that vary in `goal`; others, mostly fingers, are added to the part above."""
        shares, held = self.shares.clone(), torch.ones_like(self.above, dtype=torch.bool)
        least = NEGLIGIBLE * goal.square().sum()
        for part in range(len(shares) - 1, 0, -1):  # first what lies below
            if (goal @ shares[part]).square().sum() < least:
                shares[self.above[part]] += shares[part]
                held[part] = False
        return self.reach[held], shares[held]


def body_parts(rig: Rig, encoding: PoseEncoding) -> Parts:
    """The parts of a character, one for each encoded joint that some sample hangs on."""
    seen = [rig.skeleton.root, *sorted({*encoding.joints, *encoding.translated})]
    steps = joint_steps(rig.skeleton, seen)
    above = (steps == 1).argmax(axis=1)  # of the joints next to one, that above it comes first
    steps[:, 0] = np.minimum(steps[:, 0], 1)  # the root, where the body goes and how it leans, is near every part
    weights = np.zeros((len(rig.mesh.vertices), len(seen)))
    carrier = nearest_encoded(rig.skeleton, seen)
    np.add.at(weights, (np.arange(len(weights))[:, None], carrier[rig.skin_indices]), rig.skin_weights)
    texels = rig.texels
    corners = weights[rig.mesh.faces[texels.triangles]]  # [N, 3, P]
    image: Array = np.zeros((texels.size**2, len(seen)))
    image[texels.texels] = np.einsum("nvp,nv->np", corners, texels.barycentrics)
    image = image.reshape(texels.size, texels.size, -1)
    columns = [
        0 if part.joint is None else seen.index(part.joint) for part in encoding.parts for _ in range(part.width)
    ]
    return Parts(
        steps=torch.from_numpy(steps[:, columns]),
        world=torch.tensor([part.world for part in encoding.parts for _ in range(part.width)]),
        coarse=torch.from_numpy(sample_owners(image, COARSE_TEXELS)),
        fine=torch.from_numpy(sample_owners(image, FINE_TEXELS)),
        vertices=torch.from_numpy(weights.argmax(1)),
        above=torch.from_numpy(above),
    )


def sample_owners(
    image: Array,  # [H, W, P] how much each valid texel hangs on each part, 0 elsewhere
    block: int,  # texels along a side of a sample
) -> Array:
    """The part [H / block, W / block] int64 that most of a sample's texels hang on.

    Where a sample has no valid texel, it is that of the nearest which has.
    """
    rows, columns = image.shape[0] // block, image.shape[1] // block
    held = image.reshape(rows, block, columns, block, -1).sum((1, 3))
    owner, empty = held.argmax(-1), held.sum(-1) == 0
    if empty.all():
        return owner
    nearest = distance_transform_edt(empty, return_distances=False, return_indices=True)
    return owner[tuple(nearest)]


@torch.no_grad()
def texture_locality(
    parts: Parts,
    branch: Branch,
    targets: Targets,
    weights: Tensor,  # [C]
    *,
    fade: float,
    light: bool = False,
) -> Locality:
    """How the joint coordinates of a branch are a sum over parts.

    Coordinates stand for textures by orthonormal directions, so that those of a part's samples are the projection of
    the texture that is left when all other samples are zero.
    """
    count, device = len(parts.steps), weights.device
    shares = torch.zeros(count, len(targets.expand), len(targets.expand), device=device)
    coarse, fine = parts.coarse.flatten().to(device), parts.fine.flatten().to(device)
    alphas = branch.split(targets.expand)
    for channel in range(branch.channels):
        shapes = torch.einsum("kr,rij->kij", alphas.ll[:, channel], branch.ll_basis[channel])
        _add_shares(shares, shapes.flatten(1) * weights[channel], coarse)
        for detail, alpha, owner in ((branch.d3, alphas.d3, coarse), (branch.d2, alphas.d2, fine)):
            h, w = detail.h[:, channel], detail.w[:, channel]
            shapes = torch.einsum("kr,sri,srj->skij", alpha[:, channel], h, w)
            for band in shapes.flatten(2):
                _add_shares(shares, band * weights[channel], owner)
    return _locality(parts, shares, fade=fade, light=light)


def sample_locality(
    parts: Parts,
    basis: Tensor,  # [K, S, A] orthonormal: contribution of each coordinate to A values of S samples
    owners: Tensor,  # [S] the part of each sample
    *,
    fade: float,
    light: bool = False,
) -> Locality:
    """How coordinates of a mesh or of a full-size texture are a sum over parts."""
    shares = torch.zeros(len(parts.steps), len(basis), len(basis), device=basis.device)
    for value in range(basis.shape[2]):
        _add_shares(shares, basis[..., value], owners.to(basis.device))
    return _locality(parts, shares, fade=fade, light=light)


def _locality(parts: Parts, shares: Tensor, *, fade: float, light: bool) -> Locality:
    reach = parts.reach(fade, light=light)
    return Locality(*(own.to(shares.device) for own in (parts.steps, parts.above, reach, shares)))


def _add_shares(
    shares: Tensor,  # [P, K, K] added to
    shapes: Tensor,  # [K, S] contribution of each coordinate to S samples
    owner: Tensor,  # [S]
) -> None:
    for part in owner.unique().tolist():
        own = shapes[:, owner == part]
        shares[part] += own @ own.T
