"""How far a picture is from the teacher's: the paper's metrics, and two that need no weights.

Over the whole picture, as in the paper (Sec. Metrics), background included: PSNR of the squared error over all pixels
and colours; SSIM with the usual Gaussian window of 11 pixels, borders mirrored; MS-SSIM over five scales; FLIP at its
default viewing distance (67 pixels a degree); LPIPS times 1000, as the paper prints it, where the user gives weights.
"""

import math
import pickle
from dataclasses import dataclass, fields
from pathlib import Path
from typing import Literal

import flip_evaluator
import numpy as np
import torch
from torch import Tensor
from torchmetrics.functional.image import lpips as perceptual
from torchmetrics.functional.image import (
    multiscale_structural_similarity_index_measure,
    peak_signal_noise_ratio,
    structural_similarity_index_measure,
)

from mua.arrays import Array
from mua.errors import InputError

# by the shape of a network's first weights, in torchvision's files
NETWORKS: dict[tuple[int, ...], Literal["alex", "vgg"]] = {
    (64, 3, 11, 11): "alex",
    (64, 3, 3, 3): "vgg",
}
FIRST_WEIGHTS = "features.0.weight"
LPIPS_UNIT = 1000


@dataclass(frozen=True)
class Scores:
    """What one picture is worth beside the teacher's."""

    psnr: float  # dB; inf where nothing differs
    ssim: float
    ms_ssim: float
    flip: float
    lpips: float  # times 1000; nan where no weights were given


METRICS = tuple(field.name for field in fields(Scores))


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

    @torch.no_grad()
    def __call__(self, image: Tensor, truth: Tensor) -> float:
        """Distance of [1, 3, H, W] in 0..1."""
        distance = self._net(image, truth, normalize=True)
        assert isinstance(distance, Tensor)  # a pair only where every layer is asked for
        return float(distance)


def compare(
    image: Array,  # [H, W, 3] in 0..1
    truth: Array,  # [H, W, 3]
    *,
    lpips: Lpips | None = None,
) -> tuple[Scores, Array]:  # [H, W] FLIP of every pixel in 0..1
    """The scores of a picture, and where it differs."""
    own, teacher = (torch.from_numpy(np.ascontiguousarray(a.transpose(2, 0, 1)))[None] for a in (image, truth))
    differs = flip_evaluator.evaluate(truth, image, "LDR", applyMagma=False, computeMeanError=False)[0][..., 0]
    ssim = structural_similarity_index_measure(own, teacher, data_range=1.0)
    assert isinstance(ssim, Tensor)  # a pair only where the whole map is asked for
    scores = Scores(
        psnr=float(peak_signal_noise_ratio(own, teacher, data_range=1.0)),
        ssim=float(ssim),
        ms_ssim=float(multiscale_structural_similarity_index_measure(own, teacher, data_range=1.0)),
        flip=float(differs.mean(dtype=np.float64)),
        lpips=math.nan if lpips is None else LPIPS_UNIT * lpips(own, teacher),
    )
    return scores, differs


def mean(scores: list[Scores]) -> Scores:
    """The mean of every metric over pictures, nan over none."""
    table = np.array([[getattr(one, name) for name in METRICS] for one in scores]).reshape(-1, len(METRICS))
    return Scores(*(float(column.mean()) if len(table) else math.nan for column in table.T))


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
