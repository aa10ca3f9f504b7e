"""Skins that were bound together are one skin, each of whose joints stands where it has most weight."""

from dataclasses import replace

import numpy as np
from scenes import BIND, at, part, scene

from mua.arrays import Array
from mua.characters.skin_groups import grouped
from mua.scene import Part, Scene, Skin


def weighing(skin: int, joint: int, count: int) -> Part:
    """Vertices that hang on one joint of a skin."""
    source = part(group=skin, skin=skin)
    none = source.faces[:0]
    joints, weights = np.full((count, 1), joint), np.ones((count, 1))
    return replace(
        source, positions=source.positions[:count], joints=joints, weights=weights, faces=none, uv_faces=none
    )


def skins(second: Array, *parts: Part) -> Scene:
    """Two skins of the same joints, the second with other inverse binds."""
    return scene(skins=(Skin(np.arange(5), np.linalg.inv(BIND)), Skin(np.arange(5), second)), parts=parts)


def test_a_joint_of_two_skins_is_bound_as_in_the_one_that_it_carries_more_of() -> None:
    second = np.linalg.inv(BIND)
    second[1:3] = second[1:3] @ at(0.3, 0, 0)
    first = [weighing(0, joint, count) for joint, count in enumerate((9, 2, 5))]
    [(joined, mass)] = grouped(skins(second, *first, *(weighing(1, joint, 4) for joint in range(3))))
    by_node = dict(zip(joined.joints.tolist(), joined.inverse_binds, strict=True))
    np.testing.assert_allclose(by_node[1], second[1])
    np.testing.assert_allclose(by_node[2], np.linalg.inv(BIND[2]))
    np.testing.assert_array_equal(mass[np.argsort(joined.joints)], [13, 6, 9, 0, 0])


def test_skins_whose_binds_mostly_disagree_stay_apart() -> None:
    """One joint, which one of them uses, would put both at the same place."""
    second = np.linalg.inv(BIND)
    second[1:] = [inverse @ at(0.1 * j, 0, 0) for j, inverse in enumerate(second[1:], 1)]
    assert len(grouped(skins(second, weighing(0, 0, 9), weighing(1, 3, 4)))) == 2


def test_skins_whose_binds_mostly_agree_are_one() -> None:
    second = np.linalg.inv(BIND)
    second[3:] = second[3:] @ at(0.3, 0, 0)
    assert len(grouped(skins(second, weighing(0, 0, 9), weighing(1, 3, 4)))) == 1
