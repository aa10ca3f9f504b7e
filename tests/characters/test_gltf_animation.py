"""Clips of glTF files."""

from pathlib import Path

import numpy as np
import pytest
from gltf_files import FLOAT_BOUND, HALF_TURN, animate, body, read
from scipy.spatial.transform import Rotation

from mua.characters.gltf.keys import KeyTrack
from mua.characters.node_tree import compose
from mua.motion.read import read_motion
from mua.pose.joint_names import limb_count


def test_clip_turns_and_moves_the_joints(tmp_path: Path) -> None:
    glb = body()
    animate(glb, 1, "rotation", times=[0.0, 1.0], values=HALF_TURN)
    animate(glb, 0, "translation", times=[0.0, 1.0], values=[[0, 0, 0], [3, 0, 0]])
    (clip,) = read(glb, tmp_path).clips
    assert (clip.name, clip.rate, len(clip)) == ("wave", 30.0, 31)
    np.testing.assert_allclose(clip.translations[15, 0], [1.5, 0, 0], atol=FLOAT_BOUND)
    np.testing.assert_allclose(clip.rotations[15, 1], [np.sqrt(0.5), 0, 0, np.sqrt(0.5)], atol=1e-7)
    np.testing.assert_allclose(clip.rotations[:, 2], np.tile([1, 0, 0, 0], (31, 1)), atol=1e-7)


def test_a_transform_scales_first_then_turns_then_moves() -> None:
    turn = Rotation.from_euler("xyz", [20, 50, -70], degrees=True)
    found = compose(np.array([1.0, 2, 3]), turn.as_quat(), np.array([2.0, 3, 0.5]))
    np.testing.assert_allclose(found[:3, :3], turn.as_matrix() @ np.diag([2, 3, 0.5]), atol=1e-12)
    np.testing.assert_array_equal(found[:, 3], [1, 2, 3, 1])


@pytest.mark.parametrize("start", [0.0, 2.0])
def test_a_clip_begins_with_its_first_key_and_ends_with_its_last(tmp_path: Path, start: float) -> None:
    """This holds where rounding to float32 puts the last key just before a frame's time."""
    glb = body()
    animate(glb, 1, "rotation", times=[start, start + 0.7], values=HALF_TURN)
    (clip,) = read(glb, tmp_path).clips
    turned = Rotation.from_quat(clip.rotations[[0, 10, -1], 1], scalar_first=True).magnitude()
    np.testing.assert_allclose(turned, np.pi * np.array([0, 10 / 21, 1]), atol=1e-6)
    assert len(clip) == 22


def test_a_joint_that_turns_keeps_the_scale_of_its_node(tmp_path: Path) -> None:
    glb = body()
    glb.json["nodes"][2]["scale"] = [2, 2, 2]
    animate(glb, 2, "rotation", times=[0.0, 1.0], values=HALF_TURN)
    (clip,) = read(glb, tmp_path).clips
    assert clip.stretches is None


def test_clip_of_no_length_is_dropped_with_a_note(tmp_path: Path) -> None:
    glb = body()
    animate(glb, 1, "rotation", times=[0.0], values=HALF_TURN[:1], name="pose")
    surfaces = read(glb, tmp_path)
    assert not surfaces.clips
    assert surfaces.notes == ("Clips of a single pose are left out: pose.",)


def test_motion_above_the_skeleton_moves_its_root(tmp_path: Path) -> None:
    glb = body()
    glb.json["nodes"].append({"name": "armature", "children": [0]})
    glb.json["scenes"][0]["nodes"] = [3, 4]
    animate(glb, 4, "translation", times=[0.0, 1.0], values=[[0, 0, 0], [0, 0, 2]])
    animate(glb, 0, "translation", times=[0.0, 1.0], values=[[0, 0, 0], [1, 0, 0]])
    surfaces = read(glb, tmp_path)
    positions = surfaces.skeleton.world(surfaces.clips[0].rotations, surfaces.clips[0].translations)[1]
    hips = surfaces.skeleton.names.index("hips")
    np.testing.assert_allclose(positions[-1, hips], [1, 0, 2], atol=FLOAT_BOUND)
    assert surfaces.skeleton.root == hips


def test_every_joint_moves_as_its_source(tmp_path: Path) -> None:
    glb = body()
    animate(glb, 0, "translation", times=[0.0, 1.0], values=[[0, 0, 0], [1, 0, 0]])
    animate(glb, 1, "rotation", times=[0.0, 1.0], values=HALF_TURN)
    animate(glb, 2, "translation", times=[0.0, 1.0], values=[[0, 0.5, 0], [0.25, 0.75, 0]])
    surfaces = read(glb, tmp_path)
    (clip,) = surfaces.clips
    np.testing.assert_allclose(clip.translations[15, 2], [0.125, 0.625, 0], atol=FLOAT_BOUND)
    np.testing.assert_array_equal(clip.translations[:, 1], np.tile(surfaces.skeleton.bind_translations[1], (31, 1)))
    positions = surfaces.skeleton.world(clip.rotations, clip.translations)[1]
    np.testing.assert_allclose(positions[-1, 2], [1 - 0.25, 0.5 - 0.75, 0], atol=1e-6)  # half a turn about Z
    assert surfaces.notes == ()


