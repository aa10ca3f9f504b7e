"""Close-ups of a character: which parts are shown, and what counts as a fringe."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import still_splats
from measure_close_ups import main, measured, moments, surface_of, unlit
from PIL import Image
from shared_data import SharedData

from mua.avatar.decode import pose_splats
from mua.baking.sources import load_character
from mua.channels import ATTRIBUTES
from mua.fidelity.measure import MOST_DECIBELS
from mua.fidelity.posed_source import Poser
from mua.teachers.simulated.still import StillTeacher

pytestmark = pytest.mark.usefixtures("first_try")

SCALE = 1000.0  # pixels along a metre: a fringe is looked for within ten


def disc(radius: float, grey: float) -> np.ndarray:
    """A premultiplied image [64, 64, 4] of a disc."""
    row, column = np.mgrid[:64, :64]
    alpha = (np.hypot(row - 32, column - 32) < radius).astype(float)
    return np.dstack([np.full((64, 64, 3), grey) * alpha[..., None], alpha])


def test_a_dark_ring_outside_the_silhouette_is_a_fringe() -> None:
    nowhere, source = np.zeros((64, 64), bool), disc(16, 0.8)
    ringed = disc(19, 0.1) * (1 - source[..., 3:]) + source
    found = measured(source, ringed, nowhere, scale=SCALE)
    assert 0.2 < found.dark < 0.5
    assert np.isnan([found.border, found.border_flip]).all()
    assert measured(source, disc(19, 0.8), nowhere, scale=SCALE).dark == 0
    assert found.psnr < measured(source, disc(17, 0.8), nowhere, scale=SCALE).psnr


def test_only_pixels_near_a_border_count_there() -> None:
    source, splats, near = disc(16, 0.8), disc(16, 0.8), np.zeros((64, 64), bool)
    near[:, :32] = True
    splats[30:34, 40:44, :3] = 0
    found = measured(source, splats, near, scale=SCALE)
    assert found.border == MOST_DECIBELS
    assert found.psnr < 40
    assert found.border_flip == 0 < found.flip


def test_an_eye_that_is_farther_away_sees_less() -> None:
    source, nowhere, row = disc(16, 0.8), np.zeros((64, 64), bool), np.arange(64)[:, None, None]
    striped = source * np.where(row % 2, [1.15, 1.15, 1.15, 1], [0.85, 0.85, 0.85, 1])
    near, far = (measured(source, striped, nowhere, scale=SCALE, per_degree=each).flip for each in (25, 100))
    assert 0 < far < 0.5 * near


def test_writes_each_part_from_each_side(
    shared_data: SharedData, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    character = shared_data.path("characters/lumberjack.glb")
    main([str(character), "--texels", "64", "--size", "96", "--steps", "2", "-o", str(tmp_path)])
    names = sorted(file.stem for file in tmp_path.glob("*.png"))
    figure = "lumberjack as the file stands"
    parts = ("head", "hand", "hem") if f"{figure} hem front" in names else ("head", "hand")
    assert names == sorted(f"{figure} {part} {side}" for part in parts for side in ("front", "behind"))
    for name in names:
        source, splats = np.split(np.asarray(Image.open(tmp_path / f"{name}.png")).astype(int), 2, axis=1)
        assert np.ptp(source) > 100  # the part is in the image
        assert np.abs(source - splats).mean() < 20
    front = next(line for line in capsys.readouterr().out.splitlines() if f", {parts[0]}, front: " in line)
    psnr, bound = (float(text.split()[-1]) for text in front.split(" dB")[:2])
    assert 15 < psnr < bound


def test_splats_that_were_kept_are_drawn_and_measured_before_those_of_now(
    shared_data: SharedData, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    character, before = str(shared_data.path("characters/lumberjack.glb")), str(tmp_path / "before")
    still_splats.main([character, "--texels", "64", "-o", before])
    main([character, "--texels", "64", "--size", "96", "--steps", "0", "--before", before, "-o", str(tmp_path)])
    _, kept, now = np.split(np.asarray(Image.open(next(tmp_path.glob("*.png")))), 3, axis=1)
    assert np.array_equal(kept, now)
    kept_psnr, arrow, psnr = capsys.readouterr().out.split("front: ")[1].split()[:3]
    assert arrow == "->"
    assert float(kept_psnr) == float(psnr) > 15


def test_a_student_is_compared_in_the_colours_of_the_splats(shared_data: SharedData) -> None:
    character = load_character(shared_data.path("characters/lumberjack.glb"), uv="auto", seed=0)
    assert character.source is not None
    teacher, moment = StillTeacher(character, texels=64), Poser(character.source, character.skeleton).rest()
    shown = teacher.frame(moment.pose, moment.stretches)
    lit = shown.texture.copy()
    lit[:, ATTRIBUTES["SH"]] *= 0.5
    lit[:, ATTRIBUTES["offset"]] += 0.01
    student = pose_splats(teacher.rig, shown.mesh, texture=lit, pose=moment.pose)
    found = unlit(student, teacher, shown.texture, moment)
    np.testing.assert_array_equal(found.sh, shown.texture[:, ATTRIBUTES["SH"]])
    np.testing.assert_array_equal(found.centres, student.centres)


def test_a_surface_hangs_off_its_joints_where_it_is_loose_and_nowhere_else(
    shared_data: SharedData, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = shared_data.path("characters/lumberjack.glb")
    character = load_character(path, uv="auto", seed=0)
    ((moment, clip, at),) = moments(character, [])
    loose = np.zeros(len(character.mesh.vertices), np.float32)
    loose[: len(loose) // 2] = 1
    of_two = (surface_of(replace(character, looseness=loose), moment, clip, at, hanging=one) for one in (False, True))
    skinned, hanging = (surface.places for surface in of_two)
    apart = np.linalg.norm(hanging - skinned, axis=1)
    assert np.quantile(apart[loose == 1], 0.9) > 0.003
    assert np.median(apart[loose == 0]) < 1e-6
    main([str(path), "--texels", "64", "--size", "96", "--steps", "0", "--hanging", "-o", str(tmp_path)])
    psnr, bound = (float(text.split()[-1]) for text in capsys.readouterr().out.splitlines()[0].split(" dB")[:2])
    assert 15 < psnr < bound
