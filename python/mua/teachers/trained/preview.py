"""Previews of a training: images of a camera that it is not trained on, beside the teacher's."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import torch
from PIL import Image

from mua.arrays import Array
from mua.files.write import replacing
from mua.teachers.trained.image_losses import ImageLoss
from mua.teachers.trained.model import TeacherModel, draw
from mua.teachers.trained.views import Seen
from mua.teachers.trained.windows import Window

PICTURES, LEAST_STEPS = 20, 25  # of a stage of training at most, and so many steps apart at least
GAIN = 4  # a difference is shown so many times as strong


@dataclass(frozen=True, eq=False)
class Preview:
    """Views to look at, and where images of them go."""

    folder: Path
    seen: Sequence[tuple[Seen, Window]]

    def due(self, step: int, steps: int) -> bool:
        """Whether an image is made after a step."""
        return step == steps or step % max(steps // PICTURES, LEAST_STEPS) == 0

    def __call__(self, image_loss: ImageLoss, name: str, *, moving: bool) -> float:
        """Write an image: each view's image, the teacher's, and how they differ; returns the mean PSNR."""
        rows, scores = [], []
        look = image_loss.looks.detach().mean(dim=0)
        for seen, window in self.seen:
            truth = seen.over(torch.ones_like(seen.image[0, 0])).cpu().numpy()
            shown = picture_of(image_loss.teacher, window, seen, look=look, moving=moving)
            scores.append(psnr(shown, truth))
            rows.append(np.hstack([truth, shown, 1 - GAIN * np.abs(shown - truth)]))
        width = max(row.shape[1] for row in rows)
        padded = [np.pad(row, ((0, 0), (0, width - row.shape[1]), (0, 0)), constant_values=1) for row in rows]
        with replacing(self.folder / f"{name}.png") as temporary:
            Image.fromarray(np.rint(255 * np.clip(np.vstack(padded), 0, 1)).astype(np.uint8)).save(temporary)
        return float(np.mean(scores))


@torch.no_grad()
def picture_of(
    teacher: TeacherModel, window: Window, seen: Seen, *, look: torch.Tensor | None = None, moving: bool = True
) -> Array:
    """The teacher [H, W, 3] over white, in 0..1."""
    device = teacher.surfels.device
    own = window.to(device)
    image = draw(teacher.splats(teacher(own, look=look, moving=moving), own.joints[0]), seen.eye)
    return np.asarray((image[..., :3] + 1 - image[..., 3:]).clamp(0, 1).cpu())


def psnr(image: Array, truth: Array) -> float:
    """Decibels over all pixels and colours of images in 0..1."""
    return float(-10 * np.log10(max(np.mean(np.square(image - truth, dtype=np.float64)), 1e-10)))
