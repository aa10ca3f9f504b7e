"""mua-teach: what it leaves, what it tells, and the teacher that comes of it."""

import json
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import torch
from captures import FRAMES, make_capture
from commands import Commands, Ended
from taught import FEW

import mua
from mua.baking import lessons
from mua.capture import open_capture
from mua.capture.outline import posed_template
from mua.capture.write import write_capture
from mua.channels import CHANNELS
from mua.errors import InputError
from mua.student.settings import Schedule
from mua.teachers.teacher import TeacherFrame
from mua.teaching import settings
from mua.teaching.template_training import TemplateSettings, TemplateWeights
from mua.teaching.trained import TrainedTeacher

TEXELS = 64
OPTIONS = ("--texels", str(TEXELS), "--steps", "3")
Teach = Callable[..., Ended]


@pytest.fixture(scope="module")
def capture(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return make_capture(tmp_path_factory.mktemp("capture")).folder


@pytest.fixture(scope="module")
def made(capture: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A teacher of a few steps; tests leave it as it is."""
    folder = tmp_path_factory.mktemp("taught") / "teacher"
    with pytest.MonkeyPatch.context() as patch:
        patch.setitem(settings.PRESETS, "tiny", FEW)
        return mua.teach(capture, output=folder, steps=3, texels=TEXELS)


@pytest.fixture
def teach(command: Commands, monkeypatch: pytest.MonkeyPatch) -> Teach:
    monkeypatch.setitem(settings.PRESETS, "tiny", FEW)
    return lambda *arguments: command("teach", *arguments)


def test_it_leaves_a_teacher_and_pictures_of_its_progress(made: Path) -> None:
    assert {path.name for path in made.iterdir()} >= {"teacher.json", "rig.npz", "weights.pt", "progress", "work"}
    pictures = sorted(path.name for path in (made / "progress").iterdir())
    assert pictures == ["mean_texture_0000004.png", "texels_0000003.png"]


def test_a_drivable_template_follows_the_motion(capture: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    few = Schedule(steps=2, batch=1, lr=1e-2)
    monkeypatch.setattr(lessons, "TEMPLATE", replace(TemplateSettings(), nodes=few, offsets=few))
    monkeypatch.setitem(settings.PRESETS, "tiny", FEW)
    teacher = TrainedTeacher(mua.teach(capture, output=tmp_path / "teacher", steps=1, texels=TEXELS, drivable=True))
    clip = open_capture(capture).motion("walk")
    one, other = (frame for frame in teacher.frames(clip, {0, 3}) if isinstance(frame, TeacherFrame))
    assert np.abs(one.mesh - teacher.rig.mesh.vertices).max() > 1e-4
    assert np.abs(one.mesh - other.mesh).max() > 1e-4
    assert np.abs(one.mesh - other.mesh).max() < 0.1


def test_tracks_of_a_capture_are_trained_on(capture: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Points that went 5 cm to one side of the skinned template take the drivable one with them."""
    for entry in capture.iterdir():
        if entry.name != "capture.json":
            (tmp_path / entry.name).symlink_to(entry)
    given = open_capture(capture)
    write_capture(replace(given, folder=tmp_path, tracks="{clip}.npz"))
    bind = given.surfaces.vertices[::20]
    points = posed_template(given.surfaces, given.motion("walk"))[:, ::20] + [0.05, 0, 0]
    np.savez(tmp_path / "walk.npz", points=points, bind=bind)
    few, none = Schedule(steps=12, batch=1, lr=5e-2), TemplateWeights(silhouette=0.0)
    monkeypatch.setattr(lessons, "TEMPLATE", replace(TemplateSettings(), nodes=few, offsets=few, weights=none))
    monkeypatch.setitem(settings.PRESETS, "tiny", FEW)
    teacher = TrainedTeacher(mua.teach(tmp_path, output=tmp_path / "t", steps=1, texels=TEXELS, drivable=True))
    (frame,) = (one for one in teacher.frames(given.motion("walk"), {2}) if isinstance(one, TeacherFrame))
    assert (frame.mesh - teacher.rig.mesh.vertices).mean(axis=0)[0] == pytest.approx(0.05, abs=0.025)


def test_tracks_that_are_not_there_are_a_sentence(capture: Path, tmp_path: Path, teach: Teach) -> None:
    for entry in capture.iterdir():
        if entry.name != "capture.json":
            (tmp_path / entry.name).symlink_to(entry)
    write_capture(replace(open_capture(capture), folder=tmp_path, tracks="{clip}.npz"))
    assert "walk.npz: there is no such file" in teach(tmp_path, "-o", tmp_path / "teacher", *OPTIONS).sentence
    np.savez(tmp_path / "walk.npz", points=np.full((FRAMES["walk"], 3, 3), 9.0))
    assert "no tracked point lies on the posed" in teach(tmp_path, "-o", tmp_path / "teacher", *OPTIONS).sentence


def test_the_same_command_trains_nothing_again(capture: Path, made: Path, teach: Teach) -> None:
    before = (made / "weights.pt").read_bytes()
    ended = teach(capture, "-o", made, *OPTIONS)
    assert ended.status == 0
    assert "texels" not in ended.out.split("capture", 1)[1].splitlines()[1:2]
    assert (made / "weights.pt").read_bytes() == before


def test_a_teacher_has_frames_of_any_motion(capture: Path, made: Path) -> None:
    teacher = TrainedTeacher(made)
    clip = open_capture(capture).motion("reach")
    frames = list(teacher.frames(clip, {1}))
    assert len(frames) == FRAMES["reach"]
    assert not isinstance(frames[0], TeacherFrame)
    assert isinstance(frames[1], TeacherFrame)
    assert frames[1].texture.shape == (len(teacher.rig.texels.texels), CHANNELS)
    assert frames[1].mesh.shape == teacher.rig.mesh.vertices.shape
    assert frames[1].texture.dtype == frames[1].mesh.dtype == np.float32
    still = next(iter(TrainedTeacher(made, moving=False).frames(clip, {0})))
    assert isinstance(still, TeacherFrame)
    assert not np.array_equal(still.texture, frames[1].texture)


def test_a_capture_that_holds_all_cameras_out_is_refused(capture: Path, tmp_path: Path, teach: Teach) -> None:
    said = json.loads((capture / "capture.json").read_text())
    for camera in said["cameras"]:
        camera["held_out"] = True
    for entry in capture.iterdir():
        if entry.name != "capture.json":
            (tmp_path / entry.name).symlink_to(entry)
    (tmp_path / "capture.json").write_text(json.dumps(said))
    assert "every camera is held out" in teach(tmp_path, "-o", tmp_path / "teacher").sentence


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        (("--steps", "0"), "--steps 0: expected at least 1"),
        (("--texels", "100"), "--texels 100: expected a multiple of"),
        (("--refine", "45"), "--refine 45: expected 0 to 10 degrees"),
        (("--seed", "-1"), "--seed -1: expected 0 or more"),
        (("--lpips-weights", "absent.pth"), "absent.pth: there is no such file"),
    ],
)
def test_a_wrong_option_is_a_sentence(capture: Path, teach: Teach, options: tuple[str, str], sentence: str) -> None:
    assert sentence in teach(capture, *options).sentence


@pytest.mark.parametrize(
    ("file", "content", "sentence"),
    [
        ("teacher.json", b"{", "is damaged"),
        ("teacher.json", b'{"format": "x", "version": 1}', "format is 'x'"),
        ("weights.pt", b"half", "does not hold the weights"),
        ("teacher.json", None, "holds no teacher.json"),
    ],
)
def test_a_damaged_teacher_is_a_sentence(
    made: Path, tmp_path: Path, file: str, content: bytes | None, sentence: str
) -> None:
    for name in ("teacher.json", "rig.npz", "weights.pt"):
        (tmp_path / name).write_bytes((made / name).read_bytes())
    if content is None:
        (tmp_path / file).unlink()
    else:
        (tmp_path / file).write_bytes(content)
    with pytest.raises(InputError, match=sentence):
        TrainedTeacher(tmp_path)


def test_weights_hold_nothing_but_tensors(made: Path) -> None:
    state = torch.load(made / "weights.pt", weights_only=True)
    assert all(isinstance(value, torch.Tensor) for value in state.values())
