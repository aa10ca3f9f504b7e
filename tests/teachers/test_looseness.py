"""Guessing how loosely parts of a character hang."""

from dataclasses import replace

import numpy as np
import pytest
from tube import tube

from mua.rig.character import Mesh
from mua.teachers.simulated.looseness import (
    FIRM_LOOSENESS,
    SOFT_LOOSENESS,
    TIGHT_LOOSENESS,
    UNKNOWN_LOOSENESS,
    estimate_looseness,
)

ROUNDING = 1e3 * float(np.finfo(np.float32).eps)  # skin weights are float32; a dozen passes of averages


def test_unknown_joints_give_one_looseness() -> None:
    character = tube()
    named = replace(character, skeleton=replace(character.skeleton, names=("b0", "b1", "b2")))
    np.testing.assert_allclose(estimate_looseness(named), UNKNOWN_LOOSENESS, atol=ROUNDING)


def test_head_and_hands_are_firmer_than_the_trunk() -> None:
    character = tube(rings=101)
    skeleton = replace(
        character.skeleton,
        names=("Hips", "Spine", "Head", "LeftArm", "RightUpLeg"),
        parents=np.array([-1, 0, 1, 1, 0], np.int32),
        bind_rotations=np.tile([1.0, 0, 0, 0], (5, 1)),
        bind_translations=np.zeros((5, 3)),
    )
    looseness = estimate_looseness(replace(character, skeleton=skeleton))
    height = character.mesh.vertices[:, 1]
    np.testing.assert_allclose(looseness[height < 0.2], TIGHT_LOOSENESS, atol=0.01)
    np.testing.assert_allclose(looseness[height > 1.7], FIRM_LOOSENESS, atol=0.01)
    assert np.all(np.diff(looseness.reshape(101, -1)[:, 0]) < 1e-3)


def test_what_a_hand_holds_is_firm_and_what_hangs_from_the_head_is_not() -> None:
    """A hand may go by another name, where the skeleton or its file says what it is."""
    character = replace(tube(rings=101), roles={"Grip": "left hand"})
    hand, other, head = (
        replace(
            character.skeleton,
            names=("LeftArm", holder, "Bone_042", "Spine", "RightArm", "RightLeg", "Neck"),
            parents=np.array([-1, 0, 1, 0, 0, 0, 3], np.int32),
            bind_rotations=np.tile([1.0, 0, 0, 0], (7, 1)),
            bind_translations=np.zeros((7, 3)),
        )
        for holder in ("LeftHand", "Grip", "Head")
    )
    end = character.mesh.vertices[:, 1] > 1.7
    held, gripped, hanging = (estimate_looseness(replace(character, skeleton=s))[end] for s in (hand, other, head))
    np.testing.assert_allclose(held, FIRM_LOOSENESS, atol=0.01)
    np.testing.assert_allclose(gripped, FIRM_LOOSENESS, atol=0.01)
    np.testing.assert_allclose(hanging, SOFT_LOOSENESS, atol=0.01)


def test_a_grip_that_reaches_into_an_arm_does_not_loosen_it() -> None:
    character = tube(rings=101)
    mesh, count = character.mesh, len(character.mesh.vertices)
    names = ("Hips", "Spine", "LeftArm", "LeftHand", "Sword", "RightUpLeg", "Head")
    both = replace(
        character,
        skeleton=replace(
            character.skeleton,
            names=names,
            parents=np.array([-1, 0, 1, 2, 3, 0, 1], np.int32),
            bind_rotations=np.tile([1.0, 0, 0, 0], (7, 1)),
            bind_translations=np.zeros((7, 3)),
        ),
        mesh=replace(
            mesh,
            vertices=np.concatenate([mesh.vertices, mesh.vertices * [0.3, 1, 0.3]]),
            faces=np.concatenate([mesh.faces, mesh.faces + count]),
            uv_faces=np.concatenate([mesh.uv_faces, mesh.uv_faces]),
        ),
        skin_indices=np.concatenate(
            [character.skin_indices, np.full_like(character.skin_indices, names.index("Sword"))]
        ),
        skin_weights=np.tile(character.skin_weights, (2, 1)),
    )
    arm, sword = np.split(estimate_looseness(both), 2)
    middle = np.abs(mesh.vertices[:, 1] - 0.9) < 0.4
    np.testing.assert_allclose(arm[middle], TIGHT_LOOSENESS, atol=0.01)
    np.testing.assert_allclose(sword, FIRM_LOOSENESS, atol=0.01)


