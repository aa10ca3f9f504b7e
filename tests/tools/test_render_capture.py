"""Captures made by a renderer: its job, skipped images and errors. The renderer itself needs bpy."""

import importlib
import json
import os
import shutil
import sys
from dataclasses import asdict, replace
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from capture_fit import edge_distance, read_vertices
from capture_job import TRACKED, Order, job_file, prepare
from captures import make_capture
from PIL import Image
from render_capture import parser, render_capture, run_renderer

from mua import rotation
from mua.arrays import Array
from mua.atlas.chart_packing import TRIES
from mua.atlas.uv import build_atlas
from mua.baking.sources import load_clips
from mua.capture import open_capture
from mua.capture.tracks import read_tracks
from mua.errors import InputError
from mua.rig.surface_points import interpolate, spread_points
from mua.teachers.simulated.skinned_surface import SkinnedSurface

RADIANS = 1e-4


@pytest.fixture(scope="module")
def order(tmp_path_factory: pytest.TempPathFactory) -> Order:
    """A few images of the procedural character, without simulation."""
    folder = tmp_path_factory.mktemp("given")
    given = make_capture(folder)
    motions = tuple(str(clip.motion) for clip in given.clips)
    return Order(str(given.template), motions[:1], motions[1:], None, (), 3, 1, 32, 3, 2, 4, "studio", 0, still=True)


@pytest.fixture(scope="module")
def folder(order: Order, tmp_path_factory: pytest.TempPathFactory) -> Path:
    place = tmp_path_factory.mktemp("made")
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("capture_job.ATLAS", 128)
        patch.setattr("mua.atlas.chart_packing.TRIES", TRIES[:1])
        prepare(order, place)
    return place


def test_the_folder_is_a_capture_of_the_same_poses(order: Order, folder: Path) -> None:
    capture = open_capture(folder)
    character = build_atlas(capture.surfaces, uv="keep", size=16)
    assert [(clip.frames, clip.held_out) for clip in capture.clips] == [(3, False), (2, True)]
    given, _ = load_clips(character, [Path(name) for name in (*order.motion, *order.held_out_motion)], mapping=None)
    for clip, whole in zip(capture.clips, given, strict=True):
        poses = capture.motion(clip.name)
        wanted = whole.rotations[clip.first : clip.first + clip.frames]
        turns = rotation.multiply(rotation.conjugate(wanted), poses.rotations)
        assert 2 * np.linalg.norm(turns[..., 1:], axis=-1).max() < RADIANS


def test_true_surfaces_are_those_of_the_poses(folder: Path) -> None:
    capture = open_capture(folder)
    character = build_atlas(capture.surfaces, uv="keep", size=16)
    assert capture.clips
    for clip in capture.clips:
        surfaces = list(SkinnedSurface(character).frames(capture.motion(clip.name)))
        assert len(surfaces) == clip.frames
        for frame, moved in enumerate(surfaces):
            file = capture.place(str(capture.meshes), clip=clip.name, frame=frame)
            np.testing.assert_allclose(read_vertices(file), moved.places, atol=1e-4)


def test_true_tracks_follow_points_of_the_surface(folder: Path) -> None:
    capture = open_capture(folder)
    mesh = build_atlas(capture.surfaces, uv="keep", size=16).mesh
    triangles, barycentrics = spread_points(mesh, TRACKED)
    assert capture.clips
    for clip in capture.clips:
        (tracks,) = read_tracks(capture, clip.name)
        assert tracks.points.shape == (clip.frames, TRACKED, 3)
        assert tracks.bind is not None
        np.testing.assert_allclose(tracks.bind, interpolate(mesh.vertices, mesh.faces[triangles], barycentrics))
        for frame, points in enumerate(tracks.points):
            file = capture.place(str(capture.meshes), clip=clip.name, frame=frame)
            wanted = interpolate(read_vertices(file), mesh.faces[triangles], barycentrics)
            np.testing.assert_allclose(points, wanted, atol=1e-6)  # metres, in single precision
        assert (tracks.weights == 1).all()


def test_the_job_has_every_picture_of_the_capture_once(folder: Path) -> None:
    capture, job = open_capture(folder), json.loads(job_file(folder).read_text())
    wanted = {
        capture.place(capture.images, clip=clip.name, camera=camera.name, frame=frame)
        for clip in capture.clips
        for camera in capture.cameras
        for frame in range(clip.frames)
    }
    made = [(job_file(folder).parent / one["image"]).resolve() for one in job["pictures"]]
    assert len(made) == len(wanted) == (3 + 2) * (3 + 1)
    assert set(made) == {place.resolve() for place in wanted}
    assert len({one["seed"] for one in job["pictures"]}) == len(made)
    assert all((job_file(folder).parent / one["mesh"]).exists() for one in job["pictures"])


@pytest.fixture
def renderer(monkeypatch: pytest.MonkeyPatch) -> ModuleType:
    """tools/cycles_render.py without Blender: an image is the name of its camera."""
    mathutils = ModuleType("mathutils")
    vars(mathutils).update(Matrix=None, Vector=None)
    monkeypatch.setitem(sys.modules, "bpy", ModuleType("bpy"))
    monkeypatch.setitem(sys.modules, "mathutils", mathutils)
    monkeypatch.delitem(sys.modules, "cycles_render", raising=False)
    module = importlib.import_module("cycles_render")

    class Scene:
        class cycles:
            seed = 0

        class render:
            """Whose border is set."""

        camera = ""

    def picture(scene: Scene, file: Path) -> None:
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(scene.camera)

    monkeypatch.setattr(module, "_scene", lambda job, threads: Scene())
    monkeypatch.setattr(module, "_camera", lambda scene, camera, size: camera["name"])
    monkeypatch.setattr(module, "_surface", lambda scene, folder, job: None)
    monkeypatch.setattr(module, "_place", lambda surface, file: None)
    monkeypatch.setattr(module, "_picture", picture)
    return module


