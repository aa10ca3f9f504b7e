"""Whole characters from glTF: joints, what hangs on them, and what is refused."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import trimesh
from gltf_files import (
    BONES,
    FLOAT_BOUND,
    HALF_TURN,
    POINTS,
    Glb,
    accessor_of,
    animate,
    assert_is_column,
    body,
    posed,
    primitive,
    read,
    weighted,
)
from scipy.spatial import cKDTree

from mua.characters.read import read_surfaces
from mua.errors import InputError


def test_mesh_on_a_joint_follows_it_rigidly(tmp_path: Path) -> None:
    glb = body()
    hat = {"attributes": {"POSITION": glb.accessor([[0, 0, 0], [0.1, 0, 0], [0, 0.1, 0]])}}
    glb.json["meshes"].append({"name": "hat", "primitives": [hat]})
    glb.json["nodes"].append({"mesh": 1, "translation": [0, 0.6, 0]})
    glb.json["nodes"][2]["children"] = [4]
    surfaces = read(glb, tmp_path)
    (hat_face,) = np.flatnonzero((surfaces.uv_faces == -1).all(axis=1))
    worn = surfaces.vertices[surfaces.faces[hat_face]]
    np.testing.assert_allclose(worn, [[0, 1.6, 0], [0.1, 1.6, 0], [0, 1.7, 0]], atol=FLOAT_BOUND)
    assert (surfaces.skin_indices[surfaces.faces[hat_face], 0] == 2).all()
    assert surfaces.notes == ("Meshes that are attached rigidly to a joint (--leave-out NAME leaves one out): node4.",)


def test_mesh_on_no_joint_is_left_out_with_a_note(tmp_path: Path) -> None:
    glb = body()
    glb.json["nodes"].append({"mesh": 0, "name": "ground"})
    glb.json["scenes"][0]["nodes"].append(4)
    surfaces = read(glb, tmp_path)
    assert_is_column(surfaces)
    assert surfaces.notes == ("Meshes that no joint moves are left out: ground.",)


def test_weights_below_zero_names_that_no_file_takes_and_empty_primitives_are_read(tmp_path: Path) -> None:
    _, weights = weighted(BONES)
    glb = body(WEIGHTS_0=None)
    put("WEIGHTS_0", weights - [0, 1e-5, 0, 0])(glb)
    glb.json["nodes"][1]["name"] = "spine \ud83d"  # half of an emoji
    empty = glb.accessor(np.zeros((1, 1)), "u2", count=0)
    glb.json["meshes"][0]["primitives"].append(primitive(glb) | {"indices": empty})
    surfaces = read(glb, tmp_path)
    assert_is_column(surfaces)
    assert surfaces.skeleton.names == ("hips", "spine ?", "head")


def test_positions_equal_those_of_a_second_reader(shared_data: Any) -> None:
    path = shared_data.path("characters/Fox.glb")
    scene = trimesh.load_scene(path, process=False)
    theirs = scene.to_mesh().vertices * 0.01
    ours = read_surfaces(path).vertices
    for here, there in ((ours, theirs), (theirs, ours)):
        assert cKDTree(here).query(there)[0].max() < FLOAT_BOUND


def test_woman_stands_in_metres_and_faces_forward(shared_data: Any) -> None:
    surfaces = read_surfaces(shared_data.path("characters/White_F_3_Casual.glb"))
    assert len(surfaces.skeleton.names) == 84
    assert surfaces.skeleton.names[surfaces.skeleton.root] == "Hips"
    low, high = surfaces.vertices.min(axis=0), surfaces.vertices.max(axis=0)
    assert abs(low[1]) < 0.01
    assert 1.5 < high[1] < 1.8
    assert 1.5 < high[0] - low[0] < 1.8  # arms spread
    places = dict(zip(surfaces.skeleton.names, surfaces.skeleton.world(
        surfaces.skeleton.bind_rotations, surfaces.skeleton.bind_pose.translations)[1], strict=True))  # fmt: skip
    assert places["LeftHand"][0] > 0.5 > -0.5 > places["RightHand"][0]
    assert places["LeftToeBase"][2] > places["LeftFoot"][2] + 0.05
    assert [m.name for m in surfaces.materials] == ["_Body", "Hair"]
    bind = surfaces.skeleton.bind_pose
    np.testing.assert_allclose(posed(surfaces, bind.rotations, bind.translations), surfaces.vertices, atol=1e-6)


def test_lumberjack_stands_upright_and_keeps_its_clips(shared_data: Any) -> None:
    surfaces = read_surfaces(shared_data.path("characters/lumberjack.glb"))
    assert abs(surfaces.vertices[:, 1].min()) < 0.01
    assert surfaces.vertices[:, 1].max() == pytest.approx(1.7026, abs=1e-3)  # 170.26 centimetres in the file
    assert [(clip.name, len(clip)) for clip in surfaces.clips] == [("Walk", 31), ("Poses", 188)]
    assert surfaces.notes[0] == "Clips of a single pose are left out: A-pose."
    skeleton = surfaces.skeleton
    assert len(skeleton.names) == 33  # the other 20 carry no weights and have no bind pose
    assert skeleton.names[skeleton.root] == "DEF-spine_02"
    parents = {n: skeleton.names[p] for n, p in zip(skeleton.names, skeleton.parents, strict=True) if p >= 0}
    assert parents["DEF-thigh.L_023"] == parents["DEF-thigh.R_015"] == "DEF-spine_02"
    assert parents["DEF-upper_arm.L_045"] == "DEF-spine.003_05"
    clip = surfaces.clips[0]
    feet = min(posed(surfaces, r, t)[:, 1].min() for r, t in zip(clip.rotations, clip.translations, strict=True))
    assert abs(feet) < 0.03


def test_fox_is_brought_to_metres(shared_data: Any) -> None:
    surfaces = read_surfaces(shared_data.path("characters/Fox.glb"))
    assert np.ptp(surfaces.vertices, axis=0) == pytest.approx([0.2519, 0.7903, 1.5472], abs=1e-3)
    assert [(clip.name, len(clip)) for clip in surfaces.clips] == [("Survey", 103), ("Walk", 22), ("Run", 35)]
    assert "one unit is taken as 0.01 m" in surfaces.notes[0]


def put(name: str, values: Any, dtype: str = "f4") -> Callable[[Glb], None]:
    return lambda glb: primitive(glb)["attributes"].__setitem__(name, glb.accessor(values, dtype))


NAN = np.where(np.arange(len(POINTS))[:, None] == 5, np.nan, POINTS)
BROKEN: dict[str, tuple[Callable[[Glb], Any], str]] = {
    "unknown extension": (
        lambda g: g.json.update(extensionsRequired=["EXT_mesh_gpu_instancing"]),
        "is not supported; export it with its instances",
    ),
    "old version": (lambda g: g.json.update(asset={"version": "1.0"}), r"asset\.version is 1\.0"),
    "accessor outside": (lambda g: accessor_of(g, "POSITION").update(count=999), "accessors.*reaches to byte"),
    "accessor missing": (lambda g: primitive(g)["attributes"].update(POSITION=99), r"attributes\.POSITION is 99"),
    "accessor type": (lambda g: accessor_of(g, "TEXCOORD_0").update(type="SCALAR"), r"type is SCALAR, expected VEC2"),
    "component type": (lambda g: accessor_of(g, "POSITION").update(componentType=7), "componentType is 7"),
    "no count": (lambda g: accessor_of(g, "POSITION").update(count=0), "count is 0"),
    "view outside": (lambda g: g.json["bufferViews"][0].update(byteLength=10**6), r"bufferViews\[0\] spans"),
    "buffer missing": (lambda g: g.json["bufferViews"][0].update(buffer=3), r"bufferViews\[0\]\.buffer is 3"),
    "not finite": (put("POSITION", NAN), r"nan.* at element 5"),
    "index outside": (lambda g: primitive(g).update(indices=g.accessor([0, 1, 99], "u1")), "indices holds 99"),
    "no position": (lambda g: primitive(g)["attributes"].pop("POSITION"), "no POSITION"),
    "fewer weights": (put("WEIGHTS_0", [[1, 0, 0, 0]]), "WEIGHTS_0 holds 1 elements for 16"),
    "no weights": (lambda g: primitive(g)["attributes"].pop("WEIGHTS_0"), "lacks JOINTS_0 with WEIGHTS_0"),
    "missing joint": (put("JOINTS_0", np.full((16, 4), 7), "u1"), "holds 7, but the skin has 3 joints"),
    "negative weight": (put("WEIGHTS_0", np.full((16, 4), -0.5)), "no negative weight"),
    "joint node": (lambda g: g.json["skins"][0].update(joints=[0, 1, 20]), r"skins\[0\]\.joints is 20"),
    "few binds": (lambda g: g.json["skins"][0].update(joints=[0, 1, 2, 3]), "holds 3 matrices for 4 joints"),
    "singular bind": (
        lambda g: g.json["skins"][0].update(inverseBindMatrices=g.accessor(np.zeros((3, 16)))),
        "cannot be inverted",
    ),
    "no skin": (lambda g: [g.json["nodes"][3].pop("skin"), g.json.pop("skins")], "no skinned mesh"),
    "skin missing": (lambda g: g.json["nodes"][3].update(skin=4), r"nodes\[3\]\.skin is 4"),
    "mesh missing": (lambda g: g.json["nodes"][3].update(mesh=4), r"nodes\[3\]\.mesh is 4"),
    "material missing": (lambda g: primitive(g).update(material=4), r"material is 4"),
    "node cycle": (lambda g: g.json["nodes"][2].update(children=[0]), "its own ancestor"),
    "two parents": (lambda g: g.json["nodes"][0].update(children=[1, 2]), "child of both"),
    "bad matrix": (lambda g: g.json["nodes"][0].update(matrix=[1, 2]), r"nodes\[0\]\.matrix"),
    "bad sampler": (
        lambda g: animate(g, 1, "rotation", times=[0.0, 1.0], values=HALF_TURN[:1]),
        "holds 1 elements, expected 2",
    ),
    "times fall": (lambda g: animate(g, 1, "rotation", times=[1.0, 0.0], values=HALF_TURN), "decrease"),
    "years": (
        lambda g: animate(g, 1, "rotation", times=[0.0, 1e9], values=HALF_TURN),
        r"animations\[0\] lasts 1e\+09 s, which makes 3e\+10 frames of 3 nodes, expected at most",
    ),
    "wrong kind": (lambda g: g.json.update(nodes=7), "nodes is 7, expected an array"),
}


@pytest.mark.parametrize("name", BROKEN)
def test_broken_file_ends_in_one_sentence(tmp_path: Path, name: str) -> None:
    glb = body()
    breaks, sentence = BROKEN[name]
    breaks(glb)
    with pytest.raises(InputError, match=sentence) as raised:
        read(glb, tmp_path)
    assert str(raised.value).startswith(str(tmp_path / "body.glb"))


def test_unknown_suffix_and_missing_file_are_named(tmp_path: Path) -> None:
    with pytest.raises(InputError, match=r"suffix is \.pov, expected one of \.glb"):
        read_surfaces(tmp_path / "body.pov")
    with pytest.raises(InputError, match="no such file"):
        read_surfaces(tmp_path / "body.glb")
