"""Meshes of a capture: read, refused, and what mua-teach makes of them."""

import json
import shutil
from collections.abc import Sequence
from dataclasses import replace
from functools import partial
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
import torch
import trimesh
from captures import make_capture
from small_teachers import FEW
from synthetic_avatar import synthetic_avatar

import mua
from mua.arrays import Array
from mua.baking import teacher_stages
from mua.capture import Capture, open_capture
from mua.errors import InputError
from mua.kernels.dq_skinning import blend_vertices
from mua.rig.bones import PERSON
from mua.rotation import dual_transform
from mua.teachers.trained import frame_surfaces, settings
from mua.teachers.trained.drivable_template import Undeformed
from mua.teachers.trained.folder import load_teacher
from mua.teachers.trained.frame_surfaces import MeasuredSurfaces, measured_surfaces, read_surface, unit_of
from mua.teachers.trained.motion_deformation import MotionDeformation
from mua.teachers.trained.teacher import TrainedTeacher
from mua.teachers.trained.template_training import TemplateSettings
from mua.teachers.trained.windows import windows
from mua.training.schedule import Schedule

CORNERS = np.array([[0.0, 0, 0], [1, 0, 0], [0, 1, 0], [0, 0, 1]])
TRIANGLES = [(0, 2, 1), (0, 1, 3), (1, 2, 3)]


def write_ply(path: Path, vertices: Array, faces: Array | Sequence[Sequence[int]] = TRIANGLES) -> Path:
    """As text, of the plainest kind."""
    rows = [" ".join(map(str, row)) for row in vertices] + [f"{len(face)} {' '.join(map(str, face))}" for face in faces]
    header = ["ply", "format ascii 1.0", f"element vertex {len(vertices)}", *(f"property float {a}" for a in "xyz")]
    header += [f"element face {len(faces)}", "property list uchar int vertex_indices", "end_header"]
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text("\n".join([*header, *rows, ""]))
    return path


def assert_shape(path: Path) -> None:
    mesh = read_surface(path)
    np.testing.assert_array_equal(mesh.vertices, CORNERS)
    np.testing.assert_array_equal(mesh.faces, TRIANGLES)


def test_a_surface_is_what_the_file_holds(tmp_path: Path) -> None:
    assert_shape(write_ply(tmp_path / "a.ply", CORNERS))


@pytest.mark.parametrize("name", ["a.ply", "a.obj"])
def test_a_surface_is_what_another_program_wrote(tmp_path: Path, name: str) -> None:
    trimesh.Trimesh(CORNERS, TRIANGLES, process=False).export(tmp_path / name)
    assert_shape(tmp_path / name)


def test_squares_are_cut_into_triangles(tmp_path: Path) -> None:
    mesh = read_surface(write_ply(tmp_path / "a.ply", CORNERS, [(0, 1, 2, 3)]))
    np.testing.assert_array_equal(mesh.faces, [(0, 1, 2), (2, 3, 0)])


def test_rejects_surface_that_ends_early(tmp_path: Path) -> None:
    path = tmp_path / "a.ply"
    trimesh.Trimesh(CORNERS, TRIANGLES, process=False).export(path)
    whole = path.read_bytes()
    for length in range(0, len(whole), 7):
        path.write_bytes(whole[:length])
        with pytest.raises(InputError, match=r"a\.ply: "):
            read_surface(path)


@pytest.mark.parametrize(
    ("vertices", "faces", "sentence"),
    [
        (CORNERS, [(0, 1, 4)], "names vertex 4; there are 4"),
        (CORNERS, [(0, 1, 2), (0, -1, 3)], "names vertex -1; there are 4"),
        (CORNERS, [(0, 1), (1, 2)], "triangles"),
        (np.full((4, 3), np.nan), TRIANGLES, "expected triangles between finite vertices"),
    ],
    ids=["no such vertex", "negative", "lines", "nan"],
)
def test_rejects_surface_with_bad_indices(
    tmp_path: Path, vertices: Array, faces: Sequence[Sequence[int]], sentence: str
) -> None:
    with pytest.raises(InputError, match=sentence):
        read_surface(write_ply(tmp_path / "a.ply", vertices, faces))


@pytest.mark.parametrize("content", [b"", b"solid", b"ply\nformat ascii 1.0\nend_header\n"])
def test_rejects_file_that_is_no_surface(tmp_path: Path, content: bytes) -> None:
    path = tmp_path / "a.ply"
    path.write_bytes(content)
    with pytest.raises(InputError, match=r"a\.ply: "):
        read_surface(path)


@pytest.mark.parametrize("unit", [1.0, 0.001])
def test_surfaces_may_be_in_millimetres(tmp_path: Path, unit: float) -> None:
    template = CORNERS * 1.7 + [0.4, 0, -0.3]
    file = write_ply(tmp_path / "a.ply", (template + 0.02) / unit)
    assert unit_of(file, template) == unit
    surfaces = MeasuredSurfaces(torch.zeros(1, 6), torch.zeros(1, 1, 8), (file,), 1.0, unit)
    cloud = surfaces.observe(0, torch.Generator()).cloud
    assert cloud is not None
    np.testing.assert_allclose(cloud.points.max(axis=0), (template + 0.02).max(axis=0), atol=0.1)


