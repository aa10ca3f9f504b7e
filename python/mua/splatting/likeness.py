"""How alike two images are, with gradients: what a training on images descends."""

import torch
from torch import Tensor
from torch.nn import functional

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
    """Gaussian means [P, 1, H, W]; a Gaussian is separable, so two passes are enough."""
    away = torch.arange(WINDOW).to(planes) - WINDOW // 2
    weights = torch.exp(-((away / DEVIATION) ** 2) / 2)
    weights = (weights / weights.sum()).view(1, 1, 1, -1)
    margin = WINDOW // 2
    mode = "reflect" if min(planes.shape[2:]) > margin else "replicate"  # a mirror needs as much image as it shows
    planes = functional.pad(planes, (margin,) * 4, mode=mode)
    return functional.conv2d(functional.conv2d(planes, weights), weights.transpose(2, 3))
