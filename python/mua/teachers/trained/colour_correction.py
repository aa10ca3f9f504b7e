"""What each camera makes of colours: an affine map of its own, learnt beside the teacher."""

import torch
from torch import Tensor, nn


class ColourCorrection(nn.Module):
    """Cameras differ from the mean of all by what is learnt; a camera that was left out sees as the mean does."""

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

    def unlikeness(self) -> Tensor:
        """The mean square by which cameras differ from the mean of all, of the sum over their twelve numbers."""
        return self._own().square().sum(dim=(1, 2)).mean()

    def _own(self) -> Tensor:
        return self.change - self.change.mean(dim=0)
