"""Skins that are bound apart from each other, and what the rest pose then decides."""

from pathlib import Path

import numpy as np
from gltf_files import BONES, FLOAT_BOUND, POINTS, TRIANGLES, Glb, animate, body, posed, read, weighted

TURN = np.array([[0, 0, 1, 0], [1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 0, 1]], float)  # x to y to z to x


def bound_elsewhere(glb: Glb, joints: list[int], moved: list[np.ndarray]) -> dict:
    """A skin on `joints` whose mesh was bound where each is moved by a matrix of its own from its place at rest."""
    binds = []
    for joint, matrix in zip(joints, moved, strict=True):
        rest = np.eye(4)
        rest[1, 3] = 0.5 * joint
        binds.append(np.linalg.inv(rest @ matrix))
    return {"joints": joints, "inverseBindMatrices": glb.accessor(np.swapaxes(binds, 1, 2))}


def shifted(*offset: float) -> np.ndarray:
    matrix = np.eye(4)
    matrix[:3, 3] = offset
    return matrix


def glove(glb: Glb, joints: list[int], moved: list[np.ndarray]) -> None:
    """A triangle shared by two joints, on a skin of its own."""
    skin = len(glb.json["skins"])
    glb.json["skins"].append(bound_elsewhere(glb, joints, moved))
    attributes = {
        "POSITION": glb.accessor([[0, 0, 0], [0.1, 0, 0], [0, 0.1, 0]]),
        "JOINTS_0": glb.accessor([[0, 1, 0, 0]] * 3, "u1"),
        "WEIGHTS_0": glb.accessor([[0.5, 0.5, 0, 0]] * 3),
    }
    glb.json["meshes"].append({"name": f"glove{skin}", "primitives": [{"attributes": attributes}]})
    glb.json["nodes"].append({"mesh": len(glb.json["meshes"]) - 1, "skin": skin})
    glb.json["scenes"][0]["nodes"].append(len(glb.json["nodes"]) - 1)


def test_body_of_rigid_parts_stays_where_the_rest_pose_has_it(tmp_path: Path) -> None:
    """Two small skins, bound in another pose than the rest pose, say nothing of where the rigid body stands."""
    glb = body()
    glb.json["skins"] = []
    glb.json["nodes"] = glb.json["nodes"][:3]
    glb.json["nodes"].append({"name": "armour", "mesh": 0})
    glb.json["nodes"][0]["children"] = [1, 3]
    glb.json["scenes"] = [{"nodes": [0]}]
    glove(glb, [0, 1], [TURN, shifted(0.3, 0, 0) @ TURN])
    glove(glb, [1, 2], [TURN.T, shifted(0, 0, 0.4)])
    surfaces = read(glb, tmp_path)
    low, high = POINTS.min(axis=0), POINTS.max(axis=0)
    armour = surfaces.vertices[(np.abs(surfaces.vertices - np.clip(surfaces.vertices, low, high)) < 1e-6).all(axis=1)]
    np.testing.assert_allclose(np.ptp(armour, axis=0), np.ptp(POINTS, axis=0), atol=FLOAT_BOUND)
    places = surfaces.skeleton.world(surfaces.skeleton.bind_rotations, surfaces.skeleton.bind_translations)[1]
    np.testing.assert_allclose(places, np.array([[0, 0, 0], [0, 0.5, 0], [0, 1, 0]]), atol=FLOAT_BOUND)
    bind = surfaces.skeleton.bind_pose
    np.testing.assert_allclose(posed(surfaces, bind.rotations, bind.translations), surfaces.vertices, atol=1e-7)


