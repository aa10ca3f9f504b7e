"""Levels of detail of AvatarRenderer and the budget of several, in a player loop of stand-ins."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from component import Story, counts
from frame_bounds import FRAME_ORDER
from synthetic_avatar import synthetic_avatar

from mua.asset import write


def test_the_level_follows_the_camera_or_what_is_asked_for(story: Story) -> None:
    reported, levels = story("ChangesLevel", "first"), counts(1)
    assert reported["distance"] == [str(levels[level]) for level in (0, 2, 0)]
    assert reported["asked"] == [str(levels[level]) for level in (1, 2, 0)]
    assert reported["nearest"] == [str(levels[level]) for level in (0, 2, 0)]  # for two cameras, then for one
    assert reported["still"] == [str(len(FRAME_ORDER))]
    assert reported["geometry"] == [str(levels[0])] * 2  # also where distance would choose
    assert reported["log"] == []


def test_texels_are_measured_at_the_nearest_point_that_is_drawn(story: Story) -> None:
    """That is the near plane, 0.25 m away, where the eye is within the box; a scaled avatar has larger ones."""
    reported = story("MeasuresTexels", "first")
    focal = float(reported["focal"][0])
    seen = [tuple(map(float, line.split())) for line in reported["seen"]]
    for found, wanted in zip(seen, [(0, focal / 0.25)] * 2 + [(2, focal / 2)] * 2 + [(2, 3 * focal / 2)], strict=True):
        assert found == pytest.approx(wanted, rel=1e-4)
    assert float(reported["between"][0]) == pytest.approx(2.5, rel=1e-4)  # the middle of eyes that are 1 m and 4 m away


def test_avatars_share_a_budget_the_nearest_first(story: Story) -> None:
    reported, first, second = story("SharesBudget", "first", "second"), counts(1), counts(2)
    assert reported["splats"] == [f"{first[i]} {second[j]}" for i, j in ((0, 0), (0, 1), (2, 2))]
    assert reported["one camera"] == [f"{first[0]} {second[1]}"]
    assert reported["two cameras"] == [f"{first[1]} {second[0]}"]  # another avatar is nearer to the second camera
    assert reported["fixed"] == [f"{first[2]} {second[0]}"] * 2
    assert reported["alone"] == [str(first[0])]  # what is not in view takes nothing off
    assert reported["later"] == [
        f"{first[0]} {second[0]}",
        f"{first[2]} {second[2]}",
    ]  # the budget that was enabled last counts
    assert reported["earlier"] == [f"{first[2]} {second[2]}"]  # where that one goes, the one before does
    assert reported["free"] == [f"{first[0]} {second[0]}"]
    assert reported["allocated"] == ["0"]
    assert reported["log"] == []


def test_a_level_that_is_picked_in_the_inspector_is_checked(story: Story, folder: Path) -> None:
    avatar = synthetic_avatar(1)
    taps: dict[str, Any] = {name: np.pad(getattr(avatar.wavelet, name), 12) for name in ("rec_lo", "rec_hi")}
    write(folder / "long.muaavatar", replace(avatar, wavelet=replace(avatar.wavelet, **taps)), storage="f16")
    reported = story("LevelIsPicked", "long")
    assert reported["message"] == ["", "the avatar has no such level of detail; it is shown at full size."]
    assert reported["budget"] == ["0 0"]


def test_an_avatar_that_lacks_the_level_asked_for_is_shown_at_full_size(story: Story, folder: Path) -> None:
    """Not at the coarsest that it has."""
    avatar = synthetic_avatar(1, levels=3)
    write(folder / "two.muaavatar", avatar, storage="f16")
    assert avatar.at_level(1) is not None
    reported = story("LevelIsPicked", "two")
    assert reported["message"][1].startswith("the avatar has no such level of detail")
    assert reported["splats"] == [str(len(avatar.rig.texels.texels))]


def test_an_avatar_without_levels_says_so_once_and_shows_all(story: Story, folder: Path) -> None:
    avatar = synthetic_avatar(1)
    taps: dict[str, Any] = {name: np.pad(getattr(avatar.wavelet, name), 12) for name in ("rec_lo", "rec_hi")}
    write(folder / "long.muaavatar", replace(avatar, wavelet=replace(avatar.wavelet, **taps)), storage="f16")
    reported = story("LacksLevel", "long")
    assert reported["splats"] == [str(counts(1)[0])] * 2
    sentence = "the avatar has no such level of detail; it is shown at full size."
    assert reported["message"] == [sentence]
    assert [line.rpartition(": ")[2] for line in reported["log"]] == [sentence]


def test_geometry_is_never_drawn_of_a_coarser_level(story: Story) -> None:
    """Its triangles are of the finest: that is decoded at once, also in the middle of a clip."""
    reported, levels = story("ShowsGeometryWhilePlaying", "first"), counts(1)
    assert reported["coarse"] == [str(levels[2])]
    assert reported["geometry"] == [str(levels[0])] * 3


def test_an_avatar_that_was_far_away_when_others_came_has_room_for_all_its_splats(story: Story) -> None:
    reported, levels = story("ComesNear", "first"), counts(1)
    assert (reported["far"], reported["near"]) == ([str(levels[2])], [str(levels[0])])
    assert int(reported["room"][0]) >= levels[0]


def test_an_avatar_without_splats_takes_nothing_of_the_budget(story: Story) -> None:
    assert story("SharesBudgetWithTemplate", "first", "second")["splats"] == [str(counts(1)[0])]
