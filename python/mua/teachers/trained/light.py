"""Light that stands still while a person turns: how it changes colours, by the direction that the surface faces.

Light from afar on a matt surface is a polynomial of degree 2 in the normal, up to a percent (Ramamoorthi and Hanrahan
2001, https://doi.org/10.1145/383259.383317); shadows and what shines are left to the networks.
"""

import torch
from torch import Tensor, nn

TERMS = 8  # spherical harmonics of degree 1 and 2


class Light(nn.Module):
    """One light for all texels; before training, it comes from all sides alike."""

    def __init__(self) -> None:
        super().__init__()
        self.gains = nn.Parameter(torch.zeros(TERMS, 3))

    def forward(
        self,
        normals: Tensor,  # [N, 3] world, unit
    ) -> Tensor:
        """The factors [N, 3] of colours."""
        x, y, z = normals.unbind(-1)
        terms = [x, y, z, x * y, y * z, z * x, x * x - y * y, (3 * z * z - 1) / 2]
        return (1 + torch.stack(terms, dim=-1) @ self.gains).clamp(min=0)
