"""Motion files that a page loads, on an avatar's joints: as the package retargets them, and what is wrong with them."""

import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from animated_gltf import HUMANOID, animated, vrma, with_expressions, with_track
from named_figures import written_names
from people import hung_on_the_spine, lying, moving, on_thick_soles, person, walk
from scipy.spatial.transform import Rotation
from shared_data import SharedData
from web.test_modules import node, pytestmark  # noqa: F401  needs Node

from mua import rotation
from mua.characters.read import read_animation, read_surfaces
from mua.motion.face import own_face
from mua.motion.load import load_motions
from mua.motion.match import match_joints
from mua.motion.read import read_motion
from mua.motion.retarget import retarget
from mua.motion.source_motion import SourceMotion
from mua.pose.clip import Clip
from mua.pose.joint_names import roles
from mua.pose.signed_expressions import UNIT
from mua.pose.skeleton import Skeleton

RATE = 30.0
FLOAT = 2.0**-24  # relative rounding of the float32 that a page's clip holds
ANGLE = 4 * FLOAT  # of quaternions' components
FARTHEST = 16.0  # metres that a clip goes, at most
ROOM = FARTHEST * FLOAT


def skeleton_file(folder: Path, skeleton: Skeleton) -> Path:
    path = folder / "skeleton.json"
    path.write_text(
        json.dumps(
            {
                "names": skeleton.names,
                "parents": skeleton.parents.tolist(),
                "root": skeleton.root,
                "rotations": skeleton.bind_rotations.tolist(),
                "translations": skeleton.bind_translations.tolist(),
            }
        )
    )
    return path


def browser_clip(folder: Path, skeleton: Skeleton, motion: Path, **options: Any) -> dict[str, Any]:
    """What the browser makes of a motion file: its answer, with arrays by frame and joint."""
    [found] = node("retarget", skeleton_file(folder, skeleton), motion, json.dumps(options))
    if "message" not in found:
        for name, width in (("rotations", 4), ("translations", 3)):
            found[name] = np.array(found[name]).reshape(found["frames"], -1, width)
    return dict(found)


def assert_same(found: dict[str, Any], clip: Clip) -> None:
    """The browser's clip is the package's, from the first frame to the last, of every joint."""
    assert "message" not in found, found
    assert len(found["rotations"]) == len(clip)
    apart = np.abs(np.abs(np.sum(found["rotations"] * clip.rotations, axis=-1)) - 1)
    np.testing.assert_array_less(apart, ANGLE)
    np.testing.assert_array_less(np.abs(found["translations"] - clip.translations), ROOM)


@pytest.fixture(scope="module")
def lumberjack() -> Skeleton:
    return read_animation(SharedData().path("characters/lumberjack.glb")).skeleton


@pytest.fixture(scope="module")
def woman() -> Skeleton:
    return read_surfaces(SharedData().path("characters/White_F_3_Casual.glb")).skeleton


@pytest.mark.parametrize("motion", ["dab", "jumping", "cmu/01_01", "cmu/02_01", "cmu/02_03"])
@pytest.mark.parametrize("character", ["lumberjack", "woman"])
def test_real_motion_is_retargeted_as_the_package_does(
    tmp_path: Path, request: pytest.FixtureRequest, character: str, motion: str
) -> None:
    skeleton: Skeleton = request.getfixturevalue(character)
    path = SharedData().path(f"motion/{motion}.bvh")
    [loaded] = load_motions(path, skeleton, mapping=None, rate=RATE, feet="keep")
    found = browser_clip(tmp_path, skeleton, path)
    assert_same(found, loaded.clip)
    assert found["name"] == path.stem
    assert set(found["notes"]) <= {*loaded.notes, *(note.removeprefix(f"{path.name}: ") for note in loaded.notes)}


@pytest.mark.parametrize("suffix", ["glb", "vrma"])
def test_animations_of_gltf_and_vrma_are_retargeted_as_the_package_does(tmp_path: Path, suffix: str) -> None:
    source, target = person(size=1.3), person(arms_down=50, legs_apart=8, size=0.7, axes=3)
    target = on_thick_soles(target) if suffix == "vrma" else target
    made = vrma(source, moving(source)) if suffix == "vrma" else animated(lying(source), moving(source))
    path = made.save(tmp_path / f"moves.{suffix}")
    [loaded] = load_motions(path, target, mapping=None, rate=RATE, feet="keep")
    found = browser_clip(tmp_path, target, path)
    assert_same(found, loaded.clip)
    turned, _ = target.world(found["rotations"], found["translations"])
    raised = [
        rotation.rotate(turned[:, target.names.index(f"{side}Arm")], np.array([0, 0, 1.0]))
        for side in ("Left", "Right")
    ]
    assert all(np.abs(way[0] - way[-1]).max() > 0.1 for way in raised)


