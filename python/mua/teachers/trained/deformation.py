"""Embedded deformation: each node turns and moves what lies about it (Sumner et al. 2007, 10.1145/1275808.1276478).

v' = sum_g w_vg (R_g (v - p_g) + p_g + t_g), the f_eg of the paper's Preliminaries; R_g is the turn by |a| about a.
"""

import torch
from torch import Tensor, nn

from mua.rig.rig import Rig
from mua.splatting.projection import matrices
from mua.teachers.trained.graph import EmbeddedGraph


class EmbeddedDeformation(nn.Module):
    """The template in the bind pose, deformed by turns and moves of the nodes; both zero leave it as it is."""

    positions: Tensor  # [G, 3]
    neighbours: Tensor  # [G, N]
    blend: Tensor  # [V, G] how much each vertex follows each node
    vertices: Tensor  # [V, 3]

    def __init__(self, graph: EmbeddedGraph, rig: Rig) -> None:
        super().__init__()
        blend = torch.zeros(len(graph.weights), len(graph.nodes))
        blend.scatter_(1, torch.as_tensor(graph.indices), torch.as_tensor(graph.weights).float())
        self.register_buffer("positions", torch.as_tensor(graph.positions).float())
        self.register_buffer("neighbours", torch.as_tensor(graph.neighbours))
        self.register_buffer("blend", blend)
        self.register_buffer("vertices", torch.as_tensor(rig.mesh.vertices).float())

    def forward(
        self,
        turns: Tensor,  # [B, G, 3] axis times angle, radians
        moves: Tensor,  # [B, G, 3] metres
    ) -> Tensor:
        """Vertices [B, V, 3], metres."""
        turned = matrices(quaternions(turns))
        rest = self.positions + moves - (turned @ self.positions[..., None])[..., 0]
        about = self.blend @ torch.cat([turned.flatten(-2), rest], dim=-1)  # [B, V, 12]
        return (about[..., :9].unflatten(-1, (3, 3)) @ self.vertices[..., None])[..., 0] + about[..., 9:]

    def rigidity_error(
        self,
        turns: Tensor,  # [B, G, 3] axis times angle, radians
        moves: Tensor,  # [B, G, 3] metres
    ) -> Tensor:
        """How far nodes lie from where their neighbours would carry them: the mean squared distance, metres^2."""
        turned = matrices(quaternions(turns))
        away = self.positions[self.neighbours] - self.positions[:, None]  # [G, N, 3]
        carried = torch.einsum("bgij,gnj->bgni", turned, away) - away
        return (carried + moves[:, :, None] - moves[:, self.neighbours]).square().sum(-1).mean()


def quaternions(
    turns: Tensor,  # [..., 3] axis times angle, radians
) -> Tensor:
    """Unit quaternions [..., 4], with gradients where there is no turn too."""
    tiny = torch.finfo(turns.dtype).tiny
    half = (turns.square().sum(-1, keepdim=True) + tiny).sqrt() / 2
    return torch.cat([half.cos(), torch.sinc(half / torch.pi) * turns / 2], dim=-1)
