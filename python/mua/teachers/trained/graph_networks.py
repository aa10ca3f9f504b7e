"""Networks over the nodes of the embedded graph that read the motion descriptor (paper, Preliminaries: F_eg, F_delta).

Every body part sees the descriptor with what lies some joints away fading out; a node sees the parts on whose joints
it hangs and has a code of its own. Residual blocks then mix what neighbouring nodes know. Their weights are shared by
all nodes, and only the last layer is a node's or a vertex's own.
"""

import numpy as np
import torch
from torch import Tensor, nn

from mua.arrays import Array
from mua.pose.encoding import PoseEncoding
from mua.pose.joint_steps import joint_steps, nearest_encoded
from mua.rig.rig import Rig
from mua.teachers.trained.graph import EmbeddedGraph

BLOCKS = 2
FIRST_LAYER = 0.3  # scale of the first layer's weights at the start: small ones make smooth functions
CODE = 0.1  # standard deviation of the nodes' codes at the start


class PartFeatures(nn.Module):
    """Features of the motion for P body parts, by one layer that all share."""

    reach: Tensor  # [P, D] what each entry of a descriptor is multiplied by before a part sees it

    def __init__(self, rig: Rig, encoding: PoseEncoding, *, features: int, fade: float) -> None:
        super().__init__()
        seen = seen_joints(rig, encoding)
        steps = joint_steps(rig.skeleton, seen)
        steps[:, 0] = np.minimum(steps[:, 0], 1)  # the root, where the body goes and how it leans, is near every part
        columns = [
            0 if part.joint is None else seen.index(part.joint) for part in encoding.parts for _ in range(part.width)
        ]
        reach = torch.as_tensor(steps[:, columns])
        self.register_buffer("reach", fade ** reach.float(), persistent=False)
        self.layer = nn.Linear(encoding.width, features)

    def forward(
        self,
        inputs: Tensor,  # [B, D] normalised descriptors
    ) -> Tensor:
        """Features [B, P, C]."""
        features: Tensor = self.layer(inputs[:, None] * self.reach)
        return features


class NodeFeatures(nn.Module):
    """Features of the motion for G nodes."""

    mix: Tensor  # [G, P] how much each node hangs on each part
    neighbours: Tensor  # [G, N]

    def __init__(self, rig: Rig, encoding: PoseEncoding, graph: EmbeddedGraph, *, features: int, fade: float) -> None:
        super().__init__()
        self.parts = PartFeatures(rig, encoding, features=features, fade=fade)
        self.code = nn.Parameter(torch.zeros(len(graph.nodes), features))
        self.blocks = nn.ModuleList([nn.Linear(2 * features, features) for _ in range(BLOCKS)])
        mix = skin_of_parts(rig, encoding)[graph.nodes]
        self.register_buffer("mix", torch.as_tensor(mix).float(), persistent=False)
        self.register_buffer("neighbours", torch.as_tensor(graph.neighbours), persistent=False)

    def forward(
        self,
        inputs: Tensor,  # [B, D] normalised descriptors
    ) -> Tensor:
        """Features [B, G, C]."""
        known = torch.relu(self.mix @ self.parts(inputs) + self.code)
        for block in self.blocks:
            known = known + torch.relu(block(torch.cat([known, self._about(known)], dim=-1)))
        return known

    @torch.no_grad()
    def seed(self, generator: torch.Generator) -> None:
        """Draw all weights from a generator: the same numbers wherever it is called."""
        for layer in (self.parts.layer, *self.blocks):
            assert isinstance(layer, nn.Linear)
            layer.weight.normal_(0, layer.in_features**-0.5, generator=generator)
            layer.bias.zero_()
        self.parts.layer.weight.mul_(FIRST_LAYER)
        self.code.normal_(0, CODE, generator=generator)

    def _about(self, known: Tensor) -> Tensor:
        """The mean [B, G, C] over each node's neighbours."""
        if not self.neighbours.numel():
            return torch.zeros_like(known)
        gathered = known.index_select(1, self.neighbours.flatten())
        return gathered.unflatten(1, self.neighbours.shape).mean(2)


class OwnReadout(nn.Module):
    """The last layer of n nodes or vertices, each with weights of its own; zero at the start."""

    def __init__(self, count: int, features: int, outputs: int) -> None:
        super().__init__()
        self.weight = nn.Parameter(torch.zeros(count, features, outputs))
        self.bias = nn.Parameter(torch.zeros(count, outputs))

    def forward(
        self,
        features: Tensor,  # [B, n, C]
    ) -> Tensor:
        """[B, n, c]."""
        return torch.einsum("bnc,nco->bno", features, self.weight) + self.bias


def seen_joints(rig: Rig, encoding: PoseEncoding) -> list[int]:
    """The joints that a descriptor encodes, the root first: one for each body part."""
    return [rig.skeleton.root, *sorted({*encoding.joints, *encoding.translated})]


def skin_of_parts(rig: Rig, encoding: PoseEncoding) -> Array:
    """How much each vertex hangs on each body part [V, P]; rows sum to 1."""
    seen = seen_joints(rig, encoding)
    weights = np.zeros((len(rig.mesh.vertices), len(seen)))
    carrier = nearest_encoded(rig.skeleton, seen)
    np.add.at(weights, (np.arange(len(weights))[:, None], carrier[rig.skin_indices]), rig.skin_weights)
    return weights
