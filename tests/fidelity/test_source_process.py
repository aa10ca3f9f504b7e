"""A character and its faces that a process draws beside this one."""

import shutil
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from face_files import grinning

from mua.atlas.character_surfaces import Surfaces
from mua.atlas.uv import build_atlas
from mua.baking.check import fidelity_of
from mua.characters.read import read_surfaces
from mua.fidelity import compare, faces, source_process
from mua.fidelity.canvas import opened
from mua.fidelity.compare import face_of, sittings_of
from mua.fidelity.source_faces import source_faces
from mua.fidelity.source_poses import source_poses
from mua.fidelity.source_process import SourceProcess
from mua.fidelity.splat_faces import SplatFaces
from mua.teachers.simulated.still import StillTeacher


@pytest.fixture
def surfaces(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Surfaces:
    """Two expressions, which are as many as a process starts for."""
    monkeypatch.setattr(source_process, "FEW", 2)
    return read_surfaces(grinning(tmp_path))


def test_the_process_draws_what_this_one_would(surfaces: Surfaces, monkeypatch: pytest.MonkeyPatch) -> None:
    source, expressions = surfaces.source, surfaces.expressions
    assert source is not None
    assert expressions is not None
    monkeypatch.setattr(source_process, "LARGE", 0)
    with SourceProcess() as process:
        process.expect(Path(__file__))
        begun = process._process
        process.begin(surfaces)
        assert process._process is begun is not None
        character = build_atlas(surfaces, uv="auto", size=256)
        sittings = sittings_of(character, character.clips, source)
        process.draw_poses(sittings)
        rest = sittings[0].moment
        face = face_of(StillTeacher(character, texels=96), source.scene, rest)
        assert face is not None
        process.draw_faces_of(face)
        answers, poses = [list(process.faces()), [process._splat_faces.get() for _ in range(3)]], list(process.poses())
    with opened() as context:
        np.testing.assert_array_equal(poses, list(source_poses(context, source.scene, sittings)))
        splats = SplatFaces(context, face)
        here = list(source_faces(context, source.scene, rest, expressions.names)), [*map(splats.patch, range(3))]
    for drawn, expected in zip(answers, here, strict=True):
        assert [patch.area for patch in drawn] == [patch.area for patch in expected]
        for patch, other in zip(drawn, expected, strict=True):
            np.testing.assert_array_equal(patch.image, other.image)
        assert not np.array_equal(drawn[1].image, drawn[1].area.of(drawn[0].image))


def test_nothing_that_the_process_draws_is_drawn_here(surfaces: Surfaces, monkeypatch: pytest.MonkeyPatch) -> None:
    def nothing(*_: object) -> Iterator[Any]:
        raise AssertionError
        yield

    for module, name in ((compare, "source_poses"), (faces, "source_faces")):
        monkeypatch.setattr(module, name, nothing)
    with SourceProcess() as process:
        process.begin(surfaces)
        fidelity, _ = fidelity_of(build_atlas(surfaces, uv="auto", size=256), (), texels=96, process=process)
    assert fidelity is not None
    assert fidelity.face is not None
    assert len(fidelity.face.expressions) == 2


def test_a_character_of_many_triangles_is_drawn_by_the_process(
    surfaces: Surfaces, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(source_process, "SMALL", len(surfaces.faces))
    plain = replace(surfaces, expressions=None)
    assert plain.source is not None
    with SourceProcess() as process:
        process.begin(plain)
        sittings = sittings_of(build_atlas(plain, uv="auto", size=256), (), plain.source)
        process.draw_poses(sittings)
        assert len(list(process.poses())) == sum(len(sitting.views) for sitting in sittings)


def test_little_is_left_to_be_drawn_here(surfaces: Surfaces, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(source_process, "FEW", 3)
    monkeypatch.delattr(source_process.subprocess, "Popen")
    with SourceProcess() as process:
        process.expect(Path("no/such/file"))
        process.expect(Path(__file__))
        process.begin(surfaces)
        assert not list(process.faces())


def test_a_process_for_a_large_file_with_little_to_draw_ends(
    surfaces: Surfaces, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(source_process, "FEW", 3)
    monkeypatch.setattr(source_process, "LARGE", 0)
    with SourceProcess() as process:
        process.expect(Path(__file__))
        started = process._process
        process.begin(surfaces)
        assert started is not None
        assert started.poll() is not None
        assert not list(process.faces())


@pytest.mark.parametrize("program", [shutil.which("false"), "/no/such/program"])
def test_where_the_process_fails_all_is_left_to_be_drawn_here(
    surfaces: Surfaces, monkeypatch: pytest.MonkeyPatch, program: str
) -> None:
    monkeypatch.setattr(source_process.sys, "executable", program)
    with SourceProcess() as process:
        process.begin(surfaces)
        assert not list(process.faces())
