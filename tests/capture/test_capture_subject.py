"""A person of UMA's layout, as it is published: understood without conversion, and what it lacks is named."""

import shutil
from pathlib import Path

import numpy as np
import pytest
from commands import Commands
from skeletool_files import REST, CharacterFiles, sway
from subjects import FIRST, FRAMES, write_subject

from mua.capture import open_capture
from mua.capture.readers.streams import MASKS
from mua.capture.silhouette import posed_template

CORNER_BOUND = 5e-6  # metres: float32 weights, and vertices of one place that are welded


@pytest.fixture(scope="module")
def published(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The subject; tests leave it as it is."""
    return write_subject(tmp_path_factory.mktemp("dataset") / "Subject_0")


@pytest.fixture
def subject(published: Path, tmp_path: Path) -> Path:
    """A copy that a test may spoil."""
    shutil.copytree(published.parent, tmp_path / "dataset")
    return tmp_path / "dataset" / published.name


@pytest.fixture
def capture(published: Path, command: Commands, tmp_path: Path) -> Path:
    ended = command("capture", "describe", published, "-o", tmp_path / "capture")
    assert "4 cameras, 8 frames in 2 clips" in ended.out, ended
    return tmp_path / "capture"


def test_the_folder_brings_template_poses_and_surfaces(capture: Path) -> None:
    found = open_capture(capture)
    clips = [(clip.name, clip.held_out, clip.first_image, clip.frames) for clip in found.clips]
    assert clips == [("training", False, 2, 4), ("testing", True, 0, 4)]
    assert (found.rate, found.template.name) == (25, "tube.character")
    for clip in found.clips:
        assert found.meshes is not None
        assert found.place(found.meshes, clip=clip.name, frame=1).is_file()
    view = found.view("testing", 3, "stream001")
    assert 0.03 < view.mask.mean() < 0.3


def test_the_template_is_where_the_files_matrices_have_it(capture: Path) -> None:
    found = open_capture(capture)
    character = found.template
    files = CharacterFiles.of(*(character.with_suffix(end) for end in (".skeleton", ".obj", ".skin")))
    truth = sway(FRAMES["training"] + 9)[FIRST["training"] :]
    posed = posed_template(found.surfaces, found.motion("training"))
    assert len(posed) == found.clip("training").frames > 1
    for frame, vertices in enumerate(posed):
        np.testing.assert_allclose(vertices[found.surfaces.faces], files.skinned(REST, truth[frame]), atol=CORNER_BOUND)


def test_outlines_lie_on_the_masks(capture: Path, command: Commands) -> None:
    ended = command("capture", "check", capture, "--frames", 0)
    assert ended.status == 0, ended
    overlaps = [int(line.split("%")[0].split()[-1]) for line in ended.out.splitlines() if "stream00" in line]
    assert len(overlaps) == 4
    assert min(overlaps) >= 90


def test_one_take_may_be_described_alone(subject: Path, command: Commands, tmp_path: Path) -> None:
    shutil.rmtree(subject / "testing")
    (subject.parent / "Subject_0_metadata").rename(subject / "metadata")
    ended = command("capture", "describe", subject, "-o", tmp_path / "out", "--rate", 50)
    assert "4 cameras, 4 frames in 1 clip" in ended.out, ended
    found = open_capture(tmp_path / "out")
    assert found.rate == 50
    assert len(found.motion("training")) == 4  # one pose for each frame, at any rate
    assert found.view("training", 3, "stream003").mask.any()


def test_poses_and_template_may_lie_elsewhere(subject: Path, command: Commands, tmp_path: Path) -> None:
    """Each take is described with its own; the poses are then those of the template that is given."""
    metadata = subject.parent / "Subject_0_metadata"
    elsewhere = (metadata / "ddc_character").rename(tmp_path / "character")
    poses = (elsewhere / "skeletoolToGTPose" / "poseAngles.motion").rename(tmp_path.parent / "poses.motion")
    (metadata / "cameras.calib").rename(subject / "training" / "cameras.calib")
    given = ("--template", elsewhere / "tube.character", "--motion", poses)
    ended = command("capture", "describe", subject / "training", *given, "-o", tmp_path / "out")
    assert "4 cameras, 4 frames in 1 clip" in ended.out, ended
    assert open_capture(tmp_path / "out").template == elsewhere / "tube.character"
    poses.unlink()


def test_what_a_subject_lacks_is_named(subject: Path, command: Commands, tmp_path: Path) -> None:
    asked = ("capture", "describe", subject, "-o", tmp_path / "out")
    characters = subject.parent / "Subject_0_metadata" / "ddc_character"
    poses = characters / "skeletoolToGTPose_test" / "poseAngles.motion"

    def refused(*more: object) -> str:
        sentence = command(*asked, *more).sentence
        assert not list((tmp_path / "out").iterdir())
        return sentence

    for camera in range(4):
        (subject / "testing" / MASKS / f"stream{camera:03d}.mp4").rename(tmp_path / f"{camera}.mp4")
        (subject / "testing" / MASKS / f"stream{camera:03d}").mkdir()
        (subject / "testing" / MASKS / f"stream{camera:03d}" / "0000.png").touch()
    assert "masks are called {camera}/{frame:04d}.png, those of training {camera}.mp4" in refused()
    for camera in range(4):
        (tmp_path / f"{camera}.mp4").rename(subject / "testing" / MASKS / f"stream{camera:03d}.mp4")
    assert "holds training and testing, which cannot share it" in refused("--motion", poses)
    text = poses.read_text()
    poses.write_text(text.replace("\n0 ", "\n7 ", 1).split("\n1 ")[0])
    assert "begins with frame 7, the videos of 'testing' have 4" in refused()
    poses.write_text(text.replace("\n1 ", "\n1 nan ", 1))
    assert "poseAngles.motion, line 3: number 2 is 'nan', expected a finite number" in refused()
    poses.unlink()
    assert "skeletoolToGTPose_test/poseAngles.motion: there is no such file with the poses" in refused()
    poses.write_text(text)
    (characters / "other.character").write_text("")
    assert "tube.character; give one of them with --template" in refused()
    shutil.rmtree(characters)
    assert "found no .character of the person; give --template and --motion" in refused()
