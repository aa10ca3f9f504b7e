"""The settings of a comparison: the options of mua-eval. Needs no torch, so that the command can offer them at once."""

from collections.abc import Sequence
from dataclasses import KW_ONLY, dataclass
from pathlib import Path
from typing import Annotated

from mua.option import Option
from mua.student.settings import PRESETS

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
class EvaluationSettings:
    """What is compared with what, and how."""

    recording: Annotated[Path, Option("Folder of a recording or a capture.", metavar="RECORDING")]
    avatars: Annotated[Sequence[Path], Option("Avatar files trained on it.", metavar="AVATARS")] = ()
    _: KW_ONLY
    teacher: Annotated[
        Path | None, Option("Folder that mua-teach wrote, where RECORDING is a capture.", default="none")
    ] = None
    train_on: Annotated[
        Path | None,
        Option(
            "Recording of the teacher to train systems on, as mua-bake leaves it in its --work folder.",
            default="made of the capture's own poses",
        ),
    ] = None
    system: Annotated[
        Sequence[str], Option("System to train and compare; may be repeated", choices=(ALL, *SYSTEM_NAMES))
    ] = ()
    scale: Annotated[
        Sequence[float],
        Option(
            "Size of the systems relative to the preset's, where RECORDING is a capture; may be repeated, for a "
            "curve of quality against cost.",
            default="1",
            least=0.01,
            most=100,
        ),
    ] = ()
    seconds: Annotated[float, Option("Training time of each system, in seconds.", least=0)] = 60.0
    steps: Annotated[
        int | None,
        Option("Training steps of each system, instead of --seconds; makes the result reproducible.", least=1),
    ] = None
    preset: Annotated[str, Option("Preset that sets the sizes of the systems.", choices=tuple(PRESETS))] = "preview"
    frames: Annotated[
        int | None,
        Option("Number of training frames, and of held-out frames, to compare.", default="all whole frames", least=1),
    ] = None
    views: Annotated[int, Option("Number of cameras around the figure.", least=1, most=16)] = 2
    size: Annotated[
        int,
        Option(
            "Width and height of the rendered images, in pixels.",
            least=176,  # MS-SSIM halves an image four times and then needs 11 pixels
            most=8192,
            unit="pixels",
        ),
    ] = 512
    own_mesh: Annotated[bool, Option("Also draw each avatar file on its own predicted mesh.")] = False
    lpips_weights: Annotated[Path | None, Option("Weights of torchvision's AlexNet or VGG16, to measure LPIPS.")] = None
    seed: Annotated[int, Option("Seed of all random numbers.", least=0)] = 0
    device: Annotated[str | None, Option("Graphics device: its number or part of its name.")] = None
    output: Annotated[Path, Option("Folder to write to.", short="-o")] = Path("evaluation")
    images: Annotated[
        Path | None,
        Option(
            "Folder to write every image that was measured to: the captured one, the teacher's and the avatars', "
            "as clip/camera/frame_name.png; where RECORDING is a capture.",
            default="none",
        ),
    ] = None
