"""Smooth filling of the texels outside the UV charts, so that chart borders put no energy into the detail subbands.

Push-pull (Gortler et al. 1996, https://doi.org/10.1145/237170.237200): averages of the valid texels are pushed up an
image pyramid and pulled down again by bilinear interpolation wherever a level is empty; one Jacobi sweep of Laplace's
equation per level then takes the corners out. Everything wraps around, as the periodized wavelet transform does.
"""

import torch
from torch import Tensor
from torch.nn import functional

from mua.errors import InputError
from mua.rig.texel_map import TexelMap

CACHED_VALUES = 1 << 21  # channels are filled a few at a time, as many as the cache of a CPU holds


class Fill:
    """The filling of one texel map; what depends on the map alone is computed once."""

    def __init__(self, texels: TexelMap, device: torch.device | str = "cpu") -> None:
        """Raises InputError where no texel is valid: then there is nothing to fill from."""
        if len(texels.texels) == 0:
            raise InputError(f"texel map: of {texels.size} x {texels.size} texels none is valid, expected at least one")
        self._size = texels.size
        self._texels = torch.as_tensor(texels.texels, dtype=torch.long, device=device)
        valid = torch.zeros(texels.size**2, dtype=torch.bool, device=device)
        valid[self._texels] = True
        self._valid = [valid.view(1, 1, texels.size, texels.size)]
        self._weights: list[Tensor] = []
        while not self._valid[-1].all() and self._valid[-1].shape[-1] % 2 == 0:
            share = functional.avg_pool2d(self._valid[-1].double(), 2)
            self._valid.append(share > 0)
            self._weights.append(torch.where(share > 0, 1 / share, 0))

    def __call__(
        self,
        values: Tensor,  # [N, C] any float type, at the valid texels in the order of the map
    ) -> Tensor:
        """Images [C, H, W] of the same type that keep `values` at the valid texels and are smooth elsewhere."""
        images = torch.zeros(values.shape[1], self._size**2, dtype=values.dtype, device=self._texels.device)
        weights = [weight.to(values.dtype) for weight in self._weights]
        together = max(CACHED_VALUES // self._size**2, 1)
        for image, planes in zip(images.split(together), values.T.split(together), strict=True):
            image[:, self._texels] = planes.to(image.device)
            known = image.view(-1, 1, self._size, self._size)
            known.copy_(self._pull(self._push(known, weights)))
        return images.view(-1, self._size, self._size)

    def _push(self, image: Tensor, weights: list[Tensor]) -> list[Tensor]:
        """The pyramid, fine first, of averages of the valid values; 0 where a cell has none."""
        levels = [image]
        for weight in weights:
            levels.append(functional.avg_pool2d(levels[-1], 2) * weight)
        return levels

    def _pull(self, levels: list[Tensor]) -> Tensor:
        """The finest level with every empty texel filled from the coarser ones."""
        valid = self._valid[-1]
        filled = torch.where(valid, levels[-1], levels[-1].sum(dim=(-2, -1), keepdim=True) / valid.sum())
        for known, valid in zip(levels[-2::-1], self._valid[-2::-1], strict=True):
            filled = torch.where(valid, known, _upsample(filled))
            filled = torch.where(valid, known, _mean_of_neighbours(filled))
        return filled


def _upsample(image: Tensor) -> Tensor:
    """[C, 1, n, n] to [C, 1, 2 n, 2 n], bilinear and periodic."""
    wrapped = functional.pad(image, (1, 1, 1, 1), mode="circular")
    return functional.interpolate(wrapped, scale_factor=2, mode="bilinear", align_corners=False)[..., 2:-2, 2:-2]


def _mean_of_neighbours(image: Tensor) -> Tensor:
    """The mean of the four texels around each of [C, 1, n, n], periodic."""
    wrapped = functional.pad(image, (1, 1, 1, 1), mode="circular")
    mean = wrapped[..., 1:-1, :-2] + wrapped[..., 1:-1, 2:]
    mean += wrapped[..., :-2, 1:-1]
    mean += wrapped[..., 2:, 1:-1]
    mean *= 0.25
    return mean
