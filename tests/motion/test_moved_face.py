"""What facial motion moves of a VRM: its expressions with their rules, and eyes that are joints."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from gltf_files import Glb, animate, body, primitive

from mua import rotation
from mua.arrays import Array
from mua.characters.read import read_character
from mua.errors import InputError
from mua.motion.load import load_motions
from mua.motion.moved_face import face_of
from mua.motion.read import read_motion
from mua.pose.clip import Clip

FLOAT_BOUND = 1e-6
REACH = {"Outer": 30.0, "Inner": 20.0, "Up": 15.0, "Down": 12.0}  # degrees
EYES = {"eyeL": 0.03, "eyeR": -0.03}
MAPS = {"Outer": "HorizontalOuter", "Inner": "HorizontalInner", "Up": "VerticalUp", "Down": "VerticalDown"}
LOOK_AT = {"type": "bone"} | {
    f"rangeMap{name}": {"inputMaxValue": 90, "outputScale": REACH[way]} for way, name in MAPS.items()
}


def avatar(*, eyes: bool = False, **changes: Any) -> Glb:
    """A column with three targets, of which a VRM makes expressions; two joints at its end are its eyes."""
    glb = body()
    moved = np.zeros((3, 16, 3))
    moved[:, 12:] = 0.1 * np.eye(3)[:, None]
    primitive(glb)["targets"] = [{"POSITION": glb.accessor(offsets)} for offsets in moved]
    bones: dict[str, Any] = {"hips": {"node": 0}, "head": {"node": 2}}
    if eyes:
        count = len(glb.json["nodes"])
        turned = [0, 0, np.sin(0.4), np.cos(0.4)]  # the bones do not look ahead by themselves
        glb.json["nodes"] += [
            {"name": name, "translation": [x, 0.1, 0], "rotation": turned} for name, x in EYES.items()
        ]
        glb.json["nodes"][2].setdefault("children", []).extend([count, count + 1])
        bones |= {"leftEye": {"node": count}, "rightEye": {"node": count + 1}}
    bind: dict[str, Any] = {
        name: {"morphTargetBinds": [{"node": 3, "index": index, "weight": 1}]}
        for index, name in enumerate(("happy", "blink", "aa"))
    }
    bind["happy"] |= {"overrideBlink": "blend", "isBinary": True}
    vrm = {"specVersion": "1.0", "humanoid": {"humanBones": bones}, "expressions": {"preset": bind}}
    glb.json["extensions"] = {"VRMC_vrm": vrm | changes}
    return glb


def on(path: Path, **weights: float) -> tuple[Clip, Any]:
    """A clip that rests, under weights of a source."""
    character = read_character(path, atlas_size=64)
    skeleton, face = character.skeleton, face_of(character)
    rest = Clip("rest", 30.0, skeleton.bind_rotations[None], skeleton.bind_translations[None])
    matrix = face.shares([*weights])
    return face.on(rest, np.clip(matrix @ np.array([*weights.values()]), 0, 1)[None]), skeleton


def ahead(clip: Clip, skeleton: Any) -> Array:
    """Where +Z of the bind pose looks for the eyes [2, 3]."""
    joints = [skeleton.names.index(name) for name in EYES]
    bound, _ = skeleton.world(skeleton.bind_rotations, skeleton.bind_translations)
    turned, _ = skeleton.world(clip.rotations[0], clip.translations[0])
    since = rotation.multiply(turned[joints], rotation.conjugate(bound[joints]))
    return np.asarray(rotation.rotate(since, np.array([0.0, 0, 1])))


def test_a_clip_keeps_its_weights_and_the_character_what_the_file_says(tmp_path: Path) -> None:
    path = avatar().save(tmp_path / "hero.vrm")
    clip, _ = on(path, happy=0.6, blink=1, jawOpen=0.5)
    np.testing.assert_allclose(np.asarray(clip.expressions), [[0.6, 1, 0.5]])
    held = read_character(path, atlas_size=64).expressions
    assert held is not None
    for weights, left in (([0.6, 1, 0.5], [1, 0, 0.5]), ([0.4, 1, 0], [0, 1, 0])):
        np.testing.assert_allclose(held.shown(np.array(weights)), left)


def aimed(yaw: float, pitch: float) -> Array:
    """A direction at degrees to the left of +Z and above it."""
    a, b = np.radians([yaw, pitch])
    return np.array([np.sin(a) * np.cos(b), np.sin(b), np.cos(a) * np.cos(b)])


@pytest.mark.parametrize(
    ("weights", "left", "right"),
    [
        ({"lookLeft": 1.0}, (30, 0), (20, 0)),
        ({"lookRight": 0.5}, (-10, 0), (-15, 0)),
        ({"lookUp": 1.0}, (0, 15), (0, 15)),
        ({"lookDown": 1.0, "lookLeft": 1.0}, (30, -12), (20, -12)),
        ({"eyeLookInLeft": 1.0, "eyeLookInRight": 1.0}, (-20, 0), (20, 0)),  # ARKit's eyes may cross
        ({"aa": 1.0}, (0, 0), (0, 0)),
    ],
)
def test_gaze_turns_eyes_that_are_joints(
    tmp_path: Path, weights: dict[str, float], left: tuple[float, float], right: tuple[float, float]
) -> None:
    path = avatar(eyes=True, lookAt=LOOK_AT).save(tmp_path / "hero.vrm")
    clip, skeleton = on(path, **weights)
    np.testing.assert_allclose(ahead(clip, skeleton), [aimed(*left), aimed(*right)], atol=FLOAT_BOUND)


def test_what_holds_gaze_back_holds_the_eyes(tmp_path: Path) -> None:
    glb = avatar(eyes=True, lookAt=LOOK_AT)
    glb.json["extensions"]["VRMC_vrm"]["expressions"]["preset"]["aa"]["overrideLookAt"] = "blend"
    clip, skeleton = on(glb.save(tmp_path / "hero.vrm"), aa=0.5, lookUp=1)
    np.testing.assert_allclose(ahead(clip, skeleton), [aimed(0, 7.5)] * 2, atol=FLOAT_BOUND)


def test_eyes_that_expressions_move_stay(tmp_path: Path) -> None:
    clip, skeleton = on(avatar(eyes=True, lookAt={"type": "expression"}).save(tmp_path / "hero.vrm"), lookUp=1)
    np.testing.assert_allclose(ahead(clip, skeleton), [[0, 0, 1]] * 2, atol=FLOAT_BOUND)
    assert clip.expressions is None


def test_vrm_0_says_degrees_as_the_range_of_a_curve(tmp_path: Path) -> None:
    glb = avatar(eyes=True)
    vrm = glb.json["extensions"].pop("VRMC_vrm")
    bones = [{"bone": name} | bone for name, bone in vrm["humanoid"]["humanBones"].items()]
    looks = {
        f"lookAt{name}": {"curve": [0, 0, 0, 1, 1, 1, 1, 0], "xRange": 90, "yRange": REACH[way]}
        for way, name in MAPS.items()
    }
    glb.json["extensions"]["VRM"] = {
        "specVersion": "0.0",
        "humanoid": {"humanBones": bones},
        "firstPerson": {"lookAtTypeName": "Bone"} | looks,
    }
    clip, skeleton = on(glb.save(tmp_path / "hero.vrm"), LOOKLEFT=1)
    np.testing.assert_allclose(ahead(clip, skeleton), [aimed(30, 0), aimed(20, 0)], atol=FLOAT_BOUND)


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"lookAt": 3}, "VRMC_vrm.lookAt is 3, expected an object"),
        ({"lookAt": LOOK_AT | {"rangeMapVerticalUp": 1}}, "lookAt.rangeMapVerticalUp is 1, expected an object"),
        (
            {"lookAt": LOOK_AT | {"rangeMapVerticalUp": {"outputScale": -1}}},
            "outputScale is -1, expected 0 to 90 degrees",
        ),
        (
            {"expressions": {"preset": {"happy": {"overrideMouth": "stop"}}}},
            "overrideMouth is stop, expected none, block",
        ),
    ],
)
def test_broken_rules_are_a_sentence(tmp_path: Path, changes: dict[str, Any], sentence: str) -> None:
    path = avatar(eyes=True, **changes).save(tmp_path / "hero.vrm")
    with pytest.raises(InputError, match=sentence):
        read_character(path, atlas_size=64)


def test_a_vrm_animation_looks_where_its_node_is_turned(tmp_path: Path) -> None:
    glb = body()
    glb.json["nodes"].append({"name": "lookAt"})
    glb.json["scenes"][0]["nodes"].append(4)
    extension: dict[str, Any] = {"humanoid": {"humanBones": {"hips": {"node": 0}}}, "lookAt": {"node": 4}}
    glb.json["extensions"] = {"VRMC_vrm_animation": extension}
    half = np.radians(45) / 2
    turns = [[0, 0, 0, 1], [0, np.sin(half), 0, np.cos(half)], [-np.sin(half), 0, 0, np.cos(half)]]
    animate(glb, 1, "rotation", times=[0.0, 1.0], values=[[0, 0, 0, 1], [0, 0, 1, 0]])
    animate(glb, 4, "rotation", times=[0.0, 0.5, 1.0], values=turns)
    (source,) = read_motion(glb.save(tmp_path / "look.vrma"))
    assert source.clip.expressions is not None
    found = dict(zip(source.expressions, source.clip.expressions.T, strict=True))
    np.testing.assert_allclose(found["lookLeft"][[0, 15, 30]], [0, 0.5, 0], atol=FLOAT_BOUND)
    np.testing.assert_allclose(found["lookUp"][[0, 15, 30]], [0, 0, 0.5], atol=FLOAT_BOUND)
    character = read_character(avatar(eyes=True, lookAt=LOOK_AT).save(tmp_path / "hero.vrm"), atlas_size=64)
    (loaded,) = load_motions(
        tmp_path / "look.vrma", character.skeleton, mapping=None, rate=30.0, refuse=False, face=face_of(character)
    )
    joint = character.skeleton.names.index("eyeL")
    turned = np.abs(loaded.clip.rotations[[0, 15], joint] @ character.skeleton.bind_rotations[joint])
    np.testing.assert_allclose(2 * np.degrees(np.arccos(np.minimum(turned, 1))), [0, 15], atol=1e-2)
    extension["lookAt"] = {"node": 9}
    with pytest.raises(InputError, match=r"lookAt\.node is 9, but nodes holds 5"):
        read_motion(glb.save(tmp_path / "look.vrma"))
