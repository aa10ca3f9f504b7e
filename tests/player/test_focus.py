"""A close-up looks at the surface that a joint moves, by the usual names of body parts."""

from dataclasses import replace

import numpy as np
import pytest
from people import person
from synthetic_avatar import synthetic_avatar

from mua.errors import InputError
from mua.player.focus import find_focus
from mua.rig.rig import Rig

RIG = synthetic_avatar().rig


def personal(*, prefix: str = "") -> Rig:
    """The skeleton of a person with a mesh of one vertex 20 cm above the head joint, which follows that alone."""
    skeleton = person(axes=1)
    skeleton = replace(skeleton, names=tuple(prefix + name for name in skeleton.names))
    _, at = skeleton.world(skeleton.bind_rotations, skeleton.bind_translations)
    head = skeleton.names.index(f"{prefix}Head")
    return replace(
        RIG,
        skeleton=skeleton,
        mesh=replace(RIG.mesh, vertices=at[[head]] + [0, 0.2, 0]),
        skin_indices=np.array([[head] + [0] * 7], dtype=np.int32),
        skin_weights=np.array([[1.0] + [0] * 7], dtype=np.float32),
    )


@pytest.mark.parametrize("name", ["head", "Head", "HEAD", "mixamorig:Head"])
def test_finds_a_joint_by_its_name_and_by_what_it_is(name: str) -> None:
    rig = personal(prefix="mixamorig:")
    assert rig.skeleton.names[find_focus(rig, name).joint] == "mixamorig:Head"


@pytest.mark.parametrize(("name", "joint"), [("left hand", "LeftHand"), ("right foot", "RightFoot"), ("hips", "Hips")])
def test_finds_parts_of_the_body(name: str, joint: str) -> None:
    rig = personal()
    assert rig.skeleton.names[find_focus(rig, name).joint] == joint


def test_looks_at_the_middle_of_what_the_joint_moves_wherever_it_goes() -> None:
    rig = personal()
    focus = find_focus(rig, "head")
    bind = rig.skeleton.bind_pose
    place = rig.mesh.vertices[0]
    np.testing.assert_allclose(focus.places(rig.skeleton, bind.rotations, bind.translations), place, atol=1e-9)
    moved = bind.translations + np.eye(len(bind.translations))[0][:, None] * [3.0, 0, -1]  # the first joint's
    np.testing.assert_allclose(
        focus.places(rig.skeleton, bind.rotations, moved), place + np.array([3, 0, -1]), atol=1e-9
    )


def test_looks_at_a_joint_itself_that_moves_nothing() -> None:
    rig = personal()
    focus = find_focus(rig, "LeftHand")
    np.testing.assert_allclose(focus.offset, 0)


def test_refuses_a_joint_that_is_not_there_and_names_some_that_are() -> None:
    with pytest.raises(InputError, match=r"--look-at is 'heads'; expected a joint .* such as .*[Hh]ead"):
        find_focus(personal(), "heads")
    with pytest.raises(InputError, match="--look-at is 'qqqqqq'; expected a joint of the avatar"):
        find_focus(personal(), "qqqqqq")
