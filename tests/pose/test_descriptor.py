"""The motion descriptor against a slow one by matrices, and what it must not depend on."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from mua import rotation
from mua.pose.clip import Clip
from mua.pose.descriptor import (
    choose_joints,
    choose_translated,
    describe,
    describe_window,
    groups_of,
    heading_of,
    normalization,
    turns_of,
    units_of,
)
from mua.pose.encoding import PoseEncoding
from mua.pose.skeleton import Skeleton

FRAMES = 7
BOUND = 256 * np.finfo(float).eps * 8  # some hundred operations on numbers up to 8


def quaternions(count: int, seed: int) -> np.ndarray:
    return np.asarray(Rotation.random(count, random_state=seed).as_quat(scalar_first=True))


@pytest.fixture
def skeleton() -> Skeleton:
    """A turned joint above the root, the root, and a chain of three below it."""
    offsets = np.random.default_rng(1).normal(size=(5, 3))
    parents = np.array([-1, 0, 1, 2, 3], dtype=np.int32)
    return Skeleton(("world", "hips", "spine", "neck", "head"), parents, quaternions(5, seed=2), offsets, root=1)


@pytest.fixture
def clip(skeleton: Skeleton) -> Clip:
    """Random motion below a joint that keeps its bind rotation, as the one above a root does."""
    rotations = quaternions(FRAMES * 5, seed=3).reshape(FRAMES, 5, 4)
    rotations[:, 0] = skeleton.bind_rotations[0]
    return Clip("clip", 30.0, rotations, np.random.default_rng(4).normal(size=(FRAMES, 5, 3)))


def matrix(q: np.ndarray) -> np.ndarray:
    return np.asarray(Rotation.from_quat(q, scalar_first=True).as_matrix())


def world(rotations: np.ndarray, joint: int) -> np.ndarray:
    """World rotation of a joint in a chain; the joints above it have the numbers before its own."""
    turned = np.eye(3)
    for local in rotations[: joint + 1]:
        turned = turned @ matrix(local)
    return turned


def slow_descriptor(skeleton: Skeleton, encoding: PoseEncoding, clip: Clip, f: int) -> np.ndarray:
    """One descriptor as mua.pose.encoding words it, for the skeleton of this file, by 3x3 matrices."""
    above = matrix(skeleton.bind_rotations[0])
    bind = above @ matrix(skeleton.bind_rotations[1])

    def root(g: int) -> tuple[np.ndarray, np.ndarray]:
        return above @ matrix(clip.rotations[g, 1]) @ bind.T, clip.translations[g, 0] + above @ clip.translations[g, 1]

    turn, position = root(f)
    back = np.eye(3)
    if encoding.remove_heading:
        # The twist about Y is the rotation about Y nearest to `turn`: its angle maximises trace(R_y(angle)^T turn).
        back = Rotation.from_euler("y", -np.arctan2(turn[0, 2] - turn[2, 0], turn[0, 0] + turn[2, 2])).as_matrix()
    turns = [back @ world(clip.rotations[f], j) @ world(skeleton.bind_rotations, j).T for j in encoding.joints]
    parts = [column for turn in turns for column in turn.T[:2]]
    for i in range(encoding.window):
        g = max(f - i, 0)
        turn_g, position_g = root(g)
        parts += [back @ (position_g - position), *(back @ turn_g).T[:2]]
        for j in encoding.joints:
            parts += [*matrix(clip.rotations[g, j]).T[:2]]
        for j in encoding.translated:
            parts += [clip.translations[g, j] - skeleton.bind_translations[j]]
    return np.concatenate(parts)


@pytest.mark.parametrize("remove_heading", [True, False])
@pytest.mark.parametrize(("window", "joints"), [(3, (2, 4)), (1, (3,)), (5, ()), (9, (2, 3, 4))])
@pytest.mark.parametrize("translated", [(), (3,), (2, 4)])
def test_holds_what_the_encoding_declares(
    skeleton: Skeleton,
    clip: Clip,
    remove_heading: bool,
    window: int,
    joints: tuple[int, ...],
    translated: tuple[int, ...],
) -> None:
    encoding = PoseEncoding(joints, 30.0, window, remove_heading, translated)
    found = describe(skeleton, encoding, clip.rotations, clip.translations)
    assert found.shape == (FRAMES, encoding.width)
    assert found.dtype == np.float64
    expected = [slow_descriptor(skeleton, encoding, clip, f) for f in range(FRAMES)]
    np.testing.assert_allclose(found, expected, atol=BOUND)


@pytest.mark.parametrize("remove_heading", [True, False])
def test_a_window_gives_the_numbers_of_its_clip(skeleton: Skeleton, clip: Clip, remove_heading: bool) -> None:
    encoding = PoseEncoding((2, 3), 30.0, 3, remove_heading, (4,))
    whole = describe(skeleton, encoding, clip.rotations, clip.translations)
    for f in range(FRAMES):
        newest_first = np.maximum(f - np.arange(3), 0)
        one = describe_window(skeleton, encoding, clip.rotations[newest_first], clip.translations[newest_first])
        np.testing.assert_array_equal(one, whole[f])


def test_holds_the_clip_still_before_its_start(skeleton: Skeleton, clip: Clip) -> None:
    encoding = PoseEncoding((2, 3), 30.0, 3)
    still = describe(skeleton, encoding, clip.rotations[[0, 0, 0]], clip.translations[[0, 0, 0]])
    first = describe(skeleton, encoding, clip.rotations, clip.translations)[0]
    np.testing.assert_array_equal(first, still[2])


def moved(skeleton: Skeleton, clip: Clip, yaw: float, shift: np.ndarray) -> Clip:
    """The motion elsewhere in the world: turned about Y, then shifted."""
    turn = np.array([np.cos(yaw / 2), 0, np.sin(yaw / 2), 0])
    above = skeleton.bind_rotations[0]
    local = rotation.multiply(rotation.conjugate(above), rotation.multiply(turn, above))
    rotations = clip.rotations.copy()
    rotations[:, 1] = rotation.multiply(local, rotations[:, 1])
    translations = clip.translations.copy()
    world = translations[:, 0] + rotation.rotate(above, translations[:, 1])
    world = rotation.rotate(turn, world) + shift
    translations[:, 1] = rotation.rotate(rotation.conjugate(above), world - translations[:, 0])
    return Clip(clip.name, clip.rate, rotations, translations)


@pytest.mark.parametrize("remove_heading", [True, False])
def test_does_not_depend_on_the_place(skeleton: Skeleton, clip: Clip, remove_heading: bool) -> None:
    encoding = PoseEncoding((2, 3), 30.0, 3, remove_heading, (3, 4))
    elsewhere = moved(skeleton, clip, 0.0, np.array([5.0, -2, 3]))
    found = describe(skeleton, encoding, elsewhere.rotations, elsewhere.translations)
    np.testing.assert_allclose(found, describe(skeleton, encoding, clip.rotations, clip.translations), atol=BOUND)


def test_depends_on_the_facing_only_without_heading(skeleton: Skeleton, clip: Clip) -> None:
    elsewhere = moved(skeleton, clip, 2.5, np.array([5.0, -2, 3]))
    for remove_heading in (True, False):
        encoding = PoseEncoding((2, 3), 30.0, 3, remove_heading, (3, 4))
        found = describe(skeleton, encoding, elsewhere.rotations, elsewhere.translations)
        here = describe(skeleton, encoding, clip.rotations, clip.translations)
        assert (np.abs(found - here).max() < BOUND) == remove_heading


def test_heading_of_a_half_turn_across_y_is_none() -> None:
    np.testing.assert_array_equal(heading_of(np.array([0.0, 1, 0, 0])), [1, 0, 0, 0])
    np.testing.assert_array_equal(heading_of(np.array([0.0, 0, 1, 0])), [0, 0, 1, 0])


def test_chooses_joints_that_vary_and_are_used(skeleton: Skeleton) -> None:
    rotations = np.tile(skeleton.bind_rotations, (40, 1, 1))
    wave = np.sin(np.arange(40) * 2 * np.pi / 40)  # standard deviation sqrt(1/2)
    for joint, degrees in ((1, 30.0), (2, 0.13), (3, 0.15), (4, 30.0)):
        turn = rotation.from_axis_angle(np.array([0, 0, 1.0]), np.radians(degrees) * wave)
        rotations[:, joint] = rotation.multiply(rotations[:, joint], turn)
    rotations[1::2] *= -1  # q and -q are the same rotation
    halves = [
        Clip("a", 30.0, rotations[:20], np.zeros((20, 5, 3))),
        Clip("b", 30.0, rotations[20:], np.zeros((20, 5, 3))),
    ]
    assert choose_joints(skeleton, halves, np.ones(5, dtype=bool)) == (3, 4)
    assert choose_joints(skeleton, halves, np.array([1, 1, 1, 1, 0], dtype=bool)) == (3,)


def test_chooses_a_joint_that_differs_between_still_clips(skeleton: Skeleton) -> None:
    still = np.tile(skeleton.bind_rotations, (3, 1, 1))
    other = still.copy()
    other[:, 3] = rotation.multiply(still[:, 3], np.array([np.cos(0.2), 0, np.sin(0.2), 0]))
    clips = [Clip("a", 30.0, still, np.zeros((3, 5, 3))), Clip("b", 30.0, other, np.zeros((3, 5, 3)))]
    assert choose_joints(skeleton, clips, np.ones(5, dtype=bool)) == (3,)


def test_chooses_what_is_translated_below_the_root_and_used(skeleton: Skeleton) -> None:
    """Above the root, a translation moves the whole character and does not change its shape."""
    rotations = np.tile(skeleton.bind_rotations, (40, 1, 1))
    translations = np.tile(skeleton.bind_translations, (40, 1, 1))
    wave = np.sin(np.arange(40) * 2 * np.pi / 40)  # standard deviation sqrt(1/2)
    for joint, share in ((0, 1.0), (1, 1.0), (2, 1.3e-3), (3, 1.5e-3), (4, 1.0)):
        translations[:, joint, 2] += share * skeleton.size * wave
    halves = [Clip("a", 30.0, rotations[:20], translations[:20]), Clip("b", 30.0, rotations[20:], translations[20:])]
    assert choose_translated(skeleton, halves, np.ones(5, dtype=bool)) == (3, 4)
    assert choose_translated(skeleton, halves, np.array([1, 1, 1, 1, 0], dtype=bool)) == (3,)


def test_normalizes_but_does_not_stretch_constant_columns() -> None:
    columns = np.random.default_rng(5).normal(size=(50, 3)) * [2, 1e-6, 0] + [1, 2, 3]
    found = normalization(columns, np.ones(3))
    np.testing.assert_allclose(found.mean, columns.mean(axis=0))
    np.testing.assert_allclose(found.scale, [columns[:, 0].std(), 1, 1])


@pytest.mark.parametrize(("deviation", "stretched"), [(0.9e-3, False), (1.1e-3, True)])
def test_what_varies_by_less_than_a_millimetre_is_not_stretched(deviation: float, stretched: bool) -> None:
    columns = deviation * np.array([[-1.0], [1]])
    assert normalization(columns, np.ones(1)).scale == pytest.approx([deviation if stretched else 1])


def test_turns_count_by_their_angle_and_lengths_by_how_they_vary() -> None:
    """A joint that turns a tenth as far is raised less, and what hardly varies beside its angle is not raised."""
    encoding = PoseEncoding((1, 2), rate=30.0, window=1, translated=(2,))
    spread = np.full(encoding.width, 1e-2)
    spread[[15, 21, 27]] = 0.3, 0.4, 0.04  # one number of the root, of a joint and of one that turns little
    columns = np.random.default_rng(7).normal(size=(400, encoding.width)) * spread
    turns = turns_of(encoding)
    found = normalization(columns, units_of(encoding, 1.0), turns).scale
    lengths = turns < 0
    assert list(np.flatnonzero(lengths)) == [12, 13, 14, 33, 34, 35]
    np.testing.assert_allclose(found[lengths], columns.std(axis=0)[lengths])
    assert all(np.ptp(found[turns == group]) == 0 for group in np.unique(turns[~lengths]))
    much, little = ((columns.std(axis=0) / found)[[21, 27]]).tolist()
    assert much / 10 < little < much / 2


def test_a_small_figures_lengths_count_as_much_as_a_persons() -> None:
    """At a hundredth of the size, all lengths of a descriptor are a hundredth, and what the MLPs read is the same."""
    encoding = PoseEncoding((1, 2), rate=30.0, translated=(2,))
    columns = np.random.default_rng(6).normal(size=(50, encoding.width)) * np.geomspace(1e-4, 1, encoding.width)
    units = units_of(encoding, 0.01)
    person, small = normalization(columns, units_of(encoding, 1.0)), normalization(columns * units, units)
    assert set(units) == {1.0, 0.01}
    np.testing.assert_allclose(small.scale, person.scale * units, rtol=1e-12)


def test_a_joint_in_the_world_is_a_group_apart_from_what_it_does_in_its_parent() -> None:
    encoding = PoseEncoding((2, 4), rate=30.0, window=2, translated=(4,))
    root, spine, head = [0] * 9, [1] * 6, [2] * 6
    frame = [*root, *spine, *head, 2, 2, 2]
    groups = groups_of(encoding)
    assert len(groups) == encoding.width
    names = {group: name for name, group in zip("ab", (groups[0], groups[6]), strict=True)}
    assert [names.get(group) for group in groups] == ["a"] * 6 + ["b"] * 6 + [None] * 48
    rest = {group: place for place, group in enumerate(dict.fromkeys(groups[12:].tolist()))}
    assert [rest[group] for group in groups[12:]] == frame * 2
