"""The paper's own recipe, to compare with: random weights, then Adam on the loss.

The paper gives the optimiser, its rate, batch and steps (Implementation Details), not the start: here bases begin as
noise of a tenth of their channel's spread, MLPs as torch makes them. Channels are weighted as in the other recipe, so
that both minimise the same loss.
"""

import math

import torch
from torch import Tensor, nn

from mua.channels import COARSE_TEXELS
from mua.student.coarse import MeshPca
from mua.student.finetune import draw_frames, finetune, weighted
from mua.student.model import Branch, Coarse, linear_layers
from mua.student.settings import Settings
from mua.student.subband_source import Source
from mua.student.targets import channel_weights, still_channels
from mua.training.optimise import Run, optimise
from mua.training.processes import ALONE, Processes, Share

BASIS_START = 0.1  # share of a channel's spread


def fit_coarse_from_noise(
    coarse: Coarse,
    inputs: Tensor,  # [F, K] components of descriptors
    pca: MeshPca,  # that `set_pca` has set
    *,
    settings: Settings,
    run: Run,
) -> None:
    """Fit F_temp of `coarse` by the L1 error of the coefficients of its PCA (paper, Eq. L_coarse)."""
    start_mlp(coarse.mlp, run.generator)

    def loss(model: nn.Module) -> Tensor:
        def part(share: Share) -> Tensor:
            rows = share.rows.to(inputs.device)
            return (model(inputs[rows]) - pca.coefficients[rows]).abs().sum(1).mean()

        return run.processes.mean_loss(draw_frames(len(inputs), settings.regression, run), part, frames=len(inputs))

    groups: list[dict[str, object]] = [{"params": list(coarse.mlp.parameters()), "weight_decay": 0.0}]
    optimise(coarse.mlp, loss, schedule=settings.regression, parameters=groups, stage="coarse mesh", run=run)


def fit_branch_from_noise(
    branch: Branch,
    inputs: Tensor,  # [F, K] components of descriptors
    source: Source,  # subbands of the branch's channels, counted from 0
    *,
    channels: slice,  # the branch's channels among the 23
    settings: Settings,
    name: str,
    run: Run,
) -> None:
    """Fit bases and MLP from noise by the paper's loss; the means are those of the training frames."""
    weights = start_from_noise(branch, inputs, source, channels=channels, run=run)
    finetune(
        branch,
        inputs,
        lambda rows: source(slice(0, branch.channels), rows),
        weights=weights,
        schedule=settings.finetune,
        stage=f"{name} descent",
        run=run,
        basis_rate=1.0,
        weight_decay=0.0,
    )


def start_from_noise(
    branch: Branch,
    inputs: Tensor,  # [F, K] components of descriptors
    source: Source,  # subbands of the branch's channels, counted from 0
    *,
    channels: slice,  # the branch's channels among the 23
    run: Run,
) -> Tensor:
    """Set the means of `branch` and draw its bases and MLP; returns the weight [C] of each channel's error."""
    variance = set_means(branch, source, frames=len(inputs), processes=run.processes).to(run.device)
    weights = channel_weights(variance, channels, size=run.size)
    start_mlp(branch.mlp, run.generator)
    with weighted(branch, weights), torch.no_grad():
        branch.ll_basis.copy_(BASIS_START * torch.randn(branch.ll_basis.shape, generator=run.generator))
        for detail in (branch.d3, branch.d2):
            for factor in (detail.h, detail.w):
                factor.copy_(math.sqrt(BASIS_START) * torch.randn(factor.shape, generator=run.generator))
    branch.silence(still_channels(variance, channels, size=run.size))
    return weights


@torch.no_grad()
def set_means(branch: Branch, source: Source, *, frames: int, processes: Processes = ALONE) -> Tensor:
    """Set the mean subbands of `branch`, channel by channel; returns the texel variance [C] about them."""
    energy = []
    for channel in range(branch.channels):
        if channel not in processes.channels(branch.channels):
            energy.append(branch.ll_mean.new_empty(()))
            continue
        ll, d3, d2 = source(slice(channel, channel + 1), torch.arange(frames))
        branch.ll_mean[channel] = ll[:, 0].mean(0)
        branch.d3.mean[:, channel], branch.d2.mean[:, channel] = d3[:, :, 0].mean(0), d2[:, :, 0].mean(0)
        spread = torch.stack([(band - band.mean(0)).square().sum() for band in (ll, d3, d2)]).sum()
        energy.append(spread.to(branch.ll_mean))
    for channel, spread in enumerate(energy):
        processes.broadcast(*branch.channel(channel), spread, source=processes.owner(channel))
    texels = (COARSE_TEXELS * branch.ll_mean.shape[-1]) ** 2
    return torch.stack(energy) / (frames * texels)


@torch.no_grad()
def start_mlp(mlp: nn.Module, generator: torch.Generator) -> None:
    """Draw torch's initial weights of linear layers, uniform within 1 / sqrt(inputs), from the run's generator."""
    for layer in linear_layers(mlp):
        reach = 1 / math.sqrt(layer.in_features)
        for parameter in (layer.weight, layer.bias):
            parameter.copy_(reach * (2 * torch.rand(parameter.shape, generator=generator) - 1))
