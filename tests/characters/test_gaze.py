"""Gaze of a VRM whose eyes are joints, as expressions: where what hangs on the eyes goes."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from gltf_files import BONES, POINTS, Glb, animate, body, primitive, weighted
from scipy.spatial.transform import Rotation

from mua.arrays import Array
from mua.characters.expression_file import read_expression_names, write_expression_names
from mua.characters.gaze import GAZE
from mua.characters.read import read_surfaces
from mua.errors import InputError
from mua.motion.load import load_motions
from mua.motion.read import read_motion
from mua.pose.expression_names import set_weights
from mua.rig.expressions import Expressions

FLOAT_BOUND = 1e-6
REACH = {"Outer": 30.0, "Inner": 20.0, "Up": 15.0, "Down": 12.0}  # degrees
EYES = {"eyeL": 0.03, "eyeR": -0.03}
HELD = {"eyeL": [13, 14], "eyeR": [12, 15]}  # points of the column's upper end
MAPS = {"Outer": "HorizontalOuter", "Inner": "HorizontalInner", "Up": "VerticalUp", "Down": "VerticalDown"}
LOOK_AT = {"type": "bone"} | {
    f"rangeMap{name}": {"inputMaxValue": 90, "outputScale": REACH[way]} for way, name in MAPS.items()
}


def avatar(*, eyes: bool = False, share: float = 1.0, **changes: Any) -> Glb:
    """A column with three targets, of which a VRM makes expressions; its upper end hangs on two eyes by a share."""
    joints, weights = weighted(BONES)
    for number, at in enumerate(HELD.values()):
        joints[at, 1], weights[at, 0], weights[at, 1] = 3 + number, 1 - share, share
    glb = body()
    if eyes:
        primitive(glb)["attributes"] |= {"JOINTS_0": glb.accessor(joints, "u1"), "WEIGHTS_0": glb.accessor(weights)}
    targets = np.zeros((3, 16, 3))
    targets[:, :4] = 0.1 * np.eye(3)[:, None]
    primitive(glb)["targets"] = [{"POSITION": glb.accessor(offsets)} for offsets in targets]
    bones: dict[str, Any] = {"hips": {"node": 0}, "head": {"node": 2}}
    if eyes:
        count = len(glb.json["nodes"])
        turn = Rotation.from_euler("z", 0.8)  # the bones do not look ahead by themselves
        glb.json["nodes"] += [
            {"name": name, "translation": [x, 0.1, 0], "rotation": turn.as_quat().tolist()} for name, x in EYES.items()
        ]
        glb.json["nodes"][2].setdefault("children", []).extend([count, count + 1])
        bones |= {"leftEye": {"node": count}, "rightEye": {"node": count + 1}}
        binds = np.tile(np.eye(4), (5, 1, 1))
        binds[:3, 1, 3] = -np.array([0, 0.5, 1])
        for number, x in enumerate(EYES.values()):
            binds[3 + number, :3, :3] = turn.inv().as_matrix()
            binds[3 + number, :3, 3] = -turn.inv().apply([x, 1.1, 0])
        matrices = glb.accessor(binds.swapaxes(1, 2))
        glb.json["skins"] = [{"joints": [0, 1, 2, count, count + 1], "inverseBindMatrices": matrices}]
    bind: dict[str, Any] = {
        name: {"morphTargetBinds": [{"node": 3, "index": index, "weight": 1}]}
        for index, name in enumerate(("happy", "blink", "aa"))
    }
    bind["happy"] |= {"overrideBlink": "blend", "isBinary": True}
    vrm = {"specVersion": "1.0", "humanoid": {"humanBones": bones}, "expressions": {"preset": bind}}
    glb.json["extensions"] = {"VRMC_vrm": vrm | changes}
    return glb


def expressions(path: Path) -> Expressions:
    held = read_surfaces(path).expressions
    assert held is not None
    return held


def moved(path: Path, **named: float) -> Array:
    """How far weights by name move the points [16, 3], in their order in the file."""
    surfaces = read_surfaces(path)
    assert surfaces.expressions is not None
    weights = set_weights(surfaces.expressions.names, named)
    given = np.array([weights.get(name, 0.0) for name in surfaces.expressions.names])
    by = surfaces.expressions.displacement(given, vertices=len(surfaces.vertices))
    places = np.abs(surfaces.vertices[None] - POINTS[:, None]).max(axis=2)
    return np.asarray(by[places.argmin(axis=1)])


def turned(side: str, degrees: tuple[float, float]) -> Array:
    """How far a turn to the left and up moves the points of an eye [16, 3]; 0 for others."""
    at, place = np.isin(np.arange(16), HELD[side]), np.array([EYES[side], 1.1, 0])
    turn = Rotation.from_euler("YX", [degrees[0], -degrees[1]], degrees=True)
    return np.where(at[:, None], turn.apply(POINTS - place) - (POINTS - place), 0)


@pytest.mark.parametrize(
    ("weights", "left", "right"),
    [
        ({"lookLeft": 1.0}, (30, 0), (20, 0)),
        ({"lookRight": 1.0}, (-20, 0), (-30, 0)),
        ({"lookUp": 1.0}, (0, 15), (0, 15)),
        ({"lookDown": 1.0}, (0, -12), (0, -12)),
        ({"eyeLookInLeft": 1.0, "eyeLookInRight": 1.0}, (-20, 0), (20, 0)),  # ARKit's eyes may cross
        ({"eyeLookUpLeft": 1.0}, (0, 15), (0, 0)),
    ],
)
def test_gaze_turns_what_hangs_on_the_eyes(
    tmp_path: Path, weights: dict[str, float], left: tuple[float, float], right: tuple[float, float]
) -> None:
    path = avatar(eyes=True, lookAt=LOOK_AT).save(tmp_path / "hero.vrm")
    expected = turned("eyeL", left) + turned("eyeR", right)
    np.testing.assert_allclose(moved(path, **weights), expected, atol=FLOAT_BOUND)
    half = {name: weight / 2 for name, weight in weights.items()}
    np.testing.assert_allclose(moved(path, **half), expected / 2, atol=FLOAT_BOUND)


def test_what_hangs_on_an_eye_by_a_share_moves_by_that_share(tmp_path: Path) -> None:
    path = avatar(eyes=True, share=0.25, lookAt=LOOK_AT).save(tmp_path / "hero.vrm")
    expected = 0.25 * (turned("eyeL", (0, 15)) + turned("eyeR", (0, 15)))
    np.testing.assert_allclose(moved(path, lookUp=1), expected, atol=FLOAT_BOUND)


def test_gaze_is_held_back_and_other_expressions_keep_what_they_have(tmp_path: Path) -> None:
    glb = avatar(eyes=True, lookAt=LOOK_AT)
    glb.json["extensions"]["VRMC_vrm"]["expressions"]["preset"]["aa"]["overrideLookAt"] = "blend"
    held = expressions(glb.save(tmp_path / "hero.vrm"))
    assert held.names == ("happy", "blink", "aa", *GAZE)
    np.testing.assert_allclose(held.shown(np.array([0.6, 1, 0.5, *[1] * 8])), [1, 0, 0.5, *[0.5] * 8])
    np.testing.assert_allclose(held.shown(np.array([0.4, 1, 0, *[1] * 8])), [0, 1, 0, *[1] * 8])


def test_eyes_that_expressions_move_have_none(tmp_path: Path) -> None:
    by_expression = avatar(eyes=True, lookAt={"type": "expression"})
    shown = avatar(eyes=True, lookAt=LOOK_AT)
    preset = shown.json["extensions"]["VRMC_vrm"]["expressions"]["preset"]
    preset["lookUp"] = preset.pop("aa") | {"isBinary": True}
    for glb, names in ((by_expression, ("happy", "blink", "aa")), (shown, ("happy", "blink", "lookUp"))):
        assert expressions(glb.save(tmp_path / "hero.vrm")).names == names
    assert expressions(avatar().save(tmp_path / "hero.vrm")).names == ("happy", "blink", "aa")


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
    path = glb.save(tmp_path / "hero.vrm")
    expected = turned("eyeL", (30, 0)) + turned("eyeR", (20, 0))
    np.testing.assert_allclose(moved(path, LOOKLEFT=1), expected, atol=FLOAT_BOUND)


def test_a_file_of_names_that_a_check_wrote_is_taken(tmp_path: Path) -> None:
    path = avatar(eyes=True, lookAt=LOOK_AT).save(tmp_path / "hero.vrm")
    write_expression_names(tmp_path / "names.json", expressions(path).names)
    names = read_expression_names(tmp_path / "names.json")
    held = read_surfaces(path, expression_names=names).expressions
    assert held is not None
    assert held.names == expressions(path).names


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
        read_surfaces(path)


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
    character = read_surfaces(avatar(eyes=True, lookAt=LOOK_AT).save(tmp_path / "hero.vrm"))
    assert character.expressions is not None
    (loaded,) = load_motions(
        tmp_path / "look.vrma",
        character.skeleton,
        mapping=None,
        rate=30.0,
        refuse=False,
        face=character.expressions.names,
    )
    assert loaded.clip.expressions is not None
    weights = dict(zip(character.expressions.names, loaded.clip.expressions[15], strict=True))
    assert {name: round(float(weight), 6) for name, weight in weights.items() if weight > FLOAT_BOUND} == {
        "eyeLookOutLeft": 0.5,
        "eyeLookInRight": 0.5,
    }
    extension["lookAt"] = {"node": 9}
    with pytest.raises(InputError, match=r"lookAt\.node is 9, but nodes holds 5"):
        read_motion(glb.save(tmp_path / "look.vrma"))
