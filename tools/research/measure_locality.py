"""How well texels are predicted by the joints near them, on clips left out: the kernel alone, before any MLP.

    python tools/research/measure_locality.py RECORDING --leave 01_06 --leave 01_12 --leave 02_06

Training clips are left out, so that the recording's own held-out clips stay unseen. *fade f* multiplies a descriptor's
entries by f for each joint between them and the body part; *only n joints* cuts off what lies more than n joints away.
The figures are the shares of the left-out frames' variance about the mean that the function of the remaining frames
explains, in subband samples (every STRIDE-th) weighted as the loss weighs them.
"""

from dataclasses import replace
from pathlib import Path
from typing import Annotated

import torch
import typer
from left_out import left_out
from torch import Tensor

import mua.cli  # noqa: F401 first of all: it sets how torch's threads wait
from mua.channels import APPEARANCE, ATTRIBUTES, CHANNELS, COARSE_TEXELS, GEOMETRY
from mua.recording import Recording
from mua.student.distil import prepare
from mua.student.local import Parts
from mua.student.regress import whitening
from mua.student.settings import preset
from mua.student.smoother import fit_smoother
from mua.student.targets import channel_weights
from mua.wavelets import Bands

STRIDE = 16  # every n-th sample
FADES = (1.0, 0.8, 0.7, 0.6, 0.5, 0.3)
CUTS = (1, 2, 3)


def main(
    recording: Annotated[Path, typer.Argument(help="Recording with several training clips.")],
    leave: Annotated[list[str], typer.Option(help="Training clip to leave out, may be repeated.")],
    remove_heading: Annotated[bool, typer.Option(help="Remove the heading from the descriptor.")] = True,
) -> None:
    """Print a Markdown table of explained shares."""
    opened = Recording(recording)
    settings = replace(preset("tiny"), texels=opened.rig.texels.size)
    settings = replace(settings, generalisation=replace(settings.generalisation, remove_heading=remove_heading))
    student, samples = prepare(opened, settings)
    assert samples.parts is not None  # the default is local
    left = left_out(opened, leave)
    values, owners, channels = weighted_samples(
        samples.subbands(slice(0, CHANNELS), torch.arange(len(samples))), samples.parts
    )
    inputs = student.normalize(samples.descriptors)
    known, unseen = values[~left] - values[~left].mean(0), values[left] - values[~left].mean(0)
    steps = samples.parts.steps
    forms = {f"fade {fade:g}" if fade < 1 else "all joints alike": samples.parts.reach(fade) for fade in FADES}
    forms |= {f"only {cut} joints": (steps <= cut).float() for cut in CUTS}
    print(f"{int((~left).sum())} frames known, {int(left.sum())} of {', '.join(leave)} left out\n")
    print("| form | all | " + " | ".join(ATTRIBUTES) + " |\n" + "| --- " * (2 + len(ATTRIBUTES)) + "|")
    for form, reach in forms.items():
        found = predict(inputs[~left], known, inputs[left], owners, reach)
        missed, spread = (found - unseen).square().sum(0), unseen.square().sum(0)
        own = [slice(0, CHANNELS), *ATTRIBUTES.values()]
        within = [(channels >= part.start) & (channels < part.stop) for part in own]
        shares = [1 - float(missed[here].sum() / spread[here].sum().clamp(min=1e-12)) for here in within]
        print(f"| {form} | " + " | ".join(f"{100 * share:.1f} %" for share in shares) + " |", flush=True)


def weighted_samples(bands: Bands, parts: Parts) -> tuple[Tensor, Tensor, Tensor]:
    """Every STRIDE-th sample [F, S] in units of its channel's spread, its part [S] and its channel [S]."""
    texels = (COARSE_TEXELS * bands.ll.shape[-1]) ** 2
    centred = [band - band.mean(0) for band in bands]
    energy = sum(band.square().movedim(-3, 0).flatten(1).sum(1) for band in centred) / (len(bands.ll) * texels)
    assert isinstance(energy, Tensor)
    weights = torch.cat([channel_weights(energy[part], part) for part in (GEOMETRY, APPEARANCE)])
    values, owners, channels = [], [], []
    for band, owner in zip(centred, (parts.coarse, parts.coarse, parts.fine), strict=True):
        shape = band.shape[1:]
        values.append((band * weights[:, None, None]).flatten(1)[:, ::STRIDE])
        owners.append(owner.expand(shape).flatten()[::STRIDE])
        channels.append(torch.arange(CHANNELS)[:, None, None].expand(shape).flatten()[::STRIDE])
    return torch.cat(values, 1), torch.cat(owners), torch.cat(channels)


def predict(
    inputs: Tensor,  # [F, D]
    values: Tensor,  # [F, S]
    points: Tensor,  # [G, D]
    owners: Tensor,  # [S]
    reach: Tensor,  # [P, D]
) -> Tensor:
    """The samples [G, S] at `points`, each by the function of its part."""
    found = torch.zeros(len(points), values.shape[1])
    for part in owners.unique().tolist():
        turn = whitening(inputs * reach[part])
        z, at = ((x * reach[part]) @ turn for x in (inputs, points))
        function = fit_smoother(z, values[:, owners == part], generator=torch.Generator().manual_seed(0))
        found[:, owners == part] = function(at)
    return found


if __name__ == "__main__":
    typer.run(main)
