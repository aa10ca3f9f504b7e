"""A Timeline and animated fields move AvatarRenderer through its clips, in a player loop of stand-ins."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from component import Reports, Story
from synthetic_avatar import synthetic_avatar, with_expressions

from mua import rotation
from mua.asset import write

BLENDED = 1e-12  # one slerp of unit quaternions
ROUNDED = 1e-6  # of weights in float32
SHARE = 0.25  # of the second clip


@pytest.fixture(scope="module")
def told(story: Story, folder: Path) -> Reports:
    """What a Timeline does with an avatar of two clips that move its face."""
    made = synthetic_avatar(1)
    other = replace(made.clips[0], name="other", rotations=made.clips[0].rotations[::-1].copy())
    write(folder / "two.muaavatar", with_expressions(replace(made, clips=(*made.clips, other))), storage="f32")
    return story("PlaysTimeline", "two")


def test_a_timeline_gives_clip_and_time_until_it_ends(told: Reports) -> None:
    assert told["log"] == []
    assert told["first"] == told["paused"] == ["0 0.1"]  # the clip does not go on by itself
    assert told["second"] == ["1 0.05"]
    assert told["scrubbed"] == ["0 0.02"]
    assert told["gap"] == ["1 True"]  # what played before goes on
    assert told["after"] == ["1"]


def test_overlapping_clips_go_over_into_each_other(told: Reports) -> None:
    blend, first, second = (np.array(line.split(), float).reshape(-1, 4) for line in (*told["blend"], *told["part"]))
    wanted = rotation.slerp(first, second, np.full(len(first), SHARE))
    np.testing.assert_allclose(np.abs(np.sum(blend * wanted, axis=-1)), 1, atol=BLENDED)
    window, one, other = (
        np.array(line.split(), float).reshape(-1, 4) for line in (*told["blend window"], *told["part window"])
    )
    wanted = rotation.slerp(one, other, np.full(len(one), SHARE))
    np.testing.assert_allclose(np.abs(np.sum(window * wanted, axis=-1)), 1, atol=BLENDED)
    weights, before, after = (np.array(line.split(), float) for line in (*told["blend weights"], *told["part weights"]))
    np.testing.assert_allclose(weights, before + SHARE * (after - before), atol=ROUNDED)
    assert np.abs(np.sum(first * second, axis=-1)).min() < 1 - 1e-3  # the two differ


def test_a_moment_looks_the_same_wherever_the_playhead_comes_from(told: Reports) -> None:
    for part in ("", " window", " weights"):
        assert told[f"again{part}"] == told[f"blend{part}"]


def test_a_timeline_allocates_nothing(told: Reports) -> None:
    assert told["allocated"] == ["0"]


def test_an_unknown_clip_is_named_once(story: Story) -> None:
    reported = story("AsksForUnknownClip", "first")
    assert reported["shown"] == ["0 0.2"]
    assert len(reported["log"]) == 1
    assert "asks for the clip nobody's, which the avatar has not; its clips are" in reported["log"][0]


def test_a_timeline_may_begin_before_its_avatar_and_end_after_it(story: Story) -> None:
    reported = story("OutlivesAvatar", "first")
    assert reported["shown"] == ["0 0.2"]
    assert reported["log"] == []


def test_an_avatar_that_a_timeline_leaves_for_another_goes_on_as_before(story: Story) -> None:
    reported = story("ChangesAvatar", "first", "second")
    assert (reported["left"], reported["taken"]) == (["True"], ["0 0.2"])


def test_an_animation_of_time_and_playing_moves_the_avatar(story: Story) -> None:
    reported = story("AnimatesFields", "first")
    assert reported["begins"] == reported["rests"] == reported["reloaded"] == ["0 0.125"]
    assert reported["goes"] == ["0 0.05"]
    plays, seconds = reported["plays"][0].split()
    assert plays == "True"
    assert float(seconds) == pytest.approx(0.05 + 9 / 72, abs=1e-5)
