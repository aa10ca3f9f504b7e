"""VRM avatars of both versions: bones, facing, hidden meshes, and what is noted of the rest."""

from pathlib import Path
from typing import Any

import pytest
from gltf_files import Glb, assert_is_column, body
from people import chain

from mua.atlas.character_surfaces import Surfaces
from mua.characters.gltf.vrm import ROLES
from mua.characters.read import read_animation, read_character, read_surfaces
from mua.errors import InputError
from mua.pose.joint_names import roles

BONES = {"hips": 0, "spine": 1, "head": 2}


def first(glb: Glb, bones: dict[str, int], **more: Any) -> Glb:
    human = [{"bone": bone, "node": node} for bone, node in bones.items()]
    glb.json["extensions"] = {"VRM": {"humanoid": {"humanBones": human}} | more}
    return glb


def second(glb: Glb, bones: dict[str, int], **more: Any) -> Glb:
    human = {bone: {"node": node} for bone, node in bones.items()}
    glb.json["extensions"] = {"VRMC_vrm": {"specVersion": "1.0", "humanoid": {"humanBones": human}} | more}
    return glb


def read(glb: Glb, tmp_path: Path) -> Surfaces:
    return read_surfaces(glb.save(tmp_path / "avatar.vrm"))


def with_arms(glb: Glb, left_x: float) -> Glb:
    """Two joints without weights beside the head, whose names say nothing of their sides."""
    glb.json["nodes"] += [{"name": "a", "translation": [left_x, 0, 0]}, {"name": "b", "translation": [-left_x, 0, 0]}]
    glb.json["nodes"][2]["children"] = [4, 5]
    return glb


@pytest.mark.parametrize("version", [first, second])
def test_humanoid_bones_become_roles_of_joints(tmp_path: Path, version: Any) -> None:
    glb = body()
    for node, name in enumerate("xyz"):
        glb.json["nodes"][node]["name"] = name
    surfaces = read(version(glb, BONES), tmp_path)
    assert_is_column(surfaces)
    assert surfaces.roles == {"x": "hips", "y": "spine", "z": "head"}
    assert read_character(tmp_path / "avatar.vrm", atlas_size=16).roles == surfaces.roles
    assert read_animation(tmp_path / "avatar.vrm").roles == surfaces.roles


def test_every_role_is_one_that_motion_knows() -> None:
    spelled = {"Left" + bone[4:] if bone.startswith("left") else bone for bone in ROLES if not bone.startswith("right")}
    names = tuple(sorted(spelled))
    assert {role for role in ROLES.values() if not role.startswith("right")} <= set(roles(chain(*names)))


@pytest.mark.parametrize(("left_x", "turned"), [(1.0, False), (-1.0, True)])
def test_avatar_that_faces_backwards_is_turned_by_its_bones(tmp_path: Path, left_x: float, turned: bool) -> None:
    glb = with_arms(body(), left_x)
    surfaces = read(first(glb, {**BONES, "leftUpperArm": 4, "rightUpperArm": 5}), tmp_path)
    assert any("turned by 180°" in note for note in surfaces.notes) is turned
    place = surfaces.skeleton.world(surfaces.skeleton.bind_rotations, surfaces.skeleton.bind_translations)[1][
        surfaces.skeleton.names.index("a")
    ]
    assert place[0] == pytest.approx(1.0, abs=1e-6)


def test_bones_without_any_skin_are_joints(tmp_path: Path) -> None:
    glb = body()
    glb.json.pop("skins")
    glb.json["nodes"] = [*glb.json["nodes"][:3], {"mesh": 0, "name": "mask"}]
    glb.json["nodes"][2]["children"] = [3]
    glb.json["scenes"] = [{"nodes": [0]}]
    surfaces = read(second(glb, BONES), tmp_path)
    assert surfaces.skeleton.names == ("hips", "spine", "head")
    assert (surfaces.skin_indices[:, 0] == 2).all()


