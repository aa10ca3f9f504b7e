"""Distillation of training frames into a student: closed-form start, regression, fine-tuning."""

from collections.abc import Callable
from dataclasses import dataclass, replace
from functools import partial

import torch
from torch import Tensor

from mua.channels import APPEARANCE, CHANNELS, GEOMETRY
from mua.errors import InputError
from mua.rig.bones import figure_scale
from mua.student.bases import factorize_branch
from mua.student.branches import fit_apart, side_by_side
from mua.student.coarse import fit_coarse, set_pca
from mua.student.components import Components
from mua.student.conditioned import fold
from mua.student.finetune import BASIS_RATE, HUE, finetune, picture_loss, relative, subband_loss
from mua.student.local import Parts, texture_locality
from mua.student.model import Branch, Student, lowpass_texels
from mua.student.negligible import drop_negligible, freeze_channels
from mua.student.paper_recipe import fit_branch_from_noise, fit_coarse_from_noise
from mua.student.regress import POSED, SWUNG, regress
from mua.student.sensitivity import STAGE as SENSITIVITIES
from mua.student.settings import Settings, StageName
from mua.student.subband_source import Source, hold
from mua.student.targets import Targets, channel_weights, joint_targets, least_spread, still_channels
from mua.training.checkpoint import Checkpoints
from mua.training.memory import release_memory
from mua.training.optimise import Progress, Report, Run
from mua.training.processes import ALONE, Processes
from mua.wavelets import Bands

BRANCHES = ("geometry", "appearance")
# Bases fitted by images also serve unseen motion, while faster MLPs overfit the frames.
SEEN_BASIS_RATE = 12.0  # learning rate of the bases relative to that of the MLP


@dataclass(frozen=True, eq=False)
class Samples:
    """F training frames as inputs of the distillation."""

    descriptors: Tensor  # [F, D] from `mua.pose.descriptor`
    meshes: Callable[[Tensor], Tensor]  # canonical vertices [R, V, 3], metres, of rows [R]; all take much memory
    subbands: Source
    mean_texture: Tensor  # [N, 23] mean over the training frames at the valid texels
    parts: Parts | None = None  # body parts of the character; without them, or with a fade of 1, nothing is local
    weights: Tensor | None = None  # [F] by frame; the mean texture is over those of weight 1; None: all equal
    sensitivities: Callable[[Run], Bands] | None = None  # of images to samples; None: the paper's loss is used

    def __len__(self) -> int:
        return len(self.descriptors)


def train(
    student: Student,
    samples: Samples,
    *,
    settings: Settings,
    checkpoints: Checkpoints,
    device: torch.device,
    report: Report,
    only: StageName | None = None,
    processes: Processes = ALONE,
) -> None:
    """Distil `samples` into `student` in place, whose components are set; resumes from `checkpoints`.

    Several `processes` share the work and end with the same student; the first of them reports and keeps checkpoints.
    With `only` one stage is run up to its checkpoints, which any later run takes up; the student is then unfinished.
    Raises InputError where the recipe has no such stage, or what it starts from is not there.
    """
    checkpoints = replace(checkpoints, processes=processes)
    if only is not None:
        require_earlier(only, settings, checkpoints)
    if not processes.first:
        report = _silent
    size = figure_scale(samples.meshes(torch.arange(1))[0].numpy())
    run = Run(torch.Generator().manual_seed(settings.seed), checkpoints, report, device, processes, size)
    student.to(device)
    student.load_state_dict(run.once("components", student.read_buffers), strict=False)
    descriptors, components = samples.descriptors.to(device), student.components
    random = settings.start == "random"
    counts = None if samples.weights is None else samples.weights.to(device)
    inputs = student.read(descriptors) if random else student.normalize(descriptors)
    start = (
        fit_coarse_from_noise
        if random
        else partial(fit_coarse, components=components, parts=samples.parts, weights=counts)
    )
    warm = partial(fit_branch, components=components, parts=samples.parts, frames=counts, wavelet=student.wavelet)

    def fit_mesh(run: Run) -> None:
        own = run.alone("coarse mesh")
        meshes = samples.meshes(torch.arange(len(samples))).to(device)
        pca = set_pca(student.coarse, meshes, own, None if random else counts)
        del meshes
        release_memory()
        start(student.coarse, inputs, pca, settings=settings, run=own)
        release_memory()

    def fit_named(name: str, branch: Branch, channels: slice, run: Run, until: StageName | None = only) -> None:
        fit = (
            fit_branch_from_noise if random else partial(warm, until=until, sensitivities=_sensitivities(samples, run))
        )
        source = hold(
            samples.subbands,
            channels,
            frames=len(samples),
            size=student.size,
            device=device,
            processes=processes,
            together=len(BRANCHES) if side_by_side(run) else 1,
        )
        fit(branch, inputs, source, channels=channels, settings=settings, name=name, run=run.alone(name))

    if only == "coarse":
        fit_apart([fit_mesh], run)
        return
    branches = zip(BRANCHES, student.branches, (GEOMETRY, APPEARANCE), strict=True)
    geometry, appearance = (partial(fit_named, *branch) for branch in branches)
    if side_by_side(run) and not random:  # their channels are shared out, so that the fits below take alike
        for fit in (appearance, geometry):
            fit(run, until="bases")
    fit_apart([appearance, geometry] if only else [appearance, geometry, fit_mesh], run)
    if only is not None:
        return
    low = student.mean_lowpass() if counts is None else mean_lowpass(student, samples)
    student.static.copy_(samples.mean_texture.to(device).T - low)
    student.requires_grad_(False).eval()


