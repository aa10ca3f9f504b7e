"""Training explains its frames, resumes to the same bytes after a kill and gives the same bytes for a seed."""

import math
import threading
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import synthetic_student
import torch
from synthetic_student import (
    FRAMES,
    INPUTS,
    SETTINGS,
    Killed,
    bands_of_frames,
    kill_at,
    quick,
    random_student,
    same,
    samples,
    train_in,
)
from trainings import one_by_one

from mua.channels import APPEARANCE, COARSE_TEXELS, GEOMETRY
from mua.pose.components import INPUT_FLOOR, principal_components
from mua.pose.encoding import Components
from mua.rig.bones import figure_scale
from mua.student import coarse, targets
from mua.student import subband_source as sources
from mua.student.bases import BestCoefficients
from mua.student.conditioned import Conditioned, fold
from mua.student.factorize import truncated_svd
from mua.student.model import Branch, build_mlp, linear_layers
from mua.student.regress import leading, whitening
from mua.student.settings import Generalisation, Settings
from mua.student.stages import Samples
from mua.student.subband_source import hold
from mua.student.targets import joint_targets, least_spread
from mua.training.optimise import Progress
from mua.training.schedule import Schedule
from mua.wavelets import Bands


def explained(predicted: torch.Tensor, truth: torch.Tensor) -> float:
    return float(1 - (predicted - truth).square().sum() / (truth - truth.mean(0)).square().sum())


def test_each_stage_improves_on_the_one_before(tmp_path: Path) -> None:
    """Bases alone, their sweeps, the regression of their coefficients, the fine-tuning of all."""
    descriptors, truth = bands_of_frames()

    def gains(name: str, settings: Settings) -> torch.Tensor:
        predicted = train_in(tmp_path / name, settings).predict(descriptors)
        return torch.tensor([explained(found, band) for found, band in zip(predicted, truth, strict=True)])

    nothing = Schedule(steps=1, batch=1, lr=1e-12)
    bases = gains("bases", replace(SETTINGS, regression=nothing, finetune=nothing))
    regressed = gains("regressed", replace(SETTINGS, finetune=nothing))
    tuned = gains("tuned", SETTINGS)
    unswept = gains("unswept", replace(SETTINGS, sweeps=0))
    assert (bases < 0.05).all()
    assert (regressed > torch.tensor([0.95, 0.90, 0.85])).all()
    assert (tuned > regressed).all()
    assert (tuned[1:] > unswept[1:] + 0.005).all()  # for the details, whose factors alternate


def test_same_seed_gives_the_same_bytes_and_another_seed_others(tmp_path: Path) -> None:
    settings = quick()
    first, second = train_in(tmp_path / "a", settings), train_in(tmp_path / "b", settings)
    assert same(first, second)
    assert not same(first, train_in(tmp_path / "c", replace(settings, seed=1)))


STAGES = ("coarse mesh", "geometry bases", "geometry coefficients", "geometry fine-tuning", "appearance bases")


@pytest.mark.parametrize("stage", STAGES)
def test_resumes_to_the_same_bytes_after_a_kill(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, stage: str) -> None:
    monkeypatch.setattr("mua.training.optimise.CHECKPOINT_STEPS", 2)
    with pytest.raises(Killed):
        train_in(tmp_path / "killed", quick(), kill_at(stage, 3))
    assert same(train_in(tmp_path / "killed", quick()), train_in(tmp_path / "whole", quick()))


def turned_components(*given: Any) -> Components:
    """Half of the directions the other way."""
    found = principal_components(*given)
    signs = np.where(np.arange(len(found.margins)) % 2, 1, -1).astype(np.float32)
    ranges = np.sort(found.ranges * signs, axis=0)
    return replace(found, directions=found.directions * signs[:, None], ranges=ranges)


