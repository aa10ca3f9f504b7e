"""mua-train --check: what it says of a recording before anything is trained, and the image that it leaves."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from examples import load_example
from PIL import Image
from trainings import Training

from mua import rotation
from mua.baking.contact_sheet import LARGE_CELL
from mua.baking.recording_check import check
from mua.fidelity.strips import CAPTION
from mua.pose.skeleton import Pose
from mua.recording import Recording, TeacherWriter

EXAMPLE = load_example("own_teacher")
RIG = EXAMPLE.build_rig()
WAVE = EXAMPLE.poses(RIG, "wave")[:24]
EVERY = 8  # frames between two that are recorded


def recorded(
    directory: Path,
    poses: list[Pose] = WAVE,
    *,
    whole_every: int = 1,
    seen: Callable[[Pose], Pose] = lambda pose: pose,
) -> Recording:
    """A clip of some poses, and what the teacher makes of what it sees of them, with a held-out one of the first."""
    with TeacherWriter(directory, RIG, rate=30, whole_every=whole_every) as writer:
        writer.start_clip("wave")
        for number, pose in enumerate(poses):
            writer.add(pose, *(EXAMPLE.teacher(RIG, seen(pose)) if number % EVERY == 0 else ()))
        writer.start_clip("again", held_out=True)
        writer.add(poses[0], *EXAMPLE.teacher(RIG, seen(poses[0])))
    return Recording(directory)


def doubts(recording: Recording) -> list[str]:
    """A warning about what may be intended; nothing is refused."""
    findings = check(recording).findings
    assert not any(finding.certain for finding in findings)
    return [finding.sentence for finding in findings]


def test_says_what_is_there_and_leaves_a_picture_of_three_frames_and_nothing_else(
    tmp_path: Path, mua_train: Training
) -> None:
    recorded(tmp_path / "recording")
    printed = mua_train(tmp_path / "recording", "--check").out
    for part in (
        *("wave", "again", "1.78 m high", "9 joints, the root is Hips", "792 vertices"),
        "25 at 30 per second (0.8 s); 3 recorded to train on, 1 held out, 4 of them whole",
        "0.98 (0.98 to 0.98)",
        "no mistake in units or conventions was found",
    ):
        assert part in printed
    assert {path.name for path in tmp_path.iterdir()} == {"recording", "a_check.png"}
    picture = np.asarray(Image.open(tmp_path / "a_check.png"))
    assert picture.shape == (LARGE_CELL[1] + CAPTION, 3 * LARGE_CELL[0], 3)
    for cell in np.split(picture[CAPTION:], 3, axis=1):
        assert 0.05 < np.mean(cell.min(axis=2) < 200) < 0.5  # a figure on white


def test_frames_out_of_order_are_doubted(tmp_path: Path) -> None:
    shuffled = [WAVE[i] for i in np.random.default_rng(1).permutation(len(WAVE))]
    (doubt,) = doubts(recorded(tmp_path, shuffled))
    assert "clip 'wave'" in doubt
    assert "are they in order" in doubt


def test_a_figure_that_always_lies_is_doubted(tmp_path: Path) -> None:
    def fallen(pose: Pose) -> Pose:
        rotations = pose.rotations.copy()
        rotations[0] = rotation.from_axis_angle(np.array([1.0, 0, 0]), np.radians(-90))
        return Pose(rotations, pose.translations)

    (doubt,) = doubts(recorded(tmp_path, [fallen(pose) for pose in WAVE]))
    assert "lies or hangs in 100 %" in doubt
    assert "another up axis" in doubt


def test_a_teacher_that_never_changes_is_doubted(tmp_path: Path) -> None:
    (doubt,) = doubts(recorded(tmp_path, seen=lambda _: WAVE[0]))
    assert "is the same frame recorded every time?" in doubt


def test_without_whole_frames_there_is_no_picture(tmp_path: Path, mua_train: Training) -> None:
    with TeacherWriter(tmp_path / "recording", RIG, rate=30) as writer:
        writer.start_clip("wave")
        writer.add(WAVE[0], *EXAMPLE.teacher(RIG, WAVE[0]), whole=False)
    printed = mua_train(tmp_path / "recording", "--check").out
    assert "no frame is kept whole" in printed
    assert "no clip is held out" in printed
    assert {path.name for path in tmp_path.iterdir()} == {"recording"}


def test_a_mistake_that_was_recorded_all_the_same_ends_in_its_sentence(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, mua_train: Training
) -> None:
    with monkeypatch.context() as before_there_were_checks:
        before_there_were_checks.setattr(TeacherWriter, "_judge", lambda *_: None)
        turned = [Pose(np.roll(pose.rotations, -1, axis=1), pose.translations) for pose in WAVE]
        recorded(tmp_path / "recording", turned, seen=lambda _: WAVE[3])
    ended = mua_train(tmp_path / "recording", "--check")
    assert "clip 'wave', frame 0: pose rotations turn half of all joints" in ended.sentence
    assert ended.out.count("xyzw: are they?") == 1
    assert (tmp_path / "a_check.png").is_file()
