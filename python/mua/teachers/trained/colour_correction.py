"""Colour correction of each camera: an affine map of its own, trained beside the teacher."""

import torch
from torch import Tensor, nn


class ColourCorrection(nn.Module):
    """How each camera's colours differ from the mean of all; a held-out camera has the mean's colours."""

    def __init__(self, cameras: int) -> None:
        super().__init__()
        self.change = nn.Parameter(torch.zeros(cameras, 3, 4))  # of a colour and a one

    def forward(
        self,
        image: Tensor,  # [H, W, 4] premultiplied sRGB and alpha
        camera: int,
    ) -> Tensor:
        """The image [H, W, 4] as that camera shows it."""
        return torch.cat([image[..., :3] + image @ self._own()[camera].T, image[..., 3:]], dim=-1)

    def variance(self) -> Tensor:
        """The squared difference of cameras from the mean of all: summed over twelve numbers, averaged over cameras."""
        return self._own().square().sum(dim=(1, 2)).mean()

    def _own(self) -> Tensor:
        return self.change - self.change.mean(dim=0)
