"""What the browser player plays: its clip, time and frames, and where that places an avatar."""

import json
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from synthetic_avatar import synthetic_avatar
from web.test_modules import EXACT, node, pytestmark  # noqa: F401  needs Node

from mua.asset import write
from mua.asset.avatar import Avatar
from mua.asset.read import read
from mua.pose.resample import resample

LONGEST = 0.25  # seconds that one image plays at most
PLACE = np.tile([10, 20, 30], 2)  # where modules.mjs stands it, metres


def avatar() -> Avatar:
    """Two clips at another rate than the encoding's."""
    made = synthetic_avatar()
    first = replace(made.clips[0], rate=made.encoding.rate / 2)
    return replace(made, clips=(first, replace(first, name="again")))


def played(folder: Path, *changes: tuple[str, object], of: Avatar | None = None) -> list[dict[str, Any]]:
    file = folder / "a.muaavatar"
    write(file, of or avatar(), storage="f32")
    found: list[dict[str, Any]] = node("played", file, json.dumps(changes))[0]
    return found


def length(of: Avatar) -> float:
    """Seconds of the first clip."""
    return len(resample(of.clips[0], of.encoding.rate)) / of.encoding.rate


def test_time_goes_round_within_the_clip(tmp_path: Path) -> None:
    seconds = length(avatar())
    found = played(tmp_path, ("time", 1.25 * seconds), ("time", -0.25 * seconds), ("time", None))
    assert [one["time"] for one in found] == pytest.approx([0.25 * seconds, 0.75 * seconds, 0])


def test_playing_goes_on_by_what_has_passed_at_its_speed(tmp_path: Path) -> None:
    found = played(tmp_path, ("advance", 40), ("speed", 0.5), ("advance", 60), ("playing", False), ("advance", 90))
    assert [one["time"] for one in found] == pytest.approx([0.04, 0.04, 0.05, 0.05, 0.05])


def test_a_tab_that_was_hidden_does_not_catch_up_and_no_clock_goes_back(tmp_path: Path) -> None:
    long = replace(avatar(), clips=(replace(avatar().clips[0], rate=2.0),))
    found = played(tmp_path, ("advance", 60_000), ("advance", 59_000), ("advance", 59_010), of=long)
    assert [one["time"] for one in found] == pytest.approx([LONGEST, LONGEST, LONGEST + 0.01])


def test_another_clip_begins_anew_and_one_that_is_not_there_is_the_first(tmp_path: Path) -> None:
    first, late = avatar().clips[0].name, ("time", 0.05)
    found = played(tmp_path, late, ("clip", first), ("clip", "again"), late, ("clip", "none"), late)
    clips = [first, first, "again", "again", first, first]
    assert [one["clip"] for one in found] == clips
    assert [one["time"] for one in found] == pytest.approx([0.05, 0.05, 0, 0.05, 0, 0.05])


def test_the_next_frame_follows_while_a_clip_plays_and_skips_none(tmp_path: Path) -> None:
    made = avatar()
    frames, step = len(resample(made.clips[0], made.encoding.rate)), 1000 / made.encoding.rate
    changes = (
        ("time", (frames - 0.4) / made.encoding.rate),
        ("advance", step / 5),
        ("playing", False),
        ("playing", True),
        ("advance", step * 1.5),
    )
    found = [(one["frame"], one["following"]) for one in played(tmp_path, *changes)]
    last = frames - 1
    assert found == [(last, last), (last, 0), (last, last), (last, 0), (1, 1)]


def test_an_avatar_without_clips_rests_in_its_bind_pose(tmp_path: Path) -> None:
    [found] = played(tmp_path, ("advance", 100), of=replace(avatar(), clips=()))
    still = read(tmp_path / "a.muaavatar")
    assert (found["clip"], found["time"], found["frame"], found["following"]) == (None, 0, 0, 0)
    skeleton = still.rig.skeleton
    root = skeleton.world(skeleton.bind_rotations[None], skeleton.bind_translations[None])[1][0, skeleton.root]
    np.testing.assert_allclose(found["box"], np.ravel(still.bounds) + np.tile(root, 2) + PLACE, rtol=EXACT)


def test_a_box_goes_with_the_root_joint_and_the_place(tmp_path: Path) -> None:
    [found] = played(tmp_path, ("time", 3 / avatar().encoding.rate))
    made = read(tmp_path / "a.muaavatar")
    clip, skeleton = resample(made.clips[0], made.encoding.rate), made.rig.skeleton
    root = skeleton.world(clip.rotations[[3]], clip.translations[[3]])[1][0, skeleton.root]
    assert found["frame"] == 3
    np.testing.assert_allclose(found["box"], np.ravel(made.bounds) + np.tile(root, 2) + PLACE, rtol=EXACT)
