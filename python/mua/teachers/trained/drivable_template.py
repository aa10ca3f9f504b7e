"""The drivable template: canonical vertices that follow the motion, posed by dual quaternions (paper, Preliminaries).

V_f = f_dq(V_bar_f, theta_f): `deformation` gives V_bar_f, the skinning is that of mua.kernels.dq_skinning.
"""

from dataclasses import dataclass

import torch
from torch import Tensor, nn

from mua.rig.rig import Rig
from mua.splatting.posing import blend_vertices, dual_transform


@dataclass(frozen=True, eq=False)
class PosedTemplate:
    """The template in B frames."""

    canonical: Tensor  # [B, V, 3] bind pose with the deformation of the motion, metres
    posed: Tensor  # [B, V, 3] world, metres
    vertex_dq: Tensor  # [B, V, 8] bind pose to world


class Undeformed(nn.Module):
    """The template as it is in the bind pose, whatever the motion."""

    vertices: Tensor  # [V, 3]

    def __init__(self, rig: Rig) -> None:
        super().__init__()
        self.register_buffer("vertices", torch.as_tensor(rig.mesh.vertices))

    def forward(
        self,
        descriptors: Tensor,  # [B, D] of mua.pose.descriptor
    ) -> Tensor:
        """Canonical vertices [B, V, 3], metres."""
        return self.vertices.to(descriptors).expand(len(descriptors), -1, -1)


class DrivableTemplate(nn.Module):
    """The deformed template, posed; gradients reach the deformation and the joints."""

    skin_indices: Tensor  # [V, K]
    skin_weights: Tensor  # [V, K]

    def __init__(self, rig: Rig, deformation: nn.Module | None = None) -> None:
        """`deformation` is from descriptors [B, D] to canonical vertices [B, V, 3]; without one, skinning is all."""
        super().__init__()
        used = int((rig.skin_weights > 0).sum(axis=1).max(initial=1))  # most rigs blend fewer joints than there is room
        self.register_buffer("skin_indices", torch.as_tensor(rig.skin_indices[:, :used]).long())
        self.register_buffer("skin_weights", torch.as_tensor(rig.skin_weights[:, :used]))
        self.deformation = Undeformed(rig) if deformation is None else deformation

    def forward(
        self,
        descriptors: Tensor,  # [B, D] of mua.pose.descriptor
        joints: Tensor,  # [B, J, 8] of Skeleton.skinning: bind pose to world
    ) -> PosedTemplate:
        """The template in B frames."""
        return self.pose(self.deformation(descriptors), joints)

    def pose(
        self,
        canonical: Tensor,  # [B, V, 3] bind pose, metres
        joints: Tensor,  # [B, J, 8]
    ) -> PosedTemplate:
        """Canonical vertices posed by dual quaternions."""
        duals = blend_vertices(self.skin_indices, self.skin_weights.to(joints), joints)
        return PosedTemplate(canonical, dual_transform(duals, canonical), duals)
