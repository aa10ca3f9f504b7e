"""A figure's front is its front: for any axes of its joints, any pose, and motion from any file."""

from dataclasses import replace

import numpy as np
import pytest
from people import person
from scipy.spatial.transform import Rotation
from shared_data import SharedData
from synthetic_avatar import synthetic_avatar

from mua import rotation
from mua.avatar.decode import decode_clip_frame
from mua.baking.portrait import THREE_QUARTER, portrait
from mua.motion.facing import front_of
from mua.motion.load import load_motions
from mua.motion.rest_alignment import frame
from mua.pose.skeleton import Skeleton

ROUNDING = 1e-6  # radians
SIDES = ("Left", "Right")


def turned(skeleton: Skeleton, turn: Rotation) -> tuple[np.ndarray, np.ndarray]:
    """The bind pose, turned about the root joint as a whole."""
    rotations = skeleton.bind_rotations.copy()
    rotations[0] = rotation.multiply(turn.as_quat(scalar_first=True), rotations[0])
    return rotations, skeleton.bind_translations


def named(skeleton: Skeleton, old: str, new: str) -> Skeleton:
    """The skeleton with words of its names exchanged."""
    swapped = (name.replace(old, "?").replace(new, old).replace("?", new) for name in skeleton.names)
    return replace(skeleton, names=tuple(swapped))


def test_a_body_frame_has_left_up_and_forward_as_columns() -> None:
    up, left = np.array([0, 1.0, 0]), np.array([0.8, 0.6, 0])  # a slanting left is made square to up
    np.testing.assert_allclose(frame(up, left), np.eye(3), atol=1e-15)  # +X left, +Y up, +Z forward


@pytest.mark.parametrize("axes", [None, 0, 1])
@pytest.mark.parametrize("degrees", [-170.0, -60, 0, 35, 90, 180])
def test_the_front_goes_round_with_the_figure(degrees: float, axes: int | None) -> None:
    skeleton = person(axes=axes)
    front = front_of(skeleton, *turned(skeleton, Rotation.from_euler("y", degrees, degrees=True)))
    assert np.exp(1j * front) == pytest.approx(np.exp(1j * np.radians(degrees)), abs=ROUNDING)


@pytest.mark.parametrize("bend", [-80.0, 45, 100])
def test_a_figure_that_bends_keeps_its_front(bend: float) -> None:
    skeleton = person()
    turn = Rotation.from_euler("y", 50, degrees=True) * Rotation.from_euler("x", bend, degrees=True)
    assert front_of(skeleton, *turned(skeleton, turn)) == pytest.approx(np.radians(50), abs=ROUNDING)


def test_a_bind_pose_may_face_anywhere() -> None:
    skeleton = person()
    rotations, _ = turned(skeleton, Rotation.from_euler("y", 180, degrees=True))
    backwards = replace(skeleton, bind_rotations=rotations)
    assert abs(front_of(backwards, *turned(backwards, Rotation.identity()))) == pytest.approx(np.pi, abs=ROUNDING)


def test_a_figure_without_toes_whose_sides_are_swapped_faces_where_bind_poses_do() -> None:
    skeleton = named(named(person(), "Left", "Right"), "Toe", "Claw")
    for degrees in (0, 70):
        front = front_of(skeleton, *turned(skeleton, Rotation.from_euler("y", degrees, degrees=True)))
        assert front == pytest.approx(np.radians(degrees), abs=ROUNDING)


def test_a_bind_pose_that_is_a_little_twisted_faces_along_an_axis_all_the_same() -> None:
    skeleton = person()
    rotations, _ = turned(skeleton, Rotation.from_euler("y", 20, degrees=True))
    twisted = replace(skeleton, bind_rotations=rotations)
    assert front_of(twisted, *turned(twisted, Rotation.identity())) == pytest.approx(0, abs=ROUNDING)
    moved = front_of(twisted, *turned(twisted, Rotation.from_euler("y", 30, degrees=True)))
    assert moved == pytest.approx(np.radians(30), abs=ROUNDING)


def test_toes_show_where_a_rig_exchanges_left_and_right() -> None:
    skeleton = named(person(), "Left", "Right")
    assert front_of(skeleton, *turned(skeleton, Rotation.identity())) == pytest.approx(0, abs=ROUNDING)


def test_a_figure_turns_below_a_root_that_stands_still() -> None:
    skeleton = person()
    above = replace(
        skeleton,
        names=("Reference", *skeleton.names),
        parents=np.concatenate([[-1], skeleton.parents + 1]).astype(np.int32),
        bind_rotations=np.concatenate([[[1.0, 0, 0, 0]], skeleton.bind_rotations]),
        bind_translations=np.concatenate([np.zeros((1, 3)), skeleton.bind_translations]),
    )
    rotations = above.bind_rotations.copy()
    rotations[1] = Rotation.from_euler("y", 70, degrees=True).as_quat(scalar_first=True)
    assert front_of(above, rotations, above.bind_translations) == pytest.approx(np.radians(70), abs=ROUNDING)


def test_a_figure_that_is_no_person_faces_as_its_root_has_turned() -> None:
    skeleton = person(axes=3)
    creature = replace(skeleton, names=tuple(f"part {i}" for i in range(len(skeleton.names))))
    turn = Rotation.from_euler("y", -40, degrees=True)
    assert front_of(creature, *turned(creature, turn)) == pytest.approx(np.radians(-40), abs=ROUNDING)


@pytest.mark.parametrize("name", ["motion/dab.bvh", "motion/jumping.bvh", "motion/cmu/01_03.bvh"])
def test_toes_of_captured_motion_point_to_the_front(shared_data: SharedData, name: str) -> None:
    skeleton = person()
    clip = load_motions(shared_data.path(name), skeleton, mapping=None, rate=30)[0].clip
    front = front_of(skeleton, clip.rotations[0], clip.translations[0])
    _, at = skeleton.world(clip.rotations[0], clip.translations[0])
    toes = [at[skeleton.names.index(f"{side}ToeBase")] - at[skeleton.names.index(f"{side}Foot")] for side in SIDES]
    assert np.sum(toes, axis=0) @ [np.sin(front), 0, np.cos(front)] > 0


@pytest.mark.parametrize("degrees", [0.0, 120, -90])
def test_portraits_show_three_quarters_of_the_front(degrees: float) -> None:
    avatar = synthetic_avatar()
    skeleton, (clip,) = avatar.rig.skeleton, avatar.clips
    rotations = np.tile(skeleton.bind_rotations, (len(clip), 1, 1))
    rotations[:], _ = turned(skeleton, Rotation.from_euler("y", degrees, degrees=True))
    still = replace(clip, rotations=rotations, translations=np.tile(skeleton.bind_translations, (len(clip), 1, 1)))
    frame = decode_clip_frame(avatar, still, frame=0)
    camera = portrait(frame, skeleton, pose=still.pose(0), screen=(64, 64))
    x, _, z = camera.view[2, :3]  # from the figure to the camera
    assert np.exp(1j * np.arctan2(x, z)) == pytest.approx(np.exp(1j * (np.radians(degrees) + THREE_QUARTER)))
