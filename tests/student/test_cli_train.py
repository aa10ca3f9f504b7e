"""mua-train: its files, its stages one by one, and its output while it runs."""

import io
import json
import re
import shutil
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
import torch
from commands import Commands
from pretended_card import pretended_card
from recordings import RATE, FormulaTeacher, clip, plan
from rich.console import Console
from synthetic_avatar import synthetic_rig
from trainings import FINISHED, STAGE_NAMES, Training

from mua.asset import read
from mua.asset.read import load
from mua.asset.summary import storage_of
from mua.baking.report import UNSAID
from mua.cli import display
from mua.cli.display import Display
from mua.recording import PlannedClip, TeacherWriter, record
from mua.student import distil, stages, subband_source
from mua.student.finetune import HUE, picture_loss
from mua.student.settings import STAGES, Budget, preset
from mua.wavelets import Bands


def test_leaves_an_avatar_of_the_recordings_texture_size(trained: Path) -> None:
    avatar = read(trained)
    assert avatar.surface
    assert avatar.name == "a"
    assert avatar.rig.texels.size == 32
    assert [clip.name for clip in avatar.clips] == ["walk", "reach", "turn"]


def test_figures_claim_no_more_of_the_teacher_than_is_known(trained: Path) -> None:
    assert read(trained).notes == f"{UNSAID}; held out of training: turn"
    assert json.loads(trained.with_name("a_errors.json").read_text())["teacher"] == UNSAID
    assert UNSAID in trained.with_name("a_errors.md").read_text()
    assert trained.with_name("a_contact_sheet.png").is_file()


def test_an_unknown_clip_to_store_is_named_before_anything_is_trained(
    written: Path, tmp_path: Path, mua_train: Training
) -> None:
    assert "--clips jump: there is no such clip; expected walk" in mua_train(written, "--clips", "jump").sentence
    assert list(tmp_path.iterdir()) == []


def test_refuses_a_control_character_in_a_name_before_anything_is_trained(tmp_path: Path, mua_train: Training) -> None:
    rig, directory = synthetic_rig(), tmp_path.parent / "be\x07ll"
    planned = plan(rig)
    with TeacherWriter(directory, rig, rate=RATE) as writer:
        record(FormulaTeacher(rig), [replace(planned[0], clip=replace(planned[0].clip, name="wa\x1blk"))], writer)
    assert "the clip 'wa\\x1blk' has the control character U+001B" in mua_train(directory).sentence
    assert list(tmp_path.iterdir()) == []


def test_leaves_nothing_half_written(trained: Path) -> None:
    assert not list(trained.parent.rglob("*.part*"))


@pytest.fixture
def two_threads() -> Iterator[None]:
    """As many as torch has on two cores, on which the last bits of its sums depend."""
    before = torch.get_num_threads()
    torch.set_num_threads(2)
    yield
    torch.set_num_threads(before)


@pytest.mark.usefixtures("two_threads")
def test_stages_one_by_one_end_in_the_same_bytes(written: Path, tmp_path: Path, mua_train: Training) -> None:
    whole = tmp_path / "whole" / "a.muaavatar"
    assert mua_train(written, output=whole).status in FINISHED
    for stage in reversed(STAGES):  # out of order: each but the coarse mesh needs the one before it
        ended = mua_train(written, "--stage", stage)
        if stage in ("coarse", "bases"):
            assert ended.status == 0
        else:
            assert f"--stage {stage}" in ended.sentence
            assert "'geometry bases'" in ended.sentence
            assert "run --stage bases first" in ended.sentence
    assert mua_train(written, "--stage", "fine-tuning").status == 1  # bases alone are not enough
    for stage in ("regression", "fine-tuning"):
        assert mua_train(written, "--stage", stage).status == 0
        assert not (tmp_path / "a.muaavatar").exists()
    assert mua_train(written).status in FINISHED
    assert (tmp_path / "a.muaavatar").read_bytes() == whole.read_bytes()


def test_the_papers_recipe_has_two_stages(written: Path, mua_train: Training) -> None:
    refused = mua_train(written, "--recipe", "paper", "--stage", "bases")
    assert "expected coarse or fine-tuning" in refused.sentence