def test_second_skin_of_one_joint_follows_the_body_into_its_bind_pose(tmp_path: Path) -> None:
    """An eye on a joint of its own, bound at rest, stands at the head also where the body was bound otherwise."""
    glb = body()
    for node in (1, 2):  # spine and head bend after binding, so that no two joints agree on where the mesh is
        glb.json["nodes"][node]["rotation"] = [0, 0, np.sqrt(0.5), np.sqrt(0.5)]
    crown = np.arange(16) // 4 == 3
    joints = np.zeros((16, 4), int)
    joints[:, 0] = np.where(crown, 0, np.arange(16) // 4)  # nor does one of them hold half of it
    glb.json["meshes"][0]["primitives"][0]["attributes"]["JOINTS_0"] = glb.accessor(joints, "u1")
    glb.json["nodes"].append({"name": "eye", "translation": [0, 0.3, 0]})
    glb.json["nodes"][2]["children"] = [4]
    eye = glb.accessor([[0, 0, 0], [0.1, 0, 0], [0, 0.1, 0]])
    ones = {"JOINTS_0": glb.accessor([[0] * 4] * 3, "u1"), "WEIGHTS_0": glb.accessor([[1, 0, 0, 0]] * 3)}
    glb.json["meshes"].append({"name": "eye", "primitives": [{"attributes": {"POSITION": eye} | ones}]})
    glb.json["skins"].append({"joints": [4], "inverseBindMatrices": glb.accessor([np.eye(4).reshape(-1)])})
    glb.json["nodes"].append({"mesh": 1, "skin": 1})
    glb.json["scenes"][0]["nodes"].append(5)
    surfaces = read(glb, tmp_path)
    worn = surfaces.skin_indices[:, 0] == surfaces.skeleton.names.index("eye")
    head = surfaces.skeleton.world(surfaces.skeleton.bind_rotations, surfaces.skeleton.bind_translations)[1][
        surfaces.skeleton.names.index("head")
    ]
    np.testing.assert_allclose(surfaces.vertices[worn][0], head + np.array([0, 0.3, 0]), atol=FLOAT_BOUND)


def test_meshes_bound_together_are_placed_together(tmp_path: Path) -> None:
    """Each ring is a mesh with a skin of its own that lists all joints; at rest spine and head bend."""
    glb = body()
    (whole,) = glb.json["meshes"][0]["primitives"]
    glb.json["meshes"] = []
    triangles = TRIANGLES.reshape(-1, 3)
    for bone in range(3):
        own = triangles[(BONES[triangles] == bone).any(axis=1)]
        joints = glb.accessor(weighted(np.full(len(POINTS), bone))[0], "u1")
        attributes = whole["attributes"] | {"JOINTS_0": joints}
        primitives = [{"attributes": attributes, "indices": glb.accessor(own.reshape(-1), "u2")}]
        glb.json["meshes"].append({"name": f"ring{bone}", "primitives": primitives})
    glb.json["skins"] = [dict(glb.json["skins"][0]) for _ in range(3)]
    glb.json["nodes"] = glb.json["nodes"][:3] + [{"mesh": bone, "skin": bone} for bone in range(3)]
    glb.json["scenes"] = [{"nodes": [0, 3, 4, 5]}]
    for node in (1, 2):
        glb.json["nodes"][node]["rotation"] = [0, 0, np.sqrt(0.5), np.sqrt(0.5)]
    surfaces = read(glb, tmp_path)
    assert len(np.unique(np.round(surfaces.vertices, 4), axis=0)) == len(POINTS)  # the rings still meet


def test_head_that_clips_do_not_turn_backwards_is_not_bound_so(tmp_path: Path) -> None:
    """Rigid parts bind as the file stands, unless a joint is turned about there as most clips do not begin."""
    for turned, bound in ((170, 0), (60, 60)):
        glb = body()
        glb.json["skins"] = []
        glb.json["nodes"] = [*glb.json["nodes"][:3], {"name": "nose", "mesh": 0, "translation": [0, 0.1, 0]}]
        glb.json["meshes"][0]["primitives"][0]["attributes"]["POSITION"] = glb.accessor(POINTS * 0.2)
        glb.json["nodes"][2]["children"] = [3]
        glb.json["scenes"] = [{"nodes": [0]}]
        half = np.radians(turned) / 2
        glb.json["nodes"][2]["rotation"] = [0, 0, np.sin(half), np.cos(half)]
        for name, start in (("idle", 0.0), ("walk", 0.05), ("spin", half)):
            keys = [[0, 0, np.sin(angle), np.cos(angle)] for angle in (start, start + 0.2)]
            animate(glb, 2, "rotation", times=[0.0, 1.0], values=keys, name=name)
        surfaces = read(glb, tmp_path)
        nose = surfaces.vertices.mean(axis=0)[1] - 1
        assert abs(nose - 0.25 * np.cos(np.radians(bound))) < 0.01  # spin begins at rest, walk a little off