def test_motion_on_the_same_skeleton_is_taken_as_it_stands(tmp_path: Path, lumberjack: Skeleton) -> None:
    clip = read_motion(SharedData().path("characters/lumberjack.glb"))[0].clip
    path = animated(lumberjack, clip).save(tmp_path / "own.glb")
    found = browser_clip(tmp_path, lumberjack, path)
    apart = np.abs(np.abs(np.sum(found["rotations"] * clip.rotations, axis=-1)) - 1)
    np.testing.assert_array_less(apart, 2 * ANGLE)  # the file's float32 too


def test_what_stands_in_no_known_way_is_refused_in_a_sentence(tmp_path: Path, woman: Skeleton) -> None:
    found = browser_clip(tmp_path, woman, SharedData().path("characters/lumberjack.glb"))
    assert found["message"].startswith("lumberjack.glb: its rest pose shows no body that stands")


@pytest.mark.parametrize("rate", [24.0, 60.0])
def test_a_clip_has_the_rate_of_the_avatar(tmp_path: Path, rate: float) -> None:
    skeleton = person(axes=3)
    path = animated(person(), moving(person())).save(tmp_path / "moves.glb")
    [loaded] = load_motions(path, skeleton, mapping=None, rate=rate, feet="keep")
    assert_same(browser_clip(tmp_path, skeleton, path, rate=rate), loaded.clip)


def test_a_body_whose_hips_hang_on_its_spine_goes_as_a_whole(tmp_path: Path) -> None:
    source, target = person(size=1.2), hung_on_the_spine(person(size=0.8))
    path = animated(source, walk(source)).save(tmp_path / "walk.glb")
    [loaded] = load_motions(path, target, mapping=None, rate=RATE, feet="keep")
    assert_same(browser_clip(tmp_path, target, path), loaded.clip)


def test_a_pose_before_the_motion_is_left_out(tmp_path: Path) -> None:
    source, target = person(size=1.2), person(arms_down=45, size=0.8)
    clip = walk(source)
    rest = (source.bind_rotations, source.bind_translations - np.eye(len(source.names))[:, :1])
    begun = (np.concatenate([one[None], of]) for one, of in zip(rest, (clip.rotations, clip.translations), strict=True))
    path = animated(source, Clip("walk", clip.rate, *begun)).save(tmp_path / "begun.glb")
    [loaded] = load_motions(path, target, mapping=None, rate=RATE, feet="keep")
    found = browser_clip(tmp_path, target, path)
    assert len(found["rotations"]) == len(clip)
    assert "The first frame, a pose apart from the motion, is left out." in found["notes"]
    assert_same(found, loaded.clip)


def test_a_mapping_names_what_names_do_not_tell(tmp_path: Path) -> None:
    source, target = person(), person(arms_down=40)
    odd = {name: f"n{joint}" for joint, name in enumerate(source.names)}
    path = animated(source, moving(source), odd).save(tmp_path / "odd.glb")
    mapping = {name: odd[name] for name in HUMANOID}
    [loaded] = load_motions(path, target, mapping=mapping, rate=RATE, feet="keep")
    assert_same(browser_clip(tmp_path, target, path, mapping=mapping), loaded.clip)
    assert "known to move the avatar's left arm" in browser_clip(tmp_path, target, path)["message"]
    wrong = browser_clip(tmp_path, target, path, mapping={"Hips": "hips"})["message"]
    assert wrong.startswith('odd.glb: mapping: the motion has no joint "hips", only n0, n1')


def test_expressions_move_the_nearest_of_the_avatar_and_others_are_counted(tmp_path: Path) -> None:
    clip = moving(person())
    made, blink = vrma(person(), clip), np.linspace(0, 1, len(clip))
    with_expressions(made, blink=blink, happy=1 - blink, aa=0 * blink)
    path = made.save(tmp_path / "face.vrma")
    names = ["smile", "happy", "eyeBlinkLeft", "eyeBlinkRight"]
    found = browser_clip(tmp_path, person(size=0.8), path, expressions=names)
    weights = np.array(found["expressions"]).reshape(-1, 4)
    np.testing.assert_allclose(weights, np.stack([0 * blink, 1 - blink, blink, blink], axis=1), atol=4 * FLOAT)
    assert "1 of the motion's 3 expressions move none of the avatar's." in found["notes"]
    [read] = read_motion(path)
    loaded = own_face(read, clip, tuple(names)).expressions
    np.testing.assert_allclose(weights, np.asarray(loaded), atol=4 * FLOAT)


