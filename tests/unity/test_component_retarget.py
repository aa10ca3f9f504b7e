"""AvatarRenderer posed by a rig of another skeleton, in a player loop of stand-ins."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from component import TRANSLATED, TURNED, Story
from people import person, random_clip
from retargeted import expected
from synthetic_avatar import synthetic_avatar

from mua.asset import read, write
from mua.motion.source_motion import SourceMotion
from mua.pose.joint_names import roles

OURS, THEIRS = person(arms_down=45, size=0.8, axes=2), person(size=1.2, axes=5)
GOES = 2 * 0.8 / 1.2  # metres along the floor, where the rig goes 2
NEAR = 0.01  # metres by which the middle of a box may go otherwise


@pytest.fixture(scope="module")
def people(folder: Path) -> Path:
    """An avatar, and one whose skeleton and clip are those of the rig."""
    made = synthetic_avatar(1)
    for name, skeleton, clips in (("ours", OURS, ()), ("theirs", THEIRS, (random_clip(THEIRS),))):
        avatar = replace(made, rig=replace(made.rig, skeleton=skeleton), clips=clips)
        write(folder / f"{name}.muaavatar", avatar, storage="f32")
    return folder


def humanoid(motion: SourceMotion) -> SourceMotion:
    """The motion of joints whose names tell nothing: the Animator knows them."""
    skeleton = motion.skeleton
    names = tuple(f"bone {joint}" for joint in range(len(skeleton.names)))
    stated = {names[joint]: role for role, joints in roles(skeleton).items() for joint in joints}
    return replace(motion, skeleton=replace(skeleton, names=names), stated=stated)


@pytest.mark.parametrize("name", ["RetargetsNamed", "RetargetsClone", "RetargetsMapped", "RetargetsHumanoid"])
def test_transforms_pose_an_avatar_as_the_package_retargets_them(story: Story, people: Path, name: str) -> None:
    """Wherever their root stands and however large it is: by names, by a mapping, and by an Animator's bones alone."""
    reported = story(name, "ours", "theirs")
    assert reported["log"] == []
    clip = read(people / "theirs.muaavatar").clips[0]
    motion = SourceMotion(THEIRS, clip)
    rotations, translations = expected(humanoid(motion) if name == "RetargetsHumanoid" else motion, OURS)
    found = [
        np.array([line.split() for line in reported[key]], float).reshape(len(clip), -1, width)
        for key, width in (("rotations", 4), ("translations", 3))
    ]
    apart = 1 - np.abs(np.sum(found[0] * rotations, axis=-1))
    np.testing.assert_allclose(apart, 0, atol=TURNED)
    np.testing.assert_allclose(found[1], translations, atol=TRANSLATED)


def test_an_avatar_follows_or_stays_in_place_and_outlives_the_rig(story: Story, people: Path) -> None:
    reported = story("FollowsOtherRig", "ours", "theirs")
    assert float(reported["goes"][0]) == pytest.approx(GOES, abs=NEAR)
    assert float(reported["stays"][0]) == pytest.approx(0, abs=NEAR)
    assert reported["allocated"] == ["0"]
    assert reported["state"] == ["Ready"]
    assert len(reported["log"]) == 1
    assert "the rig that posed the avatar was destroyed" in reported["log"][0]


def test_a_rig_whose_rest_pose_does_not_stand_is_refused_with_a_sentence(story: Story, people: Path) -> None:
    reported = story("RefusesRest", "ours", "theirs")
    assert "the rig figure cannot be followed: its rest pose shows no body that stands" in reported["message"][0]
    assert reported["state"] == ["Ready"]
    assert len(reported["log"]) == 1


def test_whatever_a_rig_is_refused_for_while_loading_is_a_sentence(story: Story, people: Path) -> None:
    reported = story("RefusesNothing", "ours", "theirs")
    assert (reported["state"], reported["held"]) == (["Failed"], ["0"])
    assert "ours.muaavatar: " in reported["message"][0]
