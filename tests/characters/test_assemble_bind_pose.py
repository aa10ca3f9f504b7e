"""Scenes are brought into one bind pose: other spaces, scales, mirrors, facing."""

from dataclasses import replace

import numpy as np
import pytest
from gltf_files import posed
from scenes import BIND, DOUBLE_BOUND, HERE, PARENTS, WEIGHT_BOUND, assert_follows, at, moving, part, placed, scene
from scipy.spatial.transform import Rotation

from mua.characters.assemble import assemble
from mua.errors import InputError
from mua.scene import Skin


def test_bind_pose_reproduces_the_bind_vertices() -> None:
    surfaces = assemble(scene(), HERE)
    np.testing.assert_allclose(surfaces.vertices[surfaces.faces], part().positions[part().faces], atol=DOUBLE_BOUND)
    bind = surfaces.skeleton.bind_pose
    np.testing.assert_allclose(posed(surfaces, bind.rotations, bind.translations), surfaces.vertices, atol=WEIGHT_BOUND)


def test_skins_bound_in_other_spaces_meet() -> None:
    space = at(3, -2, 1, Rotation.from_euler("xyz", [40, 50, 60], degrees=True), scale=250)
    other = replace(part(group=1, skin=1, seed=3), positions=placed(np.linalg.inv(space), part(seed=3).positions))
    skins = (scene().skins[0], Skin(np.arange(5), np.linalg.inv(BIND) @ space))
    whole = scene(skins=skins, parts=(part(), other), motions=(moving(BIND, PARENTS),))
    surfaces = assemble(whole, HERE)
    expected = np.concatenate([part().positions[part().faces], part(seed=3).positions[part().faces]])
    np.testing.assert_allclose(surfaces.vertices[surfaces.faces], expected, atol=1000 * DOUBLE_BOUND)
    assert_follows(whole, surfaces)


def test_skins_bound_in_other_poses_meet_in_the_first() -> None:
    bent = BIND.copy()
    bent[2] = BIND[1] @ at(0, 0, 0, Rotation.from_rotvec([0.5, 0, 0])) @ np.linalg.inv(BIND[1]) @ BIND[2]
    skins = (scene().skins[0], Skin(np.arange(5), np.linalg.inv(bent)))
    whole = scene(skins=skins, parts=(part(), part(group=1, skin=1, seed=3)), motions=(moving(BIND, PARENTS),))
    rigid = replace(whole.parts[1], weights=np.tile([1.0, 0.0], (30, 1)))  # blends of two poses differ by their nature
    whole = replace(whole, parts=(whole.parts[0], rigid))
    assert_follows(whole, assemble(whole, HERE))


@pytest.mark.parametrize("scale", [(1.0, 2.0, 0.5), (0.01, 0.01, 0.01)])
def test_scales_of_joints_leave_the_pose_alone(scale: tuple[float, float, float]) -> None:
    stretch = np.diag([*scale, 1])
    bind = BIND @ stretch
    motion = moving(BIND, PARENTS)
    whole = scene(
        rest=bind,
        skins=(Skin(np.arange(5), np.linalg.inv(bind)),),
        motions=(replace(motion, worlds=motion.worlds @ stretch),),
    )
    surfaces = assemble(whole, HERE)
    np.testing.assert_allclose(surfaces.skeleton.bind_translations[1], [0, 0.3, 0], atol=DOUBLE_BOUND)
    assert_follows(whole, surfaces)


@pytest.mark.parametrize(("scale", "about"), [((2.0, 1.5, 0.5), 0), ((1.03, 1, 0.98), 0), ((2.0, 1.5, 0.5), 40)])
def test_scale_added_after_binding_is_folded_into_the_mesh(scale: tuple[float, ...], about: float) -> None:
    """Tries a small scale, too, and one along axes that are not the joint's."""
    turn = at(0, 0, 0, Rotation.from_euler("xyz", [about, about / 2, about], degrees=True))
    stretch = turn @ np.diag([*scale, 1]) @ turn.T
    bigger_head = BIND.copy()
    bigger_head[2] = BIND[2] @ stretch
    motion = moving(BIND, PARENTS)
    worlds = motion.worlds.copy()
    worlds[:, 2] = worlds[:, 2] @ stretch
    whole_weights = replace(part(), weights=np.tile([1.0, 0.0], (30, 1)))  # a blend of scales is not one of rotations
    whole = scene(rest=bigger_head, parts=(whole_weights,), motions=(replace(motion, worlds=worlds),))
    surfaces = assemble(whole, HERE)
    assert_follows(whole, surfaces)
    assert not surfaces.notes


def test_scale_that_children_inherit_moves_them_with_it() -> None:
    grown = BIND.copy()
    grown[1:] = BIND[1] @ np.diag([1.25, 1.25, 1.25, 1]) @ np.linalg.inv(BIND[1]) @ BIND[1:]
    rigid = replace(part(), weights=np.tile([1.0, 0.0], (30, 1)))
    whole = scene(rest=grown, parts=(rigid,), motions=(moving(grown, PARENTS),))
    surfaces = assemble(whole, HERE)
    assert_follows(whole, surfaces)
    bind = surfaces.skeleton.bind_pose
    places = surfaces.skeleton.world(bind.rotations, bind.translations)[1]
    apart = grown[:, :3, 3] - grown[0, :3, 3]
    np.testing.assert_allclose(places - places[0], apart, atol=DOUBLE_BOUND)


