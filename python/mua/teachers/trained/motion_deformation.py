"""How motion deforms the template in the bind pose: f_eg(F_eg(descriptor)) + F_delta(descriptor), both trained.

Far from the training frames a regression through what the networks give there takes their place.
"""

from dataclasses import dataclass

import torch
from torch import Tensor, nn

from mua.pose.descriptor import normalization, units_of
from mua.pose.encoding import PoseEncoding
from mua.rig.bones import figure_scale
from mua.rig.rig import Rig
from mua.teachers.trained.deformation import EmbeddedDeformation
from mua.teachers.trained.graph import build_graph
from mua.teachers.trained.graph_networks import NodeFeatures, OwnReadout
from mua.teachers.trained.smooth_deformation import FRAMES, SmoothDeformation
from mua.training.optimise import Run

FARTHEST = 3.0  # standard deviations; a pose beyond all that was seen deforms like one at the border
TURN = 0.1  # radians that an output of 1 turns a node
REGRESSION = "template regression"  # stage of a run
AT_ONCE = 64  # frames
MOVE = 0.01  # metres on a person that an output of 1 moves a node or a vertex


@dataclass(frozen=True)
class GraphSizes:
    """How large the networks are."""

    nodes: int = 128
    features: int = 16
    fade: float = 0.5  # of what a body part sees of the descriptor, for each joint between


@dataclass(frozen=True, eq=False)
class Deformed:
    """The template in B frames, in the bind pose, and what deformed it."""

    vertices: Tensor  # [B, V, 3] metres
    turns: Tensor  # [B, G, 3] of the nodes, axis times angle
    moves: Tensor  # [B, G, 3] of the nodes, metres
    offsets: Tensor  # [B, V, 3] of the vertices, metres


class MotionDeformation(nn.Module):
    """From motion descriptors to canonical vertices; before it is trained they are those of the bind pose."""

    mean: Tensor  # [D]
    scale: Tensor  # [D]

    def __init__(self, rig: Rig, encoding: PoseEncoding, sizes: GraphSizes) -> None:
        super().__init__()
        graph = build_graph(rig, nodes=sizes.nodes)
        count, features = len(graph.nodes), sizes.features
        self._encoding, self._size = encoding, figure_scale(rig.mesh.vertices)
        self.graph = EmbeddedDeformation(graph, rig)
        self.node_features = NodeFeatures(rig, encoding, graph, features=features, fade=sizes.fade)
        self.node_motion = OwnReadout(count, features, 6)
        self.vertex_features = NodeFeatures(rig, encoding, graph, features=features, fade=sizes.fade)
        self.vertex_offsets = OwnReadout(len(rig.mesh.vertices), features, 3)
        self.smooth = SmoothDeformation(rig, encoding, self.node_features.parts.reach)
        self.register_buffer("mean", torch.zeros(encoding.width))
        self.register_buffer("scale", torch.ones(encoding.width))

    def forward(
        self,
        descriptors: Tensor,  # [B, D]
    ) -> Tensor:
        """Canonical vertices [B, V, 3], metres."""
        vertices = self.deform(descriptors).vertices
        return self.smooth(descriptors.to(vertices), vertices) if self.smooth.fitted else vertices

    def deform(
        self,
        descriptors: Tensor,  # [B, D]
        *,
        offsets: bool = True,  # False: F_eg alone
    ) -> Deformed:
        """The networks' canonical vertices with the turns, moves and offsets that they come from."""
        inputs = ((descriptors.to(self.mean) - self.mean) / self.scale).clamp(-FARTHEST, FARTHEST)
        motion = self.node_motion(self.node_features(inputs))
        turns, moves = TURN * motion[..., :3], MOVE * self._size * motion[..., 3:]
        vertices = self.graph(turns, moves)
        own = torch.zeros_like(vertices)
        if offsets:
            known = self.graph.blend @ self.vertex_features(inputs)
            own = MOVE * self._size * self.vertex_offsets(known)
        return Deformed(vertices + own, turns, moves, own)

    @torch.no_grad()
    def prepare(
        self,
        descriptors: Tensor,  # [F, D] of the training frames
        generator: torch.Generator,
    ) -> None:
        """Set the normalisation and draw the weights that training starts from."""
        values = descriptors.double().numpy()
        found = normalization(values, units_of(self._encoding, self._size))
        self.mean.copy_(torch.as_tensor(found.mean))
        self.scale.copy_(torch.as_tensor(found.scale))
        self.node_features.seed(generator)
        self.vertex_features.seed(generator)

    @torch.no_grad()
    def carry_over(
        self,
        descriptors: Tensor,  # [F, D] of the training frames
        *,
        run: Run,
    ) -> None:
        """Fit the regression to what the networks give in training frames."""
        rows = torch.linspace(0, len(descriptors) - 1, min(len(descriptors), FRAMES)).round().long()
        known = descriptors[rows].to(self.mean)

        def solve() -> dict[str, Tensor]:
            return self.smooth.regress(known, torch.cat([self.deform(some).vertices for some in known.split(AT_ONCE)]))

        for name, tensor in run.once(REGRESSION, solve).items():
            setattr(self.smooth, name, tensor)
