"""Meshes without a skin: what they hang on, what is left out, and what a user leaves out."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from gltf_files import (
    FLOAT_BOUND,
    HALF_TURN,
    TRIANGLES,
    UV,
    Glb,
    animate,
    assert_is_column,
    body,
    posed,
    primitive,
    read,
)
from gltf_files import POINTS as COLUMN

from mua.characters.messages import LOOKS_WRONG, STILL, is_about
from mua.characters.read import read_surfaces
from mua.errors import InputError

BLOCK = COLUMN * 0.2


def block(glb: Glb, name: str, *, at: tuple[float, float, float], parent: int | None, size: float = 1) -> int:
    """A node with a small column as its mesh; returns its index."""
    points = BLOCK * size
    attributes = {
        "POSITION": glb.accessor(points, min=points.min(axis=0).tolist(), max=points.max(axis=0).tolist()),
        "TEXCOORD_0": glb.accessor(UV),
    }
    primitives = [{"attributes": attributes, "indices": glb.accessor(TRIANGLES.reshape(-1), "u2")}]
    glb.json.setdefault("meshes", []).append({"name": f"{name} mesh", "primitives": primitives})
    nodes = glb.json.setdefault("nodes", [])
    nodes.append({"name": name, "mesh": len(glb.json["meshes"]) - 1, "translation": list(at)})
    if parent is None:
        glb.json.setdefault("scenes", [{"nodes": []}])[0]["nodes"].append(len(nodes) - 1)
    else:
        nodes[parent].setdefault("children", []).append(len(nodes) - 1)
    return len(nodes) - 1


def turn(glb: Glb, node: int) -> None:
    animate(glb, node, "rotation", times=[0.0, 1.0], values=HALF_TURN)


def robot() -> Glb:
    """A torso that stands still, with an arm and a hand that turn, on a node of its own; a floor beside it."""
    glb = Glb()
    glb.json["nodes"] = [{"name": "robot"}]
    glb.json["scenes"] = [{"nodes": [0]}]
    torso = block(glb, "torso", at=(0, 1, 0), parent=0)
    arm = block(glb, "arm", at=(0.5, 0, 0), parent=torso)
    turn(glb, arm)
    turn(glb, block(glb, "hand", at=(0, 0.3, 0), parent=arm))
    turn(glb, block(glb, "head", at=(0, 0.3, 0), parent=torso))
    block(glb, "floor", at=(0, 0, 0), parent=None, size=50)
    return glb


def test_robot_of_rigid_parts_is_a_character(tmp_path: Path) -> None:
    surfaces = read(robot(), tmp_path)
    assert set(surfaces.skeleton.names) >= {"torso", "arm", "hand", "head"}
    low, high = surfaces.vertices.min(axis=0), surfaces.vertices.max(axis=0)
    np.testing.assert_allclose([low, high], [[-0.04, 1, -0.02], [0.54, 1.6, 0.02]], atol=FLOAT_BOUND)
    assert "Meshes that no joint moves are left out: floor." in surfaces.notes
    (clip,) = surfaces.clips
    half = posed(surfaces, clip.rotations[15], clip.translations[15])
    hand = surfaces.skin_indices[:, 0] == surfaces.skeleton.names.index("hand")
    # the arm has turned by 90 degrees to -X, and the hand by another 90 downwards
    reach = half[hand].mean(axis=0) - [0.5, 1, 0]
    np.testing.assert_allclose(reach, [-0.3, -0.15, 0], atol=FLOAT_BOUND)


def test_a_check_says_first_that_most_meshes_stand_still(tmp_path: Path) -> None:
    glb = Glb()
    glb.json |= {"nodes": [], "scenes": [{"nodes": []}]}
    turn(glb, block(glb, "halo", at=(0, 2, 0), parent=None))
    for name in ("statue", "base"):
        block(glb, name, at=(0, 0, 0), parent=None)
    notes = read(glb, tmp_path).notes
    assert [note.rpartition(": ")[2] for note in notes if is_about(note, STILL)] == ["statue, base."]
    assert STILL in LOOKS_WRONG


@pytest.mark.parametrize("on_a_mesh", [True, False])
def test_a_body_of_which_a_single_arm_moves_is_whole(tmp_path: Path, on_a_mesh: bool) -> None:
    """The still parts belong to it, whether the arm hangs on one of them or all on a node without a mesh."""
    glb = Glb()
    glb.json["nodes"] = [{"name": "group"}]
    glb.json["scenes"] = [{"nodes": [0]}]
    belly = block(glb, "belly", at=(0, 1, 0), parent=0)
    turn(glb, block(glb, "arm", at=(0.5, 0, 0), parent=belly if on_a_mesh else 0))
    block(glb, "hat", at=(0, 0.6, 0), parent=belly)
    surfaces = read(glb, tmp_path)
    assert not any("left out:" in note and "belly" in note for note in surfaces.notes)
    low, high = surfaces.vertices.min(axis=0), surfaces.vertices.max(axis=0)
    assert high[1] - low[1] > 0.6
    (clip,) = surfaces.clips
    moved = posed(surfaces, clip.rotations[15], clip.translations[15]) - surfaces.vertices
    still = surfaces.vertices[:, 0] < 0.25
    np.testing.assert_allclose(moved[still], 0, atol=FLOAT_BOUND)
    assert np.abs(moved[~still]).max() > 0.1


@pytest.mark.parametrize(
    ("left", "right"),
    [("arm.L", "arm.R"), ("UpperArmL", "UpperArmR"), ("LArm", "RArm"), ("lShldr", "rShldr"), ("arm_l_01", "arm_r_01")],
)
def test_robot_with_names_of_sides_is_turned_to_the_front(tmp_path: Path, left: str, right: str) -> None:
    glb = robot()
    glb.json["nodes"][2]["name"] = right
    turn(glb, block(glb, left, at=(-0.5, 0, 0), parent=1))
    assert any("turned by 180°" in note for note in read(glb, tmp_path).notes)


def test_part_that_clips_move_below_a_joint_is_a_joint_of_its_own(tmp_path: Path) -> None:
    glb = body()
    turn(glb, block(glb, "jaw", at=(0, 0.2, 0), parent=2))
    block(glb, "hat", at=(0, 0.4, 0), parent=2)
    surfaces = read(glb, tmp_path)
    assert surfaces.skeleton.names == ("hips", "spine", "head", "jaw")
    parents = dict(zip(surfaces.skeleton.names, surfaces.skeleton.parents, strict=True))
    assert parents["jaw"] == 2
    assert "Meshes that are attached rigidly to a joint (--leave-out NAME leaves one out): jaw, hat." in surfaces.notes


@pytest.mark.parametrize(
    ("at", "size", "taken"), [((0.4, 1, 0), 1, True), ((9, 0, 0), 1, False), ((0, 0, 0), 99, False)]
)
def test_moving_mesh_beside_the_skeleton_is_taken_where_it_is_near(
    tmp_path: Path, at: Any, size: float, taken: bool
) -> None:
    glb = body()
    turn(glb, block(glb, "drone", at=at, parent=None, size=size))
    surfaces = read(glb, tmp_path)
    assert ("drone" in surfaces.skeleton.names) is taken
    expected = "are attached rigidly to a joint" if taken else "that no joint moves are left out"
    assert any("drone" in note for note in surfaces.notes), expected


def test_body_around_a_small_skeleton_is_taken_where_one_node_moves_both(tmp_path: Path) -> None:
    """A robot of which only the face is skinned; a floor of the same size beside it is none of it."""
    glb = body()
    glb.json["nodes"].append({"name": "robot", "children": glb.json["scenes"][0]["nodes"]})
    glb.json["scenes"][0]["nodes"] = [robot := len(glb.json["nodes"]) - 1]
    turn(glb, robot)
    block(glb, "shell", at=(0, 0, 0), parent=robot, size=20)
    turn(glb, block(glb, "floor", at=(0, 0, 0), parent=None, size=20))
    surfaces = read(glb, tmp_path)
    assert "Meshes that are attached rigidly to a joint (--leave-out NAME leaves one out): shell." in surfaces.notes
    assert "Meshes that no joint moves are left out: floor." in surfaces.notes


@pytest.mark.parametrize("unit", [1, 100])
@pytest.mark.parametrize(("along", "taken"), [(1.3, True), (1.7, False)])
def test_near_is_measured_by_the_skeleton_and_where_a_mesh_truly_lies(
    tmp_path: Path, unit: float, along: float, taken: bool
) -> None:
    """In any unit; the mesh lies far along an axis of its own node, which is turned to lead upwards."""
    glb = body()
    drone = block(glb, "drone", at=(0, 0, 0), parent=None)
    points = np.add(BLOCK, [along, 0, 0])
    ends = {"min": points.min(axis=0).tolist(), "max": points.max(axis=0).tolist()}
    glb.json["meshes"][-1]["primitives"][0]["attributes"]["POSITION"] = glb.accessor(points, **ends)
    glb.json["nodes"][drone]["rotation"] = [0, 0, np.sqrt(0.5), np.sqrt(0.5)]
    turn(glb, drone)
    glb.json["nodes"].append({"name": "unit", "scale": [unit] * 3, "children": glb.json["scenes"][0]["nodes"]})
    glb.json["scenes"][0]["nodes"] = [len(glb.json["nodes"]) - 1]
    assert ("drone" in read(glb, tmp_path).skeleton.names) is taken


def bare_primitive(glb: Glb) -> None:
    """One more primitive of the skinned mesh, without weights: a small column 0.1 m above its node."""
    attributes = {"POSITION": glb.accessor(BLOCK + np.array([0, 0.1, 0])), "TEXCOORD_0": glb.accessor(UV)}
    indices = glb.accessor(TRIANGLES.reshape(-1), "u2")
    glb.json["meshes"][0]["primitives"].append({"attributes": attributes, "indices": indices})


def test_primitive_without_weights_follows_the_node_of_its_skinned_mesh(tmp_path: Path) -> None:
    glb = body()
    bare_primitive(glb)
    glb.json["nodes"][2]["children"] = [3]  # the mesh hangs on the head
    glb.json["scenes"] = [{"nodes": [0]}]
    surfaces = read(glb, tmp_path)
    assert len(surfaces.vertices) == 2 * len(COLUMN)
    hat = surfaces.vertices[len(COLUMN) :]
    np.testing.assert_allclose(hat.min(axis=0), [-0.04, 1.1, -0.02], atol=FLOAT_BOUND)
    joints = surfaces.skin_indices[len(COLUMN) :, 0]
    assert {surfaces.skeleton.names[joint] for joint in joints} == {"head"}


def test_primitive_without_weights_that_no_joint_moves_is_left_out_by_name(tmp_path: Path) -> None:
    glb = body()
    bare_primitive(glb)
    surfaces = read(glb, tmp_path)
    assert_is_column(surfaces)
    left_out = "Primitives without skin weights, which no joint moves, are left out, of meshes: body."
    assert left_out in surfaces.notes


def test_second_skinned_root_is_part_of_the_character(tmp_path: Path) -> None:
    """A tail on two joints of its own, which share no ancestor with the body's."""
    glb = body()
    glb.json["nodes"] += [{"name": "tail", "translation": [0, 0.2, -0.5], "children": [5]}, {"name": "tip"}]
    binds = np.tile(np.eye(4), (2, 1, 1))
    binds[:, :3, 3] = [0, -0.2, 0.5]
    glb.json["skins"].append({"joints": [4, 5], "inverseBindMatrices": glb.accessor(binds.swapaxes(1, 2))})
    attributes = {
        "POSITION": glb.accessor([[0, 0.2, -0.5], [0.1, 0.2, -0.5], [0, 0.3, -0.5]]),
        "JOINTS_0": glb.accessor([[0, 0, 0, 0], [1, 0, 0, 0], [1, 0, 0, 0]], "u1"),
        "WEIGHTS_0": glb.accessor([[1, 0, 0, 0]] * 3),
    }
    glb.json["meshes"].append({"name": "tail", "primitives": [{"attributes": attributes}]})
    glb.json["nodes"].append({"mesh": 1, "skin": 1})
    glb.json["scenes"][0]["nodes"] += [4, 6]
    turn(glb, 4)
    animate(glb, 1, "rotation", times=[0.0, 1.0], values=HALF_TURN)
    surfaces = read(glb, tmp_path)
    assert surfaces.skeleton.names == ("hips", "spine", "head", "tail", "tip")
    tail = surfaces.skin_indices[:, 0] >= 3
    assert tail.sum() == 3
    (clip,) = surfaces.clips
    turned = posed(surfaces, clip.rotations[-1], clip.translations[-1])
    np.testing.assert_allclose(sorted(turned[tail][:, 0]), [-0.1, 0, 0], atol=FLOAT_BOUND)


