"""What a teacher trained on a capture is recorded on: clips at several headings, by shares."""

import numpy as np
import pytest
from captures import motions
from synthetic_avatar import synthetic_avatar

from mua import rotation
from mua.baking.capture_motion import HEADINGS, UP, filmed_settings, plan_headings, turned
from mua.baking.plan import HeldOut
from mua.pose.clip import Clip
from mua.recording import PlannedClip
from mua.student.settings import preset
from mua.teachers.procedural import procedural_character


def counts(planned: list[PlannedClip]) -> dict[str, int]:
    return {clip.clip.name: len(clip.wanted) for clip in planned}


def test_a_turned_clip_is_the_same_motion_about_the_y_axis() -> None:
    skeleton, clip = procedural_character().skeleton, motions()["walk"]
    turn = rotation.from_axis_angle(UP, 0.7)
    other = turned(clip, skeleton, 0.7)
    for own, shown in zip(
        skeleton.world(clip.rotations, clip.translations),
        skeleton.world(other.rotations, other.translations),
        strict=True,
    ):
        expected = rotation.multiply(turn, own) if own.shape[-1] == 4 else rotation.rotate(turn, own)
        np.testing.assert_allclose(shown, expected, atol=1e-12)
    x, _, z = rotation.rotate(rotation.from_axis_angle(UP, np.pi / 2), np.array([0.0, 0, 1]))
    assert (x, z) == pytest.approx((1, 0))  # to the figure's left


def test_filmed_clips_get_up_to_half_and_turned_and_other_ones_share_the_rest() -> None:
    avatar = synthetic_avatar()
    clip = avatar.clips[0]
    filmed, other, held = (Clip(name, 30.0, *long(clip, 80)) for name in ("filmed", "other", "held"))
    planned = plan_headings(avatar.rig.skeleton, [filmed, other], [HeldOut(held)], filmed={"filmed"}, frames=126)
    found = counts(planned)
    assert found.pop("held") == 31
    assert found.pop("filmed") == 63
    assert found.pop("other") == 21
    degrees = [360 * part // HEADINGS for part in range(1, HEADINGS)]
    assert found == {f"{name} ({angle} degrees)": 7 for name in ("filmed", "other") for angle in degrees}
    assert [clip.clip.name for clip in planned if clip.held_out] == ["held"]


def test_what_few_frames_leave_goes_to_the_others() -> None:
    avatar = synthetic_avatar()
    filmed, other = (
        Clip(name, 30.0, *long(avatar.clips[0], frames)) for name, frames in (("filmed", 5), ("other", 900))
    )
    found = counts(plan_headings(avatar.rig.skeleton, [filmed, other], [], filmed={"filmed"}, frames=220))
    assert found["filmed"] == 5
    assert sum(count for name, count in found.items() if name.startswith("filmed (")) == 15
    assert found["other"] == 100
    assert sum(found.values()) == 220


def long(clip: Clip, frames: int) -> tuple[np.ndarray, np.ndarray]:
    """The first pose of a clip, so many times."""
    return np.repeat(clip.rotations[:1], frames, axis=0), np.repeat(clip.translations[:1], frames, axis=0)


def test_the_students_descriptor_keeps_the_heading() -> None:
    settings = filmed_settings(preset("tiny"), 128)
    assert settings.texels == 128
    assert not settings.generalisation.remove_heading
