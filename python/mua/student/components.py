"""The components of the descriptor in torch, the input of the MLPs (reference: `mua.pose.components`)."""

from dataclasses import dataclass

import torch
from torch import Tensor


@dataclass(frozen=True, eq=False)
class Components:
    """Principal components of normalised descriptors, softly limited to the ranges of training and their margins."""

    directions: Tensor  # [K, D]
    ranges: Tensor  # [2, K]
    margins: Tensor  # [K]

    def __len__(self) -> int:
        return len(self.directions)

    def __call__(self, inputs: Tensor) -> Tensor:
        """Components [F, K] of normalised descriptors [F, D], without limits."""
        return inputs @ self.directions.T

    def back(self) -> Tensor:
        """The map [K, D] from components to the normalised descriptors that have them."""
        return torch.linalg.pinv(self.directions.T.double()).to(self.directions)

    def hold(self, found: Tensor) -> Tensor:
        """Components [F, K] limited as the networks read them."""
        nearest = torch.minimum(torch.maximum(found, self.ranges[0]), self.ranges[1])
        beyond = found - nearest
        size = beyond.abs()
        return nearest + beyond * self.margins / (size + self.margins).clamp(min=torch.finfo(found.dtype).tiny)
