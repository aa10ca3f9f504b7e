"""Resampling against scipy's Slerp and numpy's interp."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.spatial.transform import Rotation, Slerp

from mua.pose.clip import Clip, Stretches
from mua.pose.resample import resample

BOUND = 64 * np.finfo(float).eps  # a slerp is some dozens of operations on numbers up to 1


def random_clip(frames: int, *, rate: float) -> Clip:
    random = np.random.default_rng(frames)
    rotations = Rotation.random(frames * 3, random_state=5).as_quat(scalar_first=True).reshape(frames, 3, 4)
    return Clip("clip", rate, rotations, random.normal(size=(frames, 3, 3)))


def test_returns_the_clip_itself_at_its_own_rate() -> None:
    clip = random_clip(7, rate=30.0)
    assert resample(clip, 30.0) is clip


@pytest.mark.parametrize("rate", [7.0, 24.0, 25.0, 60.0, 120.0, 119.88])
def test_agrees_with_scipy_between_frames(rate: float) -> None:
    clip = random_clip(11, rate=30.0)
    found = resample(clip, rate)
    times = np.arange(len(found)) / rate
    known = np.arange(len(clip)) / clip.rate
    assert times[-1] <= known[-1] + 1e-9 < times[-1] + 1 / rate + 1e-9
    for j in range(3):
        slow = Slerp(known, Rotation.from_quat(clip.rotations[:, j], scalar_first=True))(np.minimum(times, known[-1]))
        away = (slow.inv() * Rotation.from_quat(found.rotations[:, j], scalar_first=True)).magnitude()
        assert away.max() < 1e-7  # scipy's Slerp goes through rotation vectors: sqrt(eps) near half turns
    slow = np.stack([np.interp(times, known, x) for x in clip.translations.reshape(-1, 9).T], axis=-1)
    np.testing.assert_allclose(found.translations.reshape(-1, 9), slow, atol=BOUND)


def test_hits_the_frames_of_a_whole_ratio() -> None:
    clip = random_clip(13, rate=120.0)
    found = resample(clip, 30.0)
    assert len(found) == 4
    assert found.rate == 30.0
    np.testing.assert_allclose(found.rotations, clip.rotations[::4], atol=BOUND)
    np.testing.assert_array_equal(found.translations, clip.translations[::4])


@pytest.mark.parametrize(
    ("rate", "other", "frames"), [(24, 120, 50), (25, 50, 30), (25, 100, 58), (30, 90, 22), (60, 90, 43), (100, 50, 59)]
)
def test_rounding_costs_no_last_frame(rate: int, other: int, frames: int) -> None:
    clip = random_clip(frames, rate=rate)
    found = resample(clip, other)
    assert len(found) == (frames - 1) * other // rate + 1
    assert (frames - 1) * other % rate == 0  # so that the ends meet
    np.testing.assert_array_equal(found.translations[-1], clip.translations[-1])


def test_goes_the_short_way_round() -> None:
    half = np.array([[1.0, 0, 0, 0], [-np.cos(0.1), -np.sin(0.1), 0, 0]])[:, None]
    found = resample(Clip("clip", 1.0, half, np.zeros((2, 1, 3))), 2.0)
    np.testing.assert_allclose(np.abs(found.rotations[1, 0]), [np.cos(0.05), np.sin(0.05), 0, 0], atol=BOUND)


def test_stretches_go_between_frames_as_translations_do() -> None:
    clip = random_clip(5, rate=30.0)
    matrices = np.random.default_rng(1).normal(size=(5, 2, 3, 3))
    clip = replace(clip, stretches=Stretches(np.array([0, 2]), matrices))
    found = resample(clip, 60.0).stretches
    assert found is not None
    np.testing.assert_array_equal(found.matrices[::2], matrices)
    np.testing.assert_allclose(found.matrices[1], (matrices[0] + matrices[1]) / 2, atol=BOUND)
    kept = clip.cut(slice(1, 3)).stretches
    assert kept is not None
    np.testing.assert_array_equal(kept.matrices, matrices[1:3])


def test_keeps_a_single_frame() -> None:
    clip = random_clip(1, rate=30.0)
    found = resample(clip, 24.0)
    assert (len(found), found.rate) == (1, 24.0)
    np.testing.assert_allclose(found.rotations, clip.rotations, atol=BOUND)
    np.testing.assert_array_equal(found.translations, clip.translations)
