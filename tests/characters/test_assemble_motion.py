"""Clips of scenes on rigid joints: what each joint hangs on, and what stretches."""

from dataclasses import replace

import numpy as np
import pytest
from gltf_files import posed
from scenes import (
    BIND,
    DOUBLE_BOUND,
    HERE,
    NAMES,
    PARENTS,
    WEIGHT_BOUND,
    assert_follows,
    at,
    moving,
    part,
    scene,
    skinned,
)

from mua.characters.assemble import assemble
from mua.rig.animated_scale import stretched
from mua.scene import Motion, Scene, Skin


def test_clip_follows_the_sources_matrices() -> None:
    whole = scene(motions=(moving(BIND, PARENTS),))
    surfaces = assemble(whole, HERE)
    assert_follows(whole, surfaces)
    assert not surfaces.notes


def test_joints_moved_by_controls_hang_on_what_carries_them() -> None:
    """The arms follow the spine by a constraint; in the file they hang on an unbound control at the origin."""
    names = ("control", *NAMES)
    parents = np.array([-1, -1, 1, 2, 0, 0])
    motion = moving(BIND, PARENTS)
    control = np.tile(np.eye(4), (len(motion.worlds), 1, 1, 1))
    whole = scene(
        node_names=names,
        parents=parents,
        rest=np.concatenate([np.eye(4)[None], BIND]),
        skins=(Skin(np.arange(6), np.concatenate([at(9, 9, 9)[None], np.linalg.inv(BIND)])),),
        parts=(replace(part(), joints=part().joints + 1),),
        motions=(replace(motion, worlds=np.concatenate([control, motion.worlds], axis=1)),),
    )
    surfaces = assemble(whole, HERE)
    assert_follows(whole, surfaces)
    skeleton = surfaces.skeleton
    assert set(skeleton.names) == set(NAMES)
    for arm in ("arm_l", "arm_r"):
        assert skeleton.names[skeleton.parents[skeleton.names.index(arm)]] == "spine"
    assert "hang on others" in surfaces.notes[0]


def test_joints_that_leave_their_places_are_followed() -> None:
    """Limbs that grow longer, a head that comes off: no joint of the file carries them, and none needs to."""
    motion = moving(BIND, PARENTS)
    worlds = motion.worlds.copy()
    for joint in (2, 4):
        worlds[:, joint] = np.stack([at(0.05 * f, 0.1 * f, -0.02 * joint * f) for f in range(9)]) @ worlds[:, joint]
    whole = scene(motions=(replace(motion, worlds=worlds),))
    surfaces = assemble(whole, HERE)
    assert_follows(whole, surfaces)
    assert surfaces.notes == ()


def test_scaled_joints_stretch_the_surface_as_in_the_source() -> None:
    """Squash and stretch of joints that also turn, with vertices of one joint each, which no blending blurs."""
    motion = moving(BIND, PARENTS)
    squash = np.stack([np.diag([1 + 0.02 * f, 1 - 0.04 * f, 1 + 0.02 * f, 1]) for f in range(9)])
    worlds = motion.worlds.copy()
    worlds[:, 1] = worlds[:, 1] @ squash
    for child in (2, 3, 4):  # what hangs on a scaled joint is scaled and moved with it
        worlds[:, child] = worlds[:, 1] @ np.linalg.inv(motion.worlds[:, 1]) @ motion.worlds[:, child]
    rigid = replace(part(), weights=np.tile([1.0, 0.0], (30, 1)))
    whole = scene(parts=(rigid,), motions=(replace(motion, worlds=worlds),))
    surfaces = assemble(whole, HERE)
    (clip,) = surfaces.clips
    assert clip.stretches is not None
    assert clip.stretches.joints.tolist() == [1, 2, 3, 4]
    for frame in (0, 4, 8):
        vertices = stretched(surfaces, clip.stretches, frame, surfaces.vertices)
        shaped = replace(surfaces, vertices=vertices)
        ours = posed(shaped, clip.rotations[frame], clip.translations[frame])[surfaces.faces]
        np.testing.assert_allclose(ours, skinned(whole, frame), atol=WEIGHT_BOUND)
    assert "the largest is 32 %" in surfaces.notes[-1]