def test_meshes_for_the_wearers_own_eyes_are_left_out(tmp_path: Path) -> None:
    for version, flag in ((first, {"mesh": 1, "firstPersonFlag": "FirstPersonOnly"}),
                          (second, {"node": 4, "type": "firstPersonOnly"})):  # fmt: skip
        glb = body()
        glb.json["meshes"].append({"name": "inner", "primitives": [glb.json["meshes"][0]["primitives"][0]]})
        glb.json["nodes"].append({"mesh": 1, "skin": 0, "name": "inner"})
        glb.json["scenes"][0]["nodes"].append(4)
        surfaces = read(version(glb, BONES, firstPerson={"meshAnnotations": [flag]}), tmp_path)
        assert_is_column(surfaces)
        assert "Meshes that the file hides are left out: inner." in surfaces.notes


def test_author_licence_springs_and_constraints_are_noted(tmp_path: Path) -> None:
    meta = {"name": "Mira", "authors": ["Ann", "Bo"], "licenseUrl": "https://example.org/terms"}
    glb = second(body(), BONES, meta=meta)
    glb.json["extensions"]["VRMC_springBone"] = {"springs": [{}, {}]}
    glb.json["nodes"][1]["extensions"] = {"VRMC_node_constraint": {"constraint": {}}}
    notes = " ".join(read(glb, tmp_path).notes)
    assert "VRM avatar Mira by Ann, Bo: its licence is https://example.org/terms;" in notes
    assert "2 spring bone groups are left out" in notes
    assert "constraints on 1 of the avatar's nodes are left out" in notes
    old = first(body(), BONES, meta={"title": "Mira", "author": "Ann", "licenseName": "CC_BY"},
                secondaryAnimation={"boneGroups": [{}]})  # fmt: skip
    notes = " ".join(read(old, tmp_path).notes)
    assert "Mira by Ann: its licence is CC BY;" in notes
    assert "1 spring bone groups" in notes


@pytest.mark.parametrize(
    ("version", "extension", "sentence"),
    [
        ("VRM", {"humanoid": {"humanBones": [{"bone": "hips", "node": 77}]}}, r"humanBones\.hips\.node is 77"),
        ("VRMC_vrm", {"humanoid": {"humanBones": {"hips": {}}}}, r"humanBones\.hips\.node is -1"),
        ("VRMC_vrm", {"humanoid": {"humanBones": [1]}}, r"humanBones is \[1\], expected an object"),
        ("VRMC_vrm", {"humanoid": 3}, "humanoid is 3, expected an object"),
        ("VRM", 3, r"extensions\.VRM is 3, expected an object"),
    ],
)
def test_broken_bones_are_named(tmp_path: Path, version: str, extension: Any, sentence: str) -> None:
    glb = body()
    glb.json["extensions"] = {version: extension}
    with pytest.raises(InputError, match=sentence):
        read(glb, tmp_path)


def test_bone_that_old_exporters_mark_as_missing_is_skipped(tmp_path: Path) -> None:
    assert read(first(body(), {**BONES, "jaw": -1}), tmp_path).roles == {
        "hips": "hips",
        "spine": "spine",
        "head": "head",
    }


def test_humanoid_bones_have_the_roles_that_joint_names_are_given() -> None:
    """On both sides alike."""
    expected = {"hips": "hips", "upperChest": "spine", "leftToes": "left toe", "leftFoot": "left foot"}
    expected |= {"rightLowerLeg": "right shin", "leftLittleDistal": "left pinky", "rightThumbProximal": "right thumb"}
    expected |= {"leftShoulder": "left shoulder", "rightUpperArm": "right upper_arm", "rightLowerArm": "right forearm"}
    assert {bone: ROLES[bone] for bone in expected} == expected
    known = {role for role in ROLES.values() if role.partition(" ")[0] in ("left", "right")}
    assert {f"right {role.partition(' ')[2]}" for role in known} == {role for role in known if role[0] == "r"}
