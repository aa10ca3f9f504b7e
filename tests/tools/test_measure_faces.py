"""Faces of avatars beside their teacher: what is spoken, and which teacher tells light from shape."""

from collections.abc import Iterator
from dataclasses import replace

import numpy as np
import pytest
from measure_faces import BENT, FIXED, RELIT, SENTENCE, STUDENT, SYLLABLE, FaceStudio, Frame, Result, measure, speech
from synthetic_avatar import synthetic_avatar, with_expressions

from mua.arrays import Array
from mua.asset.avatar import Avatar
from mua.avatar.decode import Unposed, express, unposed_clip_frame
from mua.channels import APPEARANCE
from mua.fidelity.canvas import opened
from mua.fidelity.measure import MOST_DECIBELS
from mua.pose.clip import Clip
from mua.pose.skeleton import Pose


class Stub:
    """A stand-in for the simulated teacher: the avatar itself, brighter in expressions."""

    def __init__(self, avatar: Avatar) -> None:
        self._avatar = avatar

    def surfaces(self, clip: Clip) -> Iterator[int]:
        yield from range(len(clip))

    def faced(self, pose: Pose, surface: int, weights: Array) -> Unposed:
        rest = unposed_clip_frame(self._avatar, self._avatar.clips[0], frame=surface)
        mesh, texture = express(self._avatar.rig, rest.mesh, texture=rest.texture, weights=weights)
        texture = texture.copy()
        texture[:, APPEARANCE] += 0.3 * weights.max()
        return Unposed(mesh, texture, 0.0)


@pytest.fixture(scope="module")
def result() -> Result:
    body = synthetic_avatar()
    avatar = replace(with_expressions(body), clips=body.clips)
    clip = body.clips[0].cut(slice(0, 2))
    weights = np.eye(len(avatar.expressions), dtype=np.float32)[0]
    with opened() as context:
        studio = FaceStudio(context, avatar, Stub(avatar), 64)  # type: ignore[arg-type]
        frames: list[Frame] = studio.frames(clip, clip.cut(slice(0, 0)))
        (only,) = measure(studio, frames, avatar, np.tile(weights, (len(frames), 1)), each=0)
    return only


def test_student_that_is_its_teacher_differs_in_light_alone(result: Result) -> None:
    assert result.body == result.box[STUDENT] == result.box[BENT] == result.changed[STUDENT] == MOST_DECIBELS
    assert result.cost(RELIT) > 50


def test_offsets_that_do_not_turn_are_told_apart(result: Result) -> None:
    assert result.changed[BENT + FIXED] < result.changed[BENT]


def test_speech_moves_lips_jaw_and_lids() -> None:
    names = ("jawOpen", "eyeBlinkLeft", "viseme_aa", "browDownLeft")
    weights = speech(names, np.arange(0, len(SENTENCE) * SYLLABLE, SYLLABLE / 4))
    assert (weights >= 0).all()
    assert (weights <= 1).all()
    assert weights.max(axis=0) == pytest.approx([0.3, 1, 1, 0])
    assert (weights[:, 1] == 0).mean() > 0.5


def test_speech_reaches_a_face_with_other_names() -> None:
    weights = speech(("blink", "aa"), np.array([SYLLABLE, 2 * SYLLABLE]))
    assert (weights[[0, 1], [1, 0]] > 0).all()
