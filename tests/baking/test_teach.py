"""mua-teach: what it leaves, what it tells, and the teacher that comes of it."""

import errno
import json
import os
import re
import shutil
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import torch
from captures import FRAMES, make_capture
from commands import Commands, Ended
from PIL import Image
from small_teachers import FEW

import mua
from mua.baking import teacher_stages
from mua.capture import open_capture
from mua.capture.silhouette import posed_template
from mua.capture.write import write_capture
from mua.channels import CHANNELS
from mua.errors import InputError
from mua.teacher import TeacherFrame
from mua.teachers.trained import settings
from mua.teachers.trained.folder import load_teacher, save_teacher
from mua.teachers.trained.teacher import TrainedTeacher
from mua.teachers.trained.template_training import TemplateSettings, TemplateWeights
from mua.training.schedule import Schedule

TEXELS = 64
OPTIONS = ("--texels", str(TEXELS), "--steps", "3")
Teach = Callable[..., Ended]


@pytest.fixture(scope="module")
def capture(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return make_capture(tmp_path_factory.mktemp("capture")).folder


@pytest.fixture(scope="module")
def made(capture: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A teacher of a few steps; tests leave it as it is."""
    folder = tmp_path_factory.mktemp("trained") / "teacher"
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
    monkeypatch.setattr(teacher_stages, "TEMPLATE", replace(TemplateSettings(), nodes=few, offsets=few))
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
    few, none = Schedule(steps=30, batch=1, lr=5e-2), TemplateWeights(silhouette=0.0)
    monkeypatch.setattr(teacher_stages, "TEMPLATE", replace(TemplateSettings(), nodes=few, offsets=few, weights=none))
    monkeypatch.setitem(settings.PRESETS, "tiny", FEW)
    teacher = TrainedTeacher(mua.teach(tmp_path, output=tmp_path / "t", steps=1, texels=TEXELS, drivable=True))
    (frame,) = (one for one in teacher.frames(given.motion("walk"), {2}) if isinstance(one, TeacherFrame))
    assert (frame.mesh - teacher.rig.mesh.vertices).mean(axis=0)[0] == pytest.approx(0.05, abs=0.025)


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


class Until:
    """A listener that does something after a step of the last stage."""

    def __init__(self, step: int, do: Callable[[], object]) -> None:
        self._at, self._do, self._stage = step, do, ""

    def stage(self, name: str) -> None:
        self._stage = name

    def step(self, done: int, total: int, *, detail: str = "") -> None:
        if (self._stage, done) == ("texels", self._at):
            self._do()

    def note(self, sentence: str) -> None: ...


def copied(capture: Path, folder: Path) -> Path:
    """A capture that a test may spoil."""
    shutil.copytree(capture, folder)
    return folder


def test_pictures_that_vanish_are_named_and_what_was_trained_is_kept(
    capture: Path, made: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(settings.PRESETS, "tiny", FEW)
    given, output = copied(capture, tmp_path / "capture"), tmp_path / "teacher"
    images = given / "images" / "walk"
    hide = Until(1, lambda: images.rename(images.with_name("hidden")))
    with pytest.raises(InputError, match=r"^camera (front|left|right), clip walk, frame \d: .*\.png: there is no such"):
        mua.teach(given, output=output, steps=3, texels=TEXELS, listener=hide)
    assert (output / "work" / "mean texture.pt").is_file()
    images.with_name("hidden").rename(images)
    trained: list[int] = []
    again = Until(3, lambda: trained.append(3))
    mua.teach(given, output=output, steps=3, texels=TEXELS, listener=again)
    assert (output / "weights.pt").read_bytes() == (made / "weights.pt").read_bytes()


def test_a_full_disk_keeps_what_was_trained(
    capture: Path, made: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(settings.PRESETS, "tiny", FEW)
    save = torch.save

    def full(state: Any, file: Any) -> None:
        raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))

    fill = Until(1, lambda: monkeypatch.setattr(torch, "save", full))
    with pytest.raises(InputError, match=r"texels\.pt: .*No space left on device"):
        mua.teach(capture, output=tmp_path, steps=3, texels=TEXELS, listener=fill)
    monkeypatch.setattr(torch, "save", save)
    assert (tmp_path / "work" / "mean texture.pt").is_file()
    mua.teach(capture, output=tmp_path, steps=3, texels=TEXELS)
    assert (tmp_path / "weights.pt").read_bytes() == (made / "weights.pt").read_bytes()


def spoilt_pictures(capture: Path, change: Callable[[Image.Image], Image.Image | None], camera: str = "*") -> None:
    """Change the images of a camera; None takes them away."""
    for file in capture.glob(f"images/*/{camera}/*.png"):
        with Image.open(file) as opened:
            changed = change(opened.copy())
        if changed is None:
            file.unlink()
        else:
            changed.save(file)


def test_masks_that_are_all_empty_are_a_sentence(capture: Path, tmp_path: Path, teach: Teach) -> None:
    given = copied(capture, tmp_path / "capture")

    def empty(image: Image.Image) -> Image.Image:
        image.putalpha(0)
        return image

    spoilt_pictures(given, empty)
    ended = teach(given, "-o", tmp_path / "teacher", *OPTIONS)
    assert re.search(r"front/\d+\.png: none of \d+ masks .* shows the posed template", ended.sentence)
    assert not (tmp_path / "teacher" / "teacher.json").exists()


def test_missing_pictures_are_said_once_and_do_not_end_the_training(
    capture: Path, tmp_path: Path, teach: Teach
) -> None:
    given = copied(capture, tmp_path / "capture")
    spoilt_pictures(given, lambda image: None, "left")
    ended = teach(given, "-o", tmp_path / "teacher", *OPTIONS)
    assert ended.status == 0, ended
    said = re.findall(
        r"Camera left: has no images: there is no .*\.png\. .* count nowhere\.", " ".join(ended.out.split())
    )
    assert len(said) == 1, ended.out
    assert (tmp_path / "teacher" / "teacher.json").is_file()


def test_a_capture_without_any_picture_is_a_sentence(capture: Path, tmp_path: Path, teach: Teach) -> None:
    given = copied(capture, tmp_path / "capture")
    spoilt_pictures(given, lambda image: None)
    assert re.search(r"\.png: there is no such file", teach(given, "-o", tmp_path / "teacher", *OPTIONS).sentence)


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
    ],
)
def test_a_damaged_teacher_is_a_sentence(made: Path, tmp_path: Path, file: str, content: bytes, sentence: str) -> None:
    for name in ("teacher.json", "rig.npz", "weights.pt"):
        (tmp_path / name).write_bytes((made / name).read_bytes())
    (tmp_path / file).write_bytes(content)
    with pytest.raises(InputError, match=sentence):
        TrainedTeacher(tmp_path)


def test_the_bytes_of_a_teacher_do_not_tell_which_process_wrote_them(
    made: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    model, description = load_teacher(made)
    monkeypatch.setattr(os, "getpid", lambda: 123_456_789)
    save_teacher(tmp_path, model, description)
    for name in ("teacher.json", "rig.npz", "weights.pt"):
        assert (tmp_path / name).read_bytes() == (made / name).read_bytes(), name


def test_weights_hold_nothing_but_tensors(made: Path) -> None:
    state = torch.load(made / "weights.pt", weights_only=True)
    assert all(isinstance(value, torch.Tensor) for value in state.values())