def test_mirrored_mesh_keeps_its_outside() -> None:
    mirror = np.diag([-1.0, 1, 1, 1])
    mirrored = replace(part(), positions=part().positions * [-1, 1, 1])
    surfaces = assemble(scene(skins=(Skin(np.arange(5), np.linalg.inv(BIND) @ mirror),), parts=(mirrored,)), HERE)
    turned = part().faces[:, [0, 2, 1]]
    np.testing.assert_allclose(surfaces.vertices[surfaces.faces], part().positions[turned], atol=DOUBLE_BOUND)


def test_z_up_mesh_stands_up_although_the_rest_pose_is_another() -> None:
    z_up = at(0, 0, 0, Rotation.from_rotvec([-np.pi / 2, 0, 0]), scale=0.01)
    motion = moving(BIND, PARENTS)
    whole = scene(
        rest=motion.worlds[5],
        skins=(Skin(np.arange(5), np.linalg.inv(BIND) @ z_up),),
        parts=(replace(part(), positions=placed(np.linalg.inv(z_up), part().positions)),),
        motions=(motion,),
    )
    surfaces = assemble(whole, HERE)
    np.testing.assert_allclose(surfaces.vertices[surfaces.faces], part().positions[part().faces], atol=1e-12)
    assert_follows(whole, surfaces)


def test_a_mesh_of_another_pose_stands_where_the_node_above_its_joints_does() -> None:
    armature = at(0.4, 0, 0.3)
    motion = moving(BIND, PARENTS)
    worlds = np.concatenate([np.tile(armature, (9, 1, 1, 1)), armature @ motion.worlds], axis=1)
    whole = scene(
        node_names=("armature", *scene().node_names),
        parents=np.append(-1, PARENTS + 1),
        rest=worlds[5],
        skins=(Skin(np.arange(1, 6), np.linalg.inv(BIND)),),
        motions=(replace(motion, worlds=worlds),),
    )
    surfaces = assemble(whole, HERE)
    expected = placed(armature, part().positions)[part().faces]
    np.testing.assert_allclose(surfaces.vertices[surfaces.faces], expected, atol=DOUBLE_BOUND)
    assert_follows(whole, surfaces)


def test_hips_are_the_root_of_a_still_character() -> None:
    surfaces = assemble(scene(node_names=("Armature", "mixamorig:Hips", "c", "d", "e")), HERE)
    assert surfaces.skeleton.names[surfaces.skeleton.root] in ("Armature", "mixamorig:Hips")
    above = replace(part(), joints=np.minimum(part().joints + 1, 4))
    surfaces = assemble(scene(node_names=("Armature", "mixamorig:Hips", "c", "d", "e"), parts=(above,)), HERE)
    assert surfaces.skeleton.names[surfaces.skeleton.root] == "mixamorig:Hips"


@pytest.mark.parametrize("degrees", [0, 30, 55, 65, 90, 180, 270])
def test_character_is_turned_to_face_forward(degrees: int) -> None:
    away = at(0, 0, 0, Rotation.from_euler("y", degrees, degrees=True))
    bind = away @ BIND
    whole = scene(
        rest=bind,
        skins=(Skin(np.arange(5), np.linalg.inv(bind)),),
        parts=(replace(part(), positions=placed(away, part().positions)),),
    )
    surfaces = assemble(whole, HERE)
    left = surfaces.skeleton.world(surfaces.skeleton.bind_rotations, surfaces.skeleton.bind_pose.translations)[1][3]
    assert left[0] > 0.1
    assert bool(surfaces.notes) == (degrees > 60)


def test_joints_with_numbers_behind_their_names_show_left_and_right() -> None:
    away = at(0, 0, 0, Rotation.from_euler("y", 180, degrees=True))
    names = ("hips_01", "spine_02", "head_03", "arm_l_04", "arm_r_05")
    assert any("turned by 180" in note for note in assemble(scene(node_names=names, rest=away @ BIND), HERE).notes)


def shrunk(joints: np.ndarray) -> np.ndarray:
    """The rest pose, some joints of which have a scale of 0."""
    rest = BIND.copy()
    rest[joints, :3, :3] = 0
    return rest


def test_what_hangs_on_a_joint_with_a_scale_of_nothing_is_left_out() -> None:
    hidden = part(group=1, seed=1)
    hidden = replace(hidden, joints=np.full_like(hidden.joints, 3), weights=np.full_like(hidden.weights, 0.5))
    surfaces = assemble(scene(rest=shrunk(np.arange(5) == 3), parts=(part(), hidden)), HERE)
    np.testing.assert_allclose(surfaces.vertices, assemble(scene(), HERE).vertices, atol=DOUBLE_BOUND)
    assert "Triangles on joints with a scale of 0 are left out, of meshes: part1." in surfaces.notes


def test_collapsed_mesh_and_joint_are_refused() -> None:
    with pytest.raises(InputError, match="all vertices of the skinned meshes are at"):
        assemble(scene(parts=(replace(part(), positions=np.zeros((30, 3))),)), HERE)
    with pytest.raises(InputError, match="node hips has a scale of 0"):
        assemble(scene(rest=shrunk(np.arange(5) >= 0)), HERE)
