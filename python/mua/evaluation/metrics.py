"""How far an image is from the teacher's: the paper's metrics, and two that need no weights.

Over the whole image, as in the paper (Sec. Metrics), background included: PSNR of the squared error over all pixels
and colours; SSIM with the usual Gaussian window of 11 pixels, borders mirrored; MS-SSIM over five scales; FLIP at its
default viewing distance (67 pixels a degree); LPIPS times 1000, as the paper prints it, where the user gives weights.
"""

import math
from dataclasses import dataclass, fields

import flip_evaluator
import numpy as np
import torch
from torch import Tensor
from torchmetrics.functional.image import (
    multiscale_structural_similarity_index_measure,
    peak_signal_noise_ratio,
    structural_similarity_index_measure,
)

from mua.arrays import Array
from mua.splatting.perceptual import Lpips

LPIPS_UNIT = 1000


@dataclass(frozen=True)
class Scores:
    """What one image is worth beside the teacher's."""

    psnr: float  # dB; inf where nothing differs
    ssim: float
    ms_ssim: float
    flip: float
    lpips: float  # times 1000; nan where no weights were given


METRICS = tuple(field.name for field in fields(Scores))


def compare(
    image: Array,  # [H, W, 3] in 0..1
    truth: Array,  # [H, W, 3]
    *,
    lpips: Lpips | None = None,
) -> tuple[Scores, Array]:  # [H, W] FLIP of every pixel in 0..1
    """The scores of an image, and where it differs."""
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
    """The mean of every metric over images, nan over none."""
    table = np.array([[getattr(one, name) for name in METRICS] for one in scores]).reshape(-1, len(METRICS))
    return Scores(*(float(column.mean()) if len(table) else math.nan for column in table.T))
