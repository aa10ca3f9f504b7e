"""The deformation in poses that are far from all training frames: kernel ridge regression on the pose.

Networks fit the training frames closely, and other motion less. A regression that smooths over frames ends in their
mean where it knows nothing (docs/research/template.md). Each body part has one of its own, which sees what lies some
joints away less.
"""

import torch
from torch import Tensor, nn

from mua.pose.descriptor import units_of
from mua.pose.encoding import PoseEncoding
from mua.rig.bones import figure_scale
from mua.rig.rig import Rig
from mua.teachers.trained.graph_networks import skin_of_parts
from mua.training.kernel_regression import Smoother, fit_smoother

# Chosen on training clips, each left out in turn.
NOISE = 0.3  # variance of a frame's deformation beside what follows from its pose, relative to the latter
FRAMES = 1024  # that it is fitted to, all along the clips: its cost grows with them
RANK = 128  # principal components of the deformation
FITTED = ("poses", "widths", "values", "mean", "basis", "near")  # buffers of a regression


class SmoothDeformation(nn.Module):
    """Canonical vertices: given ones near training frames, the regression's far from them."""

    units: Tensor  # [D] of a descriptor's entries
    reach: Tensor  # [P, D] what each entry is multiplied by before a part sees it
    mix: Tensor  # [V, P] how much each vertex hangs on each part
    poses: Tensor  # [M, D] descriptors of frames, in `units`
    widths: Tensor  # [P] of the kernels
    values: Tensor  # [P, M, K] of the kernels at the frames
    mean: Tensor  # [V, 3] metres
    basis: Tensor  # [K, V, 3]
    near: Tensor  # squared distance from the nearest frame at which given vertices count 1 / e

    def __init__(self, rig: Rig, encoding: PoseEncoding, reach: Tensor) -> None:
        super().__init__()
        units = torch.as_tensor(units_of(encoding, figure_scale(rig.mesh.vertices))).float()
        self.register_buffer("units", units, persistent=False)
        self.register_buffer("reach", reach, persistent=False)
        self.register_buffer("mix", torch.as_tensor(skin_of_parts(rig, encoding)).float(), persistent=False)
        for name in FITTED:
            self.register_buffer(name, torch.empty(0))

    @property
    def fitted(self) -> bool:
        """Whether there is a regression: not before the networks are trained."""
        return len(self.poses) > 0

    def forward(
        self,
        descriptors: Tensor,  # [B, D]
        given: Tensor,  # [B, V, 3] canonical vertices, metres
    ) -> Tensor:
        """Canonical vertices [B, V, 3], metres."""
        poses = descriptors / self.units
        smooth = self.mean.expand_as(given).clone()
        for part, reach in enumerate(self.reach):
            function = Smoother(self.poses * reach, self.values[part], float(self.widths[part]))
            smooth += self.mix[:, part, None] * (function(poses * reach) @ self.basis.flatten(1)).view_as(given)
        trust = (-torch.cdist(poses, self.poses).square().amin(1) / self.near).exp()
        return smooth + trust[:, None, None] * (given - smooth)

    @torch.no_grad()
    def regress(
        self,
        descriptors: Tensor,  # [M, D] of training frames
        vertices: Tensor,  # [M, V, 3] canonical, metres
    ) -> dict[str, Tensor]:
        """The buffers of a regression through the vertices of training frames."""
        poses, mean = descriptors / self.units, vertices.mean(0)
        rows, spread, columns = torch.linalg.svd((vertices - mean).flatten(1), full_matrices=False)
        coefficients, basis = (rows * spread)[:, :RANK], columns[:RANK]
        generator = torch.Generator()  # draws nothing, as all frames span the functions
        parts = [fit_smoother(poses * reach, coefficients, generator=generator, noise=NOISE) for reach in self.reach]
        apart = torch.cdist(poses, poses).fill_diagonal_(torch.inf).amin(1)
        near = apart[apart.isfinite()].square().sum() / len(poses)
        return {
            "poses": poses,
            "widths": torch.tensor([part.width for part in parts]).to(poses),
            "values": torch.stack([part.values for part in parts]),
            "mean": mean,
            "basis": basis.unflatten(1, mean.shape),
            "near": near.clamp(min=torch.finfo(near.dtype).tiny),
        }

    def _load_from_state_dict(self, state_dict: dict[str, Tensor], prefix: str, *rest: object) -> None:
        """Buffers are as large as those that are loaded, whose frames and components only the state knows."""
        for name in FITTED:
            setattr(self, name, torch.empty_like(state_dict[prefix + name], device=self.units.device))
        super()._load_from_state_dict(state_dict, prefix, *rest)
