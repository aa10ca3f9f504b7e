"""The learned perceptual distance of two images, as a score and as a loss, with weights that the user gives."""

import pickle
from pathlib import Path
from typing import Literal, Self

import torch
from torch import Tensor
from torchmetrics.functional.image import lpips as perceptual

from mua.errors import InputError

# by the shape of a network's first weights, in torchvision's files
NETWORKS: dict[tuple[int, ...], Literal["alex", "vgg"]] = {
    (64, 3, 11, 11): "alex",
    (64, 3, 3, 3): "vgg",
}
FIRST_WEIGHTS = "features.0.weight"


class Lpips:
    """The learned perceptual distance (Zhang et al. 2018) by torchmetrics, whose linear layers ship with it."""

    def __init__(self, path: Path) -> None:
        """Load torchvision's weights of AlexNet or VGG16 from `path`.

        Errors: InputError where the file holds neither, or torchvision, which knows the networks' layers, is missing.
        """
        weights = _load(path)
        shape = tuple(weights[FIRST_WEIGHTS].shape) if FIRST_WEIGHTS in weights else ()
        if shape not in NETWORKS:
            raise InputError(f"{path}: {FIRST_WEIGHTS} is {list(shape) or 'missing'}, expected AlexNet's or VGG16's")
        self.network = NETWORKS[shape]
        try:
            self._net = perceptual._NoTrainLpips(net=self.network, pnet_rand=True)
        except ModuleNotFoundError as error:
            raise InputError(f"--lpips-weights {path}: torchvision is not installed, which knows the layers") from error
        own = self._net.net.state_dict()  # slice1.0.weight where torchvision says features.0.weight
        given = {name: weights.get(f"features.{name.split('.', 1)[1]}", torch.empty(0)) for name in own}
        wrong = [name for name, value in given.items() if value.shape != own[name].shape]
        if wrong:
            name = f"features.{wrong[0].split('.', 1)[1]}"
            raise InputError(f"{path}: {name} is missing or of another shape than {self.network}'s")
        self._net.net.load_state_dict(given)

    def to(self, device: torch.device) -> Self:
        """Moves the networks to a device; gradients reach images alone."""
        self._net.to(device).requires_grad_(False)
        return self

    def distance(self, image: Tensor, truth: Tensor) -> Tensor:
        """Between two images [1, 3, H, W] in 0..1, with gradients."""
        distance: Tensor = self._net(image, truth, normalize=True)
        assert isinstance(distance, Tensor)  # a pair only where every layer is asked for
        return distance.mean()

    @torch.no_grad()
    def __call__(self, image: Tensor, truth: Tensor) -> float:
        """The distance as a number."""
        return float(self.distance(image, truth))


def _load(path: Path) -> dict[str, Tensor]:
    try:
        held = torch.load(path, map_location="cpu", weights_only=True)
    except OSError as error:
        raise InputError(f"{path}: {error.strerror}") from error
    except (RuntimeError, EOFError, pickle.UnpicklingError) as error:
        raise InputError(f"{path}: is no file of weights that torch can read") from error
    if not isinstance(held, dict):
        raise InputError(f"{path}: holds a {type(held).__name__}, expected weights by name")
    return held