@pytest.mark.parametrize(
    ("stage", "part"), [("coarse mesh", "coarse."), ("geometry coefficients", "geometry."), ("appearance bases", "geo")]
)
def test_goes_on_where_directions_come_out_the_other_way(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, stage: str, part: str
) -> None:
    """This happens on another machine or with other threads: the sign of a singular vector is arbitrary."""
    monkeypatch.setattr("mua.training.optimise.CHECKPOINT_STEPS", 2)
    monkeypatch.setattr("mua.student.branches.together", one_by_one)  # so that what the kill finds is known
    whole = train_in(tmp_path / "whole", quick()).state_dict()
    with pytest.raises(Killed):
        train_in(tmp_path / "killed", quick(), kill_at(stage, 3))
    monkeypatch.setattr(coarse, "truncated_svd", turned)
    monkeypatch.setattr(targets, "truncated_svd", turned)
    monkeypatch.setattr(synthetic_student, "principal_components", turned_components)
    found = train_in(tmp_path / "killed", quick()).state_dict()
    assert all(torch.equal(found[name], whole[name]) for name in whole if name.startswith(part))
    assert torch.equal(found["directions"], whole["directions"])
    anew = train_in(tmp_path / "anew", quick()).state_dict()
    assert not torch.equal(anew["appearance.mlp.0.weight"], whole["appearance.mlp.0.weight"])