def test_errors_of_hue_count_more_in_colours_alone(
    written: Path, mua_train: Training, monkeypatch: pytest.MonkeyPatch
) -> None:
    seen = set()

    def loss(predicted: Bands, truth: Bands, sensitivities: Bands, *, hue: float) -> torch.Tensor:
        seen.add((predicted.ll.shape[-3], hue))
        return picture_loss(predicted, truth, sensitivities, hue=hue)

    monkeypatch.setattr(stages, "picture_loss", loss)
    assert mua_train(written).status in FINISHED
    assert seen == {(11, 0.0), (12, HUE)}
    assert HUE > 0


def test_a_repeated_command_repeats_no_step(written: Path, trained: Path, mua_train: Training) -> None:
    before = trained.read_bytes()
    printed = mua_train(written, output=trained).out.splitlines()
    assert "avatar" in printed
    assert not set(printed) & set(STAGE_NAMES)
    assert trained.read_bytes() == before


def test_what_is_stored_is_chosen_without_training_again(
    written: Path, trained: Path, tmp_path: Path, mua_train: Training
) -> None:
    shutil.copytree(trained.with_suffix(".work"), tmp_path / "elsewhere")
    ended = mua_train(
        written, "--work", tmp_path / "elsewhere", "--storage", "i8", "--clips", "turn", "--clips", "walk"
    )
    assert not set(ended.out.splitlines()) & set(STAGE_NAMES)
    made = tmp_path / "a.muaavatar"
    assert {clip.name for clip in read(made).clips} == {"turn", "walk"}
    assert storage_of(load(made)) == "i8"
    assert not made.with_suffix(".work").exists()


def test_another_seed_is_another_training(written: Path, trained: Path, tmp_path: Path, mua_train: Training) -> None:
    shutil.copytree(trained.with_suffix(".work"), tmp_path / "a.work")
    assert "coarse mesh" in mua_train(written, "--stage", "coarse", "--seed", 1).out.splitlines()


def test_a_recording_without_whole_frames_gives_an_avatar_and_says_so(tmp_path: Path, mua_train: Training) -> None:
    rig = synthetic_rig()
    planned = PlannedClip(clip(rig, "walk", 6), held_out=False, wanted=frozenset(range(6)), whole=frozenset())
    with TeacherWriter(tmp_path / "recording", rig, rate=24.0) as writer:
        record(FormulaTeacher(rig), [planned], writer)
    assert "keeps no frame whole" in mua_train(tmp_path / "recording").out
    assert read(tmp_path / "a.muaavatar").thumbnail
    assert {path.name for path in tmp_path.iterdir()} == {"recording", "a.muaavatar", "a.work"}


def test_a_gpu_that_is_not_there_is_named(
    written: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, mua_train: Training
) -> None:
    monkeypatch.setattr(torch.cuda, "is_available", lambda: False)
    assert "--device cuda" in mua_train(written, "--device", "cuda").sentence
    assert list(tmp_path.iterdir()) == []


def test_a_card_trains_as_good_a_student(
    written: Path, trained: Path, tmp_path: Path, mua_train: Training, monkeypatch: pytest.MonkeyPatch
) -> None:
    with pretended_card(monkeypatch):
        assert mua_train(written, "--device", "cuda").status in FINISHED
    one, other = (
        json.loads(path.with_name("a_errors.json").read_text())["groups"]["training"]["rms"]
        for path in (tmp_path / "a.muaavatar", trained)
    )
    for name, errors in one.items():
        assert errors["student"] == pytest.approx(other[name]["student"], rel=0.02), name


