"""mua-eval of a capture: a teacher and avatars beside its images, by cameras and in clips that are held out."""

import csv
import json
import sys
from dataclasses import replace
from functools import partial
from pathlib import Path

import numpy as np
import pytest
from captures import SIDE, TEXELS, make_capture, motions
from commands import Commands
from compared_systems import SETTINGS as QUICK
from empty_entries import nothing
from PIL import Image
from small_teachers import FEW
from synthetic_avatar import synthetic_avatar

import mua
from mua.asset.write import write
from mua.avatar.decode import Splats, pose_splats
from mua.capture import open_capture
from mua.errors import InputError
from mua.evaluation import capture_report, capture_scores
from mua.evaluation.capture_scores import TRAINED, UNSEEN, FilmedEntry, Judged, Shot, judge, shots
from mua.evaluation.cost import Cost
from mua.evaluation.metrics import Scores, compare
from mua.pose.clip import Clip
from mua.pose.resample import resample
from mua.pose.skeleton import Skeleton
from mua.recording import Recording
from mua.student.settings import PRESETS as STUDENTS
from mua.teachers.procedural import procedural_character
from mua.teachers.simulated.still import StillTeacher
from mua.teachers.trained.settings import PRESETS

MADE_SO = 45.0  # dB, of 8 bits and of the rasteriser's own limits, beside what drew the images


