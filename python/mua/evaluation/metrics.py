"""How far an image is from the teacher's or a camera's: the paper's metrics, and two that need no weights.

Over all of the image that is given, background included, as in the paper (Sec. Metrics): PSNR of the squared error over
all pixels and colours; SSIM with the usual Gaussian window of 11 pixels, borders mirrored; MS-SSIM over five scales;
FLIP at its default viewing distance (67 pixels a degree); LPIPS times 1000, as the paper prints it, where the user
gives weights.
"""

import math
from dataclasses import dataclass, fields

import flip_evaluator
import numpy as np
import torch
from torchmetrics.functional.image import multiscale_structural_similarity_index_measure

from mua.arrays import Array
from mua.splatting.perceptual import Lpips
from mua.splatting.ssim import structural_similarity

LPIPS_UNIT = 1000


@dataclass(frozen=True)
class Scores:
    """What one image is worth beside the one that it should be."""

    psnr: float  # dB; inf where nothing differs
    ssim: float
    ms_ssim: float  # nan where it was not asked for
    flip: float
    lpips: float  # times 1000; nan where no weights were given


METRICS = tuple(field.name for field in fields(Scores))


def compare(
    image: Array,  # [H, W, 3] in 0..1
    truth: Array,  # [H, W, 3]
    *,
    lpips: Lpips | None = None,
    multiscale: bool = True,  # whether MS-SSIM is measured, for which images must be larger than 160 pixels
) -> tuple[Scores, Array]:  # [H, W] FLIP of every pixel in 0..1
    """The scores of an image, and where it differs."""
    image, truth = (np.ascontiguousarray(picture, np.float32) for picture in (image, truth))
    pair = [torch.from_numpy(picture) for picture in (image, truth)]
    own, other = (picture.permute(2, 0, 1)[None] for picture in pair)
    differs = flip_evaluator.evaluate(truth, image, "LDR", applyMagma=False, computeMeanError=False)[0][..., 0]
    square = float(np.mean(np.square(image - truth, dtype=np.float64)))
    scores = Scores(
        psnr=-10 * math.log10(square) if square else math.inf,
        ssim=float(structural_similarity(*pair)),
        ms_ssim=float(multiscale_structural_similarity_index_measure(own, other, data_range=1.0))
        if multiscale
        else math.nan,
        flip=float(differs.mean(dtype=np.float64)),
        lpips=math.nan if lpips is None else LPIPS_UNIT * lpips(own, other),
    )
    return scores, differs


def mean(scores: list[Scores]) -> Scores:
    """The mean of every metric over images, nan over none."""
    table = np.array([[getattr(one, name) for name in METRICS] for one in scores]).reshape(-1, len(METRICS))
    return Scores(*(float(column.mean()) if len(table) else math.nan for column in table.T))