def test_a_job_that_was_stopped_goes_on_where_it_was(
    folder: Path, tmp_path: Path, renderer: ModuleType, capsys: pytest.CaptureFixture[str]
) -> None:
    shutil.copytree(folder, tmp_path, dirs_exist_ok=True)
    capture, job = open_capture(tmp_path), job_file(tmp_path)
    kept = capture.place(capture.images, clip=capture.clips[0].name, camera="cam01", frame=2)
    kept.parent.mkdir(parents=True)
    kept.write_text("finished before")
    renderer.render(job, threads=1)
    printed = capsys.readouterr().out.splitlines()
    assert (printed[0], printed[-1]) == ("rendered 1 of 20", "rendered 20 of 20")
    assert kept.read_text() == "finished before"
    for clip in capture.clips:
        for camera in capture.cameras:
            for frame in range(clip.frames):
                place = capture.place(capture.images, clip=clip.name, camera=camera.name, frame=frame)
                assert place == kept or place.read_text() == camera.name
    renderer.render(job, threads=1)
    assert capsys.readouterr().out == "rendered 20 of 20\n"


def test_a_folder_holds_the_capture_of_one_order(order: Order, folder: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("render_capture.require_bpy", lambda blender: None)
    with pytest.raises(InputError, match="holds a capture with size 32, but 64 is asked for"):
        render_capture(replace(order, size=64), folder, blender="python", threads=1)


def test_a_python_without_blender_is_named_with_what_to_do(order: Order, tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"is a Python without Blender's bpy; make one with .*bpy"):
        render_capture(order, tmp_path, blender=sys.executable, threads=1)
    with pytest.raises(InputError, match=r"--blender .*nowhere: cannot be started"):
        render_capture(order, tmp_path, blender=str(tmp_path / "nowhere"), threads=1)
    assert list(tmp_path.iterdir()) == []


def test_a_renderer_that_fails_is_reported_with_its_log(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    log = tmp_path / "blender.log"
    program = "import sys; print('rendered 1 of 2'); print('Fra:1 Mem'); sys.exit(int(sys.argv[1]))"
    run_renderer([sys.executable, "-c", program, "0"], log=log)
    assert (capsys.readouterr().out, log.read_text()) == ("rendered 1 of 2\n", "Fra:1 Mem\n")
    with pytest.raises(InputError, match=r"rendering ended with status 3; .*blender.log says why"):
        run_renderer([sys.executable, "-c", program, "3"], log=log)


@pytest.mark.parametrize("given", [["--cameras", "0"], ["--size", "8"], ["--frames", "x"], ["--seed", "-1"]])
def test_a_number_that_cannot_be_is_refused_by_name(given: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit):
        parser().parse_args(["hero.glb", "-o", "made", *given])
    printed = capsys.readouterr().err.splitlines()[-1]
    assert f"argument {given[0]}: is {given[1]!r}, expected a whole number of at least" in printed


@pytest.mark.parametrize("shift", [0.25, 1.0, 3.0])
def test_edges_are_as_far_apart_as_one_was_shifted(shift: float) -> None:
    def half(edge: float) -> np.ndarray:
        return np.tile(np.clip(edge - np.arange(40), 0, 1), (20, 1))

    assert edge_distance(half(20.0), half(20.0 + shift)) == pytest.approx(shift)
    assert edge_distance(np.zeros((4, 4)), half(20.0)[:4, :4]) == np.inf


@pytest.fixture
def blender() -> str:
    """A Python with Blender's package; skips where none is named."""
    found = os.environ.get("BLENDER")
    if not found:
        pytest.skip(
            "needs Blender's Python package: BLENDER=PYTHON pytest -m long tests/tools/test_render_capture.py, "
            "PYTHON of an environment with bpy 5.0.1"
        )
    return found


def white_figure(order: Order, folder: Path, blender: str, *, unlit: bool) -> Array:
    """Colours [N, 3] where cameras see nothing but the first frame of a figure painted white."""
    prepare(replace(order, frames=1, held_out_frames=0), folder)
    job = json.loads(job_file(folder).read_text()) | {"unlit": unlit}
    job_file(folder).write_text(json.dumps(job))
    Image.new("RGBA", (8, 8), (255, 255, 255, 255)).save(job_file(folder).with_name("texture.png"))
    render_capture(Order(**(asdict(order) | job["order"])), folder, blender=blender, threads=1)  # and checks the fit
    images = np.stack([np.asarray(Image.open(file)) for file in (folder / "images").rglob("*.png")])
    return images[images[..., 3] == 255][:, :3].astype(int)


@pytest.mark.long
def test_blender_draws_a_white_surface_white_where_the_camera_has_it(
    order: Order, tmp_path: Path, blender: str
) -> None:
    assert white_figure(order, tmp_path, blender, unlit=True).min() == 255
    assert open_capture(tmp_path).clips[0].frames == 1


@pytest.mark.long
def test_what_the_sun_lights_is_yellow_beside_its_shadows(order: Order, tmp_path: Path, blender: str) -> None:
    seen = white_figure(replace(order, light="sun"), tmp_path, blender, unlit=False)
    seen = seen[seen.sum(axis=1).argsort()]
    tenth = len(seen) // 10
    shadow, lit = seen[:tenth].mean(axis=0), seen[-tenth:].mean(axis=0)
    assert lit.sum() > 2 * shadow.sum()
    assert lit[0] / lit[2] > 1.2 * shadow[0] / shadow[2]
