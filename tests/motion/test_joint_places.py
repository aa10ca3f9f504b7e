"""Limbs are recognised by their positions on people whose names say nothing, and on nothing else."""

from dataclasses import replace

import numpy as np
import pytest
from people import person, retarget, upright, walk, world
from scipy.spatial.transform import Rotation

from mua.motion.joint_places import roles_by_place
from mua.motion.match import match_joints
from mua.motion.source_motion import SourceMotion
from mua.pose.joint_names import roles
from mua.pose.skeleton import Skeleton


def nameless(skeleton: Skeleton) -> Skeleton:
    return replace(skeleton, names=tuple(f"Bone.{i:03}" for i in range(len(skeleton.names))))


def about_y(skeleton: Skeleton, degrees: float) -> Skeleton:
    """A skeleton with plain axes, turned about Y."""
    turn = Rotation.from_euler("y", degrees, degrees=True)
    return replace(skeleton, bind_translations=turn.apply(skeleton.bind_translations))


@pytest.mark.parametrize("beside", [0, 3])
@pytest.mark.parametrize("turn", [0, 180, 90])
@pytest.mark.parametrize("arms_down", [0, 50])
def test_recognises_the_limbs_of_a_person_who_stands(turn: float, arms_down: float, beside: float) -> None:
    whole = about_y(person(arms_down=arms_down, legs_apart=8), turn)
    whole.bind_translations[whole.root] += [beside, 0, beside]
    expected = {
        whole.names[joint]: role
        for role, joints in roles(whole).items()
        for joint in joints
        if role.split()[-1] in ("thigh", "shin", "foot", "toe", "upper_arm", "forearm", "hand", "spine", "head")
    }
    names = dict(zip(nameless(whole).names, whole.names, strict=True))
    found = {names[name]: role for name, role in roles_by_place(nameless(whole)).items()}
    assert {name: found.get(name) for name in expected} == expected


def test_motion_goes_onto_joints_recognised_by_position_and_says_so() -> None:
    source, target = person(), nameless(person(size=1.2))
    found, notes = retarget(SourceMotion(source, walk(source)), target)
    expected, _ = retarget(SourceMotion(source, walk(source)), person(size=1.2))
    shins = [source.names.index(name) for name in ("LeftLeg", "RightLeg", "LeftForeArm", "LeftFoot")]
    np.testing.assert_allclose(world(target, found)[1][:, shins], world(target, expected)[1][:, shins], atol=1e-9)
    assert any("recognised by their positions" in note and "left thigh" in note for note in notes)


def test_legs_whose_names_say_nothing_are_recognised_beside_arms_that_are_named() -> None:
    whole = person()
    legs = ("UpLeg", "Leg", "Foot", "ToeBase")
    called = {f"{side}{part}": f"{side[0]}_Joint_{i}" for side in ("Left", "Right") for i, part in enumerate(legs)}
    mannequin = replace(whole, names=tuple(called.get(name, name) for name in whole.names))
    matches = match_joints(whole, mannequin)
    assert matches.roles == match_joints(whole, whole).roles
    assert any("recognised by their positions" in note and "left shin" in note for note in matches.notes)


def test_asks_names_first() -> None:
    assert match_joints(person(), person()).notes == ()


def quadruped() -> Skeleton:
    """Four legs of three joints below a level trunk with a neck."""
    names, parents, at = ["root"], [-1], [(0.0, 0.6, 0.0)]

    def add(parent: int, *places: tuple[float, float, float]) -> int:
        for place in places:
            names.append(f"b{len(names)}")
            parents.append(parent)
            at.append(place)
            parent = len(names) - 1
        return parent

    chest = add(0, (0, 0.65, 0.3), (0, 0.65, 0.6))
    add(chest, (0, 0.8, 0.8), (0, 0.95, 0.9), (0, 0.95, 1.0))
    for parent, z in ((0, 0.0), (chest, 0.6)):
        for x in (0.1, -0.1):
            add(parent, (x, 0.55, z), (x, 0.3, z - 0.02), (x, 0.05, z), (x, 0.0, z + 0.05))
    places, above = np.array(at), np.array(parents, dtype=np.int32)
    offsets = places - np.where(above[:, None] < 0, 0, places[above])
    return upright(names, above, offsets)


def test_recognises_nothing_in_what_is_no_standing_person() -> None:
    lying = replace(person(), bind_translations=person().bind_translations[:, [2, 0, 1]])
    armless = replace(person(), names=person().names)
    offsets = armless.bind_translations.copy()
    for name in ("LeftArm", "LeftForeArm", "LeftHand"):
        offsets[armless.names.index(name)] *= 0.3
    one_armed = replace(armless, bind_translations=offsets)
    for skeleton in (quadruped(), lying, one_armed):
        assert roles_by_place(nameless(skeleton)) == {}
