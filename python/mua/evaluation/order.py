"""What a user may ask a comparison for; needs no torch, so that a command can offer it at once."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

ALL, OURS = "all", "ours"
SYSTEM_NAMES = (
    "pca-only",
    "single-level",
    "2d-conv+2d-conv",
    "2d-conv+blendshapes",
    "blendshapes+1d-conv",
    "full-blendshapes",
    "linear",
    OURS,
)


@dataclass(frozen=True)
class EvaluationOrder:
    """What a user asks to have compared; the fields are the options of mua-eval."""

    recording: Path
    avatars: Sequence[Path] = ()
    teacher: Path | None = None  # folder that mua-teach wrote, where the recording is a capture
    train_on: Path | None = None  # recording of that teacher; None: it is recorded on the capture's own poses
    system: Sequence[str] = ()  # those of the paper's tables, or all
    scale: Sequence[float] = ()  # of the systems, where the recording is a capture; none: that of the preset alone
    seconds: float = 60.0  # of training of each system, unless there are steps
    steps: int | None = None
    preset: str = "preview"  # whose sizes the systems have
    frames: int | None = None  # of each kind; None: all that are kept whole
    views: int = 2
    size: int = 512  # pixels along a side
    own_mesh: bool = False
    lpips_weights: Path | None = None
    seed: int = 0
    device: str | None = None
    output: Path = Path("evaluation")
    images: Path | None = None  # folder for the images that were measured, where the recording is a capture
