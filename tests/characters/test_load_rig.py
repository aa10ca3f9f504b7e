"""mua.load_rig: the rig of a character's file, on its own mesh or a simplified one, and what is refused."""

from pathlib import Path
from typing import Any

import gltf_files
import numpy as np
import pytest
from shared_data import SharedData

import mua
from mua.recording.plausible import rig_findings


@pytest.fixture
def column(tmp_path: Path) -> Path:
    return gltf_files.body().save(tmp_path / "column.glb")


def test_the_template_is_the_files_own_mesh_with_its_own_uvs(column: Path) -> None:
    rig = mua.load_rig(str(column), texels=32)
    bound = gltf_files.FLOAT_BOUND
    np.testing.assert_allclose(rig.mesh.vertices[rig.mesh.faces], gltf_files.POINTS[gltf_files.TRIANGLES], atol=bound)
    np.testing.assert_allclose(rig.mesh.uv[rig.mesh.uv_faces], gltf_files.UV[gltf_files.TRIANGLES], atol=bound)
    assert rig.texels.size == 32
    assert list(rig_findings(rig)) == []


def test_a_writer_takes_it(column: Path, tmp_path: Path) -> None:
    rig = mua.load_rig(column, texels=32)
    with mua.TeacherWriter(tmp_path / "recording", rig, rate=30) as writer:
        writer.start_clip("rest")
        writer.add(rig.skeleton.bind_pose, frame=0)
    assert [clip.name for clip in mua.Recording(tmp_path / "recording").clips] == ["rest"]


def test_a_file_in_another_unit_is_given_its_height(column: Path) -> None:
    rig = mua.load_rig(column, texels=32, height=0.5)
    assert np.ptp(rig.mesh.vertices[:, 1]) == pytest.approx(0.5, rel=1e-6)


def test_a_real_character_is_kept_or_simplified(shared_data: SharedData) -> None:
    path = shared_data.path("characters/Fox.glb")
    whole, simple = mua.load_rig(path, texels=64), mua.load_rig(path, texels=64, vertices=120)
    assert len(simple.mesh.vertices) < 180 < len(whole.mesh.vertices)
    assert np.array_equal(simple.skeleton.bind_translations, whole.skeleton.bind_translations)


WRONG: dict[str, tuple[dict[str, Any], str]] = {
    "texels that cannot be halved": ({"texels": 100}, "texels is 100, expected a multiple of 16"),
    "no texels": ({"texels": 0}, "texels is 0, expected a multiple of 16"),
    "half a texel": ({"texels": 31.5}, "texels is 31.5"),
    "no vertices": ({"vertices": 2}, "vertices is 2, expected at least 3"),
    "another word": ({"uv": "own"}, "uv is 'own'; expected keep, unwrap, auto"),
    "a height of nothing": ({"height": 1e-4}, "height is 0.0001 .float.; expected 0.01 to 100 metres"),
    "a part that is not there": ({"leave_out": ("hat",)}, "hat"),
}


@pytest.mark.parametrize("name", WRONG)
def test_what_cannot_be_meant_is_refused(column: Path, name: str) -> None:
    options, expected = WRONG[name]
    with pytest.raises(mua.InputError, match=expected):
        mua.load_rig(column, **options)


@pytest.mark.parametrize(("path", "expected"), [(3, "character is 3"), ("none.glb", "there is no such file")])
def test_a_character_that_is_no_file_is_refused(path: Any, expected: str) -> None:
    with pytest.raises(mua.InputError, match=expected):
        mua.load_rig(path)
