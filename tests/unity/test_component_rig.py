"""Rigs that AvatarRenderer follows in a player loop of stand-ins."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from component import SECOND, TRANSLATED, TURNED, Story
from frame_bounds import FRAME_ORDER
from synthetic_avatar import synthetic_avatar

from mua.asset import write


def test_a_joint_that_is_destroyed_returns_to_its_bind_pose(story: Story) -> None:
    """Of two objects of one name the first is followed."""
    skeleton, clip = synthetic_avatar(1).rig.skeleton, synthetic_avatar(1).clips[0]
    found = [np.array(line.split(), float) for line in story("LosesJoint", "first")["last"]]
    for rotation, expected in zip(found, (clip.rotations[2, -1], skeleton.bind_rotations[-1]), strict=True):
        assert abs(rotation @ expected) == pytest.approx(1, abs=1e-5)


def test_an_inactive_joint_counts_as_missing(story: Story) -> None:
    assert synthetic_avatar(1).rig.skeleton.names[-1] in story("HasInactiveJoint", "first")["missing"][0]


def test_transforms_give_the_pose_wherever_their_root_stands(story: Story) -> None:
    reported = story("FollowsRig", "first")
    assert float(reported["turned"][0]) < TURNED
    assert float(reported["translated"][0]) < TRANSLATED


def test_an_avatar_whose_rig_rests_is_only_sorted(story: Story) -> None:
    """Once its window holds nothing but the pose in which it rests: as long as that is, it is decoded."""
    reported = story("RigRests", "first")
    sorting = len(FRAME_ORDER[FRAME_ORDER.index("SplatProject") :])
    posed = len(FRAME_ORDER[FRAME_ORDER.index("BlendVertices") :])
    window = synthetic_avatar(1).encoding.window
    assert reported["settling"] == [str(len(FRAME_ORDER) + (SECOND - 1) * sorting)]  # the first frame fills the window
    assert reported["idle"] == [str(10 * sorting)] * 3
    for moved in ("woken", "stepped"):
        decodes, reposes = divmod(int(reported[moved][0]) - SECOND * sorting, len(FRAME_ORDER) - sorting)
        assert decodes == window
        assert reposes in (0, posed - sorting)  # the frame that moved, where it is none of the avatar's own rate
    assert reported["carried"] == [str(posed)]
    assert reported["left"] == [str(len(FRAME_ORDER))]


def test_a_rig_that_is_picked_in_the_inspector_is_followed(story: Story) -> None:
    reported = story("RigIsPicked", "first")
    sorting = len(FRAME_ORDER[FRAME_ORDER.index("SplatProject") :])
    assert reported["idle"] == [str(10 * sorting)]
    assert int(reported["woken"][0]) > 10 * sorting


def test_a_rig_that_rested_is_remembered_resting(story: Story) -> None:
    reported = story("RemembersRest", "first")
    assert reported["changes"] == ["1", "1"]
    assert (reported["fresh"], reported["rests"]) == (["1"], ["1"])


def test_the_window_takes_a_pose_in_each_frame_of_the_avatars_rate(story: Story) -> None:
    """On a display three times as fast; it goes on after 3 frames without a pose, starts anew after 4 or going back."""
    reported = story("WindowTakesTurns", "first")
    window = synthetic_avatar(1).encoding.window
    assert window == 3
    assert reported["window"] == ["12 9 6", "13 12 9", "14 14 14", "15 14 14", "16 16 16"]
    assert [float(number) for number in reported["before"]] == [pytest.approx(0.5), pytest.approx(1)]
    assert reported["steady"] == ["300"]  # one pose in each frame
    assert reported["other clip"] == ["1"]  # is another window, though both play their first frame


def test_a_rig_that_is_destroyed_is_said_once(story: Story) -> None:
    reported = story("FollowsRig", "first")
    assert reported["state"] == ["Ready"]
    assert len(reported["log"]) == 1
    assert "destroyed" in reported["log"][0]


def test_missing_joints_are_said_once(story: Story) -> None:
    reported = story("LacksJoint", "first")
    assert reported["state"] == ["Ready"]
    some, root = reported["log"]
    assert synthetic_avatar(1).rig.skeleton.names[-1] in some
    assert "root joint" in root


def test_an_avatar_without_clips_returns_to_its_bind_pose_when_its_rig_goes(story: Story, folder: Path) -> None:
    write(folder / "mute.muaavatar", replace(synthetic_avatar(1), clips=()))
    before, meanwhile, after = story("LeavesRigWithoutClips", "first", "mute")["middle"]
    assert before == after != meanwhile


def test_a_larger_rig_gives_the_same_pose(story: Story) -> None:
    assert float(story("FollowsScaledRig", "first")["off"][0]) < TRANSLATED
