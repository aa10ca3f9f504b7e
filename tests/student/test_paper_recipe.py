"""The paper's recipe starts from noise, descends the same loss and resumes to the same bytes."""

from dataclasses import replace
from pathlib import Path

import pytest
import torch
from synthetic_student import SETTINGS, Killed, bands_of_frames, kill_at, quick, same, samples, train_in

from mua.errors import InputError
from mua.student.settings import PRESETS, with_recipe
from mua.training.schedule import Schedule
from mua.wavelets import Bands

RANDOM = replace(
    SETTINGS,
    start="random",
    regression=Schedule(steps=300, batch=8, lr=1e-3, cosine=False),
    finetune=Schedule(steps=1200, batch=1, lr=3e-3, cosine=False),
)


def test_noise_descends_to_the_training_frames(tmp_path: Path) -> None:
    descriptors, truth = bands_of_frames()
    assert len(truth)
    for found, band in zip(train_in(tmp_path, RANDOM).predict(descriptors), truth, strict=True):
        about_mean = (band - band.mean(0)).abs().sum()
        assert about_mean > 0
        assert (found - band).abs().sum() < 0.6 * about_mean


def test_means_are_those_of_the_training_frames(tmp_path: Path) -> None:
    steps = {"regression": replace(RANDOM.regression, steps=1), "finetune": replace(RANDOM.finetune, steps=1)}
    student = train_in(tmp_path, replace(RANDOM, **steps))  # type: ignore[arg-type]
    mean = student.mean_lowpass() + student.static
    assert torch.allclose(mean, samples().mean_texture.T, atol=1e-5)


def test_a_channel_that_does_not_vary_gets_no_blendshape(tmp_path: Path) -> None:
    _, bands = bands_of_frames()
    opacity = 10
    for band in (bands.ll[:, opacity], bands.d3[:, :, opacity], bands.d2[:, :, opacity]):
        band.fill_(2)
    data = replace(samples(), subbands=lambda part, rows: Bands(*(b[rows] for b in bands.of(part))))
    geometry = train_in(tmp_path, quick(RANDOM), data=data).geometry
    for factor in (geometry.ll_basis, *(part.transpose(0, 1) for part in (geometry.d3.h, geometry.d2.w))):
        assert not factor[opacity].any()
        assert factor[0].any()


@pytest.mark.parametrize(("stage", "step"), [("coarse mesh", 21), ("geometry descent", 5), ("appearance descent", 45)])
def test_a_killed_descent_ends_in_the_same_bytes(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, stage: str, step: int
) -> None:
    """Before its first checkpoint, after one and after several."""
    monkeypatch.setattr("mua.training.optimise.CHECKPOINT_STEPS", 20)
    few = {name: replace(getattr(RANDOM, name), steps=46) for name in ("regression", "finetune")}
    settings = replace(RANDOM, **few)
    with pytest.raises(Killed):
        train_in(tmp_path / "a", settings, kill_at(stage, step))
    assert same(train_in(tmp_path / "a", settings), train_in(tmp_path / "b", settings))


def test_the_paper_recipe_is_the_papers() -> None:
    settings = with_recipe(PRESETS["paper"], "paper")
    assert (settings.finetune.steps, settings.finetune.batch, settings.finetune.lr) == (1_000_000, 1, 1e-4)
    assert (settings.regression.steps, settings.regression.batch, settings.regression.lr) == (2_000_000, 8, 1e-4)
    assert not settings.finetune.cosine
    assert with_recipe(PRESETS["tiny"], "closed-form") == PRESETS["tiny"]
    with pytest.raises(InputError, match="recipe: 'fast' is unknown"):
        with_recipe(PRESETS["tiny"], "fast")


def test_bases_have_the_learning_rate_of_the_mlp_and_nothing_decays(tmp_path: Path) -> None:
    """The first step of Adam moves every weight by its rate, so that two rates end as far apart as they are."""
    students = []
    for lr in (1e-3, 3e-3):
        one_step = replace(RANDOM.finetune, steps=1, lr=lr)
        settings = replace(RANDOM, regression=replace(RANDOM.regression, steps=1), finetune=one_step)
        students.append(train_in(tmp_path / str(lr), settings))
    slow, fast = (dict(student.geometry.named_parameters()) for student in students)
    apart = {name: (fast[name] - slow[name]).detach().abs() for name in slow}
    for name in (name for name in apart if name.startswith("mlp")):
        assert apart[name].max() == pytest.approx(2e-3, rel=1e-2)
    for factor in (apart["d3.h"], apart["d3.w"], apart["d2.h"], apart["d2.w"]):  # by the root of a channel's weight
        assert factor.max() ** 2 / apart["ll_basis"].max() == pytest.approx(2e-3, rel=1e-2)