def test_nodes_that_the_file_hides_are_left_out(tmp_path: Path) -> None:
    glb = body()
    holder = len(glb.json["nodes"])
    glb.json["nodes"].append({"name": "kit", "extensions": {"KHR_node_visibility": {"visible": False}}})
    glb.json["nodes"][2]["children"] = [holder]
    block(glb, "sword", at=(0, 0, 0), parent=holder)
    glb.json["extensionsRequired"] = ["KHR_node_visibility"]
    surfaces = read(glb, tmp_path)
    assert_is_column(surfaces)
    assert surfaces.notes == ("Meshes that the file hides are left out: sword.",)


def test_prop_that_is_scaled_to_nothing_is_left_out(tmp_path: Path) -> None:
    glb = body()
    sword = block(glb, "sword", at=(0, 0, 0), parent=2)
    glb.json["nodes"][sword]["scale"] = [0, 0, 0]
    surfaces = read(glb, tmp_path)
    assert_is_column(surfaces)
    assert surfaces.notes == ("Meshes that the file hides are left out: sword.",)


@pytest.mark.parametrize("name", ["sword", "SWORD MESH", "steel"])
def test_mesh_node_or_material_is_left_out_by_name(tmp_path: Path, name: str) -> None:
    glb = body()
    block(glb, "sword", at=(0, 0, 0), parent=2)
    glb.json["materials"] = [{"name": "steel"}, {"name": "cloth"}]
    glb.json["meshes"][1]["primitives"][0]["material"] = 0
    primitive(glb)["material"] = 1
    surfaces = read_surfaces(glb.save(tmp_path / "body.glb"), leave_out=[name])
    assert_is_column(surfaces)
    assert surfaces.notes == ()