def test_what_is_steered_from_above_the_root_is_led_by_the_body() -> None:
    """A foot that hangs beside the travelling hips, as rigs with inverse kinematics have it."""
    parents = np.array([-1, 0, 1, 1, 0])
    motion = moving(BIND, parents, hips=False)
    worlds = motion.worlds.copy()
    for f in range(9):
        worlds[f, 1:4] = at(0.2 * f, 0, 0) @ worlds[f, 1:4]
        worlds[f, 4] = at(0.2 * f, 0, 0.3 * np.sin(f)) @ worlds[f, 4]
    weighted = replace(part(), joints=1 + part().joints % 4)
    whole = scene(parents=parents, parts=(weighted,), motions=(replace(motion, worlds=worlds),))
    surfaces = assemble(whole, HERE)
    assert_follows(whole, surfaces)
    skeleton = surfaces.skeleton
    assert skeleton.names[skeleton.root] == NAMES[1]
    assert skeleton.root in skeleton.ancestors(skeleton.names.index(NAMES[4]))
    assert surfaces.notes == ("1 joint hangs on another than in the file, as the clips show.",)


def test_parents_come_before_children() -> None:
    parents = assemble(scene(motions=(moving(BIND, PARENTS),)), HERE).skeleton.parents
    assert all(parent < joint for joint, parent in enumerate(parents))


def test_moved_ancestor_of_two_skeletons_becomes_a_joint() -> None:
    """A moving carriage with two roots: neither root alone can carry the motion of both."""
    parents = np.array([-1, 0, 0])
    rest = np.stack([np.eye(4), at(0, 1, 0), at(0.5, 1.5, 0)])
    worlds = np.stack([at(0.2 * f, 0, 0) @ rest for f in range(9)])
    worlds[:, 1] = worlds[:, 1] @ np.stack([at(0, 0.1 * f, 0) for f in range(9)])
    piece = replace(part(), joints=np.tile(np.arange(30)[:, None] % 2, (1, 2)))
    whole = scene(
        node_names=("carriage", "left one", "other"),
        parents=parents,
        rest=rest,
        skins=(Skin(np.array([1, 2]), np.linalg.inv(rest[1:])),),
        parts=(piece,),
        motions=(Motion("roll", 30.0, worlds),),
    )
    assert "carriage" in assemble(whole, HERE).skeleton.names


def steered(size: float) -> Scene:
    """A figure of that size whose head slides a little and whose foot hangs beside the hips, on a node above them."""
    names = ("armature", "hips", "head", "foot", "prop")
    parents = np.array([-1, 0, 1, 0, 1])
    bind = np.stack([at(0, 0, 0), at(0, 0.9, 0), at(0, 1.6, 0), at(0.2, 0.1, 0), at(0.2, 1.2, 0)])
    worlds = np.tile(bind, (9, 1, 1, 1))
    worlds[:, 1:, 0, 3] += 0.01 * np.arange(9)[:, None]  # 5 % of the height from where the armature had them
    worlds[:, 2, 1, 3] += 0.00004 * np.arange(9)
    bound = bind.copy()
    bound[4, 0, 3] += 0.1  # the prop carries nothing, and is bound beside its place at rest
    for matrices in (bind, worlds, bound):
        matrices[..., :3, 3] *= size
    joints = np.stack([1 + np.arange(30) % 3, 1 + (np.arange(30) + 1) % 3], axis=1)
    mesh = replace(part(), positions=part().positions * size, joints=joints)
    skin = Skin(np.arange(5), np.linalg.inv(bound))
    motion = Motion("slides", 30.0, worlds)
    return scene(node_names=names, parents=parents, rest=bind, parts=(mesh,), skins=(skin,), motions=(motion,))


@pytest.mark.parametrize("size", [0.07, 4.0])
def test_a_doll_and_a_giant_move_as_a_person_does(size: float) -> None:
    person, other = assemble(steered(1), HERE), assemble(steered(size), HERE)
    assert other.unit == 1
    assert (other.skeleton.names, other.skeleton.root) == (person.skeleton.names, person.skeleton.root)
    np.testing.assert_array_equal(other.skeleton.parents, person.skeleton.parents)
    places = size * person.skeleton.bind_translations
    np.testing.assert_allclose(other.skeleton.bind_translations, places, atol=DOUBLE_BOUND)
    np.testing.assert_allclose(other.clips[0].translations, size * person.clips[0].translations, atol=DOUBLE_BOUND)


def test_what_leaves_the_side_of_the_node_above_the_hips_hangs_on_the_hips() -> None:
    """A head that slides by a fraction of a millimetre does so in the clip, too."""
    surfaces = assemble(steered(1), HERE)
    names = surfaces.skeleton.names
    assert names[surfaces.skeleton.parents[names.index("foot")]] == "hips"
    slid = np.ptp(surfaces.clips[0].translations[:, names.index("head"), 1])
    assert slid == pytest.approx(8 * 0.00004)
    assert_follows(steered(1), surfaces)
