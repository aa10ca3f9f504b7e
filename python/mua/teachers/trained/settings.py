"""The sizes and schedules of a teacher's training, and presets: from a laptop to the sizes of the paper's teacher."""

from dataclasses import dataclass, field
from typing import Literal

from mua.errors import InputError
from mua.training.schedule import Schedule

Rasteriser = Literal["mua", "gsplat"]


@dataclass(frozen=True)
class LossWeights:
    """The weight of each term of the loss; L1 and SSIM as in ASH (Pang et al. 2024, https://arxiv.org/abs/2312.05941)."""

    l1: float = 0.9
    ssim: float = 0.1
    alpha: float = 0.1  # L1 of opacity against the mask
    perceptual: float = 0.1  # LPIPS, where its weights are given
    tracks: float = 0.02  # squared distance of tracked points in centimetres on a person, where there are tracks
    residual: float = 1e-3  # square of what the networks add to the geometry, in `texels.UNITS`
    smooth: float = 3e-3  # squared difference between neighbouring texels of what is added to the surfels' colours
    beside: float = 1e-2  # square of frames' codes
    refinement: float = 1e-3  # squared corrections of a frame's pose
    correction: float = 0.1  # squared difference of a camera's colours from the others'


@dataclass(frozen=True)
class TeacherSettings:
    """Sizes and schedules of one teacher."""

    texels: int  # H = W of the texture
    channels: int  # at the first level of each UNet; every level below has twice as many, up to eight times
    levels: int  # levels of each UNet
    rows: int  # largest height of a whole image, pixels
    mean: Schedule  # for the mean texture
    texture: Schedule  # for the networks
    window: int = 3  # k, the poses that a frame depends on
    code: int = 0  # values of a frame's look, for one pose that looks several ways; 0: looks differ by pose alone
    refine: float = 0.0  # degrees by which a joint of a frame may be turned to fit the images
    colour_correction: bool = True  # whether cameras may differ in colour
    drivable: bool | None = None  # whether motion deforms the template; None: where the capture has meshes
    weights: LossWeights = field(default_factory=LossWeights)
    rasteriser: Rasteriser = "mua"  # what draws the images in training
    seed: int = 0


# The batch of a schedule is a number of views: cameras of one frame.
PRESETS = {
    "tiny": TeacherSettings(
        texels=128,
        channels=12,
        levels=4,
        rows=256,
        mean=Schedule(steps=150, batch=2, lr=2e-2),
        texture=Schedule(steps=3000, batch=2, lr=1e-3, warm_up=0.02),
    ),
    "small": TeacherSettings(
        texels=256,
        channels=24,
        levels=5,
        rows=512,
        mean=Schedule(steps=300, batch=2, lr=2e-2),
        texture=Schedule(steps=20_000, batch=2, lr=1e-3, warm_up=0.01),
    ),
    "paper": TeacherSettings(
        texels=768,
        channels=64,
        levels=6,
        rows=2048,
        mean=Schedule(steps=1000, batch=4, lr=2e-2),
        texture=Schedule(steps=400_000, batch=4, lr=2e-4, warm_up=0.005),
    ),
}


def teacher_preset(name: str) -> TeacherSettings:
    """The settings called `name`; raises InputError where there are none."""
    if name not in PRESETS:
        raise InputError(f"preset: {name!r} is unknown, expected one of {', '.join(PRESETS)}")
    return PRESETS[name]