def test_unknown_name_to_leave_out_is_refused_with_the_nearest(tmp_path: Path) -> None:
    glb = body()
    block(glb, "Sword_1H", at=(0, 0, 0), parent=2)
    path = glb.save(tmp_path / "body.glb")
    with pytest.raises(InputError, match=r"--leave-out swrd: no mesh, node or material has this name; .*Sword_1H"):
        read_surfaces(path, leave_out=["swrd"])
    with pytest.raises(InputError, match=r"there are .*body"):
        read_surfaces(path, leave_out=["###"])


def test_leaving_out_everything_is_refused(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="no skinned mesh"):
        read_surfaces(body().save(tmp_path / "body.glb"), leave_out=["body"])


def test_meshes_of_other_scenes_are_left_out_by_name(tmp_path: Path) -> None:
    glb = body()
    block(glb, "stage", at=(0, 0, 0), parent=None)
    glb.json["scenes"] = [{"nodes": [0, 3]}, {"nodes": [4]}]
    surfaces = read(glb, tmp_path)
    assert_is_column(surfaces)
    assert surfaces.notes == ("Meshes of other scenes than the file's first are left out: stage.",)


def test_mesh_that_lies_flat_keeps_its_size(tmp_path: Path) -> None:
    glb = body()
    primitive(glb)["attributes"]["POSITION"] = glb.accessor(COLUMN * [1, 1e-20, 1])
    np.testing.assert_allclose(np.ptp(read(glb, tmp_path).vertices, axis=0), [0.4, 0, 0.2], atol=FLOAT_BOUND)