def test_without_a_terminal_stages_and_steps_are_lines(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(display, "LINE_SECONDS", 0.0)
    file = io.StringIO()
    with Display(Console(file=file)) as shown:
        shown.stage("geometry fine-tuning")
        shown.step(1, 4, detail="loss 0.5000, 2.0 steps/s")
        shown.step(2, 4, detail="loss 0.4000, 2.0 steps/s")
    lines = file.getvalue().splitlines()
    assert lines[0] == "geometry fine-tuning"
    assert lines[1].startswith("  1 of 4, loss 0.5000, 2.0 steps/s")
    assert lines[2].startswith("  2 of 4, loss 0.4000, 2.0 steps/s, ")
    assert lines[2].endswith(" left")
    assert re.fullmatch(r"  \d+\.\d s", lines[3])  # the stage's time


def test_stages_that_take_turns_are_reported_separately(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(display, "LINE_SECONDS", 0.0)
    file = io.StringIO()
    with Display(Console(file=file)) as shown:
        shown.stage("coarse mesh")
        shown.step(1, 1)
        for step in (1, 2):
            for name in ("geometry bases", "appearance bases"):
                shown.stage(name)
                shown.step(step, 2)
        shown.stage("avatar")
    lines = [re.sub(r"\d+\.\d s", "T", line.split(", ")[0]) for line in file.getvalue().splitlines()]
    assert lines == [
        *("coarse mesh", "  1 of 1", "  T"),
        *("geometry bases", "  1 of 2", "appearance bases", "  appearance bases: 1 of 2"),
        *("  geometry bases: 2 of 2", "  geometry bases: T", "  appearance bases: 2 of 2", "  T"),
        *("avatar", "  T"),
    ]


@pytest.mark.parametrize("asked", [True, False])
def test_says_how_busy_a_gpu_is_if_the_driver_reports_it(monkeypatch: pytest.MonkeyPatch, asked: bool) -> None:
    def utilization(_: torch.device) -> int:
        if not asked:
            raise ModuleNotFoundError("pynvml does not seem to be installed")
        return 87

    monkeypatch.setattr(torch.cuda, "memory_allocated", lambda _: 12_340_000_000)
    monkeypatch.setattr(torch.cuda, "utilization", utilization)
    assert distil.gpu_use(torch.device("cuda")) == (", GPU 87 %, 12.3 GB" if asked else ", GPU 12.3 GB")
    assert distil.gpu_use(torch.device("cpu")) == ""


def test_a_gpu_holds_what_fits_into_half_of_what_is_free(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(torch.cuda, "mem_get_info", lambda _: (6_000, 10_000))
    monkeypatch.setattr(torch.cuda, "memory_reserved", lambda _: 3_000)
    monkeypatch.setattr(torch.cuda, "memory_allocated", lambda _: 1_000)
    assert subband_source.room(torch.device("cuda")) == 4_000
    assert subband_source.room(torch.device("cpu")) == subband_source.HELD_BYTES


def test_a_check_reports_on_the_recording_and_trains_nothing(
    written: Path, tmp_path: Path, mua_train: Training
) -> None:
    printed = mua_train(written, "--check").out
    assert "walk" in printed
    assert not set(printed.splitlines()) & set(STAGE_NAMES)
    assert [path.name for path in tmp_path.iterdir()] == ["a_check.png"]


def test_a_preset_says_how_large_the_student_is(
    written: Path, tmp_path: Path, command: Commands, monkeypatch: pytest.MonkeyPatch
) -> None:
    given: list[Any] = []
    monkeypatch.setattr("mua.baking.train._train", lambda _, settings, __: given.append(settings.student))
    for name in ("tiny", "preview"):
        assert command("train", written, "-o", tmp_path / "a.muaavatar", "--preset", name).status == 0
    assert [settings.hidden for settings in given] == [preset(name).hidden for name in ("tiny", "preview")]
    assert given[0] != given[1]


def test_a_budget_is_that_of_the_student(
    written: Path, tmp_path: Path, command: Commands, monkeypatch: pytest.MonkeyPatch
) -> None:
    given: list[Any] = []
    monkeypatch.setattr("mua.baking.train._train", lambda _, settings, __: given.append(settings.student.budget))
    budget = ("--budget-mflop", "40", "--budget-mb", "20")
    assert command("train", written, "-o", tmp_path / "a.muaavatar", *budget).status == 0
    assert given == [Budget(mflop=40, mb=20)]
