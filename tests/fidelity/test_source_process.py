"""Faces of a file that a process draws beside this one."""

import shutil
from pathlib import Path

import numpy as np
import pytest
from face_files import grinning

from mua.atlas.character_surfaces import Surfaces
from mua.characters.read import read_surfaces
from mua.fidelity import source_process
from mua.fidelity.canvas import opened
from mua.fidelity.source_faces import source_faces
from mua.fidelity.source_pose import Poser
from mua.fidelity.source_process import SourceProcess


@pytest.fixture
def surfaces(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Surfaces:
    """Two expressions, which are as many as a process starts for."""
    monkeypatch.setattr(source_process, "FEWEST", 2)
    return read_surfaces(grinning(tmp_path))


def test_the_process_draws_what_this_one_would(surfaces: Surfaces) -> None:
    source, expressions = surfaces.source, surfaces.expressions
    assert source is not None
    assert expressions is not None
    with SourceProcess() as process:
        process.begin(surfaces)
        drawn = process.images()
    rest = Poser(source, surfaces.skeleton).rest()
    with opened() as context:
        here = list(source_faces(context, source.scene, rest, expressions.names))
    assert drawn is not None
    np.testing.assert_array_equal(drawn, here)
    assert not np.array_equal(drawn[0], drawn[1])


def test_few_expressions_are_left_to_be_drawn_here(surfaces: Surfaces, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(source_process, "FEWEST", 3)
    monkeypatch.delattr(source_process.subprocess, "Popen")
    with SourceProcess() as process:
        process.begin(surfaces)
        assert process.images() is None


@pytest.mark.parametrize("program", [shutil.which("false"), "/no/such/program"])
def test_where_the_process_fails_all_is_left_to_be_drawn_here(
    surfaces: Surfaces, monkeypatch: pytest.MonkeyPatch, program: str
) -> None:
    monkeypatch.setattr(source_process.sys, "executable", program)
    with SourceProcess() as process:
        process.begin(surfaces)
        assert process.images() is None