def test_a_shirt_with_room_beneath_it_hangs_and_the_body_in_it_does_not() -> None:
    character = tube(rings=101)
    mesh, count = character.mesh, len(character.mesh.vertices)
    shirt = mesh.vertices * [1.8, 1, 1.8]
    both = replace(
        character,
        skeleton=replace(
            character.skeleton,
            names=("Hips", "Spine", "Chest", "LeftArm", "RightUpLeg", "Head"),
            parents=np.array([-1, 0, 1, 1, 0, 1], np.int32),
            bind_rotations=np.tile([1.0, 0, 0, 0], (6, 1)),
            bind_translations=np.zeros((6, 3)),
        ),
        mesh=replace(
            mesh,
            vertices=np.concatenate([mesh.vertices, shirt]),
            faces=np.concatenate([mesh.faces, mesh.faces + count]),
            uv_faces=np.concatenate([mesh.uv_faces, mesh.uv_faces]),
        ),
        skin_indices=np.tile(character.skin_indices, (2, 1)),
        skin_weights=np.tile(character.skin_weights, (2, 1)),
    )
    body, hanging = np.split(estimate_looseness(both), 2)
    middle = np.abs(mesh.vertices[:, 1] - 0.9) < 0.4
    np.testing.assert_allclose(body[middle], TIGHT_LOOSENESS, atol=0.01)
    np.testing.assert_allclose(hanging[middle], SOFT_LOOSENESS, atol=0.01)


@pytest.mark.parametrize(("right", "expected"), [("RightUpLeg", SOFT_LOOSENESS), ("LeftUpLeg", TIGHT_LOOSENESS)])
def test_a_skirt_about_both_legs_hangs(right: str, expected: float) -> None:
    """A tube whose left half the left leg moves, and whose other half the right one, or the left one too."""
    character = tube(rings=101)
    names = ("Hips", "LeftUpLeg", "RightUpLeg", "LeftLeg", "RightLeg", "Spine", "LeftArm", "RightArm", "Head")
    skeleton = replace(
        character.skeleton,
        names=names,
        parents=np.array([-1, 0, 0, 1, 2, 0, 5, 5, 5], np.int32),
        bind_rotations=np.tile([1.0, 0, 0, 0], (9, 1)),
        bind_translations=np.zeros((9, 3)),
    )
    joints = np.zeros_like(character.skin_indices)
    joints[:, 0] = np.where(character.mesh.vertices[:, 0] > 0, names.index("LeftUpLeg"), names.index(right))
    weights = np.zeros_like(character.skin_weights)
    weights[:, 0] = 1
    moved = replace(character, skeleton=skeleton, skin_indices=joints, skin_weights=weights)
    middle = np.abs(character.mesh.vertices[:, 1] - 0.9) < 0.4
    assert np.median(estimate_looseness(moved)[middle]) == pytest.approx(expected, abs=0.02)


def test_a_head_that_is_named_as_a_spine_is_firm_and_hair_on_it_is_not() -> None:
    """As in Rigify."""
    character = tube(rings=101)
    end = character.mesh.vertices[:, 1] > 1.7
    names = ("DEF-spine", *(f"DEF-spine.00{k}" for k in range(1, 7)), "DEF-hair")
    limbs = [
        f"DEF-{limb}.{side}" for side in "LR" for limb in ("upper_arm", "forearm", "hand", "thigh", "shin", "foot")
    ]
    parents = [-1, 0, 1, 2, 3, 4, 5, 6, 3, 8, 9, 0, 11, 12, 3, 14, 15, 0, 17, 18]
    count = len(parents)
    skeleton = replace(
        character.skeleton,
        names=(*names, *limbs),
        parents=np.array(parents, np.int32),
        bind_rotations=np.tile([1.0, 0, 0, 0], (count, 1)),
        bind_translations=np.zeros((count, 3)),
    )
    top = (character.skin_indices == 2) & (character.skin_weights > 0)
    head, hair = (
        replace(character, skeleton=skeleton, skin_indices=np.where(top, names.index(name), character.skin_indices))
        for name in ("DEF-spine.006", "DEF-hair")
    )
    np.testing.assert_allclose(estimate_looseness(head)[end], FIRM_LOOSENESS, atol=0.01)
    np.testing.assert_allclose(estimate_looseness(hair)[end], SOFT_LOOSENESS, atol=0.01)


@pytest.mark.parametrize("side", [1, -1])
@pytest.mark.parametrize("size", [1.0, 0.05, 20.0])
def test_small_separate_pieces_are_rigid(side: int, size: float) -> None:
    """On either side, and small beside the figure."""
    character = tube()
    mesh = character.mesh
    count = len(mesh.vertices)
    button = 0.01 * np.eye(3) + [0.3 * side, 1, 0.13 * side]
    joined = Mesh(
        size * np.concatenate([mesh.vertices, button]),
        np.concatenate([mesh.faces, [[count, count + 1, count + 2]]]),
        mesh.uv,
        np.concatenate([mesh.uv_faces, [[0, 1, 2]]]),
    )
    rows = [*range(count), 0, 0, 0]
    both = replace(
        character,
        mesh=joined,
        skin_indices=character.skin_indices[rows],
        skin_weights=character.skin_weights[rows],
    )
    looseness = estimate_looseness(both)
    assert np.all(looseness[-3:] == 0)
    assert np.all(looseness[:-3] > 0)
