"""The settings of a training, and three presets: from minutes on a laptop to the paper's texels and frames."""

from dataclasses import dataclass, replace
from typing import Literal, get_args

from mua.errors import InputError
from mua.training.schedule import Schedule

StageName = Literal["coarse", "bases", "regression", "fine-tuning"]
STAGES: tuple[StageName, ...] = get_args(StageName)


@dataclass(frozen=True)
class Ranks:
    """Blendshapes per channel of the three dynamic levels (paper, Methodology)."""

    ll: int
    d3: int
    d2: int

    @property
    def total(self) -> int:
        return self.ll + self.d3 + self.d2


@dataclass(frozen=True)
class Sizes:
    """What a student's parameters and operations follow from, beside its texels."""

    geometry: Ranks
    appearance: Ranks
    components: int  # PCA components of the coarse mesh
    hidden: int  # width of the two hidden layers of every MLP


@dataclass(frozen=True)
class Generalisation:
    """Options that improve unseen motion, measured in docs/research/unseen_motion.md."""

    fade: float = 0.6  # factor of a joint's weight in a body part's texels per joint between them; 1: all equal
    noise: float = 0.3  # noise of the regression's points around frames, in spreads of each direction
    exchanged: float = 0.5  # share of those points where a body part is as in another frame
    exchanged_noise: float = 1.0  # noise of these
    outside: float = 0.2  # share of all points that lie outside of training, where the function fades to the mean
    weight_decay: float = 1e-3  # weight decay of the MLPs
    remove_heading: bool = True  # whether descriptors are turned back by the heading
    own: bool = True  # whether frames show motion that will be played; else all weigh as little as the range of motion


@dataclass(frozen=True)
class Budget:
    """The most that an avatar may cost; without numbers the settings' own sizes hold."""

    mflop: float | None = None  # million operations of a frame, as mua-inspect counts them
    mb: float | None = None  # megabytes of the file without its clips

    def __bool__(self) -> bool:
        return self.mflop is not None or self.mb is not None


@dataclass(frozen=True)
class Settings:
    """Sizes and schedules of one distillation."""

    texels: int  # H = W of the Gaussian texture
    frames: int  # number of training frames to record
    geometry: Ranks
    appearance: Ranks
    components: int  # PCA components of the coarse mesh
    hidden: int  # width of the two hidden layers of every MLP
    sweeps: int  # rounds of alternating least squares
    regression: Schedule
    finetune: Schedule
    pictures: int = 0  # images by which fine-tuning's weights are measured; 0: it minimises the paper's loss
    generalisation: Generalisation = Generalisation()
    seed: int = 0
    start: Literal["closed form", "random"] = "closed form"
    budget: Budget = Budget()  # by which ranks, components and width are chosen anew (`mua.student.budget`)


PAPER_SIZES = Sizes(Ranks(192, 128, 96), Ranks(128, 128, 96), components=128, hidden=384)  # its hidden layers: ours
# Draws as well as PAPER_SIZES with bior4.4, for half the operations and parameters (docs/research/ranks.md).
LEAN_SIZES = Sizes(Ranks(24, 96, 16), Ranks(64, 256, 64), components=72, hidden=192)

PRESETS = {
    "tiny": Settings(
        texels=192,
        frames=240,
        geometry=Ranks(24, 96, 80),
        appearance=Ranks(24, 96, 80),
        components=24,
        hidden=128,
        sweeps=10,
        regression=Schedule(steps=4000, batch=256, lr=3e-3, epochs=2000),
        finetune=Schedule(steps=2000, batch=12, lr=5e-4, warm_up=0.1, epochs=72),
        pictures=12,
    ),
    "preview": Settings(
        texels=384,
        frames=1500,
        **vars(LEAN_SIZES),
        sweeps=10,
        regression=Schedule(steps=4000, batch=384, lr=2e-3, epochs=3000),
        finetune=Schedule(steps=1500, batch=16, lr=5e-4, warm_up=0.1, epochs=72),
        pictures=32,
    ),
    "paper": Settings(
        texels=768,
        frames=17000,
        **vars(LEAN_SIZES),
        sweeps=20,
        regression=Schedule(steps=20000, batch=512, lr=2e-3, epochs=3000),
        finetune=Schedule(steps=5000, batch=64, lr=5e-4, warm_up=0.1, epochs=20),
        pictures=64,
    ),
}


def preset(name: str) -> Settings:
    """The settings called `name`; raises InputError where there are none."""
    if name not in PRESETS:
        raise InputError(f"preset: {name!r} is unknown, expected one of {', '.join(PRESETS)}")
    return PRESETS[name]


RECIPES = ("closed-form", "paper")


def with_recipe(settings: Settings, name: str) -> Settings:
    """The settings with another recipe; "paper" is the paper's own: a random start, then Adam for a million steps.

    Raises InputError for a recipe that is not in RECIPES. Source: paper, Implementation Details.
    """
    if name not in RECIPES:
        raise InputError(f"recipe: {name!r} is unknown, expected one of {', '.join(RECIPES)}")
    if name != "paper":
        return settings
    return replace(
        settings,
        start="random",
        regression=Schedule(steps=2_000_000, batch=8, lr=1e-4, cosine=False),
        finetune=Schedule(steps=1_000_000, batch=1, lr=1e-4, cosine=False),
    )
