"""Training clips that a measurement leaves out to measure errors on, so that the held-out clips stay unseen."""

from dataclasses import replace

import torch
import typer
from torch import Tensor

from mua.recording import Recording
from mua.student.stages import Samples


def left_out(
    recording: Recording,
    leave: list[str],  # names of training clips
) -> Tensor:
    """Training frames [F], bool, of the clips that are left out."""
    training = {clip.name: len(clip.recorded) for clip in recording.clips if not clip.held_out}
    for name in leave:
        if name not in training:
            raise typer.BadParameter(f"--leave: {name!r} is no training clip, expected some of {', '.join(training)}")
    return torch.tensor([name in leave for name, frames in training.items() for _ in range(frames)])


def some(
    samples: Samples,
    rows: Tensor,  # indices of frames
) -> Samples:
    """Some of the frames; the mean texture stays that of all."""
    return replace(
        samples,
        descriptors=samples.descriptors[rows],
        meshes=samples.meshes[rows],
        subbands=lambda channels, few: samples.subbands(channels, rows[few]),
    )
