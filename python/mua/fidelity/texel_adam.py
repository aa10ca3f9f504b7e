"""Adam for texels of which an image shows some: those alone move, by moments and counts of their own.

As in torch, but that means of gradients are not corrected for their bias: a texel's first images move it less.
"""

import torch
from torch import Tensor

BETAS, EPSILON = (0.7, 0.9), 0.1


class TexelAdam:
    """The moments of N texels."""

    def __init__(self, texels: int, numbers: int) -> None:
        self._mean, self._square = torch.zeros(2, texels, numbers)
        self._count = torch.zeros(texels, 1)

    def __call__(
        self,
        seen: Tensor,  # [M] int64, texels, each once
        gradient: Tensor,  # [M, C]
    ) -> Tensor:
        """What to subtract from their numbers, over the rate, [M, C]."""
        count = self._count[seen] + 1
        mean = self._mean[seen].lerp(gradient, 1 - BETAS[0])
        square = self._square[seen].lerp(gradient.square(), 1 - BETAS[1])
        self._count[seen], self._mean[seen], self._square[seen] = count, mean, square
        return mean / ((square / (1 - BETAS[1] ** count)).sqrt() + EPSILON)
