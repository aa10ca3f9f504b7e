"""What all compared networks share: weighted deviations from the training mean, counts, training.

A network predicts deviations from the mean of the training frames in units in which every attribute counts alike
(`mua.student.targets.channel_weights`); the mean texture is among its parameters.
"""

import time
from abc import abstractmethod
from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import torch
from torch import Tensor, nn

from mua.channels import CHANNELS
from mua.rig.bones import figure_scale
from mua.student.conditioned import fold
from mua.student.finetune import BASIS_RATE
from mua.student.model import Coarse, linear_layers
from mua.student.settings import Generalisation
from mua.training.checkpoint import Checkpoints
from mua.training.optimise import Report, Run
from mua_research.optimise import Groups, optimise
from mua_research.system import Budget, Motion, Sizes, TrainingFrames, coarse_flops, coarse_parameters

FRAMES_AT_ONCE = 16


class Network(nn.Module):
    """A texture model; buffers are what training data gives, parameters what is trained."""

    mean_texture: Tensor
    weights: Tensor
    texels: Tensor

    def __init__(self, sizes: Sizes) -> None:
        super().__init__()
        self.sizes = sizes
        self.size, self.inputs = sizes.settings.texels, sizes.inputs
        self.register_buffer("texels", sizes.texels.long())
        self.register_buffer("mean_texture", torch.zeros(len(sizes.texels), CHANNELS))
        self.register_buffer("weights", torch.ones(CHANNELS))

    def attach(self, frames: TrainingFrames, device: torch.device) -> None:
        """Take over what the training frames give without learning."""
        self.mean_texture.copy_(frames.mean_texture)
        self.weights.copy_(frames.weights)
        self.to(device)

    @abstractmethod
    def start(self, frames: TrainingFrames, *, rate: float, run: Run) -> Groups:
        """Give the parameters their start; returns them in groups with the rates that they are descended at."""

    @abstractmethod
    def loss(self, frames: TrainingFrames, rows: Tensor) -> Tensor:
        """The L1 loss of a batch."""

    @abstractmethod
    def deviations(self, motion: Motion) -> Tensor:
        """Weighted deviations [F, 23, N] from the mean texture at the valid texels."""

    @abstractmethod
    def flops(self) -> int:
        """Of one frame, a multiply-add as two, without the coarse mesh."""

    def parameter_count(self) -> int:
        """Parameters and the mean, without the coarse mesh."""
        return sum(parameter.numel() for parameter in self.parameters()) + self.mean_texture.numel()


class NetworkSystem:
    """A `Network` as a compared system."""

    def __init__(self, name: str, sizes: Sizes, build: Callable[[Sizes], Network]) -> None:
        self.name = name
        self._sizes, self._build = sizes, build
        self._network: Network | None = None
        self.steps = 0  # of Adam that the budget allowed
        self.seconds = 0.0  # that training took
        with torch.device("meta"):
            network = build(sizes)
            coarse = Coarse(
                sizes.vertices, sizes.settings.components, inputs=sizes.inputs, hidden=sizes.settings.hidden
            )
        self.parameters = network.parameter_count() + coarse_parameters(coarse)
        self.flops = network.flops() + coarse_flops(coarse)

    @property
    def network(self) -> Network:
        """The trained network."""
        assert self._network is not None, f"{self.name} is not trained"
        return self._network

    def fit(self, frames: TrainingFrames, budget: Budget, generator: torch.Generator, report: Report) -> None:
        """Train a new network; the closed-form start, where the system has one, counts towards the seconds."""
        started = time.monotonic()
        network = self._build(self._sizes)
        network.attach(frames, frames.device)

        def hear(progress: Any) -> None:
            report(replace(progress, stage=f"{self.name}: {progress.stage}"))

        size = figure_scale(frames.rig.mesh.vertices)
        run = Run(generator, Forgetful(Path(), ""), hear, frames.device, size=size)
        groups = network.start(frames, rate=budget.rate, run=run)
        self.steps = optimise(
            lambda rows: network.loss(frames, rows),
            groups,
            frames=len(frames),
            budget=budget,
            started=started,
            stage="Adam",
            generator=generator,
            report=hear,
        )
        fold(network)
        self._network, self.seconds = network.eval(), time.monotonic() - started

    def state(self) -> dict[str, Any]:
        """The trained parameters, for a file."""
        trained = {name: tensor.cpu() for name, tensor in self.network.state_dict().items()}
        return {"network": trained, "steps": self.steps, "seconds": self.seconds}

    def restore(self, state: dict[str, Any], frames: TrainingFrames) -> None:
        """Take up what was trained on the same frames before."""
        network = self._build(self._sizes)
        network.attach(frames, frames.device)  # the convolutions' maps need the rig
        network.load_state_dict(state["network"])
        self._network, self.steps, self.seconds = network.eval(), state["steps"], state["seconds"]

    @torch.no_grad()
    def textures(self, motion: Motion) -> Tensor:
        """Raw channels [F, N, 23] at the valid texels."""
        network = self.network
        device = network.mean_texture.device
        parts = []
        for rows in torch.arange(len(motion)).split(FRAMES_AT_ONCE):
            moved = network.deviations(motion.of(rows).to(device)) / network.weights[:, None]
            parts.append((network.mean_texture + moved.transpose(1, 2)).cpu())
        return torch.cat(parts) if parts else torch.zeros(0, *network.mean_texture.shape)


class Forgetful(Checkpoints):
    """Keeps nothing: a comparison is short, and what is interrupted is run again."""

    def save(self, stage: str, state: dict[str, Any]) -> None:
        pass

    def load(self, stage: str) -> dict[str, Any] | None:
        return None


def parameter_groups(
    mlps: Sequence[nn.Module],
    bases: Sequence[nn.Parameter],
    *,
    rate: float,
    basis_rate: float = BASIS_RATE,
) -> Groups:
    """Networks that decay and bases that do not, the latter at `basis_rate` times the rate."""
    return [
        {
            "params": [p for mlp in mlps for p in mlp.parameters()],
            "lr": rate,
            "weight_decay": Generalisation.weight_decay,
        },
        {"params": list(bases), "lr": basis_rate * rate},
    ]


def mlp_flops(mlp: nn.Module) -> int:
    return 2 * sum(layer.weight.numel() for layer in linear_layers(mlp))
