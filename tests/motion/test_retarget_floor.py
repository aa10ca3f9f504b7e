"""Retargeting sets figures on the floor, and keeps the height of those that never stand."""

from dataclasses import replace

import numpy as np
import pytest
from people import (
    POSITION_BOUND,
    lying,
    on_thick_soles,
    person,
    retarget,
    still,
    walk,
    with_offset,
    world,
)

from mua.motion.match import match_joints
from mua.motion.quality import measure_motion
from mua.motion.source_motion import SourceMotion

LYING = 0.01  # metres: feet of the walk are this level; without a floor in the rest pose its lowest ones make one


def test_source_resting_about_its_hips_is_set_on_the_floor() -> None:
    source, target = person(), person(size=1.2, axes=2)
    floating = with_offset(source, "Hips", 0)
    standing = still(floating, 5, root=[0, 1.07, 0])
    found, _ = retarget(SourceMotion(floating, standing), target)
    expected = target.world(target.bind_rotations, target.bind_translations)[1]
    np.testing.assert_allclose(world(target, found)[1][0], expected, atol=POSITION_BOUND)


def test_a_rest_pose_that_lies_says_nothing_of_the_floor() -> None:
    source, target = SourceMotion(person(), walk(person())), person(size=1.2, axes=2)
    expected, _ = retarget(source, target)
    found, _ = retarget(replace(source, skeleton=lying(person())), target)
    np.testing.assert_allclose(world(target, found)[1], world(target, expected)[1], atol=LYING)


def test_keeps_the_height_of_a_clip_that_never_stands_and_says_so() -> None:
    source = person()
    floating = with_offset(source, "Hips", 0)
    flight = still(floating, 5, root=[0, 4.0, 0])
    found, notes = retarget(SourceMotion(floating, flight, notes=("The reader guessed.",)), source)
    assert world(source, found)[1][0, 0, 1] == pytest.approx(4)
    kept = "still: its feet never come nearer to the floor than 3.00 m; the height is kept."
    assert notes == ("The reader guessed.", kept)


def test_feet_that_step_on_one_level_are_put_on_the_floor() -> None:
    source = person()
    clip = walk(source)
    lifted = replace(clip, translations=clip.translations + np.eye(len(source.names))[:, :1] * [0, 0.65, 0])
    floating = with_offset(source, "Hips", 0)
    expected, _ = retarget(SourceMotion(floating, clip), source)
    found, notes = retarget(SourceMotion(floating, lifted), source)
    np.testing.assert_allclose(world(source, found)[1], world(source, expected)[1], atol=POSITION_BOUND)
    assert any("put on the floor" in note for note in notes)


def test_feet_that_stay_where_a_raised_rest_pose_has_them_stand() -> None:
    """Files without joints in the soles begin above the floor, and so do figures on a pedestal."""
    raised = person()
    raised.bind_translations[raised.root, 1] += 0.35
    found, notes = retarget(SourceMotion(raised, still(raised, frames=30)), person())
    at_rest = np.tile(world(person(), still(person()))[1], (30, 1, 1))
    np.testing.assert_allclose(world(person(), found)[1], at_rest, atol=1e-9)
    assert not any("floor" in note for note in notes)


def test_a_figure_on_thick_soles_stands_as_high_as_its_file_has_it() -> None:
    """Its soles reach down to the floor from joints that are far above it."""
    source, target = person(), on_thick_soles(person(size=0.6))
    clip = walk(source)
    found, _ = retarget(SourceMotion(source, clip), target)
    feet = [target.names.index(f"{side}Foot") for side in ("Left", "Right")]
    at_rest = target.world(target.bind_rotations, target.bind_translations)[1][feet[0], 1]
    assert at_rest > 0.15 * np.ptp(target.world(target.bind_rotations, target.bind_translations)[1][:, 1])
    lower = world(target, found)[1][:, feet, 1].min(axis=1)
    assert np.median(lower) == pytest.approx(at_rest, abs=0.02)
    height = measure_motion(SourceMotion(source, clip), target, found, match_joints(source, target)).feet_height
    assert height == pytest.approx(0, abs=0.02)


def test_legs_without_feet_end_on_the_floor() -> None:
    source = person()
    clip = walk(source)
    names = tuple(name.replace("Foot", "Wheel").replace("Toe", "Cap") for name in source.names)
    target = replace(person(size=0.4), names=names)
    lifted = replace(clip, translations=clip.translations + np.eye(len(source.names))[:, :1] * [0, 0.65, 0])
    found, _ = retarget(SourceMotion(source, lifted), target)
    wheels = [names.index(f"{side}Wheel") for side in ("Left", "Right")]
    lowest = world(target, found)[1][:, wheels, 1].min(axis=1)
    assert np.abs(lowest - target.world(target.bind_rotations, target.bind_translations)[1][wheels[0], 1]).max() < 0.03


def test_feet_that_climb_keep_their_height() -> None:
    source = person()
    clip = walk(source)
    path = np.linspace(0.5, 2.0, len(clip))[:, None, None] * np.eye(len(source.names))[:, :1] * [0, 1, 0]
    climb = replace(clip, translations=clip.translations + path)
    found, _ = retarget(SourceMotion(with_offset(source, "Hips", 0), climb), source)
    assert world(source, found)[1][..., 1].min() > 0.4
