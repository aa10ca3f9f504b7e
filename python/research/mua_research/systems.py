"""Every system of the paper's tables that can be built from its description, by the name that a table calls it."""

from collections.abc import Callable
from functools import partial

import torch

from mua.training.checkpoint import Checkpoints
from mua.training.optimise import Report
from mua_research.bands import blendshapes_conv1d, conv_blendshapes, conv_conv, ours
from mua_research.full import LinearMap, SingleLevel, full_blendshapes, pca_only
from mua_research.network import Network, NetworkSystem
from mua_research.system import Budget, Sizes, TrainingFrames

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


def train_or_restore(
    system: NetworkSystem,
    frames: TrainingFrames,
    *,
    stage: str,  # under which it is kept
    budget: Budget,
    checkpoints: Checkpoints,  # of this recording, these settings and this budget
    report: Report,
) -> None:
    """Train a system, or take up what an earlier run made of it."""
    kept = checkpoints.load(stage)
    if kept is not None:
        system.restore(kept, frames)
        return
    system.fit(frames, budget, torch.Generator().manual_seed(frames.sizes.settings.seed), report)
    checkpoints.save(stage, system.state())
