"""The systems of the paper's tables as rows of a comparison with a recording."""

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import numpy as np
import torch

from mua.arrays import Array
from mua.cli.display import Display
from mua.evaluation.cost import learnt_cost
from mua.evaluation.entries import Entry, Picture, sentence
from mua.evaluation.settings import ALL, EvaluationSettings
from mua.recording import Recording, WholeFrame
from mua.student.settings import preset
from mua_research.motion import motion_of
from mua_research.network import NetworkSystem
from mua_research.system import Training, TrainingFrames
from mua_research.systems import SYSTEMS, train_or_restore
from mua_research.training import prepare


def system_entries(
    evaluation: EvaluationSettings, recording: Recording, work: Path, display: Display
) -> Iterator[Entry]:
    """Train the systems of a comparison one after the other; take from the work directory those that it holds."""
    settings = replace(preset(evaluation.preset), texels=recording.rig.texels.size, seed=evaluation.seed)
    training = prepare(evaluation, recording, settings, work, display)
    for name in SYSTEMS if ALL in evaluation.system else dict.fromkeys(evaluation.system):
        display.stage(name)
        entry = system_entry(name, recording, training)
        if entry.failure:
            display.note(f"{name}: {entry.failure}")
        yield entry


def system_entry(name: str, recording: Recording, training: Training) -> Entry:
    """Train the system called `name`, or take up what an earlier run made of it; one that fails becomes a sentence."""
    try:
        system = SYSTEMS[name](training.frames.sizes)
        train_or_restore(system, training, name)
    except Exception as error:  # whatever one system stumbles over, the others go on
        return Entry(name, None, failure=sentence(error))
    cost = learnt_cost(system.parameters, system.flops)
    return Entry(name, lambda frame: Picture(system_texture(system, recording, training.frames, frame)), cost)


def system_texture(system: NetworkSystem, recording: Recording, frames: TrainingFrames, frame: WholeFrame) -> Array:
    """A trained system's texture [N, 23] of a frame."""
    motion = motion_of(frame.clip, np.array([frame.index]), rig=recording.rig, student=frames.student)
    with torch.no_grad():
        return np.asarray(system.textures(motion)[0].cpu().numpy())
