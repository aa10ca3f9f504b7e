"""A UNet (Ronneberger et al. 2015, https://arxiv.org/abs/1505.04597) over textures of any even size."""

import torch
from torch import Tensor, nn
from torch.nn import functional

WIDEST = 8  # times the channels of the first level


class UNet(nn.Module):
    """From images [B, in, H, W] to [B, out, H, W]; before training it gives 0 everywhere."""

    def __init__(self, inputs: int, outputs: int, *, channels: int, levels: int) -> None:
        """H and W are multiples of 2^(levels - 1)."""
        super().__init__()
        widths = [channels * min(2**level, WIDEST) for level in range(levels)]
        before = [inputs, *widths[:-1]]
        self.down = nn.ModuleList(_block(a, b) for a, b in zip(before, widths, strict=True))
        self.up = nn.ModuleList(
            _block(below + own, own) for own, below in zip(widths[-2::-1], widths[:0:-1], strict=True)
        )
        self.last = nn.Conv2d(widths[0], outputs, 1)
        nn.init.zeros_(self.last.weight)
        nn.init.zeros_(self.last.bias)  # type: ignore[arg-type]

    def forward(self, x: Tensor) -> Tensor:
        skipped: list[Tensor] = []
        for block in self.down:
            x = block(functional.avg_pool2d(x, 2) if skipped else x)
            skipped.append(x)
        for block, own in zip(self.up, skipped[-2::-1], strict=True):
            x = block(torch.cat([functional.interpolate(x, scale_factor=2.0, mode="nearest"), own], dim=1))
        return self.last(x)


def _block(inputs: int, outputs: int) -> nn.Sequential:
    """Two convolutions whose activations keep their spread."""
    block = nn.Sequential(
        nn.Conv2d(inputs, outputs, 3, padding=1), nn.SiLU(), nn.Conv2d(outputs, outputs, 3, padding=1), nn.SiLU()
    )
    for layer in block:
        if isinstance(layer, nn.Conv2d):
            nn.init.kaiming_normal_(layer.weight)
            nn.init.zeros_(layer.bias)  # type: ignore[arg-type]
    return block
