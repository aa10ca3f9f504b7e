"""The template of a capture and the poses of its clips: exactly one for each frame, where they were recorded."""

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from captures import FRAMES, make_capture, motions

from mua.arrays import Array
from mua.capture import Capture, poses
from mua.errors import InputError
from mua.pose.clip import Clip
from mua.pose.skeleton import Skeleton
from mua.teachers.procedural import procedural_character

WRITTEN = 1e-5  # metres: six digits of metres and degrees in a .bvh, through a body's chains of joints


def places(skeleton: Skeleton, clip: Clip) -> dict[str, Array]:
    """World positions [F, 3] of joints, by name."""
    _, at = skeleton.world(clip.rotations, clip.translations)
    return {name: at[:, j] for j, name in enumerate(skeleton.names)}


@pytest.mark.parametrize("name", FRAMES)
def test_poses_are_those_that_were_recorded_from_the_first_on(small_capture: Capture, name: str) -> None:
    clip = small_capture.motion(name)
    assert (len(clip), clip.rate, clip.name) == (FRAMES[name], small_capture.rate, name)
    found = places(small_capture.surfaces.skeleton, clip)
    expected = places(procedural_character().skeleton, motions()[name])
    assert found.keys() == expected.keys()
    for joint, at in expected.items():
        np.testing.assert_allclose(found[joint], at[1:], atol=WRITTEN)


def test_poses_come_at_the_rate_of_the_pictures(small_capture: Capture) -> None:
    half = replace(small_capture, rate=15.0, clips=(replace(small_capture.clips[0], first=1, frames=2),))
    motion = half.motion("walk")
    assert motion.rate == 15.0
    found = places(half.surfaces.skeleton, motion)
    expected = places(procedural_character().skeleton, motions()["walk"])
    np.testing.assert_allclose(found["Head"], expected["Head"][[2, 4]], atol=WRITTEN)


def test_fewer_poses_than_frames_are_counted(small_capture: Capture) -> None:
    longer = replace(small_capture, clips=(replace(small_capture.clips[0], frames=5),))
    with pytest.raises(InputError, match=r"walk\.bvh: has 5 poses at 30 frames per second; .* needs 5 from pose 1"):
        longer.motion("walk")


def test_a_pose_that_is_no_number_is_named(tmp_path: Path) -> None:
    capture = make_capture(tmp_path)
    file = capture.clips[0].motion
    lines = file.read_text().splitlines()
    file.write_text("\n".join([*lines[:-1], " ".join(["nan", *lines[-1].split()[1:]])]) + "\n")
    with pytest.raises(InputError, match=r"walk\.bvh.*nan"):
        capture.motion("walk")


def found_in(monkeypatch: pytest.MonkeyPatch, *clips: Clip) -> None:
    """Let the readers of motion find these clips."""
    monkeypatch.setattr(poses, "load_motions", lambda *_, **__: [SimpleNamespace(clip=clip) for clip in clips])


@pytest.mark.parametrize("part", ["rotations", "translations"])
def test_a_pose_that_a_reader_lets_through_is_named(
    small_capture: Capture, monkeypatch: pytest.MonkeyPatch, part: str
) -> None:
    clip = small_capture.motion("walk")
    values = getattr(clip, part).copy()
    values[2, 1, 0] = np.inf
    found_in(monkeypatch, replace(clip, **{part: values}))
    with pytest.raises(InputError, match=r"walk\.bvh: pose 2: a joint's place or turn is not finite"):
        small_capture.motion("walk")


def test_of_several_motions_the_one_of_the_clips_name_is_taken(
    small_capture: Capture, monkeypatch: pytest.MonkeyPatch
) -> None:
    clip = small_capture.whole_motion("walk")
    jump = replace(clip, name="jump")
    later = replace(clip.cut(slice(1, None)), name="walk")
    found_in(monkeypatch, jump, later)
    np.testing.assert_array_equal(small_capture.whole_motion("walk").rotations, later.rotations)
    found_in(monkeypatch, jump)
    assert small_capture.whole_motion("walk").name == "walk", "a motion alone has any name"
    found_in(monkeypatch, jump, replace(clip, name="run"))
    with pytest.raises(InputError, match=r"holds 2 motions \('jump', 'run'\), none of which is called 'walk'"):
        small_capture.whole_motion("walk")


def test_the_template_has_the_height_and_the_parts_that_were_filmed(small_capture: Capture) -> None:
    taller = replace(small_capture, template_height=3.4)
    assert np.ptp(taller.surfaces.vertices[:, 1]) == pytest.approx(3.4)
    with pytest.raises(InputError, match="--leave-out hat"):
        _ = replace(small_capture, leave_out=("hat",)).surfaces