def test_a_shift_too_small_to_see_is_not_kept(tmp_path: Path) -> None:
    glb = body()
    animate(glb, 2, "translation", times=[0.0, 1.0], values=[[0, 0.5, 0], [0.00005, 0.5, 0]])
    surfaces = read(glb, tmp_path)
    (clip,) = surfaces.clips
    np.testing.assert_array_equal(clip.translations, np.tile(surfaces.skeleton.bind_translations, (31, 1, 1)))


def test_scales_are_kept_for_the_mesh_with_a_note(tmp_path: Path) -> None:
    glb = body()
    animate(glb, 0, "translation", times=[0.0, 1.0], values=[[0, 0, 0], [1, 0, 0]])
    animate(glb, 2, "translation", times=[0.0, 1.0], values=[[0, 0.5, 0], [0, 0.51, 0]])
    animate(glb, 2, "scale", times=[0.0, 1.0], values=[[1, 1, 1], [1.5, 1, 1]])
    surfaces = read(glb, tmp_path)
    (clip,) = surfaces.clips
    assert clip.stretches is not None
    assert clip.stretches.joints.tolist() == [2]
    np.testing.assert_allclose(clip.stretches.matrices[-1, 0], np.diag([1.5, 1, 1]), atol=1e-6)
    (note,) = surfaces.notes
    assert note.startswith("Animated scales go into the mesh")
    assert note.endswith("the largest is 50 %, of head in clip wave.")


def test_motion_of_a_file_that_shows_a_face_alone_has_all_limbs(tmp_path: Path) -> None:
    """Exports of motion may keep one mesh of many: its skin knows the head, the clip moves the whole body."""
    glb = body()
    limbs = ["LeftArm", "LeftForeArm", "RightArm", "RightForeArm", "LeftUpLeg", "LeftLeg", "RightUpLeg", "RightLeg"]
    first = len(glb.json["nodes"])
    for i, name in enumerate(limbs):
        node = {"name": name, "translation": [0.2 if "Left" in name else -0.2, 0.1, 0]}
        glb.json["nodes"].append(node | ({} if i % 2 else {"children": [first + i + 1]}))
    glb.json["nodes"][0]["children"] += list(range(first, first + len(limbs), 2))
    for node in (0, *range(first, first + len(limbs))):
        animate(glb, node, "rotation", times=[0.0, 1.0], values=HALF_TURN)
    (source,) = read_motion(glb.save(tmp_path / "face.glb"))
    assert set(limbs) <= set(source.skeleton.names)
    assert limb_count(source.skeleton) == 8
    turned, _ = source.skeleton.world(source.clip.rotations, source.clip.translations)
    arm = source.skeleton.names.index("LeftForeArm")
    # after half a second hips, arm and forearm have each turned by 90 degrees about Z
    np.testing.assert_allclose(np.abs(turned[15, arm] @ [np.cos(0.75 * np.pi), 0, 0, np.sin(0.75 * np.pi)]), 1)


def test_step_holds_keys_of_one_time_jump_and_cubic_passes_its_keys() -> None:
    times, keys = np.array([0.0, 1.0, 3.0]), np.array([[0.0], [1.0], [5.0]])
    at = np.array([-1, 0, 0.99, 1, 2.5, 3, 9])
    np.testing.assert_array_equal(KeyTrack(times, keys, "STEP").at(at)[:, 0], [0, 0, 0, 1, 1, 5, 5])
    jump = KeyTrack(np.array([0.0, 1.0, 1.0, 2.0, 2.0]), np.array([[0.0], [1.0], [5.0], [6.0], [9.0]]), "LINEAR")
    np.testing.assert_array_equal(jump.at(np.array([0.5, 1, 1.5, 2, 3]))[:, 0], [0.5, 5, 5.5, 9, 9])
    slopes = np.gradient(times**2, times, edge_order=2)  # a parabola, which cubic segments hold exactly
    cubic = np.stack([slopes, times**2, slopes], axis=1).reshape(-1, 1)
    inside = np.linspace(0, 3, 13)
    values = KeyTrack(times, cubic, "CUBICSPLINE").at(inside)[:, 0]
    np.testing.assert_allclose(values, inside**2, atol=1e-12)