@pytest.mark.parametrize("vertices", [CORNERS * 0.5, CORNERS * 8.5 - 3.4, CORNERS * 1.7 + [0, 3.0, 0]])
def test_rejects_surfaces_of_another_world(tmp_path: Path, vertices: Array) -> None:
    with pytest.raises(InputError, match="expected metres or millimetres in the world of the cameras"):
        unit_of(write_ply(tmp_path / "a.ply", vertices), CORNERS * 1.7)


def surfaces_of(folder: Path, count: int) -> MeasuredSurfaces:
    """Frames whose surfaces differ in size."""
    files = tuple(write_ply(folder / f"{frame}.ply", CORNERS * (1 + frame)) for frame in range(count))
    return MeasuredSurfaces(torch.zeros(count, 6), torch.zeros(count, 1, 8), files, 1.0)


def test_a_surface_is_measured_by_the_size_of_the_figure(tmp_path: Path) -> None:
    """The size decides how much normals count beside distances."""
    avatar = synthetic_avatar()
    rig, large = avatar.rig, replace(avatar.rig, mesh=replace(avatar.rig.mesh, vertices=4 * avatar.rig.mesh.vertices))
    for own in (rig, large):
        joints = own.skeleton.skinning(avatar.clips[0].rotations[:1], avatar.clips[0].translations[:1])[0]
        posed = dual_transform(blend_vertices(joints, own.skin_indices, own.skin_weights), own.mesh.vertices)
        file = write_ply(tmp_path / "a.ply", posed, own.mesh.faces)
        capture = SimpleNamespace(meshes="", place=lambda *_, file=file, **__: file)
        subject = SimpleNamespace(rig=own)
        seen = partial(windows, own.skeleton, avatar.encoding)
        filmed = SimpleNamespace(capture=capture, subject=subject, clips=avatar.clips, windows=seen)
        surfaces = measured_surfaces(filmed)  # type: ignore[arg-type]
        assert surfaces is not None
        cloud = surfaces.observe(0, torch.Generator()).cloud
        assert cloud is not None
        assert cloud.size == surfaces.size == pytest.approx(np.ptp(own.mesh.vertices, axis=0).max() / PERSON)


def test_a_surface_is_read_once_for_all_steps(tmp_path: Path) -> None:
    surfaces, generator = surfaces_of(tmp_path, 2), torch.Generator()
    first = [surfaces.observe(frame, generator).cloud for frame in range(2)]
    for file in surfaces.files:
        file.unlink()
    assert [surfaces.observe(frame, generator).cloud for frame in range(2)] == first
    sizes = [cloud.points.max() for cloud in first if cloud is not None]
    assert sizes[1] > 1 > sizes[0] > 0.9


def test_no_more_surfaces_are_held_than_there_is_room_for(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(frame_surfaces, "KEPT", 2)
    surfaces, generator = surfaces_of(tmp_path, 3), torch.Generator()
    for frame in range(3):
        surfaces.observe(frame, generator)
    for file in surfaces.files:
        file.unlink()
    surfaces.observe(2, generator)
    with pytest.raises(InputError, match=r"0\.ply"):
        surfaces.observe(0, generator)


@pytest.fixture
def measured_capture(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Capture:
    """A capture with meshes, and trainings of a few steps."""
    monkeypatch.setitem(settings.PRESETS, "tiny", FEW)
    few = Schedule(steps=2, batch=1, lr=1e-2)
    monkeypatch.setattr(teacher_stages, "TEMPLATE", TemplateSettings(nodes=few, offsets=few, samples=300))
    folder = make_capture(tmp_path / "capture").folder
    said = json.loads((folder / "capture.json").read_text())
    said["meshes"] = "meshes/{clip}/{frame:06d}.ply"
    (folder / "capture.json").write_text(json.dumps(said))
    capture = open_capture(folder)
    for clip in capture.clips:
        for frame in range(clip.frames):
            write_ply(capture.place(said["meshes"], clip=clip.name, frame=frame), CORNERS)
    return capture


def test_a_capture_with_meshes_trains_how_the_template_deforms(measured_capture: Capture, tmp_path: Path) -> None:
    folder = measured_capture.folder
    model, described = load_teacher(mua.teach(folder, output=tmp_path / "teacher", steps=1, texels=64))
    assert described.settings.drivable is True
    deformation = model.template.deformation
    assert isinstance(deformation, MotionDeformation)
    rest = torch.as_tensor(model.rig.mesh.vertices).float()
    assert (deformation(torch.zeros(1, described.encoding.width)) - rest).abs().max() > 1e-6
    still = TrainedTeacher(tmp_path / "teacher", moving=False).model.template.deformation
    torch.testing.assert_close(still(torch.zeros(1, 1))[0], rest)


def test_a_missing_mesh_is_named(measured_capture: Capture, tmp_path: Path) -> None:
    training = next(clip for clip in measured_capture.clips if not clip.held_out)
    missing = measured_capture.place(str(measured_capture.meshes), clip=training.name, frame=1)
    missing.unlink()
    with pytest.raises(InputError, match=f"{missing.name}: there is no such file"):
        mua.teach(measured_capture.folder, output=tmp_path / "teacher", steps=1, texels=64)


def test_meshes_can_be_left_out_of_the_training(measured_capture: Capture, tmp_path: Path) -> None:
    shutil.rmtree(measured_capture.folder / "meshes")
    teacher = mua.teach(measured_capture.folder, output=tmp_path / "teacher", steps=1, texels=64, drivable=False)
    assert isinstance(load_teacher(teacher)[0].template.deformation, Undeformed)
