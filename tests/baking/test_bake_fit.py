"""A bake fits the splats to its character's source before it records them."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from column_files import column_file
from silent import Silent

from mua.baking import pipeline
from mua.baking.settings import BakeSettings
from mua.errors import InputError
from mua.fidelity import fitting
from mua.student.settings import PRESETS
from mua.teachers.simulated.teacher import SimulatedTeacher

TINY = replace(PRESETS["tiny"], texels=32, frames=8)


class Recorded(Exception):
    """Ends a bake when its teacher is ready."""


@pytest.fixture
def keys() -> list[str]:
    """Those of the recordings."""
    return []


@pytest.fixture
def teachers(forked: None, keys: list[str], monkeypatch: pytest.MonkeyPatch) -> list[SimulatedTeacher]:
    made: list[SimulatedTeacher] = []

    def recorded(make_teacher: Callable[[], SimulatedTeacher], key: str, *_: object) -> None:
        made.append(make_teacher())
        keys.append(key)
        raise Recorded

    monkeypatch.setattr(pipeline, "recorded", recorded)
    monkeypatch.setattr(pipeline, "fidelity_of", lambda *_, **__: (None, ()))  # which takes seconds
    return made


class Notes(Silent):
    """Keeps what a bake says."""

    def __init__(self) -> None:
        self.all: list[str] = []

    def note(self, sentence: str) -> None:
        self.all.append(sentence)


def bake(tmp_path: Path) -> list[str]:
    settings = BakeSettings(
        tmp_path / "a.muaavatar",
        tmp_path / "work",
        TINY,
        "cpu",
        character=column_file(tmp_path),
        motion_range="none",
    )
    notes = Notes()
    with pytest.raises(Recorded):
        pipeline.bake(settings, notes)
    return notes.all


def nothing_to_draw_with() -> None:
    raise InputError("OpenGL is not there")


def test_the_teacher_holds_the_fit_and_a_second_bake_takes_it_from_the_work_directory(
    tmp_path: Path, teachers: list[SimulatedTeacher], keys: list[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    bake(tmp_path)
    (file,) = (tmp_path / "work").glob("fit-*.npy")
    corrections = np.load(file)
    assert corrections.any()
    monkeypatch.setattr(fitting, "fit", None)
    bake(tmp_path)
    file.unlink()
    monkeypatch.setattr(fitting, "fit", lambda *_, **__: nothing_to_draw_with())
    bake(tmp_path)
    assert keys[0] == keys[1] != keys[2]  # what is recorded without a fit is no recording of the fitted splats
    pose = teachers[0].rig.skeleton.bind_pose
    first, second, as_laid = (teacher.frame(pose).texture for teacher in teachers)
    assert np.array_equal(first, second)
    np.testing.assert_allclose((first - as_laid)[:, 7:10], corrections[:, 3:6], atol=1e-5)


def test_without_opengl_splats_stay_as_they_are_laid_and_a_note_says_so(
    tmp_path: Path, teachers: list[SimulatedTeacher], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(fitting, "opened", nothing_to_draw_with)
    assert any("were not fitted to the source: OpenGL is not there" in note for note in bake(tmp_path))
    assert not list((tmp_path / "work").glob("fit-*"))
    assert len(teachers) == 1
