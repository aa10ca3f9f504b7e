"""Folders in the layouts of others, as they are published, all the way to a teacher of a few steps."""

import json
from pathlib import Path

import numpy as np
import pytest
from avatarrex_files import WORLDS, write_source
from commands import Commands
from PIL import Image
from small_teachers import FEW
from subjects import FOCAL, SIDE, picture, write_subject

import mua
from mua.arrays import Array
from mua.baking import teacher_stages
from mua.capture import Capture, open_capture
from mua.capture.silhouette import posed_template
from mua.teacher import TeacherFrame
from mua.teachers.trained import settings
from mua.teachers.trained.teacher import TrainedTeacher
from mua.teachers.trained.template_training import TemplateSettings
from mua.training.schedule import Schedule


def film_set(folder: Path, capture: Capture) -> None:
    """Draw the images and masks of an AvatarReX set: its template in the poses of the capture that it becomes."""
    for clip in capture.clips:
        posed = posed_template(capture.surfaces, capture.motion(clip.name))
        for camera in capture.cameras:
            for frame, vertices in enumerate(posed):
                drawn = picture(vertices[capture.surfaces.faces], camera.world_to_camera)
                place = folder / camera.name
                Image.fromarray(drawn[..., :3]).save(place / f"{clip.first_image + frame:08d}.jpg")
                mask = Image.fromarray(drawn[..., 3])
                mask.save(place / "mask" / "pha" / f"{clip.first_image + frame:08d}.jpg")


def assert_trains_teacher(capture: Path, output: Path, clip: str, height: float, *, drivable: bool = False) -> None:
    """A teacher of three steps has frames of a clip that are as tall as the person."""
    few = Schedule(steps=2, batch=1, lr=1e-3)
    with pytest.MonkeyPatch.context() as patch:
        patch.setitem(settings.PRESETS, "tiny", FEW)
        patch.setattr(teacher_stages, "TEMPLATE", TemplateSettings(nodes=few, offsets=few, samples=300))
        teacher = TrainedTeacher(mua.teach(capture, output=output, steps=3, texels=64, drivable=drivable))
    frames = teacher.frames(open_capture(capture).motion(clip), {2})
    (frame,) = (one for one in frames if isinstance(one, TeacherFrame))
    assert np.isfinite(frame.texture).all()
    assert np.ptp(frame.mesh[:, 1]) == pytest.approx(height, rel=0.05)


def height_of(vertices: Array) -> float:
    return float(np.ptp(vertices[:, 1]))


@pytest.mark.long
def test_umas_layout_becomes_a_teacher(command: Commands, tmp_path: Path) -> None:
    source, folder = write_subject(tmp_path / "Subject_0"), tmp_path / "capture"
    assert command("capture", "describe", source, "-o", folder).status == 0
    assert command("capture", "check", folder).status == 0
    height = height_of(open_capture(folder).surfaces.vertices)
    assert_trains_teacher(
        folder, tmp_path / "teacher", "testing", height, drivable=True
    )  # on its surfaces in millimetres


@pytest.mark.long
@pytest.mark.parametrize("up", ["y", "z"])
def test_avatarrexs_layout_becomes_a_teacher(command: Commands, tmp_path: Path, up: str) -> None:
    source, folder = write_source(tmp_path / "set", WORLDS[up]), tmp_path / "capture"
    calibration = json.loads((source / "calibration_full.json").read_text())
    middle = (SIDE - 1) / 2
    for camera in calibration.values():
        camera |= {"K": [[FOCAL, 0, middle], [0, FOCAL, middle], [0, 0, 1]], "imgSize": [SIDE, SIDE], "distCoeff": []}
    (source / "calibration_full.json").write_text(json.dumps(calibration))
    asked = ("capture", "describe", source, "--template", tmp_path / "template.glb", "-o", folder)
    assert command(*asked).status == 0
    capture = open_capture(folder)
    film_set(source, capture)
    assert command(*asked).status == 0
    ended = command("capture", "check", folder)
    assert ended.status == 0, ended
    assert_trains_teacher(folder, tmp_path / "teacher", capture.clips[0].name, height_of(capture.surfaces.vertices))
