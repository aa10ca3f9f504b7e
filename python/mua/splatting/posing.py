"""Posing in torch: the same blending and activation as mua.kernels.dq_skinning, with gradients.

They reach the mesh, the texture and the joints' dual quaternions; the signs of blended terms are taken as fixed.
"""

from dataclasses import dataclass

import torch
from torch import Tensor

from mua.channels import APPEARANCE
from mua.kernels.dq_skinning import LARGEST_LOG_SCALE
from mua.rig.rig import Rig
from mua.splatting.projection import TorchSplats


@dataclass(frozen=True, eq=False)
class TorchRig:
    """The parts of a rig that pose splats, as tensors of one dtype on one device."""

    skin_indices: Tensor  # [V, K] int64 joints, largest weight first
    skin_weights: Tensor  # [V, K] rows sum to 1
    corners: Tensor  # [N, 3] int64 vertices about each texel
    barycentrics: Tensor  # [N, 3]

    @classmethod
    def of(cls, rig: Rig, like: Tensor) -> "TorchRig":
        """In the dtype and on the device of `like`."""
        used = int((rig.skin_weights > 0).sum(axis=1).max(initial=1))  # most rigs blend fewer joints than there is room
        indices = torch.as_tensor(rig.skin_indices[:, :used]).long().to(like.device)
        corners = torch.as_tensor(rig.mesh.faces[rig.texels.triangles]).long().to(like.device)
        weights, barycentrics = rig.skin_weights[:, :used], rig.texels.barycentrics
        return cls(indices, torch.as_tensor(weights).to(like), corners, torch.as_tensor(barycentrics).to(like))


def blend_vertices(
    indices: Tensor,  # [V, K] int64 joints, largest weight first
    weights: Tensor,  # [V, K] rows sum to 1
    joints: Tensor,  # [..., J, 8] bind pose to world
) -> Tensor:
    """Dual quaternions [..., V, 8] of the vertices, bind pose to world."""
    return _blend(joints[..., indices, :], weights, joints[..., indices[:, 0], :4])


def blend_texels(
    rig: TorchRig,
    vertex_dq: Tensor,  # [V, 8]
) -> Tensor:
    """Dual quaternions [N, 8] of the texels."""
    nearest = rig.corners.gather(1, rig.barycentrics.argmax(dim=1, keepdim=True))[:, 0]
    return _blend(vertex_dq[rig.corners], rig.barycentrics, vertex_dq[nearest, :4])


def pose_splats(
    rig: TorchRig,
    joints: Tensor,  # [J, 8] bind pose to world
    canonical: Tensor,  # [V, 3] canonical vertices, metres
    texture: Tensor,  # [N, 23] raw channels (mua.channels)
) -> TorchSplats:
    """Activate the channels and pose them: the splats of one frame in the world."""
    texel_dq = blend_texels(rig, blend_vertices(rig.skin_indices, rig.skin_weights, joints))
    return place_splats(texel_dq, surface_points(rig, canonical), texture)


def surface_points(
    rig: TorchRig,
    canonical: Tensor,  # [V, 3] canonical vertices, metres
) -> Tensor:
    """The canonical places [N, 3] of the texels on the mesh, metres."""
    return torch.einsum("nk,nkc->nc", rig.barycentrics, canonical[rig.corners])


def place_splats(
    texel_dq: Tensor,  # [N, 8] unit, bind pose to world
    surface: Tensor,  # [N, 3] canonical, metres
    texture: Tensor,  # [N, 23] raw channels (mua.channels)
) -> TorchSplats:
    """As pose_splats, where texels are blended and placed on the mesh already."""
    turns = texel_dq[:, :4]
    return TorchSplats(
        centres=dual_transform(texel_dq, surface + texture[:, 0:3]),
        rotations=multiply(turns, texture[:, 3:7] / _norm(texture[:, 3:7])),
        scales=texture[:, 7:10].clamp(max=LARGEST_LOG_SCALE).exp(),
        opacities=texture[:, 10].sigmoid(),
        sh=texture[:, APPEARANCE],
        turns=turns,
    )


def multiply(
    a: Tensor,  # [..., 4] wxyz
    b: Tensor,  # [..., 4]
) -> Tensor:
    """Hamilton products [..., 4]."""
    aw, av, bw, bv = a[..., :1], a[..., 1:], b[..., :1], b[..., 1:]
    real = aw * bw - (av * bv).sum(-1, keepdim=True)
    return torch.cat([real, aw * bv + bw * av + torch.linalg.cross(av, bv)], dim=-1)


def rotate(
    q: Tensor,  # [..., 4] unit
    v: Tensor,  # [..., 3]
) -> Tensor:
    """Vectors [..., 3] turned by quaternions."""
    t = 2 * torch.linalg.cross(q[..., 1:], v)
    return v + q[..., :1] * t + torch.linalg.cross(q[..., 1:], t)


def dual_transform(
    dual: Tensor,  # [..., 8] unit
    points: Tensor,  # [..., 3]
) -> Tensor:
    """Points [..., 3] moved by rigid dual quaternions."""
    w, v, dw, dv = dual[..., :1], dual[..., 1:4], dual[..., 4:5], dual[..., 5:]
    return rotate(dual[..., :4], points) + 2 * (w * dv - dw * v + torch.linalg.cross(v, dv))


def _blend(
    terms: Tensor,  # [..., N, K, 8]
    weights: Tensor,  # [N, K]
    reference: Tensor,  # [..., N, 4] on whose hemisphere all terms are added
) -> Tensor:
    away = (terms[..., :4] * reference[..., None, :]).sum(-1) < 0
    total = (torch.where(away, -weights, weights)[..., None] * terms).sum(-2)
    return total / _norm(total[..., :4])


def _norm(
    q: Tensor,  # [..., 4]
) -> Tensor:
    """Norms [..., 1], never zero."""
    return torch.linalg.vector_norm(q, dim=-1, keepdim=True).clamp(min=torch.finfo(q.dtype).tiny)
