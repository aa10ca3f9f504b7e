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
        own = self.change[camera] - self.change.mean(dim=0)
        return torch.cat([image[..., :3] + image @ own.T, image[..., 3:]], dim=-1)

    def size(self) -> Tensor:
        """The mean square of what is learnt."""
        return self.change.square().mean()