@pytest.fixture(scope="module")
def capture(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return make_capture(tmp_path_factory.mktemp("capture")).folder


@pytest.fixture(scope="module")
def teacher(capture: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A teacher of the capture, trained for a few steps."""
    folder = tmp_path_factory.mktemp("teacher")
    with pytest.MonkeyPatch.context() as patched:
        patched.setitem(PRESETS, "tiny", FEW)
        mua.teach(capture, output=folder, texels=64)
    return folder


def test_held_out_cameras_see_every_tenth_frame_of_each_split(capture: Path) -> None:
    opened = open_capture(capture)
    assert shots(opened, None) == [Shot(TRAINED, "walk", 0, "above"), Shot(UNSEEN, "reach", 0, "above")]
    assert [shot.frame for shot in shots(opened, 2)] == [1, 3, 0, 1]


def test_a_capture_without_held_out_cameras_is_refused(capture: Path) -> None:
    opened = open_capture(capture)
    everyone = replace(opened, cameras=tuple(replace(camera, held_out=False) for camera in opened.cameras))
    with pytest.raises(InputError, match=r"capture\.json: cameras: none has held_out, expected one at least"):
        shots(everyone, None)


def test_of_a_long_clip_every_tenth_frame_is_compared(capture: Path) -> None:
    opened = open_capture(capture)
    longer = replace(opened, clips=(replace(opened.clips[0], frames=21),))
    assert [shot.frame for shot in shots(longer, None)] == [0, 10, 20]


def test_what_drew_the_pictures_is_nearly_all_there(capture: Path) -> None:
    teacher = StillTeacher(procedural_character(), texels=TEXELS, template_vertices=500)

    def show(clip: Clip, frame: int) -> Splats:
        shown = teacher.frame(motions()[clip.name].pose(frame + 1))
        return pose_splats(teacher.rig, shown.mesh, texture=shown.texture, pose=shown.pose)

    opened = open_capture(capture)
    chosen = shots(opened, 1)
    see = partial(opened.view, crop=True)
    found = list(judge(opened, chosen, [FilmedEntry("own", show)], see=see, kept=chosen[:1]))
    assert [one.shot for one in found] == chosen
    for one in found:
        assert list(one.pictures) == (["image", "own"] if one.shot == chosen[0] else [])
        assert one.scores["own"].psnr > MADE_SO
        assert one.scores["own"].ssim > 0.99
        assert one.scores["own"].flip < 0.02


def test_likeness_of_a_picture_that_is_off_by_a_tenth() -> None:
    truth = np.full((20, 30, 3), 0.5)
    assert compare(truth + 0.1, truth, multiscale=False)[0].psnr == pytest.approx(20, abs=1e-3)
    assert compare(truth, truth, multiscale=False)[0].psnr == np.inf


def judged() -> list[Judged]:
    picture = np.full((9, 7, 3), 128, np.uint8)
    scores = {name: Scores(db, 0.9, np.nan, 0.1, np.nan) for name, db in (("a", 20.0), ("b", 30.0))}
    pictures = {"image": picture, "a": picture, "b": picture}
    return [Judged(Shot(TRAINED, "walk", frame, "cam"), pictures, scores) for frame in range(2)]


def test_tables_have_a_row_for_each_entry_and_a_dash_for_what_is_not_there() -> None:
    entries = [FilmedEntry("a", nothing, Cost(2_500_000, 30_000_000)), FilmedEntry("b", nothing)]
    text = capture_report.markdown(judged(), entries, ["Two images."])
    assert "- Two images." in text
    assert "| a | 20.00 | 0.9000 | 0.1000 | - | - | - | 2.500 | 30.00 |" in text
    assert "| b | 30.00 | 0.9000 | 0.1000 | - | - | - | - | - |" in text
    assert "LPIPS" not in text
    lines = list(csv.DictReader(capture_report.as_csv(judged()).splitlines()))
    assert [line["entry"] for line in lines] == ["a", "b", "a", "b"]
    assert capture_report.contact_sheet(judged(), UNSEEN, ["a", "b"], "b") is None
    sheet = capture_report.contact_sheet(judged(), TRAINED, ["a", "b"], "b")
    assert sheet is not None
    assert sheet.width == 4 * capture_report.LEAST_WIDTH


def test_the_command_compares_a_teacher_with_the_pictures(
    capture: Path, teacher: Path, tmp_path: Path, command: Commands, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(sys.modules, "mua_research", None)  # only systems need it
    monkeypatch.setattr("mua.cli.capture_evaluation.Lpips", lambda path: lambda image, truth: float(path.read_text()))
    (tmp_path / "weights").write_text("0.25")
    given: tuple[str | Path, ...] = ("--teacher", teacher, "--frames", "1", "--lpips-weights", tmp_path / "weights")
    given = (*given, "--images", tmp_path / "images")
    ended = command("eval", capture, *given, "-o", tmp_path / "evaluation")
    assert ended.status == 0, ended
    lines = list(csv.DictReader((tmp_path / "evaluation" / "results.csv").read_text().splitlines()))
    assert {(line["camera"], float(line["lpips"])) for line in lines} == {("above", 250.0)}
    text = (tmp_path / "evaluation" / "results.md").read_text()
    assert f"| {capture_scores.BASELINE} |" in text
    assert f"| {capture_scores.TEACHER} |" in text
    for name in ("training_poses.png", "clips_held_out.png"):
        with Image.open(tmp_path / "evaluation" / name) as sheet:
            assert sheet.height > 30
    assert len(list((tmp_path / "evaluation" / "work" / "views").rglob("*.png"))) == 2
    assert not (tmp_path / "evaluation" / "curve.png").exists()
    for clip, frame in (("walk", 2), ("reach", 1)):
        written = {
            name: np.asarray(Image.open(tmp_path / "images" / clip / "above" / f"{frame:06d}_{name}.png")) / 255
            for name in ("image", "mean_texture", "teacher")
        }
        scores = {line["entry"]: float(line["psnr"]) for line in lines if line["clip"] == clip}
        for name in ("mean texture", "teacher"):
            of_8_bits = compare(written[name.replace(" ", "_")], written["image"], multiscale=False)[0].psnr
            assert of_8_bits == pytest.approx(scores[name], abs=0.2)


def test_views_without_the_person_count_nowhere_and_are_named(
    capture: Path, teacher: Path, tmp_path: Path, command: Commands
) -> None:
    spoilt = make_capture(tmp_path / "spoilt")
    Image.new("RGBA", (SIDE, SIDE)).save(spoilt.files("walk", 1, "above").image)
    spoilt.files("reach", 0, "above").image.unlink()
    rows = {}
    for folder in (capture, spoilt.folder):
        output = tmp_path / f"evaluation of {folder.name}"
        ended = command("eval", folder, "--teacher", teacher, "--frames", "2", "-o", output)
        assert ended.status == 0, ended
        rows[folder] = list(csv.DictReader((output / "results.csv").read_text().splitlines()))
        text = (output / "results.md").read_text()
    assert "- 2 images of figure" in text
    assert "- Camera above: nobody is seen in 2 views, which count nowhere: walk 1, reach 0." in text
    places = {(line["clip"], line["frame"]) for line in rows[spoilt.folder]}
    assert places == {("walk", "3"), ("reach", "1")}
    assert rows[spoilt.folder] == [line for line in rows[capture] if (line["clip"], line["frame"]) in places]


def test_a_capture_in_which_nobody_is_seen_is_a_sentence(teacher: Path, tmp_path: Path, command: Commands) -> None:
    spoilt = make_capture(tmp_path / "spoilt")
    for image in spoilt.folder.glob("images/*/above/*.png"):
        image.unlink()
    ended = command("eval", spoilt.folder, "--teacher", teacher, "--frames", "1", "-o", tmp_path / "evaluation")
    assert "capture.json: nobody is seen in any of the 2 views by cameras with held_out" in ended.sentence


def test_the_command_trains_systems_at_several_sizes_and_once(
    capture: Path, teacher: Path, tmp_path: Path, command: Commands, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setitem(STUDENTS, "tiny", replace(QUICK, frames=3))
    names, sizes = ("--system", "ours", "--system", "linear"), ("--scale", "1", "--scale", "0.5")
    order = (capture, "--teacher", teacher, *names, *sizes, "--steps", "2", "--preset", "tiny", "--frames", "1")
    output = tmp_path / "evaluation"
    ended = command("eval", *order, "-o", output)
    assert ended.status == 0, ended
    results = json.loads((output / "results.json").read_text())
    rows = {one["name"]: one for one in results["entries"]}
    assert {"ours x0.5", "ours", "linear x0.5", "linear"} < set(rows)
    (equal,) = (one for one in results["entries"] if one["system"] == "linear" and one["scale"] not in (0.5, 1))
    assert equal["parameters"] <= rows["ours"]["parameters"]
    assert equal["flops"] <= rows["ours"]["flops"]
    within = {name for name, one in rows.items() if one["system"] == "linear" and one["flops"] <= rows["ours"]["flops"]}
    assert {equal["name"], "linear"} <= within
    assert {one["rival"] for one in results["standings"]} <= within
    assert len(results["standings"]) == len(capture_scores.SPLITS)
    assert "learnt" not in rows["ours"]
    assert "on 3 frames of the teacher at 64 texels" in (output / "results.md").read_text()
    with Image.open(output / "curve.png") as plot:
        assert np.asarray(plot).std() > 5
    trained = {path.name: path.stat().st_mtime_ns for path in (output / "work").glob("system *.pt")}
    assert len(trained) == len([one for one in results["entries"] if one["system"]])
    before = (output / "results.json").read_bytes()
    assert command("eval", *order, "-o", output).status == 0
    assert {path.name: path.stat().st_mtime_ns for path in (output / "work").glob("system *.pt")} == trained
    assert (output / "results.json").read_bytes() == before

    (recording,) = (output / "work").glob("recording-*")
    assert {clip.name.split(" (")[0] for clip in Recording(recording).clips} == {"walk"}, "reach is held out"
    monkeypatch.setitem(STUDENTS, "tiny", replace(QUICK, frames=2))  # what is not recorded again does not follow it
    few = (capture, "--teacher", teacher, "--system", "linear", "--steps", "1", "--preset", "tiny", "--frames", "1")
    assert command("eval", *few, "--train-on", recording, "-o", tmp_path / "given").status == 0
    assert "on 3 frames of the teacher" in (tmp_path / "given" / "results.md").read_text()


def test_an_avatar_on_another_skeleton_is_refused(capture: Path, tmp_path: Path, command: Commands) -> None:
    write(tmp_path / "a.muaavatar", synthetic_avatar())
    assert (
        "its joints are not those of the capture's template"
        in command("eval", capture, tmp_path / "a.muaavatar").sentence
    )


def moved(skeleton: Skeleton) -> Skeleton:
    places = skeleton.bind_translations.copy()
    places[1] += 0.25
    return replace(skeleton, bind_translations=places)


def test_a_teacher_of_another_template_is_refused(capture: Path, teacher: Path) -> None:
    template = open_capture(capture).surfaces.skeleton
    assert [one.name for one in capture_scores.teacher_entries(teacher, template)] == [
        capture_scores.BASELINE,
        capture_scores.TEACHER,
    ]
    renamed = replace(template, names=tuple(f"{name}_" for name in template.names))
    with pytest.raises(InputError, match=r"--teacher .*: its joints are not those of the capture's template"):
        capture_scores.teacher_entries(teacher, renamed)
    with pytest.raises(InputError, match=r"--teacher .*: its joints are up to 0\.25 m from those of the capture's"):
        capture_scores.teacher_entries(teacher, moved(template))


def test_an_avatar_shows_a_capture_at_another_rate_at_the_same_moment(tmp_path: Path) -> None:
    avatar = synthetic_avatar()
    write(tmp_path / "a.muaavatar", avatar, storage="f32")
    entry = capture_scores.avatar_entry(tmp_path / "a.muaavatar", avatar.rig.skeleton)
    clip = avatar.clips[0]
    rate = avatar.encoding.rate
    one = entry.show(resample(clip, rate), 3)
    np.testing.assert_allclose(entry.show(resample(clip, 2 * rate), 6).centres, one.centres, atol=1e-5)
    assert np.abs(entry.show(resample(clip, rate), 2).centres - one.centres).max() > 1e-3


@pytest.mark.parametrize(
    ("options", "sentence"),
    [
        ((), "give a --teacher or avatar files"),
        (("--system", "ours"), "--system ours: learns from a teacher; give its folder with --teacher"),
        (("--system", "theirs"), "--system theirs: expected one of all, pca-only"),
        (("--teacher", "x", "--scale", "2"), "--scale 2: is the size of a --system, and none is given"),
        (("--teacher", "x", "--train-on", "y"), "--train-on y: is what a --system is trained on, and none is given"),
        (("--teacher", "x", "--system", "ours", "--train-on", "absent"), "absent: there is no such directory"),
        (("--teacher", "absent"), "--teacher absent: there is no such directory"),
    ],
)
def test_a_wrong_option_is_a_sentence(
    capture: Path, command: Commands, options: tuple[str, ...], sentence: str
) -> None:
    assert sentence in command("eval", capture, *options).sentence


@pytest.mark.parametrize(
    ("option", "sentence"),
    [
        ("--teacher", "can only be compared with the images of a capture"),
        ("--train-on", "--train-on x: only applies to a comparison"),
        ("--images", "--images x: only applies to a comparison with"),
        ("--scale", "--scale 2: only applies to a comparison with"),
    ],
)
def test_options_of_a_capture_are_refused_for_a_recording(
    written: Path, command: Commands, option: str, sentence: str
) -> None:
    assert sentence in command("eval", written, option, "2" if option == "--scale" else "x").sentence


def test_a_recording_of_another_character_is_refused(
    capture: Path, teacher: Path, written: Path, tmp_path: Path, command: Commands
) -> None:
    given = ("--teacher", teacher, "--system", "ours", "--train-on", written, "-o", tmp_path)
    ended = command("eval", capture, *given)
    assert f"--train-on {written}: its joints are not those of the capture's template" in ended.sentence
