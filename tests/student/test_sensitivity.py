"""The change of images with a sample of the subbands, against images of changed subbands."""

from copy import copy
from dataclasses import replace
from itertools import count
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest
import torch
from compared_systems import SETTINGS
from synthetic_student import quick, same

from mua.arrays import Array
from mua.avatar.camera import orbit
from mua.avatar.decode import box_of
from mua.channels import APPEARANCE, ATTRIBUTES, CHANNELS
from mua.recording import Recording
from mua.splatting.posing import TorchRig, pose_splats
from mua.splatting.projection import Eye
from mua.splatting.rasterise import rasterise
from mua.student import distil as distillation
from mua.student import sensitivity
from mua.student import stages as training
from mua.student.bases import worth_of
from mua.student.distil import distil
from mua.student.finetune import picture_loss, relative
from mua.student.model import Student, lowpass_texels
from mua.student.sensitivity import GOLDEN, LEAST, measure_sensitivities, shared_pattern
from mua.student.settings import Ranks
from mua.training.checkpoint import Checkpoints
from mua.training.optimise import Progress, Run
from mua.wavelets import Bands

CPU = torch.device("cpu")
SIDE = 40  # pixels
DRAWS = 150  # images of random signs
SAMPLING = 0.25  # four standard errors of their mean square, over a channel's samples
ROUNDING = 32 * float(np.finfo(np.float32).eps)  # share of squares that a closed form in single precision leaves
STEP = {10: 1e-2, 11: 1e-2, 0: 1e-5}  # by changed channel: opacity, red, an offset


class Quiet:
    def __init__(self) -> None:
        self.stages: list[str] = []

    def stage(self, name: str) -> None:
        self.stages.append(name)

    def step(self, done: int, total: int, *, detail: str = "") -> None:
        pass


def run(tmp_path: Path, seed: int = 0) -> Run:
    return Run(torch.Generator().manual_seed(seed), Checkpoints(tmp_path, "key"), lambda _: None, CPU)


def changed_pictures(recording: Recording, channel: int, step: float) -> Array:
    """Mean squared change of an image of the first frame, for each sample of a channel's LL and D3, over `step`."""
    size, clip = recording.rig.texels.size // 16, recording.clips[0]
    mean = torch.from_numpy(recording.mean_texture()).double()
    pose, rig = clip.pose(clip.recorded[0]), TorchRig.of(recording.rig, mean)
    joints = torch.from_numpy(recording.rig.skeleton.skinning(pose.rotations, pose.translations)).double()
    mesh = torch.from_numpy(recording.meshes([0])[0]).double()
    texels = torch.from_numpy(recording.rig.texels.texels).long()
    box = box_of(pose_splats(rig, joints, mesh, mean).centres.numpy())
    camera = orbit(box, screen=(SIDE, SIDE), azimuth=GOLDEN, elevation=0.0)

    def picture(bands: Bands) -> torch.Tensor:
        texture = lowpass_texels(bands, recording.wavelet, texels)[0].T + mean
        splats = pose_splats(rig, joints, mesh, texture)
        return rasterise(splats, Eye.of(camera, mean), torch.from_numpy(box), torch.zeros(3).double())

    changes = []
    for band in range(4):
        for place in np.ndindex(size, size):
            pictures = []
            for sign in (-1, 1):
                zero = (torch.zeros(shape, dtype=torch.float64) for shape in _shapes(size))
                bands = Bands(*zero)
                chosen = bands.ll[0] if band == 0 else bands.d3[0, band - 1]
                chosen[(channel, *place)] = sign * step
                pictures.append(picture(bands))
            changes.append(((pictures[1] - pictures[0]) / (2 * step)).square().mean().item())
    return np.array(changes)


def _shapes(size: int) -> list[tuple[int, ...]]:
    fine = 2 * size
    return [(1, CHANNELS, size, size), (1, 3, CHANNELS, size, size), (1, 3, CHANNELS, fine, fine)]


def test_a_sample_counts_for_what_a_unit_of_it_changes_in_pictures(
    smooth_recording: Recording, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sensitivity, "SIDE", SIDE)
    one_frame = [measure_sensitivities(smooth_recording, 1, run(tmp_path, seed)).ll.square() for seed in range(DRAWS)]
    found = torch.stack(one_frame).mean((0, 1, 3, 4))
    for channel, step in STEP.items():
        expected = changed_pictures(smooth_recording, channel, step).mean()
        np.testing.assert_allclose(found[channel], expected, rtol=SAMPLING)


