"""mua-eval of a capture: a teacher and avatars beside its pictures, by cameras and in clips that are held out."""

import csv
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from captures import TEXELS, make_capture, motions
from commands import Commands
from PIL import Image
from synthetic_avatar import synthetic_avatar
from taught import FEW

import mua
from mua.asset.write import write
from mua.capture import open_capture
from mua.compare import filmed, filmed_report
from mua.compare.filmed import TRAINED, UNSEEN, Judged, Likeness, Shot, judge, likeness, shots
from mua.decode import Splats, pose_splats
from mua.pose.clip import Clip
from mua.teachers.procedural import procedural_character
from mua.teachers.still import StillTeacher
from mua.teaching.settings import PRESETS

MADE_SO = 45.0  # dB, of 8 bits and of the rasteriser's own limits, beside what drew the pictures


@pytest.fixture(scope="module")
def capture(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return make_capture(tmp_path_factory.mktemp("capture")).folder


def test_held_out_cameras_see_every_tenth_frame_of_each_split(capture: Path) -> None:
    opened = open_capture(capture)
    assert shots(opened, None) == [Shot(TRAINED, "walk", 0, "above"), Shot(UNSEEN, "reach", 0, "above")]
    assert [shot.frame for shot in shots(opened, 2)] == [1, 3, 0, 1]
    everyone = replace(opened, cameras=tuple(replace(camera, held_out=False) for camera in opened.cameras))
    assert len(shots(everyone, None)) == 2 * len(opened.cameras)


def test_what_drew_the_pictures_is_nearly_all_there(capture: Path) -> None:
    teacher = StillTeacher(procedural_character(), texels=TEXELS, template_vertices=500)

    def show(clip: Clip, frame: int) -> Splats:
        shown = teacher.frame(motions()[clip.name].pose(frame + 1))
        return pose_splats(teacher.rig, shown.mesh, texture=shown.texture, pose=shown.pose)

    opened = open_capture(capture)
    for one in judge(opened, shots(opened, 1), {"own": show}):
        assert one.scores["own"].psnr > MADE_SO
        assert one.scores["own"].ssim > 0.99
        assert one.scores["own"].flip < 0.02


def test_likeness_of_a_picture_that_is_off_by_a_tenth() -> None:
    truth = np.full((20, 30, 3), 0.5)
    assert likeness(truth + 0.1, truth).psnr == pytest.approx(20, abs=1e-3)
    assert likeness(truth, truth).psnr == np.inf


def judged() -> list[Judged]:
    picture = np.full((9, 7, 3), 0.5)
    scores = {name: Likeness(db, 0.9, 0.1, np.nan) for name, db in (("a", 20.0), ("b", 30.0))}
    pictures = {"image": picture, "a": picture, "b": picture}
    return [Judged(Shot(TRAINED, "walk", frame, "cam"), pictures, scores) for frame in range(2)]


def test_tables_have_a_row_for_each_entry_and_a_dash_for_what_is_not_there() -> None:
    text = filmed_report.markdown(judged(), ["a", "b"], "Two pictures.")
    assert "| a | 20.00 | 0.9000 | 0.1000 | - | - | - |" in text
    assert "LPIPS" not in text
    lines = list(csv.DictReader(filmed_report.as_csv(judged()).splitlines()))
    assert [line["entry"] for line in lines] == ["a", "b", "a", "b"]
    assert filmed_report.contact_sheet(judged(), UNSEEN) is None
    sheet = filmed_report.contact_sheet(judged(), TRAINED)
    assert sheet is not None
    assert sheet.width == 4 * filmed_report.LEAST_WIDTH


def test_the_command_compares_a_teacher_with_the_pictures(
    capture: Path, tmp_path: Path, command: Commands, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(PRESETS, "tiny", FEW)
    mua.teach(capture, output=tmp_path / "teacher", texels=64)
    ended = command("eval", capture, "--teacher", tmp_path / "teacher", "-o", tmp_path / "evaluation", "--frames", "1")
    assert ended.status == 0, ended
    text = (tmp_path / "evaluation" / "results.md").read_text()
    assert f"| {filmed.BASELINE} |" in text
    assert f"| {filmed.TEACHER} |" in text
    for name in ("training_poses.png", "clips_held_out.png"):
        with Image.open(tmp_path / "evaluation" / name) as sheet:
            assert sheet.height > 30


def test_an_avatar_on_another_skeleton_is_refused(capture: Path, tmp_path: Path, command: Commands) -> None:
    write(tmp_path / "a.muaavatar", synthetic_avatar())
    assert (
        "its joints are not those of the capture's template"
        in command("eval", capture, tmp_path / "a.muaavatar").sentence
    )


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        ((), "give a --teacher or avatar files"),
        (("--system", "ours"), "--system ours: is trained on a recording"),
        (("--teacher", "absent"), "--teacher absent: there is no such directory"),
    ],
)
def test_a_wrong_option_is_a_sentence(
    capture: Path, command: Commands, options: tuple[str, ...], sentence: str
) -> None:
    assert sentence in command("eval", capture, *options).sentence


def test_a_recording_has_no_pictures_to_compare_a_teacher_with(written: Path, command: Commands) -> None:
    assert "compared with the pictures of a capture" in command("eval", written, "--teacher", "x").sentence
