"""A teacher of few texels, and images that it can be taught from."""

from collections.abc import Callable
from dataclasses import replace
from functools import cache
from pathlib import Path

import torch
from synthetic_avatar import synthetic_avatar

from mua.camera import orbit
from mua.checkpoint import Checkpoints
from mua.pose.encoding import PoseEncoding
from mua.processes import ALONE, Processes
from mua.splatting.projection import Eye
from mua.student.optimise import Progress, Run
from mua.student.settings import Schedule
from mua.teaching.lesson import Lesson, Material
from mua.teaching.model import Subject, TeacherModel, draw
from mua.teaching.settings import PRESETS, TeacherSettings
from mua.teaching.train import train_teacher
from mua.teaching.views import Seen, Views
from mua.teaching.windows import Window, windows

SETTINGS = replace(
    PRESETS["tiny"],
    texels=32,
    channels=4,
    levels=3,
    code=2,
    mean=Schedule(steps=8, batch=2, lr=5e-2),
    texture=Schedule(steps=14, batch=4, lr=5e-3),
)
FRAMES, CAMERAS = 3, 2
FEW = replace(  # of the preset `tiny`, for commands
    PRESETS["tiny"],
    channels=4,
    mean=Schedule(steps=4, batch=2, lr=2e-2),
    texture=Schedule(steps=2, batch=2, lr=1e-3),
    rows=48,
)
SCREEN = (40, 36)


@cache
def subject() -> Subject:
    """Surfels that lie on the synthetic rig, all grey."""
    rig = synthetic_avatar().rig
    surfels = torch.zeros(len(rig.texels.texels), 23)
    surfels[:, 3], surfels[:, 7:10], surfels[:, 10] = 1, -3.2, 2.0
    return Subject(rig, surfels, PoseEncoding((1, 2), rate=24.0))


@cache
def motion() -> list[Window]:
    own = subject()
    return windows(own.rig.skeleton, own.encoding, synthetic_avatar().clips[0])


def teacher(settings: TeacherSettings = SETTINGS) -> TeacherModel:
    """Before its training; the same for the same settings."""
    torch.manual_seed(settings.seed)
    return TeacherModel(subject(), settings)


def looks_of_pictures(truth: TeacherModel) -> torch.Tensor:
    """What the colours of `material` differ by from grey, [N, 3]."""
    across = torch.arange(len(truth.mean))[:, None] / torch.tensor([60.0, 90, 150])
    return 0.3 * torch.sin(across)


def material(change: Callable[[Seen, int], Seen] = lambda seen, camera: seen, *, sun: float = 0.0) -> Material:
    """Images of a teacher whose colours and folds depend on the pose; `change` is done to those of each camera.

    By `sun`, of 1, what faces +X is brighter and what faces -X darker.
    """
    truth = teacher()
    with torch.no_grad():
        truth.mean.copy_(looks_of_pictures(truth))
        truth.light.gains[0] = sun
    seen = {}
    for frame in range(FRAMES):
        window = motion()[2 * frame]
        with torch.no_grad():
            shown = truth(window)
            folds = shown.texture.clone()
            folds[:, 0:3] += 0.05 * (frame - 1) * torch.sin(torch.arange(len(folds)) / 9)[:, None]
            splats = truth.splats(shown._replace(texture=folds), window.joints[0])
            box = torch.stack([splats.centres.amin(dim=0), splats.centres.amax(dim=0)]).numpy()
            for camera in range(CAMERAS):
                eye = Eye.of(orbit(box, screen=SCREEN, azimuth=2.0 * camera), window.root)
                image = draw(splats, eye)
                mask = image[..., 3]
                colours = image[..., :3] / mask[..., None].clamp(min=1e-6)
                seen[frame, camera] = change(Seen(colours, mask, eye), camera)
    return Material(
        Views(FRAMES, CAMERAS, lambda frame, camera: seen[frame, camera]),
        [motion()[2 * frame] for frame in range(FRAMES)],
    )


def run_in(
    directory: Path, report: Callable[[Progress], None] = lambda _: None, *, processes: Processes = ALONE
) -> Run:
    checkpoints = Checkpoints(directory, "key", processes)
    generator = torch.Generator().manual_seed(SETTINGS.seed)
    return Run(generator, checkpoints, report, torch.device("cpu"), processes)


def taught(
    directory: Path,
    report: Callable[[Progress], None] = lambda _: None,
    *,
    settings: TeacherSettings = SETTINGS,
    shown: Material | None = None,
    processes: Processes = ALONE,
) -> Lesson:
    """A lesson after its training."""
    shown = material() if shown is None else shown
    lesson = Lesson(teacher(settings), shown, settings)
    train_teacher(lesson, shown, settings, run=run_in(directory, report, processes=processes))
    return lesson


def errors(lesson: Lesson, shown: Material, *, moving: bool = True) -> float:
    """The mean square error of all images."""
    squares = []
    with torch.no_grad():
        for frame in range(FRAMES):
            window = lesson.window(frame)
            splats = lesson.teacher.splats(lesson.teacher(window, moving=moving), window.joints[0])
            for camera in range(CAMERAS):
                seen = shown.views.see(frame, camera)
                image = draw(splats, seen.eye)
                squares.append((image[..., :3] + 1 - image[..., 3:] - seen.over(torch.ones(3))).square().mean())
    return float(torch.stack(squares).mean())
