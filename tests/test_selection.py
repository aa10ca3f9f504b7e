"""Selection keeps the step that does best on clips that nothing is trained on, also across a kill."""

from dataclasses import replace
from pathlib import Path

import pytest
import torch
from synthetic_student import SETTINGS, new_student, quick, run_in, samples
from torch import Tensor, nn

from mua.errors import InputError
from mua.student.checkpoint import Checkpoints
from mua.student.model import Bands, Student
from mua.student.optimise import Progress, Run, optimise
from mua.student.selection import Selection, validation_rows
from mua.student.settings import Schedule, Settings
from mua.student.train import Samples, set_apart, train

CPU = torch.device("cpu")
STEPS = 20  # of the made-up case; a look after each
BEST = 12


class Killed(Exception):
    """Stands for a kill at one moment of a run."""


def walk(directory: Path, *, killed_at: int | None = None) -> tuple[nn.Linear, Selection, list[float]]:
    """Adam walks along a line; the clips that choose like best where it is after BEST steps."""
    torch.manual_seed(0)
    module = nn.Linear(1, 1, bias=False)
    nn.init.zeros_(module.weight)
    looks: list[float] = []

    def unseen() -> float:
        looks.append(module.weight.item())
        return abs(module.weight.item() + 0.1 * BEST)

    def report(progress: Progress) -> None:
        if progress.step == killed_at:
            raise Killed

    run = replace(run_in(directory), report=report)
    selection = Selection(unseen)
    groups: list[dict[str, object]] = [{"params": list(module.parameters()), "weight_decay": 0.0}]
    schedule = Schedule(steps=STEPS, batch=1, rate=0.1, falls=False)
    optimise(
        module,
        lambda model: model(torch.ones(1)).sum(),
        schedule=schedule,
        parameters=groups,
        stage="walk",
        run=run,
        selection=selection,
    )
    return module, selection, looks


def test_ends_at_the_step_that_does_best_on_unseen_clips(tmp_path: Path) -> None:
    module, selection, _ = walk(tmp_path)
    assert selection.step == BEST
    assert module.weight.item() == pytest.approx(-0.1 * BEST, abs=1e-4)


def test_looks_before_the_first_step_too(tmp_path: Path) -> None:
    _, _, looks = walk(tmp_path)
    assert looks[0] == 0
    assert len(looks) == STEPS + 1


def test_a_finished_stage_is_taken_up_at_its_best_step(tmp_path: Path) -> None:
    first, _, _ = walk(tmp_path)
    again, _, looks = walk(tmp_path)
    assert torch.equal(first.weight, again.weight)
    assert not looks  # nothing was trained again


@pytest.mark.parametrize("killed_at", [5, BEST + 4])
def test_a_killed_selection_goes_on_to_the_same_bytes(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, killed_at: int
) -> None:
    monkeypatch.setattr("mua.student.optimise.CHECKPOINT_STEPS", 4)
    whole, chosen, _ = walk(tmp_path / "whole")
    with pytest.raises(Killed):
        walk(tmp_path / "cut", killed_at=killed_at)
    resumed, again, looks = walk(tmp_path / "cut")
    assert len(looks) == STEPS - killed_at // 4 * 4  # it did not start anew
    assert (again.step, again.least) == (chosen.step, chosen.least)
    assert torch.equal(resumed.weight, whole.weight)


def drawn(clips: Tensor, share: float, seed: int = 0) -> Tensor:
    return validation_rows(clips, share, generator=torch.Generator().manual_seed(seed))


def test_whole_clips_choose_and_never_more_than_the_share() -> None:
    clips = torch.arange(10).repeat_interleave(torch.tensor([30, 5, 12, 8, 20, 3, 9, 6, 4, 3]))
    for seed in range(20):
        chosen = drawn(clips, 0.2, seed)
        assert 0 < int(chosen.sum()) <= 20
        assert all(len(chosen[clips == clip].unique()) == 1 for clip in range(10))
    assert not torch.equal(drawn(clips, 0.2, 0), drawn(clips, 0.2, 1))


def test_the_end_chooses_where_every_clip_is_longer_than_the_share() -> None:
    assert drawn(torch.zeros(10, dtype=torch.int64), 0.2).tolist() == [False] * 8 + [True] * 2


def with_clips() -> Samples:
    return replace(samples(), clips=torch.arange(6).repeat_interleave(10))


def choosing(settings: Settings = SETTINGS) -> Settings:
    return replace(settings, generalisation=replace(settings.generalisation, validation=0.2))


def trained(directory: Path, settings: Settings, data: Samples, *, kill: tuple[str, int] | None = None) -> Student:
    def report(progress: Progress) -> None:
        if (progress.stage, progress.step) == kill:
            raise Killed

    student = new_student(settings)
    student.mean.copy_(data.descriptors.mean(0))
    student.scale.copy_(data.descriptors.std(0))
    train(student, data, settings=settings, checkpoints=Checkpoints(directory, "key"), device=CPU, report=report)
    return student


def spoilt(data: Samples, rows: Tensor) -> Samples:
    """The same, but some frames are far off."""
    shift = torch.zeros(len(data))
    shift[rows] = 1000.0

    def subbands(channels: slice, some: Tensor) -> Bands:
        bands = data.subbands(channels, some)
        return Bands(*(band + shift[some].view(-1, *[1] * (band.ndim - 1)) for band in bands))

    return replace(data, meshes=data.meshes + shift[:, None, None], subbands=subbands)


def test_frames_that_choose_are_not_trained_on(tmp_path: Path) -> None:
    settings, data = choosing(quick()), with_clips()
    run = Run(torch.Generator().manual_seed(settings.seed), Checkpoints(tmp_path, "key"), lambda _: None, CPU)
    _, unseen = set_apart(data, 0.2, run=run.alone("selection"))
    assert unseen is not None
    own = torch.isin(data.descriptors[:, 0], unseen.descriptors[:, 0]).nonzero()[:, 0]
    others = torch.isin(data.descriptors[:, 0], unseen.descriptors[:, 0]).logical_not().nonzero()[:, 0]
    plain = trained(tmp_path / "plain", settings, data)
    same = trained(tmp_path / "same", settings, spoilt(data, own))
    far = trained(tmp_path / "far", settings, spoilt(data, others[:1]))
    for part in ("coarse.mean", "coarse.basis", "geometry.ll_mean", "appearance.d3.mean"):
        assert torch.equal(plain.state_dict()[part], same.state_dict()[part])
        assert not torch.equal(plain.state_dict()[part], far.state_dict()[part])


@pytest.mark.parametrize(("share", "sentence"), [(0.001, "0 frames to choose, 60 to train on"), (1.0, "60 frames to")])
def test_a_share_that_leaves_nothing_is_refused(tmp_path: Path, share: float, sentence: str) -> None:
    with pytest.raises(InputError, match=sentence):
        set_apart(with_clips(), share, run=run_in(tmp_path))


def test_a_training_with_selection_resumes_to_the_same_bytes(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("mua.student.optimise.CHECKPOINT_STEPS", 2)
    settings, data = choosing(quick()), with_clips()
    whole = trained(tmp_path / "whole", settings, data)
    with pytest.raises(Killed):
        trained(tmp_path / "cut", settings, data, kill=("geometry fine-tuning", 3))
    resumed = trained(tmp_path / "cut", settings, data)
    for one, other in zip(whole.state_dict().values(), resumed.state_dict().values(), strict=True):
        assert torch.equal(one, other)
