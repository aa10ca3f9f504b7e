"""Splats that are fitted to images of their source."""

from pathlib import Path

import gltf_files
import numpy as np
import pytest

from mua.avatar.camera import orbit
from mua.characters.read import read_character
from mua.evaluation import metrics
from mua.fidelity.background import over
from mua.fidelity.compare import PoseFidelity, compare
from mua.fidelity.fitting import fit, in_view
from mua.rig.character import Character
from mua.teachers.simulated.still import StillTeacher

TEXELS, STEPS = 48, 30


@pytest.fixture
def column(tmp_path: Path) -> Character:
    """A white column with black stripes, one unit of its texture after another."""
    picture = np.full((32, 32, 4), 255, np.uint8)
    picture[::8, :, :3] = picture[1::8, :, :3] = 0
    glb = gltf_files.textured(picture)
    gltf_files.animate(glb, 1, "rotation", times=[0.0, 1.0], values=[[0, 0, 0, 1], [0, 0, np.sin(0.3), np.cos(0.3)]])
    return read_character(glb.save(tmp_path / "column.glb"), atlas_size=128)


def flip(pose: PoseFidelity) -> float:
    """The mean of all sides, none of which the fit has seen, on grey."""
    pairs = [[over(image, 0.5).astype(np.float32) for image in (shot.splats, shot.source)] for shot in pose.shots]
    return float(np.mean([metrics.compare(*pair)[0].flip for pair in pairs]))


def test_fitted_splats_are_nearer_to_the_source_in_all_poses(column: Character) -> None:
    assert column.source is not None
    teacher = StillTeacher(column, texels=TEXELS)
    corrected = teacher.corrected(fit(column, column.clips, teacher=teacher, source=column.source, steps=STEPS))
    laid, fitted = (compare(column, column.clips, teacher=each, source=column.source) for each in (teacher, corrected))
    assert fitted.iou > laid.iou
    for before, after in zip(laid.poses, fitted.poses, strict=True):
        assert after.agreement.psnr > before.agreement.psnr
        assert flip(after) < flip(before)


def test_without_steps_nothing_is_corrected(column: Character) -> None:
    assert column.source is not None
    assert not np.any(fit(column, (), teacher=StillTeacher(column, texels=TEXELS), source=column.source, steps=0))


def test_the_same_character_is_fitted_alike(column: Character) -> None:
    assert column.source is not None
    teacher = StillTeacher(column, texels=TEXELS)
    first, second = (fit(column, column.clips, teacher=teacher, source=column.source, steps=3) for _ in range(2))
    assert np.array_equal(first, second)
    assert first.any()


def test_points_beside_and_behind_the_camera_are_not_in_view() -> None:
    camera = orbit(np.array([[-1.0, -1, -1], [1, 1, 1]]), screen=(64, 64))
    eye = np.linalg.inv(camera.view)[:3, 3]
    points = np.array([[0.0, 0, 0], 2 * eye, [50, 0, 0], [0.5, 0.5, 0], [0, -50, 0]])
    assert in_view(points, camera).tolist() == [0, 3]
