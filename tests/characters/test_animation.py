"""Motion in files without a mesh, against the same rig with one."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from gltf_files import FLOAT_BOUND, HALF_TURN, Glb, animate, body, weighted
from people import retarget

from mua.characters.animation import Animation
from mua.characters.read import read_animation, read_surfaces
from mua.errors import InputError
from mua.motion.read import read_motion
from mua.pose.skeleton import Skeleton

# Name, parent and offset of each joint, centimetres, Z up: what stands below a node that turns and scales it.
BONES = [
    ("Hips", None, (0, 0, 90)),
    ("Spine", 0, (0, 0, 20)),
    ("Head", 1, (0, 0, 40)),
    *(
        joint
        for first, side, x in ((3, "Left", 1), (10, "Right", -1))
        for joint in (
            (f"{side}Arm", 1, (18 * x, 0, 25)),
            (f"{side}ForeArm", first, (25 * x, 2, 0)),
            (f"{side}Hand", first + 1, (25 * x, -2, 0)),
            (f"{side}UpLeg", 0, (10 * x, 0, -5)),
            (f"{side}Leg", first + 3, (0, -1, -40)),
            (f"{side}Foot", first + 4, (0, 1, -38)),
            (f"{side}ToeBase", first + 5, (0, -14, -6)),
        )
    ),
]
HIPS = 1  # node of the hips; the node above, 0, turns to Y up and to metres
FRAMES = 7  # at 30 frames a second
# Rotations through float32 keys, matrices and back, along chains of at most five joints.
TURN_BOUND = 16 * 2**-23


def rig(*, skin: bool = True, mesh: bool = True, moved: int | None = None) -> Glb:
    """A body of two metres whose joints all turn and whose hips move; `moved` of them, if not all."""
    glb = Glb()
    rng = np.random.default_rng(2)
    nodes: list[dict[str, Any]] = [{"name": "Armature", "rotation": [-(0.5**0.5), 0, 0, 0.5**0.5], "scale": [0.01] * 3}]
    nodes += [{"name": f"mixamorig:{name}", "translation": offset} for name, _, offset in BONES]
    for node, (_, parent, _) in enumerate(BONES, 1):
        nodes[0 if parent is None else parent + 1].setdefault("children", []).append(node)
    glb.json["nodes"] = nodes
    glb.json["scenes"] = [{"nodes": [0]}]
    times = np.arange(FRAMES) / 30
    for node in range(HIPS, len(nodes))[:moved]:
        turns = rng.standard_normal((FRAMES, 4)) * 0.2 + [0, 0, 0, 1]
        animate(glb, node, "rotation", times=times, values=turns / np.linalg.norm(turns, axis=1, keepdims=True))
    path = np.array(BONES[0][2]) + 5 * rng.standard_normal((FRAMES, 3))
    animate(glb, HIPS, "translation", times=times, values=path)
    if skin:
        places = np.array([(0.0, 0.0, 0.0)] * len(BONES))
        for j, (_, parent, offset) in enumerate(BONES):
            places[j] = np.add(offset, 0 if parent is None else places[parent])
        binds = np.tile(np.eye(4), (len(BONES), 1, 1))
        binds[:, :3, 3] = -places
        matrices = glb.accessor(binds.swapaxes(1, 2))
        glb.json["skins"] = [{"joints": list(range(HIPS, len(nodes))), "inverseBindMatrices": matrices}]
    if mesh:
        joints, weights = weighted(np.repeat(np.arange(len(BONES)), 3))
        corners = (places[:, None] + np.eye(3)).reshape(-1, 3)  # a triangle beside every joint
        attributes = {"POSITION": corners, "WEIGHTS_0": weights}
        accessors = {name: glb.accessor(values) for name, values in attributes.items()}
        accessors["JOINTS_0"] = glb.accessor(joints, "u1")
        glb.json["meshes"] = [{"primitives": [{"attributes": accessors}]}]
        glb.json["nodes"].append({"mesh": 0, "skin": 0})
        glb.json["scenes"][0]["nodes"].append(len(nodes) - 1)
    return glb


def read(glb: Glb, tmp_path: Path) -> Animation:
    return read_animation(glb.save(tmp_path / "motion.glb"))


def bind(skeleton: Skeleton) -> tuple[np.ndarray, np.ndarray]:
    return skeleton.bind_rotations, skeleton.bind_pose.translations


def with_camera(glb: Glb) -> Glb:
    """The file with a camera beside the body, which the clip moves too."""
    nodes = glb.json["nodes"]
    nodes += [{"name": "Camera", "translation": [0, 50, 3]}, {"name": "RootNode", "children": [0, len(nodes)]}]
    glb.json["scenes"] = [{"nodes": [len(nodes) - 1]}]
    animate(glb, len(nodes) - 2, "translation", times=[0.0, 0.2], values=[[0, 50, 3], [9, 50, 3]])
    return glb


def with_face(glb: Glb) -> Glb:
    """The file with a face that hangs rigidly on the head, as files of motion keep it for its expressions."""
    corners = np.array([[0, -8, 0], [5, -8, 0], [0, -8, 9]], float)
    glb.json["meshes"] = [{"primitives": [{"attributes": {"POSITION": glb.accessor(corners)}}]}]
    glb.json["nodes"].append({"mesh": 0, "name": "face"})
    glb.json["nodes"][HIPS + 2].setdefault("children", []).append(len(glb.json["nodes"]) - 1)
    return glb


@pytest.mark.parametrize(
    "bare",
    [
        rig(skin=True, mesh=False),
        with_face(rig(skin=True, mesh=False)),
        rig(skin=False, mesh=False),
        with_camera(rig(skin=False, mesh=False)),
    ],
    ids=["skin", "skin of which a face is left", "nodes", "nodes beside a camera"],
)
def test_motion_without_a_mesh_is_the_identity_on_its_own_rig(tmp_path: Path, bare: Glb) -> None:
    character = read_surfaces(rig().save(tmp_path / "rig.glb"))
    (expected,) = character.clips
    (source,) = read_motion(bare.save(tmp_path / "motion.glb"))
    clip, notes = retarget(source, character.skeleton)
    assert (clip.name, clip.rate, len(clip)) == ("wave", 30.0, FRAMES)
    cosines = np.abs(np.sum(clip.rotations * expected.rotations, axis=-1))
    np.testing.assert_allclose(cosines, 1, atol=TURN_BOUND)
    np.testing.assert_allclose(clip.translations, expected.translations, atol=FLOAT_BOUND)
    assert not notes


def test_file_with_a_mesh_gives_the_motion_of_its_character(tmp_path: Path) -> None:
    path = rig().save(tmp_path / "rig.glb")
    character, animation = read_surfaces(path), read_animation(path)
    assert animation.skeleton.names == character.skeleton.names
    np.testing.assert_array_equal(animation.clips[0].rotations, character.clips[0].rotations)


def test_joints_that_no_clip_moves_are_kept(tmp_path: Path) -> None:
    skeleton = read(rig(skin=False, mesh=False, moved=2), tmp_path).skeleton
    assert skeleton.names[skeleton.root] == "mixamorig:Hips"
    assert {f"mixamorig:{name}" for name, _, _ in BONES} <= set(skeleton.names)


def bare_column() -> Glb:
    """Hips, spine and head with a clip, without mesh and skin."""
    glb = body()
    del glb.json["meshes"], glb.json["skins"]
    glb.json["nodes"] = glb.json["nodes"][:3]
    glb.json["scenes"] = [{"nodes": [0]}]
    animate(glb, 1, "rotation", times=[0.0, 1.0], values=HALF_TURN)
    animate(glb, 0, "translation", times=[0.0, 1.0], values=[[0, 0, 0], [3, 0, 0]])
    return glb


def test_motion_above_the_skeleton_moves_its_root(tmp_path: Path) -> None:
    glb = bare_column()
    glb.json["nodes"].append({"name": "armature", "children": [0]})
    glb.json["scenes"][0]["nodes"] = [3]
    animate(glb, 3, "translation", times=[0.0, 1.0], values=[[0, 0, 0], [0, 0, 2]])
    animation = read(glb, tmp_path)
    positions = animation.skeleton.world(animation.clips[0].rotations, animation.clips[0].translations)[1]
    hips = animation.skeleton.names.index("hips")
    assert animation.skeleton.root == hips
    np.testing.assert_allclose(positions[-1, hips], [3, 0, 2], atol=FLOAT_BOUND)


def test_skin_keeps_its_bind_pose_where_the_rest_pose_is_another(tmp_path: Path) -> None:
    glb = body()
    del glb.json["meshes"]
    glb.json["nodes"] = glb.json["nodes"][:3]
    glb.json["scenes"] = [{"nodes": [0]}]
    glb.json["nodes"][2]["rotation"] = [0, 0.5**0.5, 0, 0.5**0.5]
    animate(glb, 1, "rotation", times=[0.0, 1.0], values=HALF_TURN)
    skeleton = read(glb, tmp_path).skeleton
    np.testing.assert_allclose(np.abs(skeleton.bind_rotations[:, 0]), 1, atol=TURN_BOUND)


def test_joints_without_a_bind_matrix_of_their_own_stay_where_they_rest(tmp_path: Path) -> None:
    glb = rig(mesh=False)
    expected = read(glb, tmp_path).skeleton
    binds = np.frombuffer(glb.blob, "<f4")[-16 * len(BONES) :].reshape(-1, 16).copy()
    binds[[1, 4]] = np.eye(4).ravel()
    glb.json["skins"][0]["inverseBindMatrices"] = glb.accessor(binds)
    skeleton = read(glb, tmp_path).skeleton
    assert set(skeleton.names) == set(expected.names)
    assert skeleton.names
    places = dict(zip(expected.names, expected.world(*bind(expected))[1], strict=True))
    for name, place in zip(skeleton.names, skeleton.world(*bind(skeleton))[1], strict=True):
        np.testing.assert_allclose(place, places[name], atol=FLOAT_BOUND)


@pytest.mark.parametrize("stated", [False, True])
def test_skin_without_bind_matrices_is_bound_at_rest(tmp_path: Path, stated: bool) -> None:
    """Or with matrices that are all the identity."""
    glb = rig(mesh=False)
    del glb.json["skins"][0]["inverseBindMatrices"]
    if stated:
        glb.json["skins"][0]["inverseBindMatrices"] = glb.accessor(np.tile(np.eye(4), (len(BONES), 1, 1)))
    bare, skinned = read(glb, tmp_path).skeleton, read(rig(), tmp_path).skeleton
    assert bare.names == skinned.names
    np.testing.assert_allclose(bare.bind_translations, skinned.bind_translations, atol=FLOAT_BOUND)


def test_centimetres_taken_for_metres_are_noted(tmp_path: Path) -> None:
    glb = rig(skin=False, mesh=False)
    glb.json["nodes"][0]["scale"] = [1, 1, 1]
    animation = read(glb, tmp_path)
    height = np.ptp(animation.skeleton.world(*bind(animation.skeleton))[1][:, 1])
    assert 1.3 < height < 1.8
    assert "one unit is taken as 0.01 m" in animation.notes[0]
    assert read_motion(tmp_path / "motion.glb")[0].notes == animation.notes


def test_refuses_a_file_without_mesh_skeleton_and_motion(tmp_path: Path) -> None:
    glb = bare_column()
    del glb.json["animations"]
    with pytest.raises(InputError, match=r"motion\.glb: no skinned mesh, skeleton or animated nodes were found"):
        read(glb, tmp_path)


def test_refuses_a_skeleton_without_motion(tmp_path: Path) -> None:
    glb = rig(mesh=False)
    del glb.json["animations"]
    with pytest.raises(InputError, match="expected an animation, found none"):
        read_motion(glb.save(tmp_path / "motion.glb"))


def test_names_a_target_that_is_no_node(tmp_path: Path) -> None:
    glb = bare_column()
    glb.json["animations"][0]["channels"][1]["target"]["node"] = 9
    with pytest.raises(InputError, match=r"animations\[0\]\.channels\[1\]\.target\.node is 9"):
        read(glb, tmp_path)


@pytest.mark.parametrize("begins_turned", [False, True])
def test_motion_is_turned_to_the_front_only_where_its_clips_begin_as_it_rests(
    tmp_path: Path, begins_turned: bool
) -> None:
    """Files without a mesh may rest in any moment of a dance, which says nothing about where their motion faces."""
    aside = [0, 0, 0.5**0.5, 0.5**0.5]  # a quarter turn about the Z of the joints, which leads up
    glb = rig(skin=False, mesh=False, moved=0)
    glb.json["nodes"][HIPS]["rotation"] = aside
    animate(glb, HIPS, "rotation", times=[0, 1], values=[aside if begins_turned else [0, 0, 0, 1], aside])
    assert any("turned by 270" in note for note in read(glb, tmp_path).notes) is begins_turned
