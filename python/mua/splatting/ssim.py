"""Structural similarity (SSIM) of two images, with gradients, as a training loss."""

import torch
from torch import Tensor

WINDOW = 11  # pixels along a side of the window of SSIM, of the given standard deviation
DEVIATION = 1.5
C1, C2 = 0.01**2, 0.03**2  # of images in 0..1


def structural_similarity(
    image: Tensor,  # [H, W, C] in 0..1
    truth: Tensor,  # [H, W, C]
) -> Tensor:
    """Mean SSIM (Wang et al. 2004, https://doi.org/10.1109/TIP.2003.819861), borders mirrored."""
    stacked = torch.stack([image, truth, image * image, truth * truth, image * truth]).permute(0, 3, 1, 2)
    a, b, aa, bb, ab = _blur(stacked.flatten(0, 1)[:, None]).unflatten(0, stacked.shape[:2])
    ab, aa, bb = ab - a * b, aa - a * a, bb - b * b
    similar = (2 * a * b + C1) * (2 * ab + C2) / ((a * a + b * b + C1) * (aa + bb + C2))
    return similar.mean()


def _blur(
    planes: Tensor,  # [P, 1, H, W]
) -> Tensor:
    """Gaussian means [P, 1, H, W], by a product for rows and one for columns.

    On a CPU that is ten times as fast, forward and back, as torch's convolutions of single channels.
    """
    rows, columns = (_means(length, planes) for length in planes.shape[2:])
    return rows @ planes @ columns.T


def _means(length: int, like: Tensor) -> Tensor:
    """The matrix [L, L] from L samples to their Gaussian means."""
    away = torch.arange(WINDOW) - WINDOW // 2
    weights = torch.exp(-((away.to(like) / DEVIATION) ** 2) / 2)
    reached = torch.arange(length)[:, None] + away
    last = length - 1
    mirrored = last - (last - reached.abs()).abs()
    reached = mirrored if length > WINDOW // 2 else reached.clamp(0, last)  # a mirror needs as much image as it shows
    means = torch.zeros(length, length).to(like)
    return means.scatter_add_(1, reached.to(like.device), (weights / weights.sum()).expand(length, -1))
