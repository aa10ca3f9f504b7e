"""docs/python.md: its examples run as they stand, in a folder with the files that they name."""

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from PIL import Image
from python_blocks import python_blocks
from synthetic_avatar import synthetic_avatar
from trainings import SMALL

import mua
from mua.baking import pipeline
from mua.baking.settings import BakeSettings
from mua.student.settings import PRESETS

PAGE = Path(__file__).resolve().parents[2] / "docs" / "python.md"
READING, CAMERA, BAKING, TRAINING, _ = python_blocks(PAGE)
LINES = 10  # most lines of the first example


def walking_avatar() -> mua.Avatar:
    """With a clip of the name and length that the page has."""
    avatar = synthetic_avatar()
    walk = replace(avatar.clips[0].cut(np.arange(13) % len(avatar.clips[0])), name="walk")
    return replace(avatar, clips=(walk,))


def test_the_example_reads_decodes_draws_and_saves(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    avatar = walking_avatar()
    mua.save("hero.muaavatar", avatar)
    names: dict[str, object] = {}
    exec(READING, names)
    exec(CAMERA, names)
    printed = capsys.readouterr().out.splitlines()
    assert printed[0] == repr(avatar)
    assert printed[1] == f"{avatar.clips!r}"
    with Image.open("hero.png") as hero, Image.open("standing.png") as standing:
        assert (hero.size, standing.size) == ((480, 720), (640, 960))
        assert np.asarray(hero).std() > 0
        assert standing.getpixel((0, 0)) == (0x20, 0x20, 0x20)
    with Image.open("head.png") as head:
        assert head.size == (512, 512)
    assert mua.load("hero_small.muaavatar").name == avatar.name
    assert len([line for line in READING.splitlines() if line and not line.startswith("import")]) <= LINES


def test_what_the_readme_shows_runs_after_the_demo(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    avatar = synthetic_avatar()
    dance = replace(avatar.clips[0].cut(np.arange(21) % len(avatar.clips[0])), name="dance")
    Path("build/demo").mkdir(parents=True)
    mua.save("build/demo/avatar.muaavatar", replace(avatar, clips=(dance,)))
    (lines,) = python_blocks(PAGE.parents[1] / "README.md")
    exec(lines, {})
    with Image.open("dance.png") as dancing:
        assert dancing.size == (480, 720)
        assert np.asarray(dancing).std() > 0
    assert len([line for line in lines.splitlines() if line]) <= 5


def test_a_bake_is_ordered_as_shown(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """The bake itself takes minutes; here it is only ordered."""
    monkeypatch.chdir(tmp_path)
    Path("hero.glb").write_bytes(b"glTF")
    Path("walks").mkdir()
    Path("walks/walk_07.bvh").write_text("HIERARCHY")
    given: list[BakeSettings] = []
    errors = {"training": SimpleNamespace(explained=lambda attribute: {"SH": 0.9}[attribute])}

    def bake(settings: BakeSettings, _: object) -> SimpleNamespace:
        given.append(settings)
        return SimpleNamespace(errors=errors)

    monkeypatch.setattr(pipeline, "bake", bake)
    exec(BAKING, {})
    (settings,) = given
    assert (settings.motions, settings.hold_out, settings.detail) == ((Path("walks"),), ("walk_07",), {"head": 3})


def test_a_recording_is_read_and_distilled_as_shown(
    written: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setitem(PRESETS, "tiny", SMALL)
    Path("recordings").mkdir()
    Path("recordings/subject01").symlink_to(written)
    exec(TRAINING, {})
    recording = mua.Recording("recordings/subject01")
    assert f"{recording.count()} training" in capsys.readouterr().out
    assert mua.load("subject01.muaavatar").rig.texels.size == recording.rig.texels.size
