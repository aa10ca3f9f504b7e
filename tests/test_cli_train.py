"""mua-train: what it leaves, its stages one by one, and what it tells while it runs."""

import io
import json
import re
from pathlib import Path

import pytest
import torch
from recordings import FormulaTeacher, clip
from rich.console import Console
from synthetic_avatar import synthetic_rig
from trainings import STAGE_NAMES, mua_train, sentence

from mua.asset import read
from mua.baking.report import UNSAID
from mua.cli import display
from mua.cli.display import Display
from mua.recording import PlannedClip, TeacherWriter, record
from mua.student import distil, source
from mua.student.settings import STAGES


@pytest.fixture(scope="module")
def trained(written: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The avatar of an undisturbed training."""
    output = tmp_path_factory.mktemp("trained") / "new" / "a.muaavatar"
    with pytest.MonkeyPatch.context() as monkeypatch:
        assert mua_train(monkeypatch, written, output) == 0
    return output


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
    written: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    assert mua_train(monkeypatch, written, tmp_path / "a.muaavatar", "--clips", "jump") == 1
    assert "--clips jump: there is no such clip, only walk" in sentence(capsys.readouterr().err)
    assert list(tmp_path.iterdir()) == []


def test_leaves_nothing_half_written(trained: Path) -> None:
    assert not list(trained.parent.rglob("*.part*"))


def test_stages_one_by_one_end_in_the_same_bytes(
    written: Path, trained: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    output = tmp_path / "a.muaavatar"
    for stage in reversed(STAGES):  # out of order: each but the coarse mesh needs the one before it
        status = mua_train(monkeypatch, written, output, "--stage", stage)
        assert status == (0 if stage in ("coarse", "bases") else 1), stage
    assert mua_train(monkeypatch, written, output, "--stage", "fine-tuning") == 1  # bases alone are not enough
    for stage in ("regression", "fine-tuning"):
        assert mua_train(monkeypatch, written, output, "--stage", stage) == 0
        assert not output.exists()
    assert mua_train(monkeypatch, written, output) == 0
    assert output.read_bytes() == trained.read_bytes()


@pytest.mark.parametrize(("stage", "lacking"), [("regression", "bases"), ("fine-tuning", "bases")])
def test_a_stage_names_what_it_needs(
    written: Path,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    stage: str,
    lacking: str,
) -> None:
    assert mua_train(monkeypatch, written, tmp_path / "a.muaavatar", "--stage", stage) == 1
    told = sentence(capsys.readouterr().err)
    assert f"--stage {stage}" in told
    assert f"'geometry {lacking}'" in told
    assert f"run --stage {lacking} first" in told


def test_the_papers_recipe_has_two_stages(
    written: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    output = tmp_path / "a.muaavatar"
    assert mua_train(monkeypatch, written, output, "--recipe", "paper", "--stage", "bases") == 1
    assert "expected coarse or fine-tuning" in sentence(capsys.readouterr().err)


def test_a_repeated_command_repeats_no_step(
    written: Path, trained: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    before = trained.read_bytes()
    assert mua_train(monkeypatch, written, trained) == 0
    told = capsys.readouterr().out.splitlines()
    assert "avatar" in told
    assert not set(told) & set(STAGE_NAMES)
    assert trained.read_bytes() == before


def test_a_recording_without_whole_frames_gives_an_avatar_and_says_so(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    rig = synthetic_rig()
    planned = PlannedClip(clip(rig, "walk", 6), held_out=False, wanted=frozenset(range(6)), whole=frozenset())
    with TeacherWriter(tmp_path / "recording", rig, rate=24.0) as writer:
        record(FormulaTeacher(rig), [planned], writer)
    assert mua_train(monkeypatch, tmp_path / "recording", tmp_path / "a.muaavatar") == 0
    assert "keeps no frame whole" in capsys.readouterr().out
    assert read(tmp_path / "a.muaavatar").thumbnail
    assert {path.name for path in tmp_path.iterdir()} == {"recording", "a.muaavatar", "a.work"}


def test_a_gpu_that_is_not_there_is_named(
    written: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(torch.cuda, "is_available", lambda: False)
    assert mua_train(monkeypatch, written, tmp_path / "a.muaavatar", "--device", "cuda") == 1
    assert "--device cuda" in sentence(capsys.readouterr().err)
    assert list(tmp_path.iterdir()) == []


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
    assert re.fullmatch(r"  \d+\.\d s", lines[3])  # what the stage took


def test_two_stages_that_take_turns_are_told_apart(monkeypatch: pytest.MonkeyPatch) -> None:
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
def test_says_how_busy_a_gpu_is_as_far_as_it_tells(monkeypatch: pytest.MonkeyPatch, asked: bool) -> None:
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
    assert source.room(torch.device("cuda")) == 4_000
    assert source.room(torch.device("cpu")) == source.HELD_BYTES
