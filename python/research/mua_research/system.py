"""What a compared system is: trained on a recording within a budget, it gives textures, and says what it costs.

All systems share the coarse mesh of our student, so that what they draw differs by the texture alone. The systems
themselves are listed in `mua_research.systems`.
"""

from collections.abc import Callable
from dataclasses import dataclass

import torch
from torch import Tensor

from mua.channels import CHANNELS
from mua.pose.encoding import PoseEncoding
from mua.rig.rig import Rig
from mua.student.components import Components
from mua.student.local import Parts
from mua.student.model import Coarse, Student, lowpass_texels
from mua.student.settings import Ranks, Settings
from mua.training.checkpoint import Checkpoints
from mua.training.optimise import Report
from mua.wavelets import Bands

ALL = slice(0, CHANNELS)


@dataclass(frozen=True, eq=False)
class Sizes:
    """What the shape of every system follows from."""

    settings: Settings  # of our student; the other systems are scaled with it
    encoding: PoseEncoding
    inputs: int  # components of the descriptor that every MLP reads
    vertices: int
    texels: Tensor  # [N] the valid texels as row * size + col
    wavelet: str
    scale: float = 1.0  # of what a texture is made of: ranks, components, cells and widths of convolutions

    def times(self, count: float, power: float = 1.0) -> int:
        """So many at the scale, at least one; what parameters grow with the square of takes half the power."""
        return max(round(count * self.scale**power), 1)

    def ranks(self, own: Ranks) -> Ranks:
        """Ranks at the scale."""
        return Ranks(self.times(own.ll), self.times(own.d3), self.times(own.d2))


@dataclass(frozen=True)
class Budget:
    """How long each system may learn, everything included; a budget in steps gives the same bytes each time."""

    seconds: float | None = None
    steps: int | None = None  # of Adam
    batch: int = 16  # frames per step
    rate: float = 1e-3  # of Adam, for what starts from noise; a closed-form start is descended from more slowly


@dataclass(frozen=True, eq=False)
class Motion:
    """F frames as the systems see them."""

    descriptors: Tensor  # [F, D] normalised
    inputs: Tensor  # [F, K] their components, which every MLP reads
    canonical: Tensor  # [F, V, 3] the coarse mesh before posing, metres
    posed: Tensor  # [F, V, 3] posed, relative to the root joint and its heading, metres

    def __len__(self) -> int:
        return len(self.descriptors)

    def of(self, rows: Tensor) -> "Motion":
        """Some of the frames."""
        return Motion(self.descriptors[rows], self.inputs[rows], self.canonical[rows], self.posed[rows])

    def to(self, device: torch.device) -> "Motion":
        parts = (self.descriptors, self.inputs, self.canonical, self.posed)
        return Motion(*(part.to(device) for part in parts))


@dataclass(frozen=True, eq=False)
class TrainingFrames:
    """The training frames of a recording (`mua_research.motion.training_frames`)."""

    rig: Rig
    sizes: Sizes
    student: Student  # its normalisation set and its coarse mesh trained; the textures of all systems lie on that mesh
    motion: Motion
    bands: Callable[[slice, Tensor], Bands]  # absolute subbands of channels and rows
    mean: Bands  # [1, ...] of the training frames
    mean_texture: Tensor  # [N, 23] of the training frames
    weights: Tensor  # [23] of the channels in every system's loss (`mua.student.targets.channel_weights`)
    parts: Parts | None  # of the body, where our student's coefficients are local
    device: torch.device  # that systems are trained on; what is above stays on the CPU

    def __len__(self) -> int:
        return len(self.motion)

    def components(self, device: torch.device) -> Components:
        """Of the descriptors, on a device."""
        own = self.student.components
        return Components(*(part.to(device) for part in (own.directions, own.ranges, own.margins)))

    def band_deviations(self, rows: Tensor, channels: slice = ALL) -> Bands:
        """Weighted deviations of the subbands of some channels and frames from their mean."""
        weights = self.weights[channels, None, None]
        pairs = zip(self.bands(channels, rows), self.mean.of(channels), strict=True)
        return Bands(*(weights * (band - mean) for band, mean in pairs))

    def deviations(self, rows: Tensor, channels: slice = ALL) -> Tensor:
        """Weighted deviations [F, C, N] of the recorded textures from their mean at the valid texels.

        A recorded texture is what its subbands hold; the two finest levels stay at their mean.
        """
        return lowpass_texels(self.band_deviations(rows, channels), self.sizes.wavelet, self.sizes.texels)

    def textures(self, rows: Tensor) -> Tensor:
        """The recorded textures [F, N, 23] in raw channels."""
        return self.mean_texture + (self.deviations(rows) / self.weights[:, None]).transpose(1, 2)


@dataclass(frozen=True, eq=False)
class Training:
    """What every system of a comparison is trained with."""

    frames: TrainingFrames
    budget: Budget
    checkpoints: Checkpoints  # of this recording, these settings and this budget
    report: Report


def coarse_parameters(coarse: Coarse) -> int:
    """Learnt numbers of the mesh that all systems share."""
    return sum(tensor.numel() for tensor in coarse.state_dict().values())


def coarse_flops(coarse: Coarse) -> int:
    """Operations of the mesh that all systems share: F_temp, then the basis."""
    weights = sum(tensor.numel() for tensor in coarse.mlp.parameters() if tensor.dim() > 1)
    return 2 * (weights + coarse.basis.numel())