def test_shape_keys_of_smplx_move_either_of_a_pair(tmp_path: Path) -> None:
    clip = moving(person())
    made, values = animated(person(), clip), np.linspace(-1.5, 1.5, len(clip)) * [[UNIT], [1]]
    made.json["meshes"] = [{"primitives": [], "extras": {"targetNames": ["Exp003", "jawOpen"]}}]
    with_track(made, "weights", values.T.reshape(-1, 1), name="face", mesh=0)
    path, names = made.save(tmp_path / "keys.glb"), ["Exp003+", "Exp003-", "jawOpen"]
    found = np.array(browser_clip(tmp_path, person(size=0.8), path, expressions=names)["expressions"]).reshape(-1, 3)
    expected = np.clip(values / [[UNIT], [1]], 0, 1)
    np.testing.assert_allclose(found, np.stack([expected[0], expected[0, ::-1], expected[1]], axis=1), atol=8 * FLOAT)


def test_the_gaze_of_a_vrm_animation_moves_what_the_package_moves_by_it(tmp_path: Path) -> None:
    clip = moving(person())
    made, count = vrma(person(), clip), len(clip)
    turns = np.concatenate(
        [
            Rotation.from_euler("y", np.linspace(-60, 60, count // 2)[:, None], degrees=True).as_quat(),
            Rotation.from_euler("x", np.linspace(30, -30, count - count // 2)[:, None], degrees=True).as_quat(),
        ]
    )
    gaze = with_track(made, "rotation", turns, name="gaze")
    made.json["extensions"]["VRMC_vrm_animation"]["lookAt"] = {"node": gaze}
    path, names = made.save(tmp_path / "gaze.vrma"), ["lookUp", "eyeLookOutLeft", "eyeLookInLeft", "jawOpen"]
    found = browser_clip(tmp_path, person(size=0.8), path, expressions=names)
    weights = np.array(found["expressions"]).reshape(-1, 4)
    [read] = read_motion(path)
    np.testing.assert_allclose(weights, np.asarray(own_face(read, clip, names).expressions), atol=8 * FLOAT)
    assert (weights[:, :3].max(axis=0) > 0.3).all()


def test_weights_of_a_mesh_are_expressions_of_their_names(tmp_path: Path) -> None:
    clip = moving(person())
    made, open_jaw = animated(person(), clip), np.linspace(0, 1, len(clip))
    made.json["meshes"] = [{"primitives": [], "extras": {"targetNames": ["jawOpen", "tongueOut"]}}]
    with_track(made, "weights", np.stack([open_jaw, 1 - open_jaw], axis=1).reshape(-1, 1), name="face", mesh=0)
    found = browser_clip(tmp_path, person(), made.save(tmp_path / "face.glb"), expressions=["jawOpen"])
    np.testing.assert_allclose(found["expressions"], open_jaw, atol=4 * FLOAT)


def test_an_animation_is_chosen_by_its_name(tmp_path: Path) -> None:
    source = person()
    made = animated(source, moving(source))
    first = made.json["animations"][0]
    still = {"name": "face", "channels": [], "samplers": []}
    made.json["animations"] = [still, first, {**first, "name": "again"}]
    path = made.save(tmp_path / "more.glb")
    assert 'holds 3 animations; "again" is taken' in browser_clip(tmp_path, source, path, animation="again")["notes"][0]
    assert f'"{first["name"]}" is taken' in browser_clip(tmp_path, source, path)["notes"][0]
    missing = browser_clip(tmp_path, source, path, animation="jump")["message"]
    assert missing == f'more.glb: it has no animation "jump" that moves a joint, only face, {first["name"]}, again.'


BVH = """HIERARCHY
ROOT Hips
{
  OFFSET 0 0 0
  CHANNELS 6 Xposition Yposition Zposition Zrotation Xrotation Yrotation
  End Site
  {
    OFFSET 0 1 0
  }
}
MOTION
Frames: 2
Frame Time: 0.0333333
0 0 0 0 0 0
0 0 0 0 0 1
"""


@pytest.mark.parametrize(
    ("name", "content", "message"),
    [
        ("a.bvh", BVH.replace("0 0 0 0 0 1", "0 0 0 0 0 nan"), 'MOTION: expected finite numbers, found "nan"'),
        ("a.bvh", BVH.replace("0 0 0 0 0 1", "0 0 0 0 1"), "MOTION: expected 2 frames of 6 values, found 11"),
        ("a.bvh", BVH.replace("Yrotation", "Wrotation"), 'CHANNELS of Hips: expected .*, found "wrotation"'),
        ("a.bvh", BVH.replace("CHANNELS 6", "CHANNELS 5"), "CHANNELS of Hips: expected a count and as many names"),
        ("a.bvh", BVH.replace("0.0333333", "30"), "Frame Time: expected seconds above 0 and up"),
        ("a.bvh", BVH.replace("MOTION\n", ""), "expected a line MOTION"),
        ("a.bvh", BVH.replace("}\nMOTION", "MOTION"), "HIERARCHY: 1 braces are not closed"),
        ("a.bvh", BVH, "nothing of it is known to move the avatar's left arm"),
        ("a.gltf", "{}", "no animation of it moves a joint"),
        ("a.gltf", "{", "its JSON cannot be read"),
        ("a.glb", "glTF", "its JSON cannot be read"),
        ("a.fbx", "Kaydara FBX Binary", "expected a BVH, glTF, GLB, VRM or VRMA file"),
    ],
)
def test_a_motion_file_that_is_wrong_is_a_sentence(tmp_path: Path, name: str, content: str, message: str) -> None:
    (tmp_path / name).write_text(content)
    found = browser_clip(tmp_path, person(), tmp_path / name)["message"]
    assert found.startswith(f"{name}: ")
    assert found.endswith(".")
    assert "\n" not in found
    assert re.search(message, found), found


@pytest.mark.parametrize(
    ("field", "value", "message"),
    [
        (("accessors", 0, "bufferView"), 99, "its input: sparse accessors are not read"),
        (("accessors", 0, "count"), 10**9, "its input: its accessor lies outside"),
        (("animations", 0, "channels", 0, "sampler"), 500, "sampler is 500, expected one of its samplers"),
        (("animations", 0, "samplers", 0, "output"), 0, "its output holds 60 numbers for 60 keys of rotation"),
        (("nodes", 0, "children"), [0], "a node is its own ancestor|no other's child"),
        (("nodes", 0, "rotation"), [0, 0, 0, 0], "expected a unit quaternion"),
        (("nodes", 0, "translation"), [0, 0], "expected 3 finite numbers"),
    ],
)
def test_a_gltf_file_that_is_wrong_is_a_sentence(
    tmp_path: Path, field: tuple[str | int, ...], value: Any, message: str
) -> None:
    made = animated(person(), moving(person()))
    place: Any = made.json
    for part in field[:-1]:
        place = place[part]
    place[field[-1]] = value
    found = browser_clip(tmp_path, person(), made.save(tmp_path / "a.glb"))["message"]
    assert re.search(message, found), found


def test_joints_are_known_by_the_names_that_the_package_knows(tmp_path: Path) -> None:
    skeletons = written_names()
    file = tmp_path / "skeletons.json"
    file.write_text(
        json.dumps([{"names": s.names, "parents": s.parents.tolist(), "root": s.root} for s in skeletons]),
        encoding="utf-8",
    )
    [found] = node("roles", file)
    for skeleton, told in zip(skeletons, found, strict=True):
        assert {role: tuple(joints) for role, joints in told.items()} == roles(skeleton), skeleton.names


def test_a_rig_is_followed_as_its_clip_would_be(tmp_path: Path) -> None:
    source, target = person(size=1.2), person(arms_down=45, size=0.8, axes=2)
    clip = moving(source)
    rest = source.world(source.bind_rotations, source.bind_translations)
    turned, at = source.world(clip.rotations, clip.translations)
    posed = [(turned[f], at[f]) for f in (0, len(clip) - 1)]
    given = {
        "names": source.names,
        "parents": source.parents.tolist(),
        **dict(zip(("rotations", "positions"), (part.tolist() for part in rest), strict=True)),
        "poses": [{"rotations": r.tolist(), "positions": p.tolist()} for r, p in [rest, *posed]],
    }
    (tmp_path / "rig.json").write_text(json.dumps(given))
    [found] = node("live", skeleton_file(tmp_path, target), tmp_path / "rig.json")
    rotations = np.roll(np.array([one["rotations"] for one in found]).reshape(3, -1, 4), 1, axis=-1)
    matches = match_joints(source, target)
    wanted, _ = retarget(SourceMotion(source, clip), target, matches, rate=clip.rate)
    apart = np.abs(np.abs(np.sum(rotations[1:] * wanted.rotations[[0, -1]], axis=-1)) - 1)
    np.testing.assert_array_less(apart, ANGLE)
    translations = np.array([one["translations"] for one in found]).reshape(3, -1, 3)
    np.testing.assert_allclose(translations[0], target.bind_translations, atol=ROOM)  # at rest where the rig rests
    gone = translations[2, target.root] - translations[1, target.root]
    hips = at[-1, source.root] - at[0, source.root]
    np.testing.assert_allclose(gone, hips * 0.8 / 1.2, atol=1e-3)
