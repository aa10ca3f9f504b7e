"""The training of a teacher: the mean texture first, then what motion changes; a resumed run ends in the same bytes."""

from collections.abc import Callable
from functools import partial

import torch
from torch import Tensor, nn

from mua.teachers.trained.image_losses import ImageLoss, Material
from mua.teachers.trained.parameters import deterministic, gradients_for
from mua.teachers.trained.settings import TeacherSettings
from mua.training.optimise import Run, optimise

MEAN, TEXTURE = "mean texture", "texels"
STAGES = (MEAN, TEXTURE)
CHECKPOINT_STEPS = 50  # a step takes up to seconds
# Learning rates over that of the networks, of parameters that each affect a single texel, frame or camera.
STILL_RATE, LIGHT_RATE, BESIDE_RATE, POSE_RATE = 60.0, 20.0, 1.0, 100.0


def train_teacher(image_loss: ImageLoss, material: Material, settings: TeacherSettings, *, run: Run) -> None:
    """Train the teacher of `image_loss` in place, from the last checkpoint of `run` on."""
    with deterministic():
        own = run.alone(MEAN)
        with gradients_for(image_loss, [image_loss.teacher.mean]):
            loss = partial(_loss, material=material, batch=settings.mean.batch, run=own, moving=False)
            groups: list[dict[str, object]] = [{"params": [image_loss.teacher.mean], "weight_decay": 0.0}]
            optimise(
                image_loss, loss, schedule=settings.mean, parameters=groups, stage=MEAN, run=own, every=CHECKPOINT_STEPS
            )
        own = run.alone(TEXTURE)
        rates = _rates(image_loss)
        groups = [{"params": parameters, "weight_decay": 0.0, "lr": rate} for parameters, rate in rates]
        with gradients_for(image_loss, [parameter for parameters, _ in rates for parameter in parameters]):
            loss = partial(_loss, material=material, batch=settings.texture.batch, run=own, moving=True)
            optimise(
                image_loss,
                loss,
                schedule=settings.texture,
                parameters=groups,
                stage=TEXTURE,
                run=own,
                every=CHECKPOINT_STEPS,
            )
    image_loss.keep_mean_look()


def _rates(image_loss: ImageLoss) -> list[tuple[list[nn.Parameter], float]]:
    """Parameters trained with the networks, each group with its learning rate over that of the networks."""
    teacher = image_loss.teacher
    beside = [image_loss.correction.change] if image_loss.colour_correction else []
    beside += [image_loss.looks] if image_loss.looks.numel() else []
    refinement = image_loss.refinement
    poses = [] if refinement is None else [refinement.turns, refinement.moves]
    return [
        (list(teacher.nets.parameters()), 1.0),
        ([teacher.still], STILL_RATE),
        ([teacher.light.gains], LIGHT_RATE),
        *([(beside, BESIDE_RATE)] if beside else []),
        *([(poses, POSE_RATE)] if poses else []),
    ]


def _loss(model: Callable[..., Tensor], *, material: Material, batch: int, run: Run, moving: bool) -> Tensor:
    """This process's part of the mean loss over a batch that all processes draw alike."""
    rows = material.views.draw(batch, run.generator)
    backgrounds = torch.rand(len(rows), 3, generator=run.generator).to(run.device)
    processes = run.processes
    own = slice(processes.rank, None, processes.count)
    count = len(rows[own])
    if not count:  # fewer views than processes: a loss of zero
        return 0 * model(rows[:1], backgrounds[:1], moving)
    return model(rows[own], backgrounds[own], moving) * (count * processes.count / len(rows))