def test_branches_side_by_side_end_in_the_bytes_of_one_after_the_other(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    at_once = train_in(tmp_path / "a", quick())
    monkeypatch.setattr("mua.student.branches.together", one_by_one)
    assert same(at_once, train_in(tmp_path / "b", quick()))


def test_where_one_branch_fails_the_other_ends_too(tmp_path: Path) -> None:
    stages: list[str] = []
    failed = threading.Event()

    def fail(progress: Progress) -> None:
        stages.append(progress.stage)
        if progress.stage == "geometry coefficients":
            failed.set()
            raise Killed
        if progress.stage == "appearance coefficients":
            assert failed.wait(60)

    with pytest.raises(Killed):
        train_in(tmp_path, quick(), fail)
    assert "appearance fine-tuning" not in stages


def turned(x: torch.Tensor, rank: int, *, generator: torch.Generator) -> tuple[torch.Tensor, ...]:
    u, s, v = truncated_svd(x, rank, generator=generator)
    return -u, s, -v


def test_reports_every_step_of_every_stage(tmp_path: Path) -> None:
    reports: list[Progress] = []
    settings = quick()
    train_in(tmp_path, settings, reports.append)
    fine = [r.step for r in reports if r.stage == "appearance fine-tuning"]
    assert fine == list(range(1, settings.finetune.steps + 1))
    assert {r.stage for r in reports} >= set(STAGES)


def test_best_coefficients_give_back_what_the_bases_span() -> None:
    branch = random_student().appearance
    alphas = branch.split(torch.randn(3, branch.channels * branch.ranks.total, generator=torch.Generator()))
    bands = branch.synthesize(alphas)
    again = branch.synthesize(BestCoefficients(branch)(bands))
    assert [len(band) for band in bands] == [3, 3, 3]
    for found, band in zip(again, bands, strict=True):
        assert torch.allclose(found, band, atol=1e-3 * float(band.abs().max()))


def test_best_coefficients_are_no_worse_than_any_others() -> None:
    branch = random_student().geometry
    bands = bands_of_frames(4)[1].of(GEOMETRY)
    best = branch.synthesize(BestCoefficients(branch)(bands))
    predicted = branch(torch.zeros(4, INPUTS))
    assert [len(band) for band in bands] == [4, 4, 4]
    for found, other, band in zip(best, predicted, bands, strict=True):
        assert (found - band).square().sum() <= (other - band).square().sum()


def test_joint_targets_measure_the_weighted_texture() -> None:
    branch = random_student().geometry
    flat = torch.randn(9, branch.channels * branch.ranks.total, generator=torch.Generator().manual_seed(1))
    weights = torch.linspace(0.5, 3, branch.channels)
    targets = joint_targets(branch, flat, weights, rank=9, generator=torch.Generator().manual_seed(0))
    zero = branch.synthesize(branch.split(torch.zeros(1, flat.shape[1])))
    bands = branch.synthesize(branch.split(flat))
    parts = (
        ((band - still) * weights[:, None, None]).double().square().flatten(1).sum(1)
        for band, still in zip(bands, zero, strict=True)
    )
    energy = torch.stack(list(parts)).sum(0)
    # The ridge of the Gram matrices adds its share of energy, GRAM_RIDGE of the mean one.
    assert torch.allclose(targets.coordinates.double().square().sum(1), energy, rtol=1e-3)
    assert torch.allclose(targets.coordinates @ targets.expand, flat, atol=1e-2)


def test_directions_below_the_rounding_of_a_recording_are_dropped() -> None:
    branch = random_student().geometry
    generator = torch.Generator().manual_seed(1)
    modes = torch.randn(3, branch.channels * branch.ranks.total, generator=generator)
    flat = torch.randn(9, 3, generator=generator) * torch.tensor([1.0, 0.01, 1e-5]) @ modes
    targets = joint_targets(branch, flat, torch.ones(branch.channels), rank=9, generator=generator)
    assert targets.coordinates.shape == (9, 2)
    assert torch.allclose(targets.coordinates @ targets.expand, flat, atol=1e-3)


def test_a_channel_that_only_rounds_stays_at_its_mean(tmp_path: Path) -> None:
    descriptors, bands = bands_of_frames()
    opacity = 10
    for band in (bands.ll[:, opacity], bands.d3[:, :, opacity], bands.d2[:, :, opacity]):
        band.mul_(1e-6).add_(2)
    data = replace(samples(), subbands=lambda part, rows: Bands(*(b[rows] for b in bands.of(part))))
    student = train_in(tmp_path, quick(), data=data)
    assert torch.equal(
        student.predict(descriptors).ll[:, opacity], student.geometry.ll_mean[opacity].expand(FRAMES, -1, -1)
    )
    assert not student.geometry.d2.h[:, opacity].any()


def figure_of(size: float, bands: Bands) -> Samples:
    """Samples of a figure that is so many times as large as a person."""
    given = samples()
    scale = size / figure_scale(given.meshes(torch.arange(1))[0].numpy())
    return replace(
        given,
        subbands=lambda part, rows: Bands(*(b[rows] for b in bands.of(part))),
        meshes=lambda rows: scale * given.meshes(rows),
    )


@pytest.mark.parametrize(("size", "still"), [(1.0, False), (100.0, True)])
def test_what_is_seen_of_an_offset_depends_on_the_size_of_the_figure(tmp_path: Path, size: float, still: bool) -> None:
    """Hundredths of a millimetre on a person, and on a figure that is a hundred times as large."""
    _, bands = bands_of_frames()
    for band in (bands.ll[:, 0], bands.d3[:, :, 0], bands.d2[:, :, 0]):
        band.mul_(1e-2)
    student = train_in(tmp_path, quick(), data=figure_of(size, bands))
    assert student.geometry.d2.h[:, 0].any() != still


@pytest.mark.parametrize(("channel", "size"), [(10, 1.0), (0, 100.0)])  # an opacity, an offset of a large figure
def test_a_channel_that_hardly_varies_stays_at_its_mean(tmp_path: Path, channel: int, size: float) -> None:
    """One sample of its LL changes visibly; over all texels and frames that is next to nothing."""
    _, bands = bands_of_frames()
    for band in (bands.ll[:, channel], bands.d3[:, :, channel], bands.d2[:, :, channel]):
        band.zero_()
    least = least_spread(GEOMETRY, size=size)[channel]
    bands.ll[:, channel, 1, 1] = 2 * COARSE_TEXELS * least * torch.linspace(-1, 1, FRAMES)
    assert train_in(tmp_path, quick(), data=figure_of(size, bands)).geometry.ll_basis[channel].abs().max() < 0.1 * least


def test_whitened_directions_vary_alike_down_to_the_floor() -> None:
    inputs = torch.randn(500, 3, generator=torch.Generator().manual_seed(0)) * torch.tensor([3.0, 1.0, 1e-4])
    spread = (inputs @ whitening(inputs)).std(0).sort().values
    variance = torch.linalg.eigvalsh(torch.cov(inputs.T))
    assert torch.allclose(spread, (variance / (variance + INPUT_FLOOR)).sqrt(), atol=0.01)


def test_a_rate_rises_then_falls_to_zero() -> None:
    schedule = Schedule(steps=100, batch=1, lr=2.0, warm_up=0.1)
    rates = [schedule.lr_at(step) for step in range(100)]
    assert rates[:10] == sorted(rates[:10])
    assert rates[0] == pytest.approx(0.2)
    assert max(rates) == pytest.approx(2.0, rel=0.05)
    assert rates[10:] == sorted(rates[10:], reverse=True)
    assert rates[-1] < 0.001
    assert {replace(schedule, warm_up=0.0, cosine=False).lr_at(step) for step in (0, 50, 99)} == {2.0}


def test_few_frames_get_fewer_steps() -> None:
    schedule = Schedule(steps=100, batch=8, lr=1.0, epochs=20)
    assert [schedule.over(frames).steps for frames in (0, 1, 20, 40, 1000)] == [1, 3, 50, 100, 100]
    assert replace(schedule, epochs=math.inf).over(1).steps == 100


def test_keeps_the_directions_that_distinguish_frames() -> None:
    z = torch.randn(400, 4, generator=torch.Generator().manual_seed(0)) * torch.tensor([1.0, 1e-4, 0.1, 0.0])
    assert leading(z).tolist() == [True, False, True, False]
    assert leading(torch.zeros(5, 3)).sum() < 3


def conditioned() -> Conditioned:
    """One of three components and two coordinates to seven outputs, every part of it away from its start."""
    torch.manual_seed(0)
    module = Conditioned(build_mlp(3, 5, 2), torch.randn(2, 7))
    torch.nn.init.normal_(module.expand.bias)
    return module


def test_a_folded_mlp_is_the_same_function() -> None:
    module, x = conditioned(), torch.randn(4, 3, generator=torch.Generator().manual_seed(1))
    assert [tuple(p.shape) for p in module.folded().parameters()] == [(5, 3), (5,), (5, 5), (5,), (7, 5), (7,)]
    assert torch.allclose(module.folded()(x), module(x), atol=1e-5)


def test_a_network_is_folded_wherever_it_holds_a_conditioned_mlp() -> None:
    network = torch.nn.ModuleDict({"one": torch.nn.Sequential(conditioned()), "other": torch.nn.Linear(2, 2)})
    fold(network)
    assert not any(isinstance(module, Conditioned) for module in network.modules())
    assert isinstance(network["other"], torch.nn.Linear)


def test_large_sources_are_read_batch_by_batch(monkeypatch: pytest.MonkeyPatch) -> None:
    _, bands = bands_of_frames()
    asked: list[tuple[slice, int]] = []

    def source(channels: slice, rows: torch.Tensor) -> Bands:
        asked.append((channels, len(rows)))
        return Bands(*(band[rows] for band in bands.of(channels)))

    rows = torch.tensor([4, 2])
    held = hold(source, APPEARANCE, frames=FRAMES, size=48)(slice(1, 3), rows)
    monkeypatch.setattr(sources, "HELD_BYTES", 0)
    streamed = hold(source, APPEARANCE, frames=FRAMES, size=48)(slice(1, 3), rows)
    assert all(torch.equal(a, b) for a, b in zip(held, streamed, strict=True))
    assert asked == [(APPEARANCE, FRAMES), (slice(12, 14), 2)]
    asked.clear()
    monkeypatch.setattr(sources, "HELD_BYTES", sum(band.nbytes for band in bands.of(APPEARANCE)))
    for together in (1, 2):  # beside another source there is room for half
        hold(source, APPEARANCE, frames=FRAMES, size=48, together=together)
    assert asked == [(APPEARANCE, FRAMES)]


def test_fewer_frames_than_blendshapes_train(tmp_path: Path) -> None:
    student = train_in(tmp_path, quick(), data=samples(2))
    assert all(torch.isfinite(tensor).all() for tensor in student.state_dict().values())
    assert isinstance(student.geometry, Branch)


def test_fine_tuning_lets_weights_decay_and_bases_not(tmp_path: Path) -> None:
    """One step whose rate is all but nothing, so that the decay alone changes a student."""
    lr, shrink = 1e-7, 0.25
    step = Schedule(steps=1, batch=1, lr=lr, cosine=False)
    settings = replace(SETTINGS, regression=replace(step, lr=1e-12), finetune=step)
    kept, decayed = (
        train_in(tmp_path / str(decay), replace(settings, generalisation=Generalisation(weight_decay=decay)))
        for decay in (0.0, shrink / lr)
    )
    for before, after in ((kept.geometry, decayed.geometry), (kept.appearance, decayed.appearance)):
        hidden = [linear_layers(branch.mlp)[1].weight for branch in (before, after)]
        assert torch.allclose(hidden[1], (1 - shrink) * hidden[0], atol=1e-4)
        assert torch.allclose(after.ll_basis, before.ll_basis, atol=1e-4)
        assert torch.allclose(after.d2.h, before.d2.h, atol=1e-4)
