"""Whatever is written over an older file replaces it: who has the older one open reads it to its end."""

import os
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace

import pytest
from captures import ring
from commands import Commands
from PIL import Image
from synthetic_avatar import synthetic_avatar

import mua
from mua.baking import check, distillation
from mua.baking.settings import BakeSettings
from mua.capture import Capture, CaptureClip, write_capture
from mua.files import png
from mua.motion.mapping import write_mapping
from mua.motion.poses_file import write_poses
from mua.recording.rig_file import write_rig
from mua.student.settings import preset
from mua.training.checkpoint import Checkpoints

AVATAR = synthetic_avatar()
OLD = b"what was there"


@pytest.fixture
def opened(tmp_path: Path) -> Callable[[str], Path]:
    """Lays an older file, which somebody has open, at a name."""

    def lay(name: str) -> Path:
        path, reader = tmp_path / name, tmp_path / f"{name}.reader"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(OLD)
        os.link(path, reader)
        return path

    return lay


def replaced(path: Path) -> bool:
    return path.read_bytes() != OLD and Path(f"{path}.reader").read_bytes() == OLD


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("a.ply", ("export",)),
        ("a.spz", ("export",)),
        ("a.glb", ("export",)),
        ("a.usda", ("export",)),
        ("a.bvh", ("export",)),
        ("sequence/frame_0000.ply", ("export", "--frames", "0:2")),
        ("a.png", ("view", "--reference", "--size", "32x32")),
        ("a.html", ("share", "--single-file", "--reference")),
        ("packed.muaavatar", ("pack",)),
    ],
)
def test_what_a_command_writes(
    opened: Callable[[str], Path], command: Commands, avatar_file: Path, name: str, words: tuple[str, ...]
) -> None:
    path = opened(name)
    output = path.parent if "/" in name else path
    ended = command(words[0], avatar_file, *words[1:], "-o", output)
    assert (ended.status, replaced(path)) == (0, True), ended.err


def test_what_a_check_of_a_character_writes(opened: Callable[[str], Path], tmp_path: Path) -> None:
    found = check.Check(None, (), (), (), (), (), ())
    png.write_png(opened("a_check.png"), Image.new("RGB", (2, 2)))
    settings = BakeSettings(tmp_path / "a.muaavatar", tmp_path, preset("tiny"))
    check.write_json(opened("a.json"), check.as_dict(settings, found))
    assert replaced(tmp_path / "a_check.png")
    assert replaced(tmp_path / "a.json")


def test_the_picture_of_a_bake(opened: Callable[[str], Path], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(distillation, "contact_sheet", lambda *_, **__: Image.new("RGB", (2, 2)))
    recording = SimpleNamespace(whole_count=1, whole_frames=lambda held_out: iter([0]))
    path = opened("a_contact_sheet.png")
    distillation._picture(path, AVATAR, recording, None)  # type: ignore[arg-type]
    assert replaced(path)


@pytest.mark.parametrize(
    ("name", "write"),
    [
        ("a.muaavatar", lambda path: mua.save(path, AVATAR)),
        ("mapping.json", lambda path: write_mapping(path, (), ("hips",))),
        ("walk.npz", lambda path: write_poses(path, AVATAR.rig.skeleton, AVATAR.clips[0])),
        ("rig.npz", lambda path: write_rig(path, AVATAR.rig)),
        ("stage.pt", lambda path: Checkpoints(path.parent, "key").save("stage", {})),
        (
            "capture.json",
            lambda path: write_capture(
                Capture(
                    path.parent, "figure", 30.0, path, tuple(ring()), (CaptureClip("walk", path, 0, 2),),
                    "{camera}/{frame}.png",
                )
            ),
        ),
    ],
)  # fmt: skip
def test_what_the_package_writes(opened: Callable[[str], Path], name: str, write: Callable[[Path], None]) -> None:
    path = opened(name)
    write(path)
    assert replaced(path)
