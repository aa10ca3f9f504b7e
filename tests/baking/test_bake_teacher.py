"""mua-bake of a trained teacher, and of a capture."""

from dataclasses import replace
from pathlib import Path

import pytest
from captures import make_capture
from commands import Commands
from small_teachers import FEW
from trainings import FINISHED

import mua
from mua.student.settings import PRESETS as STUDENTS
from mua.student.settings import Ranks
from mua.teachers.trained import settings as teaching
from mua.teachers.trained.folder import FILE, WEIGHTS, teacher_bytes
from mua.training.schedule import Schedule


@pytest.fixture(scope="module")
def capture(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return make_capture(tmp_path_factory.mktemp("capture")).folder


@pytest.fixture
def small(monkeypatch: pytest.MonkeyPatch) -> None:
    """Presets of few steps."""
    monkeypatch.setitem(teaching.PRESETS, "tiny", FEW)
    ranks, few = Ranks(2, 2, 2), Schedule(steps=2, batch=2, lr=1e-3)
    student = replace(STUDENTS["tiny"], texels=64, frames=4, geometry=ranks, appearance=ranks, components=2, hidden=8)
    monkeypatch.setitem(STUDENTS, "tiny", replace(student, regression=few, finetune=few, sweeps=1, pictures=2))


@pytest.mark.usefixtures("small", "forked")
def test_a_capture_becomes_an_avatar_and_so_does_its_teacher(capture: Path, tmp_path: Path, command: Commands) -> None:
    given = ("--preset", "tiny", "--jobs", "1")
    motion = capture / "walk.bvh"
    whole = command("bake", capture, "--motion", motion, "-o", tmp_path / "whole.muaavatar", *given)
    assert whole.status in FINISHED, whole
    assert "trained on the images of a capture" in whole.out
    avatar = mua.load(tmp_path / "whole.muaavatar")
    assert avatar.name == "figure"
    assert {clip.name for clip in avatar.clips} == {"walk", "reach", "walk 2"}
    assert "held out of training: reach" in avatar.notes
    (recording,) = (tmp_path / "whole.work").glob("recording-*")
    recorded = [clip.name for clip in mua.Recording(recording).clips if not clip.held_out and len(clip.recorded)]
    assert {name.partition(" (")[0] for name in recorded} == {"walk", "walk 2"}
    assert any(" degrees)" in name for name in recorded)

    teacher = tmp_path / "whole.work" / "teacher"
    apart = command("bake", "--teacher", teacher, "--motion", motion, "-o", tmp_path / "apart.muaavatar", *given)
    assert apart.status in FINISHED, apart
    avatar = mua.load(tmp_path / "apart.muaavatar")
    assert [clip.name for clip in avatar.clips] == ["walk"]
    assert not avatar.encoding.remove_heading


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        (("--teacher", "absent"), "--teacher absent: there is no such directory"),
        (("--teacher", "{folder}"), "it holds no teacher.json"),
        (("{capture}", "--height", "1.7"), "--height: the capture's own capture.json says it"),
        (("{capture}", "--scale", "2"), "--scale: the capture's own capture.json says it"),
        (("{capture}", "--uv", "unwrap"), "--uv: the capture's own capture.json says it"),
        (("{capture}", "--detail", "head=2"), "--detail: the capture's own capture.json says it"),
        (("{capture}", "--leave-out", "hat"), "--leave-out: the capture's own capture.json says it"),
        (("{capture}", "--alpha", "hair=cut"), "--alpha: the capture's own capture.json says it"),
        (("{capture}", "--check"), "mua-capture check"),
        (("--teacher", "{teacher}"), "give the motion to record with --motion"),
        (("hero.glb", "--teacher", "{teacher}"), "has its own character; leave hero.glb out"),
        (("--teacher", "{teacher}", "--texels", "64"), "--texels 64: the texture is as large as the teacher's"),
    ],
)
def test_a_wrong_option_is_a_sentence(
    capture: Path, tmp_path: Path, command: Commands, options: tuple[str, ...], sentence: str
) -> None:
    teacher = tmp_path / "teacher"
    teacher.mkdir()
    (teacher / "teacher.json").touch()
    places = {"capture": capture, "teacher": teacher, "folder": tmp_path}
    assert sentence in command("bake", *(option.format(**places) for option in options)).sentence


def test_what_is_recorded_depends_on_settings_and_weights(tmp_path: Path) -> None:
    for name in (FILE, WEIGHTS):
        (tmp_path / name).write_bytes(name.encode())
    assert list(teacher_bytes(tmp_path)) == [FILE.encode(), WEIGHTS.encode()]
