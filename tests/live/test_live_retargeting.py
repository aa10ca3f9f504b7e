"""An avatar does what a sender's figure does: the poses are those of the same motion, retargeted as a clip."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pytest
from people import person, retarget, still, walk, with_fingers, world
from shared_data import SharedData
from vmc_senders import BODY, Sender, frames_of, humanoid, performing

from mua import rotation
from mua.arrays import Array
from mua.characters.gltf.vrm import ROLES
from mua.characters.read import read_surfaces
from mua.errors import InputError
from mua.live.bones import AT_REST, BONES, sender_skeleton
from mua.live.retargeting import CONFIRMED, SECONDS, Posing
from mua.live.vmc import Frame
from mua.motion.bvh import read_bvh
from mua.motion.source_motion import SourceMotion
from mua.pose.clip import Clip
from mua.pose.joint_names import roles
from mua.pose.skeleton import Skeleton

SINGLE = 12 * 4 * float(np.finfo(np.float32).eps)  # chains of 12 joints, each a quaternion of four rounded numbers
METRES = 10 * SINGLE  # of places up to 10 m away
FLOOR = 0.01  # metres; where feet stand in all of a clip and in what has come of a stream


def frame(turns: Mapping[str, Array], *, known: tuple[str, ...] = BODY) -> Frame:
    """A frame in which some bones are turned."""
    rotations, sent = AT_REST.copy(), np.isin(BONES, known)
    for name, turn in turns.items():
        rotations[BONES.index(name)] = turn
    return Frame(0.0, rotations, np.zeros((len(BONES), 3)), sent, {})


def about(axis: tuple[float, float, float], degrees: float) -> Array:
    return rotation.from_axis_angle(np.array(axis), np.radians(degrees))


def posed(posing: Posing, frames: list[Frame]) -> Clip:
    poses = [posing.pose(one) for one in frames]
    return Clip("live", 30.0, np.stack([p.rotations for p in poses]), np.stack([p.translations for p in poses]))


def away(a: Array, b: Array) -> float:
    """The largest difference of rotations, as a distance of quaternions."""
    return float(np.sqrt(2 * np.maximum(1 - np.abs(np.sum(a * b, axis=-1)), 0)).max())


def path_away(live: Array, clip: Array) -> float:
    """Metres between paths along the floor, but for the scale, which a clip learns from the steps of all its frames."""
    a, b = live[:, [0, 2]], clip[:, [0, 2]]
    return float(np.abs(a - np.sum(a * b) / np.sum(b * b) * b).max())


def at(skeleton: Skeleton, clip: Clip, name: str) -> Array:
    return world(skeleton, clip)[1][:, skeleton.names.index(name)]


def hips(skeleton: Skeleton, clip: Clip) -> Array:
    """The middle between the legs, which is what goes along a path."""
    return (at(skeleton, clip, "LeftUpLeg") + at(skeleton, clip, "RightUpLeg")) / 2


def test_the_names_of_all_bones_say_what_they_are() -> None:
    figure, present = sender_skeleton(np.ones(len(BONES), bool), np.zeros((len(BONES), 3)))
    assert list(figure.names) == list(BONES) == [BONES[bone] for bone in present]
    found = {figure.names[joint]: role for role, joints in roles(figure).items() for joint in joints}
    assert found == {name: role for name in BONES if (role := ROLES.get(name[0].lower() + name[1:]))}


@pytest.mark.parametrize("bones", [BODY, BONES], ids=["body", "all bones"])
def test_a_stream_poses_as_the_retargeted_clip(bones: tuple[str, ...]) -> None:
    """To a figure of other axes, arms and size, rotations and the path alike."""
    body, target = person(), with_fingers(person(arms_down=40, size=1.3))
    sender = performing(SourceMotion(body, walk(body, 45)), humanoid(bones))
    clip, _ = retarget(sender.motion, target)
    live = posed(Posing(target), frames_of(sender))
    assert away(live.rotations, clip.rotations) < SINGLE
    assert path_away(hips(target, live), hips(target, clip)) < METRES
    assert np.abs(at(target, live, "Hips") - at(target, clip, "Hips"))[:, 1].max() < FLOOR


@pytest.fixture(scope="module")
def woman(shared_data: SharedData) -> Skeleton:
    return read_surfaces(shared_data.path("characters/White_F_3_Casual.glb")).skeleton


@pytest.mark.parametrize("name", ["cmu/02_01", "cmu/01_05", "dab"])
def test_a_stream_of_real_motion_poses_a_real_character_as_the_retargeted_clip(
    shared_data: SharedData, woman: Skeleton, name: str
) -> None:
    sender = performing(_real(shared_data.path(f"motion/{name}.bvh")), humanoid())
    clip, _ = retarget(sender.motion, woman)
    live = posed(Posing(woman), frames_of(sender))
    assert away(live.rotations, clip.rotations) < SINGLE
    assert path_away(hips(woman, live), hips(woman, clip)) < METRES
    assert np.abs(at(woman, live, "Hips") - at(woman, clip, "Hips"))[:, 1].max() < FLOOR


def _real(path: Path) -> SourceMotion:
    motion = read_bvh(path)
    clip = motion.clip.cut(slice(0, 90))
    return SourceMotion(motion.skeleton, clip, stated=motion.stated)


def test_left_is_left_and_forwards_is_forwards() -> None:
    target = person(axes=4)
    posing = Posing(target)
    turned = posed(posing, [frame({}), frame({"Hips": about((0, 1, 0), 90)})])
    hands = at(target, turned, "LeftHand") - at(target, turned, "RightHand")
    assert hands[0] @ [1, 0, 0] > 1
    assert hands[1] @ [0, 0, -1] > 1  # after a turn to the left


def test_bones_that_are_not_sent_are_at_ease() -> None:
    """As of a telephone that sends the head alone."""
    target = person(axes=2)
    posing = Posing(target)
    nod = posed(posing, [frame({}, known=("Head",)), frame({"Head": about((1, 0, 0), 30)}, known=("Head",))])
    for side in ("Left", "Right"):
        arm = at(target, nod, f"{side}Hand") - at(target, nod, f"{side}Arm")
        assert (arm[:, 1] < -0.4).all()
    tops = at(target, nod, "HeadTop_End") - at(target, nod, "Head")
    assert tops[1] @ [0, 0, 1] - tops[0] @ [0, 0, 1] > 0.08
    np.testing.assert_allclose(at(target, nod, "LeftFoot")[0], at(target, nod, "LeftFoot")[1], atol=METRES)


def test_feet_stand_on_the_floor_however_high_the_sender_has_its_hips() -> None:
    target = person(size=0.7)
    ankle = at(target, still(target), "LeftFoot")[0, 1]
    for height in (0.0, 0.94, 5.0):
        moved = frame({})
        moved.positions[BONES.index("Hips")] = [0, height, 0]
        live = posed(Posing(target), [moved])
        assert at(target, live, "LeftFoot")[0, 1] == pytest.approx(ankle, abs=FLOOR)


def test_the_floor_is_where_feet_stood_in_the_last_ten_seconds() -> None:
    target, one, frames = person(), frame({}), []
    for index in range(60):  # upstairs from the half on
        one.positions[BONES.index("Hips")] = [0, 0.94 + (2.0 if index >= 30 else 0), 0]
        time = index / 60 + (SECONDS if index >= 31 else 0)
        frames.append(Frame(time, one.rotations, one.positions.copy(), one.known, {}))
    heights = at(target, posed(Posing(target), frames), "LeftFoot")[:, 1]
    assert heights[30] - heights[0] > 1.5
    assert heights[-1] == pytest.approx(heights[0], abs=FLOOR)


def test_a_jump_leaves_the_floor() -> None:
    target, frames = person(), []
    for index in range(60):
        one = frame({})
        one.positions[BONES.index("Hips")] = [0, 0.94 + (0.3 if index >= 50 else 0), 0]
        frames.append(Frame(index / 60, one.rotations, one.positions, one.known, {}))
    live = posed(Posing(target), frames)
    heights = at(target, live, "LeftFoot")[:, 1]
    assert heights[-1] - heights[0] > 0.25


def test_another_figure_is_taken_when_it_stays_and_a_wrong_frame_is_not() -> None:
    target, small = person(), humanoid(size=0.5)
    body = person()
    moving = performing(SourceMotion(body, walk(body, 2 * CONFIRMED)), humanoid())
    half = Sender(small, Clip("half", 30.0, moving.clip.rotations, moving.clip.translations / 2))
    large, little = frames_of(moving), frames_of(half)
    posing, wrong = Posing(target), CONFIRMED // 2 + 5  # too few in a row, though not in all
    before = posed(posing, [*large[:2], *little[2:wrong], large[wrong], *little[:wrong], *large[20:25]])
    steady = posed(Posing(target), large[:25])
    steps, usual = (np.diff(at(target, clip, "Hips")[-5:], axis=0)[:, [0, 2]] for clip in (before, steady))
    np.testing.assert_allclose(steps, usual, atol=METRES)
    walked = posed(posing, [*little[25:], *little])
    ends = at(target, walked, "Hips")[[-20, -1]]
    expected = at(target, posed(Posing(target), large), "Hips")[[-20, -1]]
    np.testing.assert_allclose((ends[1] - ends[0])[[0, 2]], (expected[1] - expected[0])[[0, 2]], atol=FLOOR)


def test_bones_whose_places_tremble_are_no_other_figure() -> None:
    """As those of trackers that stretch a figure."""
    body, random = person(), np.random.default_rng(3)
    steady = frames_of(performing(SourceMotion(body, walk(body, 2 * CONFIRMED)), humanoid()))
    trembling = [steady[0]]
    for one in steady[1:]:
        places = one.positions + np.where(one.known[:, None], random.normal(0, 0.02, one.positions.shape), 0)
        places[:2] = one.positions[:2]
        trembling.append(Frame(one.time, one.rotations, places, one.known, {}))
    live, expected = (posed(Posing(person(axes=1)), frames) for frames in (trembling, steady))
    np.testing.assert_array_equal(live.rotations, expected.rotations)


def test_a_mapping_says_which_bone_moves_which_joint() -> None:
    named = person()
    target = Skeleton(
        tuple(f"j{index}" for index in range(len(named.names))),
        named.parents,
        named.bind_rotations,
        named.bind_translations,
        named.root,
    )
    mapping = {f"j{named.names.index('Head')}": "Head", f"j{named.names.index('Spine1')}": "Chest"}
    nod = posed(Posing(target, mapping), [frame({}), frame({"Head": about((0, 1, 0), 60)})])
    moved = np.flatnonzero(np.abs(nod.rotations[1] - nod.rotations[0]).max(axis=-1) > 0.01)
    assert [named.names[joint] for joint in moved] == ["Head"]


@pytest.mark.parametrize(
    ("mapping", "sentence"),
    [
        ({"Head": "Tail"}, "mapping: source joint 'Tail' does not exist"),
        ({"Tail": "Head"}, "mapping: target joint 'Tail' does not exist"),
    ],
)
def test_refuses_a_mapping_of_what_there_is_not(mapping: dict[str, str], sentence: str) -> None:
    with pytest.raises(InputError, match=sentence):
        Posing(person(), mapping)


def test_refuses_an_avatar_whose_limbs_no_bone_moves() -> None:
    fox = Skeleton(("a", "b"), np.array([-1, 0]), AT_REST[:2], np.ones((2, 3)), 0)
    with pytest.raises(InputError, match="--mapping"):
        Posing(fox)