def test_the_channels_of_an_attribute_are_seen_at_the_same_samples(smooth_recording: Recording, tmp_path: Path) -> None:
    measured = measure_sensitivities(smooth_recording, 2, run(tmp_path))
    for band in (measured.ll[0], measured.d2[0, 0]):
        for own in ATTRIBUTES.values():
            pattern = band[own] / band[own].square().mean((1, 2), keepdim=True).sqrt()
            torch.testing.assert_close(pattern, pattern[:1].expand_as(pattern))


def test_a_level_counts_for_the_mean_of_its_bands_and_of_all_pictures(
    smooth_recording: Recording, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """LL and the three bands of D3 are one level."""

    def squares(*_: object, middle: Bands, **__: object) -> Bands:
        threes = torch.tensor([3.0, 5, 7])[:, None, None, None]
        return Bands(torch.full_like(middle.ll, 4), threes * torch.ones_like(middle.d3), threes + 0 * middle.d2)

    monkeypatch.setattr(sensitivity, "_squares", squares)
    measured = measure_sensitivities(smooth_recording, 2, run(tmp_path))
    for band, mean in ((measured.ll, 19 / 4), (measured.d3, 19 / 4), (measured.d2, 5)):
        torch.testing.assert_close(band, torch.full_like(band, np.sqrt(mean)))


def test_clips_that_are_held_out_are_not_looked_at(smooth_recording: Recording, tmp_path: Path) -> None:
    """Wherever they stand among the others."""
    before = copy(smooth_recording)
    before.clips = tuple(sorted(smooth_recording.clips, key=lambda clip: not clip.held_out))
    assert [clip.name for clip in before.clips] != [clip.name for clip in smooth_recording.clips]
    measured = [measure_sensitivities(one, 2, run(tmp_path)) for one in (smooth_recording, before)]
    for one, other in zip(*measured, strict=True):
        assert torch.equal(one, other)


def test_what_no_picture_shows_counts_a_little() -> None:
    squares = torch.rand(CHANNELS, 4, 4, generator=torch.Generator().manual_seed(0))
    squares[:, 2, 1] = 0
    found = shared_pattern(squares)
    torch.testing.assert_close(found[:, 2, 1], LEAST * squares.mean((1, 2)))
    assert torch.isfinite(shared_pattern(torch.zeros_like(squares))).all()


def test_the_loss_is_that_of_pictures_to_first_order() -> None:
    rng = torch.Generator().manual_seed(0)
    truth, predicted = (Bands(*(torch.randn(5, *s[1:], generator=rng) for s in _shapes(2))) for _ in range(2))
    counts = Bands(*(torch.rand(1, *s[1:], generator=rng) for s in _shapes(2)))
    errors = [((a - b) * c).flatten() for a, b, c in zip(predicted, truth, counts, strict=True)]
    torch.testing.assert_close(picture_loss(predicted, truth, counts), torch.cat(errors).square().mean())


def test_errors_of_hue_count_more_than_those_of_light() -> None:
    truth = Bands(*(torch.zeros(1, *s[1:-3], 6, *s[-2:]) for s in _shapes(2)))
    ones = Bands(*(torch.ones_like(band) for band in truth))
    red = Bands(*(band.clone() for band in truth))
    for band in red:
        band[..., 3, :, :] = 1  # red of the second three
    lighter = Bands(*(band.clone() for band in truth))
    for band in lighter:
        band[..., 3:, :, :] = 1 / 3  # as much, but of all three colours
    plain, by_hue = picture_loss(red, truth, ones), picture_loss(red, truth, ones, hue=3)
    torch.testing.assert_close(by_hue, plain * (1 + 3 * 2 / 3))  # two thirds of its square are hue
    torch.testing.assert_close(picture_loss(lighter, truth, ones, hue=3), picture_loss(lighter, truth, ones))


def test_sensitivities_to_weighted_subbands_have_a_mean_square_of_one() -> None:
    rng = torch.Generator().manual_seed(0)
    counts, weights = Bands(*(torch.rand(s, generator=rng) for s in _shapes(2))), torch.rand(23, generator=rng) + 0.1
    found = relative(counts, weights)
    torch.testing.assert_close(torch.cat([band.flatten() for band in found]).square().mean(), torch.tensor(1.0))
    ratio = found.ll * weights[:, None, None] / counts.ll
    torch.testing.assert_close(ratio, ratio[:1, :1, :1, :1].expand_as(ratio))


def distilled(
    recording: Recording, directory: Path, *, pictures: int, heard: Quiet | None = None, **sizes: Any
) -> Student:
    settings = replace(quick(SETTINGS), pictures=pictures, **sizes)
    return distil(recording, settings, device=CPU, directory=directory, report=heard or Quiet())


def test_sensitivities_are_measured_once_and_end_in_the_same_bytes(
    smooth_recording: Recording, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    first = distilled(smooth_recording, tmp_path, pictures=2)
    for kept in tmp_path.glob("* fine-tuning.pt"):
        kept.unlink()

    def again(recording: Recording, pictures: int, run: Run) -> Bands:
        raise AssertionError("measured twice")

    monkeypatch.setattr(distillation, "measure_sensitivities", again)
    assert same(first, distilled(smooth_recording, tmp_path, pictures=2))
    with pytest.raises(AssertionError, match="measured twice"):
        distilled(smooth_recording, tmp_path, pictures=3)  # another run


def test_pictures_change_what_fine_tuning_ends_in(smooth_recording: Recording, tmp_path: Path) -> None:
    heard = Quiet()
    measured = distilled(smooth_recording, tmp_path / "a", pictures=2, heard=heard)
    assert sensitivity.STAGE in heard.stages
    without = distilled(smooth_recording, tmp_path / "b", pictures=0)
    for one, other in zip(measured.branches, without.branches, strict=True):
        assert not torch.equal(one.ll_basis, other.ll_basis)


def test_bases_are_solved_for_what_pictures_show(smooth_recording: Recording, tmp_path: Path) -> None:
    kept = []
    for pictures in (2, 0):
        distilled(smooth_recording, tmp_path / str(pictures), pictures=pictures, appearance=Ranks(1, 1, 1))
        kept.append(torch.load(tmp_path / str(pictures) / "appearance bases.pt", weights_only=True)["state"]["branch"])
    seen = Bands(**torch.load(tmp_path / "2" / f"{sensitivity.STAGE}.pt", weights_only=True)["state"]["tensors"])
    rows = torch.arange(smooth_recording.count())
    for channel in range(3):
        samples = smooth_recording.subbands(APPEARANCE, rows).ll[:, channel]
        worth = seen.of(APPEARANCE).ll[0, channel]
        left = [_left((samples - own["ll_mean"][channel]) * worth, own["ll_basis"][channel] * worth) for own in kept]
        assert left[0] < (1 - ROUNDING) * left[1]


def _left(
    x: torch.Tensor,  # [F, n, n]
    basis: torch.Tensor,  # [R, n, n]
) -> float:
    """The squares that the best coefficients leave."""
    fit = torch.linalg.lstsq(basis.flatten(1).double().T, x.flatten(1).double().T, driver="gelsd")
    return float((x.flatten(1).double().T - basis.flatten(1).double().T @ fit.solution).square().sum())


def test_a_channel_that_no_picture_shows_counts_alike() -> None:
    dark = Bands(torch.zeros(1, 1, 2, 2), torch.zeros(1, 1, 1, 2, 2), torch.zeros(1, 1, 1, 4, 4))
    worth = worth_of(dark, 0)
    assert [own.shape[-1] for own in worth] == [2, 2, 4]
    assert all(bool((own == 1).all()) for own in worth)


def test_bases_have_a_learning_rate_of_their_own_with_pictures(
    smooth_recording: Recording, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    students = []
    for rate in (0.0, training.SEEN_BASIS_RATE):
        monkeypatch.setattr(training, "SEEN_BASIS_RATE", rate)
        students.append(distilled(smooth_recording, tmp_path / str(rate), pictures=2))
    for still, moved in zip(*(student.branches for student in students), strict=True):
        assert not torch.equal(still.ll_basis, moved.ll_basis)


def test_every_picture_is_reported(
    smooth_recording: Recording, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """With the rate per second: here each takes four."""
    reports: list[Progress] = []
    monkeypatch.setattr(sensitivity, "time", SimpleNamespace(monotonic=count(0, 4).__next__))
    measure_sensitivities(smooth_recording, 3, replace(run(tmp_path), report=reports.append))
    assert [(one.step, one.steps) for one in reports] == [(1, 3), (2, 3), (3, 3)]
    assert [one.rate for one in reports] == [0.25] * 3
