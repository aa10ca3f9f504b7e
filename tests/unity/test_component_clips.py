"""Clips that AvatarRenderer plays in a player loop of stand-ins."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from component import RATE, SECOND, Story, counts
from frame_bounds import FEWER_THAN, FRAME_ORDER
from synthetic_avatar import synthetic_avatar
from training import outside_of_training

from mua.asset import write
from mua.pose.resample import resample


def test_a_clip_plays(story: Story) -> None:
    reported = story("Plays", "first")
    assert reported["state"] == ["Ready"]
    assert reported["clips"] == [" ".join(clip.name for clip in synthetic_avatar(1).clips)]
    assert reported["draws"] == [str(SECOND)]
    assert reported["log"] == []


def test_an_application_chooses_clip_frame_and_speed(story: Story, folder: Path) -> None:
    avatar = synthetic_avatar(1)
    [clip] = avatar.clips
    shorter = replace(clip, name="shorter", rotations=clip.rotations[:4], translations=clip.translations[:4])
    later = replace(clip, name="later", rotations=clip.rotations[4:], translations=clip.translations[4:])
    write(folder / "clips.muaavatar", replace(avatar, clips=(clip, shorter, later)))
    reported = story("Steers", "clips")
    counts = [len(resample(each, avatar.encoding.rate)) for each in (clip, shorter, later)]
    assert (reported["name"], reported["progress"], reported["frames"]) == ([avatar.name], ["1"], [str(counts[0])])
    assert reported["clip"] == [f"{index} 0 {counts[index]}" for index in (0, 2, 1, 0)]
    assert reported["still"] == ["0.25"]
    assert float(reported["half"][0]) == pytest.approx(36 / SECOND)
    assert float(reported["slow"][0]) == pytest.approx(0.5)
    assert float(reported["back"][0]) == pytest.approx(0.5)
    assert reported["posed"][0] != reported["posed"][1]  # the first poses of two clips, one after the other
    missing = f"the avatar has no clip nobody's; its clips are {clip.name}, shorter, later."
    assert reported["picked"] == [f"0 {missing}", "2 "]
    assert [line.rpartition(": ")[2] for line in reported["log"]] == [missing]


def test_numbers_and_names_that_mean_nothing_leave_a_clip_that_plays(story: Story) -> None:
    """Python and the browser refuse or ignore the same: a moment that is no number is the clip's first."""
    reported = story("IsMisused", "first")
    assert set(reported["moment"]) == {"True"}
    assert float(reported["plays"][0]) == pytest.approx(36 / SECOND)
    assert reported["splats"] == [str(counts(1)[0])] * 2
    assert reported["loaded"] == [*["Empty False False"] * 2, *["Failed True False"] * 2, "Empty False False"]
    assert reported["destroyed"] == ["Empty 0 0"]


def test_an_avatar_says_how_far_outside_of_training_its_pose_is(story: Story, folder: Path) -> None:
    reported, file = story("LeavesTraining", "first"), folder / "first.muaavatar"
    expected = [outside_of_training(file, frame) for frame in (2, 5, 0)]
    assert min(np.abs(np.diff(expected))) > 0.01
    assert [float(number) for number in reported["outside"]] == pytest.approx(expected, rel=1e-6)
    assert reported["loading"] == ["0"]


def test_an_avatar_is_decoded_at_its_own_rate_and_posed_in_every_frame(story: Story) -> None:
    posed = FRAME_ORDER[FRAME_ORDER.index("BlendVertices") :]
    decodes, rest = divmod(
        int(story("Plays", "first")["dispatches"][0]) - SECOND * len(posed), len(FRAME_ORDER) - len(posed)
    )
    assert rest == 0
    assert abs(decodes - RATE) <= 1
    assert len(FRAME_ORDER) < FEWER_THAN


def test_each_avatar_starts_over_where_its_own_clip_ends(story: Story, folder: Path) -> None:
    avatar = synthetic_avatar(2)
    clip = avatar.clips[0]
    short = replace(clip, rotations=clip.rotations[:3], translations=clip.translations[:3])
    write(folder / "short.muaavatar", replace(avatar, clips=(short,)), storage="f16")
    reported = story("EndsEarly", "short", "first")
    frames = len(synthetic_avatar(1).clips[0])
    assert reported["counts"] == [f"3 {frames}"]
    assert reported["frames"] == [f"{at % 3} {at % frames}" for at in (4, 8, 12)]  # 12 displayed frames are 4 of a clip


def test_a_clip_holds_its_last_frame_until_it_starts_over(story: Story) -> None:
    assert story("StaysAtItsEnd", "first")["at"] == ["last", "last", "last", "first", ""]


def test_a_clip_stands_still_in_an_editor_that_does_not_play(story: Story) -> None:
    still, playing = (float(seconds) for seconds in story("StandsStillInEditor", "first")["seconds"])
    assert still == 0.1
    assert playing == pytest.approx(0.1 + 10 / SECOND)
