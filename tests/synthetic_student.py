"""A small student and training frames for tests: smooth low-rank textures that depend nonlinearly on a descriptor."""

from dataclasses import replace
from pathlib import Path

import torch
from torch import Tensor

from mua.channels import ATTRIBUTES, CHANNELS
from mua.checkpoint import Checkpoints
from mua.pose.components import principal_components
from mua.pose.descriptor import groups_of, normalization, units_of
from mua.pose.encoding import PoseEncoding
from mua.processes import ALONE, Processes
from mua.student.model import Student
from mua.student.optimise import Progress, Report, Run
from mua.student.settings import Ranks, Schedule, Settings
from mua.student.train import Samples, train
from mua.wavelets import Bands

SIZE = 48  # LL 3 x 3
ENCODING = PoseEncoding(joints=(), rate=30.0, window=1)
WIDTH = ENCODING.width
INPUTS = 7  # components that the MLPs read
VERTICES = 7
FRAMES = 60
SPREAD = {"offset": 0.01, "rotation": 0.1, "scale": 0.2, "opacity": 1.0, "SH": 0.3}

SETTINGS = Settings(
    texels=SIZE,
    frames=FRAMES,
    geometry=Ranks(6, 5, 4),
    appearance=Ranks(5, 4, 3),
    components=4,
    hidden=32,
    sweeps=4,
    regression=Schedule(steps=150, batch=64, lr=5e-3),
    finetune=Schedule(steps=20, batch=16, lr=3e-4),
)


def quick(settings: Settings = SETTINGS) -> Settings:
    """The same sizes, trained for a few steps only."""
    return replace(
        settings, regression=replace(settings.regression, steps=6), finetune=replace(settings.finetune, steps=4)
    )


def new_student(settings: Settings = SETTINGS, *, inputs: int = INPUTS) -> Student:
    return Student(
        settings, encoding=ENCODING, inputs=inputs, vertices=VERTICES, texels=valid_texels(), wavelet="bior4.4"
    )


def random_student(seed: int = 0) -> Student:
    """A student whose every parameter and buffer but the texels is random."""
    student = new_student()
    generator = torch.Generator().manual_seed(seed)
    with torch.no_grad():
        for tensor in student.state_dict().values():
            if tensor.is_floating_point():
                tensor.normal_(0, 0.3, generator=generator)
        student.scale.abs_().add_(0.5)
        student.ranges.copy_(student.ranges.sort(dim=0).values)
        student.margins.abs_()
    return student.requires_grad_(False)


def valid_texels() -> Tensor:
    return torch.arange(5, SIZE * SIZE, 3)


def bands_of_frames(frames: int = FRAMES, *, rank: int = 4, seed: int = 0) -> tuple[Tensor, Bands]:
    """Descriptors [F, D] and subbands of all 23 channels, `rank` hidden factors driving all of them."""
    generator = torch.Generator().manual_seed(seed)
    descriptors = torch.randn(frames, WIDTH, generator=generator)
    hidden = torch.tanh(descriptors @ torch.randn(WIDTH, rank, generator=generator) / 3)
    unit = torch.empty(CHANNELS)
    for name, channels in ATTRIBUTES.items():
        unit[channels] = SPREAD[name]
    n = SIZE // 16

    def field(*shape: int) -> Tensor:
        drawn = torch.randn(rank, *shape, generator=generator).cumsum(-1).cumsum(-2) / shape[-1]
        return torch.tensordot(hidden, drawn, dims=1) * unit[:, None, None]

    return descriptors, Bands(4 * field(CHANNELS, n, n), field(3, CHANNELS, n, n), field(3, CHANNELS, 2 * n, 2 * n))


def samples(frames: int = FRAMES) -> Samples:
    descriptors, bands = bands_of_frames(frames)
    shift = torch.arange(VERTICES * 3).reshape(VERTICES, 3) / 100
    meshes = shift * (1 + 0.1 * torch.tanh(descriptors[:, :1, None]))
    mean_texture = torch.linspace(-1, 1, len(valid_texels()))[:, None].expand(-1, CHANNELS)
    return Samples(
        descriptors,
        meshes,
        lambda channels, rows: Bands(*(band[rows] for band in bands.of(channels))),
        mean_texture,
    )


def student_of(data: Samples, settings: Settings = SETTINGS) -> Student:
    """A student that is not trained yet, with the components of the samples' descriptors."""
    descriptors, units = data.descriptors.double().numpy(), units_of(ENCODING, 1.0)
    components = principal_components(descriptors, normalization(descriptors, units), units, groups_of(ENCODING))
    student = new_student(settings, inputs=len(components.margins))
    student.set_components(components)
    return student


def train_in(
    directory: Path,
    settings: Settings = SETTINGS,
    report: Report = lambda _: None,
    *,
    data: Samples | None = None,
    processes: Processes = ALONE,
) -> Student:
    """A student of `samples`, or of other data, trained with checkpoints in a directory."""
    data = data or samples()
    student = student_of(data, settings)
    cpu, checkpoints = torch.device("cpu"), Checkpoints(directory, "key")
    train(student, data, settings=settings, checkpoints=checkpoints, device=cpu, report=report, processes=processes)
    return student


def same(a: Student, b: Student) -> bool:
    """Whether two students are the same to the byte."""
    return all(torch.equal(x, y) for x, y in zip(a.state_dict().values(), b.state_dict().values(), strict=True))


class Killed(Exception):
    """Stands for a kill at one moment of a run."""


def kill_at(stage: str, step: int) -> Report:
    def report(progress: Progress) -> None:
        if (progress.stage, progress.step) == (stage, step):
            raise Killed

    return report


def run_in(directory: Path, report: list[Progress] | None = None) -> Run:
    """A run with its own generator; `report` collects its progress."""
    progress = report.append if report is not None else lambda _: None
    return Run(torch.Generator().manual_seed(0), Checkpoints(directory, "test"), progress, torch.device("cpu"))
