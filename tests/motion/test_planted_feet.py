"""Feet stand where the source's do, on legs of other proportions, without turning feet or limbs visibly."""

from dataclasses import replace

import numpy as np
import pytest
from people import person, retarget, still, upright, walk, world

from mua.motion.match import match_joints
from mua.motion.planted_feet import Feet, plant_feet
from mua.motion.quality import MotionQuality, measure_motion
from mua.motion.source_motion import SourceMotion
from mua.pose.clip import Clip
from mua.pose.skeleton import Skeleton

ROUNDING = 1e-9  # turns through some ten products of rotations
STRETCH = 0.03  # metres by which a foot rises where the leg is too short to reach
SMALL = 4.0  # degrees by which a limb may turn so that a foot stands


def long_thighs() -> Skeleton:
    """The person with plain axes whose thighs are twice as long as its shins, which stay as they are."""
    skeleton = person()
    offsets = skeleton.bind_translations.copy()
    for side in ("Left", "Right"):
        offsets[skeleton.names.index(f"{side}Leg")] *= 2
    offsets[0, 1] += np.linalg.norm(offsets[skeleton.names.index("LeftLeg")]) / 2
    return replace(skeleton, bind_translations=offsets)


def put_on(source: SourceMotion, target: Skeleton, feet: Feet) -> tuple[Clip, MotionQuality, tuple[str, ...]]:
    matches = match_joints(source.skeleton, target)
    clip, _ = retarget(source, target)
    held, notes = plant_feet(source, target, clip, matches, feet=feet)
    return held, measure_motion(source, target, held, matches), notes


def test_standing_feet_of_other_legs_stand() -> None:
    source, target = SourceMotion(person(), walk(person())), long_thighs()
    kept, before, no_notes = put_on(source, target, "keep")
    held, after, notes = put_on(source, target, "auto")
    assert before.slide is not None
    assert after.slide is not None
    assert before.slide > 0.1
    assert after.slide < before.slide / 4
    assert after.limb_degrees < SMALL
    assert (no_notes, len(notes)) == ((), 1)
    feet = [target.names.index(name) for name in ("LeftFoot", "RightToeBase")]
    turned = np.sum(world(target, kept)[0][:, feet] * world(target, held)[0][:, feet], axis=-1)
    np.testing.assert_allclose(np.abs(turned), 1, atol=ROUNDING)
    height = np.abs(world(target, kept)[1][:, feet, 1] - world(target, held)[1][:, feet, 1])
    assert height.max() < STRETCH


def test_no_foot_jumps_where_it_begins_or_ends_to_stand() -> None:
    source, target = SourceMotion(person(), walk(person())), long_thighs()
    fastest = []
    for feet in ("keep", "plant"):
        at = world(target, put_on(source, target, feet)[0])[1][:, target.names.index("LeftFoot")]
        fastest.append(np.linalg.norm(np.diff(at, axis=0), axis=-1).max())
    assert fastest[1] < 1.5 * fastest[0]


def test_feet_are_left_alone_where_the_source_slides_or_nothing_is_won() -> None:
    clip = walk(person())
    sliding = replace(clip, translations=clip.translations.copy())
    sliding.translations[:, 0, 2] *= 0.7
    for source, target in ((SourceMotion(person(), sliding), long_thighs()), (SourceMotion(person(), clip), person())):
        kept, _, _ = put_on(source, target, "keep")
        held, _, notes = put_on(source, target, "auto")
        assert held is kept or (held.rotations == kept.rotations).all()
        assert notes == ()


@pytest.mark.parametrize("feet", ["auto", "plant"])
def test_bodies_without_legs_and_single_frames_stay_as_they_are(feet: Feet) -> None:
    half = upright(("Hips", "Spine"), (-1, 0), [[0, 1.0, 0], [0, 0.5, 0]])
    clip = still(half, 3)
    assert plant_feet(SourceMotion(half, clip), half, clip, match_joints(half, half), feet=feet) == (clip, ())
    whole = person()
    single = walk(whole, frames=1)
    assert plant_feet(SourceMotion(whole, single), whole, single, match_joints(whole, whole), feet=feet)[0] is single
