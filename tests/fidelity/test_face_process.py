"""Faces that a process draws beside this one."""

import shutil
from pathlib import Path

import numpy as np
import pytest
from face_files import grinning

from mua.atlas.surfaces import Surfaces
from mua.atlas.uv import build_atlas
from mua.characters.read import read_surfaces
from mua.fidelity import face_process
from mua.fidelity.canvas import opened
from mua.fidelity.compare import face_of
from mua.fidelity.face_process import FaceProcess
from mua.fidelity.posing import Poser
from mua.fidelity.source_faces import source_faces
from mua.fidelity.splat_faces import splat_faces
from mua.teachers.simulated.still import StillTeacher


@pytest.fixture
def surfaces(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Surfaces:
    """Two expressions, which are as many as a process starts for."""
    monkeypatch.setattr(face_process, "FEWEST", 2)
    return read_surfaces(grinning(tmp_path))


def test_the_process_draws_what_this_one_would(surfaces: Surfaces) -> None:
    source, expressions = surfaces.source, surfaces.expressions
    assert source is not None
    assert expressions is not None
    with FaceProcess() as process:
        process.begin(surfaces)
        rest = Poser(source, surfaces.skeleton).rest()
        teacher = StillTeacher(build_atlas(surfaces, uv="auto", size=256), texels=96)
        face = face_of(teacher, source.scene, rest)
        assert face is not None
        process.go_on(face)
        answers = list(process.source()), list(process.splats())
    with opened() as context:
        here = list(source_faces(context, source.scene, rest, expressions.names)), list(splat_faces(context, face))
    for drawn, expected in zip(answers, here, strict=True):
        assert [patch.area for patch in drawn] == [patch.area for patch in expected]
        for patch, other in zip(drawn, expected, strict=True):
            np.testing.assert_array_equal(patch.image, other.image)
        assert not np.array_equal(drawn[1].image, drawn[1].area.of(drawn[0].image))


def test_few_expressions_are_left_to_be_drawn_here(surfaces: Surfaces, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(face_process, "FEWEST", 3)
    monkeypatch.delattr(face_process.subprocess, "Popen")
    with FaceProcess() as process:
        process.begin(surfaces)
        assert not list(process.source())


@pytest.mark.parametrize("program", [shutil.which("false"), "/no/such/program"])
def test_where_the_process_fails_all_is_left_to_be_drawn_here(
    surfaces: Surfaces, monkeypatch: pytest.MonkeyPatch, program: str
) -> None:
    monkeypatch.setattr(face_process.sys, "executable", program)
    with FaceProcess() as process:
        process.begin(surfaces)
        assert not list(process.source())
