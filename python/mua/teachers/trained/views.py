"""Training views: images of frames by cameras, as tensors."""

from collections.abc import Callable
from dataclasses import dataclass

import torch
from torch import Tensor

from mua.splatting.projection import Eye

TOGETHER = 2  # views of a frame in one batch: the networks are asked once for both


@dataclass(frozen=True, eq=False)
class Seen:
    """An image of one frame by one camera, cut to the person."""

    image: Tensor  # [H, W, 3] sRGB in 0..1
    mask: Tensor  # [H, W] in 0..1
    eye: Eye
    background: Tensor | None = None  # [H, W, 3] of the empty set
    weight: float = 1.0  # how much it counts; masks that do not fit the pose cannot be trusted

    def over(self, background: Tensor) -> Tensor:
        """The person [H, W, 3] over [3] or [H, W, 3]."""
        mask = self.mask[..., None]
        return mask * self.image + (1 - mask) * background


@dataclass(frozen=True, eq=False)
class Views:
    """Images of F frames by C cameras."""

    frames: int
    cameras: int
    see: Callable[[int, int], Seen]  # of a frame by a camera

    def __len__(self) -> int:
        return self.frames * self.cameras

    def draw(self, count: int, generator: torch.Generator) -> Tensor:
        """Rows [B] of up to `count` views, of which TOGETHER show one frame; a row is frame * C + camera.

        Frames take turns, so that processes that take turns have frames of their own.
        """
        together = min(TOGETHER, count, self.cameras)
        frames = torch.randint(self.frames, (count // together,), generator=generator)
        cameras = [torch.randperm(self.cameras, generator=generator)[:together] for _ in frames]
        return (frames * self.cameras + torch.stack(cameras, dim=1)).flatten()
