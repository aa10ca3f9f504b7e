"""Every system of the paper's tables that can be built from its description, by the name that a table calls it."""

from collections.abc import Callable
from functools import partial

import torch

from mua_research.bands import blendshapes_conv1d, conv_blendshapes, conv_conv, ours
from mua_research.full import LinearMap, SingleLevel, full_blendshapes, pca_only
from mua_research.network import Network, NetworkSystem
from mua_research.system import Sizes, Training

NETWORKS: dict[str, Callable[[Sizes], Network]] = {
    "pca-only": pca_only,
    "single-level": SingleLevel,
    "2d-conv+2d-conv": conv_conv,
    "2d-conv+blendshapes": conv_blendshapes,
    "blendshapes+1d-conv": blendshapes_conv1d,
    "full-blendshapes": full_blendshapes,
    "linear": LinearMap,
    "ours": ours,
}

SYSTEMS = {name: partial(NetworkSystem, name, build=build) for name, build in NETWORKS.items()}


def train_or_restore(system: NetworkSystem, training: Training, name: str) -> None:
    """Train a system, or take up what an earlier run made of it, under its name."""
    stage, frames = f"system {name}", training.frames
    kept = training.checkpoints.load(stage)
    if kept is not None:
        system.restore(kept, frames)
        return
    generator = torch.Generator().manual_seed(frames.sizes.settings.seed)
    system.fit(frames, training.budget, generator, training.report)
    training.checkpoints.save(stage, system.state())
