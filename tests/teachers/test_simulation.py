"""Position-based dynamics: rest, decay, determinism and memory."""

from dataclasses import replace
from itertools import pairwise

import numpy as np
import pytest
from tube import RATE, still, swing, tube

from mua import rotation
from mua.arrays import Array
from mua.kernels.dq_skinning import blend_vertices
from mua.pose.clip import Clip
from mua.rig.bones import Bones, fit_bones
from mua.rig.character import Character
from mua.teachers.simulated.looseness import FIRM_LOOSENESS
from mua.teachers.simulated.simulation import DEVICE, Simulation, gravity_beyond_rest, one_rings

SINGLE = 32 * float(np.finfo(np.float32).eps)  # metres; sums of some ten terms of up to 2 m
NO_BONES = Bones(np.zeros(0, int), np.zeros((0, 2, 3)), np.zeros(0))


def skinned(character: Character, clip: Clip) -> list[tuple[Array, Array]]:
    """Skinned positions and rotations of every frame."""
    result = []
    for joints in character.skeleton.skinning(clip.rotations, clip.translations):
        dual = blend_vertices(joints, character.skin_indices, character.skin_weights)
        result.append((rotation.dual_transform(dual, character.mesh.vertices), dual[:, :4]))
    return result


def simulation(character: Character, *, bones: Bones = NO_BONES) -> Simulation:
    assert character.looseness is not None
    mesh = character.mesh
    return Simulation(mesh.vertices, mesh.faces, looseness=character.looseness, bones=bones)


def play(character: Character, clip: Clip) -> Array:
    """Positions [F, V, 3]."""
    frames, state = skinned(character, clip), simulation(character)
    ends = np.zeros((0, 2, 3))
    state.settle(*frames[0], ends)
    return np.stack([state.advance(*frame, ends, seconds=1 / RATE) for frame in frames])


def test_runs_on_a_processor_of_every_machine() -> None:
    assert DEVICE == "cpu"


@pytest.mark.parametrize("looseness", [0.0, 0.4, 1.0])
def test_stays_at_rest_in_the_bind_pose(looseness: float) -> None:
    character = tube(looseness=looseness)
    places = play(character, still(character))
    np.testing.assert_allclose(places, np.broadcast_to(character.mesh.vertices, places.shape), atol=SINGLE)


def test_rigid_skin_follows_exactly() -> None:
    character = tube(looseness=0.0)
    clip = swing(character)
    expected = np.stack([target for target, _ in skinned(character, clip)])
    np.testing.assert_allclose(play(character, clip), expected, atol=SINGLE)


def test_what_hangs_next_to_nothing_follows_its_skin() -> None:
    character = tube(looseness=FIRM_LOOSENESS)
    clip = swing(character)
    targets = [target for target, _ in skinned(character, clip)]
    np.testing.assert_allclose(play(character, clip), targets, rtol=0, atol=SINGLE)


def test_looser_surfaces_deviate_more() -> None:
    deviations = []
    for looseness in (0.2, 0.5, 1.0):
        character = tube(looseness=looseness)
        clip = swing(character)
        target = np.stack([target for target, _ in skinned(character, clip)])
        deviations.append(np.linalg.norm(play(character, clip) - target, axis=2).mean())
    assert deviations == sorted(deviations)
    assert deviations[0] > 1e-4


def test_vertices_that_nearly_coincide_stay_with_their_neighbours() -> None:
    character = tube(looseness=0.8)
    vertices, (_, second, third) = character.mesh.vertices.copy(), character.mesh.faces[len(character.mesh.faces) // 2]
    vertices[third] = vertices[second] + 1e-3 * (vertices[third] - vertices[second])
    pinched = replace(character, mesh=replace(character.mesh, vertices=vertices))
    clip = swing(pinched, frames=60)
    target = np.stack([target for target, _ in skinned(pinched, clip)])
    away = np.linalg.norm(play(pinched, clip) - target, axis=2)
    assert 0 < away.max() < 1.5 * np.delete(away, [second, third], axis=1).max()


def test_swing_dies_out_when_the_pose_is_held() -> None:
    character = tube(looseness=1.0)
    clip = swing(character, frames=10)
    held = Clip(
        "held",
        RATE,
        np.concatenate([clip.rotations, np.repeat(clip.rotations[-1:], 60, axis=0)]),
        np.concatenate([clip.translations, np.repeat(clip.translations[-1:], 60, axis=0)]),
    )
    speed = np.linalg.norm(np.diff(play(character, held), axis=0), axis=2).max(axis=1) * RATE
    assert speed[9] > 0.1
    assert speed[-1] < 0.01 * speed[9]


def test_the_same_motion_gives_the_same_bytes() -> None:
    character = tube(looseness=0.7)
    clip = swing(character)
    np.testing.assert_array_equal(play(character, clip), play(character, clip))


def test_a_moving_surface_differs_from_one_at_rest_in_the_same_pose() -> None:
    character = tube(looseness=0.7)
    clip = swing(character, frames=10)
    held = Clip("held", RATE, clip.rotations[-1:], clip.translations[-1:])
    apart = np.linalg.norm(play(character, clip)[-1] - play(character, held)[0], axis=1)
    assert apart.max() > 0.01


def test_loose_cloth_stays_out_of_a_bone_that_moves_into_it() -> None:
    character = tube(looseness=1.0)
    fitted = fit_bones(tube(), np.zeros(len(character.mesh.vertices)))
    bone = Bones(fitted.joints[:1], np.array([[[0.0, 0.7, -0.3], [0.0, 1.0, -0.3]]]), np.array([0.05]))
    target, turn = skinned(character, still(character))[0]
    state = simulation(character, bones=bone)
    into = bone.ends + np.array([0, 0, 0.3 - 0.12])  # onto the wall of the tube
    state.settle(target, turn, bone.ends)
    for _ in range(10):
        places = state.advance(target, turn, into, seconds=1 / RATE)
    level = (places[:, 1] > 0.7) & (places[:, 1] < 1.0)
    from_axis = np.linalg.norm((places - into[0, 0])[level][:, [0, 2]], axis=1)
    assert from_axis.min() > 0.05


def test_only_turned_surfaces_feel_gravity() -> None:
    half_turn = np.array([[1.0, 0, 0, 0], [0, 1.0, 0, 0]])
    np.testing.assert_allclose(gravity_beyond_rest(half_turn), np.array([[0, 0, 0], [0, -2 * 9.81, 0]]), atol=1e-12)


def test_one_rings_list_every_edge_from_both_ends() -> None:
    starts, neighbours = one_rings(np.array([[0, 1, 2], [2, 1, 3]]), 5)
    rings = [neighbours[a:b].tolist() for a, b in pairwise(starts)]
    assert rings == [[1, 2], [0, 2, 3], [0, 1, 3], [1, 2], []]