def mean_lowpass(student: Student, samples: Samples) -> Tensor:
    """The contribution to the valid texels [23, N] of the mean subbands over the mean texture's frames."""
    assert samples.weights is not None
    rows = torch.nonzero(samples.weights == 1)[:, 0]
    means = [
        Bands(*(band.mean(0, keepdim=True) for band in samples.subbands(slice(channel, channel + 1), rows)))
        for channel in range(CHANNELS)
    ]
    ll, d3, d2 = zip(*means, strict=True)
    mean = Bands(torch.cat(ll, dim=1), torch.cat(d3, dim=2), torch.cat(d2, dim=2))
    device = student.static.device
    return lowpass_texels(Bands(*(band.to(device) for band in mean)), student.wavelet, student.texels)[0]


def _sensitivities(samples: Samples, run: Run) -> Bands | None:
    """The samples' sensitivities, kept for a resumed run; None where they measure none."""
    measure, run = samples.sensitivities, run.alone(SENSITIVITIES)
    if measure is None:
        return None
    measured = Bands(**run.once(SENSITIVITIES, lambda: measure(run)._asdict()))
    release_memory()
    return measured


def _silent(_: Progress) -> None:
    pass


def stages(settings: Settings) -> dict[StageName, tuple[str, ...]]:
    """The stages of a recipe in order, and the names of the checkpoints that each leaves."""
    if settings.start == "random":
        coarse = ("components", "coarse components", "coarse mesh")
        return {"coarse": coarse, "fine-tuning": tuple(f"{name} descent" for name in BRANCHES)}
    endings: dict[StageName, tuple[str, ...]] = {
        "bases": ("bases",),
        "regression": ("targets", "coefficients"),
        "fine-tuning": ("fine-tuning",),
    }
    kept = {stage: tuple(f"{name} {end}" for end in ends for name in BRANCHES) for stage, ends in endings.items()}
    kept["bases"] = (SENSITIVITIES, *kept["bases"])
    return {"coarse": ("components", "coarse components", "coarse mesh"), **kept}


def require_earlier(only: StageName, settings: Settings, checkpoints: Checkpoints) -> None:
    """Raise InputError where the recipe has no stage `only`, or a checkpoint that it starts from is not finished."""
    needed = stages(settings)
    if only not in needed:
        raise InputError(f"--stage {only}: this recipe has no such stage; expected {' or '.join(needed)}")
    for stage, names in needed.items():
        if stage == only:
            return
        for name in names:
            # no later stage starts from the coarse mesh; missing sensitivities are measured again
            if stage != "coarse" and name != SENSITIVITIES and not checkpoints.finished(name):
                raise InputError(
                    f"--stage {only}: {checkpoints.directory} holds no finished {name!r}; run --stage {stage} first"
                )


def fit_branch(
    branch: Branch,
    inputs: Tensor,  # [F, D] normalised descriptors
    source: Source,  # subbands of the branch's channels, counted from 0
    *,
    channels: slice,
    components: Components,
    settings: Settings,
    name: str,
    run: Run,
    parts: Parts | None = None,
    until: StageName | None = None,
    sensitivities: Bands | None = None,  # sensitivities of images to the samples of all 23 channels, for one frame
    frames: Tensor | None = None,  # [F] how much each frame counts
    wavelet: str | None = None,  # of the subbands, as `factorize_branch` takes it
) -> None:
    """Fit one branch: closed-form bases, regression of the MLP on their coefficients, joint fine-tuning.

    Stops after the stage `until`.
    """
    stage = f"{name} bases"
    flat, variance = factorize_branch(
        branch,
        source,
        frames=len(inputs),
        settings=settings,
        stage=stage,
        run=run.alone(stage),
        sensitivities=None if sensitivities is None else sensitivities.of(channels),
        counts=frames,
        wavelet=wavelet,
    )
    release_memory()
    weights = channel_weights(variance, channels, size=run.size)
    if until == "bases":
        return
    freeze_channels(branch, flat, still_channels(variance, channels, size=run.size))
    drop_negligible(branch, flat, least_spread(channels, size=run.size).to(flat))
    rank = min(settings.hidden, len(inputs))  # the last layer's rank is that of the hidden layer before it
    stage = f"{name} coefficients"
    own = run.alone(stage)

    def aim(flat: Tensor) -> dict[str, Tensor]:
        return vars(joint_targets(branch, flat, weights, rank=rank, generator=own.generator, frames=frames))

    targets = Targets(**own.once(f"{name} targets", partial(aim, flat)))
    light, fade = channels == APPEARANCE, settings.generalisation.fade
    local = None if parts is None else texture_locality(parts, branch, targets, weights, fade=fade, light=light)
    branch.mlp = regress(
        inputs,
        targets.coordinates,
        components=components,
        expand=targets.expand,
        locality=local,
        own=None if frames is None else frames == 1,
        fit=POSED if light or settings.generalisation.own else SWUNG,
        hidden=settings.hidden,
        schedule=settings.regression,
        stage=stage,
        run=own,
        generalisation=settings.generalisation,
    )
    if until == "regression":
        return
    del flat, targets, local  # to leave their memory to the fine-tuning
    release_memory()
    error, basis_rate = subband_loss, BASIS_RATE
    if sensitivities is not None:
        seen = relative(sensitivities.of(channels), weights)
        error = partial(picture_loss, sensitivities=seen, hue=HUE if light else 0.0)
        basis_rate = SEEN_BASIS_RATE
    stage = f"{name} fine-tuning"
    finetune(
        branch,
        components.hold(components(inputs)),
        lambda rows: source(slice(0, branch.channels), rows),
        weights=weights,
        schedule=settings.finetune,
        stage=stage,
        run=run.alone(stage),
        weight_decay=settings.generalisation.weight_decay,
        basis_rate=basis_rate,
        error=error,
        frames=frames,
    )
    fold(branch)
