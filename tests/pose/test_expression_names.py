"""Expressions by their names, in every spelling, and what moves what between them."""

import numpy as np
import pytest

from mua.arrays import Array
from mua.pose.expression_names import STAND_INS, match_expressions, set_weights, stand_ins
from mua.pose.expression_vocabulary import ARKIT, NAMES, PAIRS_AND_HALVES, VISEMES, VRM, known_expression

EVERY = (*ARKIT, *VRM, *VISEMES, *PAIRS_AND_HALVES)


def weights(avatar: tuple[str, ...], source: dict[str, float]) -> dict[str, float]:
    """What an avatar's expressions become under weights of a source, those that are not 0."""
    matrix = match_expressions(avatar, tuple(source))
    moved = np.clip(matrix @ np.array([*source.values()]), 0, 1)
    return {name: round(float(w), 6) for name, w in zip(avatar, moved, strict=True) if w}


def test_every_other_name_means_an_expression() -> None:
    assert {*NAMES["otherNames"].values()} <= {*EVERY}
    assert all(known_expression(other) == name for other, name in NAMES["otherNames"].items())


def test_vocabularies_have_their_published_sizes() -> None:
    assert (len(set(ARKIT)), len(set(VRM)), len(set(VISEMES))) == (52, 18, 15)
    assert set(STAND_INS) <= set(EVERY)
    assert {other for sets in STAND_INS.values() for there in sets for other in there} <= set(EVERY)


@pytest.mark.parametrize("name", EVERY)
def test_every_name_is_known_in_usual_spellings(name: str) -> None:
    snake = "".join(f"_{c.lower()}" if c.isupper() and name in (*ARKIT, *PAIRS_AND_HALVES) else c for c in name)
    short = name.replace("Left", "_L").replace("Right", "_R") if name.endswith(("Left", "Right")) else name
    for spelt in (name, name[0].upper() + name[1:], short, f"blendShape1.{name}", snake):
        assert known_expression(spelt) == name, spelt


@pytest.mark.parametrize(
    ("name", "known"),
    [
        ("AK_09_EyeBlinkLeft", "eyeBlinkLeft"),
        ("AA_VI_01_PP", "viseme_PP"),
        ("Fcl_MTH_A", "aa"),
        ("h_expressions.ReyeClose_h", "eyeBlinkRight"),  # Autodesk Character Generator's
        ("h_expressions.MouthOpen_h", "jawOpen"),
        ("Fcl_EYE_Close_L", "blinkLeft"),
        ("blendShape1.MTH_A", "aa"),
        ("blink_l", "blinkLeft"),
        ("BLINK_R", "blinkRight"),
        ("LOOKUP", "lookUp"),
        ("lookleft", "lookLeft"),
        ("Joy", "happy"),
        ("A", "aa"),
        ("viseme_U", "viseme_ou"),
        ("sil", "viseme_sil"),
        ("PP", "viseme_PP"),
        ("nn", "viseme_nn"),
        ("まばたき", "blink"),
        ("EyeClosedLeft", "blinkLeft"),
        ("Eye Blink Left", "eyeBlinkLeft"),
        ("AU_04_BrowLowerer", "browDown"),  # Rocketbox
        ("AU_02_L_OuterBrowRaiser", "browOuterUpLeft"),
        ("lipCornerPuller_L", "mouthSmileLeft"),  # Meta's face tracking
        ("eyesClosedR", "blinkRight"),
        ("eyesLookLeftR", "eyeLookInRight"),
        ("lipFunnelerLB", "mouthFunnelLowerLeft"),
        ("LeftBrowLowerer", "browDownLeft"),  # Roblox
        ("Facial_Blends.NoseScrunch_Left", "noseSneerLeft"),  # Fuse
        ("Brow_Raise_Inner_L", "browInnerUpLeft"),  # Character Creator
        ("Eye_L_Look_R", "eyeLookInLeft"),
        ("face_shapes.ai_browDown_L", "browDownLeft"),
        ("face_surprise", "surprised"),
        ("left", None),
        ("VLeft", None),
        ("Fcl_EYE_Iris_Hide", None),
        ("Smoking", None),
        ("", None),
        ("___", None),
    ],
)
def test_names_of_exporters(name: str, known: str | None) -> None:
    assert known_expression(name) == known


@pytest.mark.parametrize("names", [ARKIT, VRM, VISEMES])
def test_same_vocabulary_maps_to_itself(names: tuple[str, ...]) -> None:
    assert (match_expressions(names, names) == np.eye(len(names))).all()
    other = [name.upper() for name in names] if names is not ARKIT else [n[0].upper() + n[1:] for n in names]
    assert (match_expressions(names, other) == np.eye(len(names))).all()


@pytest.mark.parametrize("source", EVERY)
@pytest.mark.parametrize("avatar", [ARKIT, VRM, VISEMES])
def test_what_has_a_counterpart_moves_something(source: str, avatar: tuple[str, ...]) -> None:
    matrix = match_expressions(avatar, [source])
    expected = source in avatar or any(set(there) & set(avatar) for there in stand_ins(source))
    assert matrix.any() == expected
    assert (np.abs(matrix) <= 1).all()


def test_arkit_drives_vrm() -> None:
    assert weights(VRM, {"eyeBlinkLeft": 1, "eyeBlinkRight": 0.5}) == {"blinkLeft": 1, "blinkRight": 0.5}
    assert weights(("blink",), {"eyeBlinkLeft": 1, "eyeBlinkRight": 1}) == {"blink": 1}
    assert weights(VRM, {"jawOpen": 0.6}) == {"aa": 0.6}
    assert weights(VRM, {"jawOpen": 0.6, "mouthClose": 0.6}) == {}
    assert weights(VRM, {"eyeLookOutLeft": 1, "eyeLookInRight": 1}) == {"lookLeft": 1}
    assert weights(VRM, {"mouthSmileLeft": 1, "mouthSmileRight": 1}) == {"happy": 1}


def test_vrm_drives_arkit() -> None:
    assert weights(ARKIT, {"blink": 0.8}) == {"eyeBlinkLeft": 0.8, "eyeBlinkRight": 0.8}
    assert weights(ARKIT, {"lookRight": 1}) == {"eyeLookInLeft": 1, "eyeLookOutRight": 1}
    assert weights(ARKIT, {"aa": 1}) == {"jawOpen": 0.7}
    assert weights(("viseme_aa", *ARKIT), {"aa": 1}) == {"viseme_aa": 1}


def test_both_sides_as_one_and_one_side_of_one_stand_for_each_other() -> None:
    assert weights(("browDown",), {"browDownLeft": 1, "browDownRight": 0.5}) == {"browDown": 0.75}
    assert weights(ARKIT, {"browLowerer": 0.5}) == {"browDownLeft": 0.5, "browDownRight": 0.5}
    halves = ("innerBrowRaiserL", "innerBrowRaiserR")
    assert weights(halves, {"browInnerUp": 0.5}) == dict.fromkeys(halves, 0.5)
    assert weights(ARKIT, {"innerBrowRaiserL": 1, "innerBrowRaiserR": 0.5}) == {"browInnerUp": 0.75}
    quarters = {f"lipFunneler{corner}": 0.5 for corner in ("LB", "LT", "RB", "RT")}
    assert weights(ARKIT, quarters) == {"mouthFunnel": 0.5}
    assert weights(tuple(quarters), {"mouthFunnel": 0.5}) == quarters


def test_visemes_and_vowels_stand_for_each_other() -> None:
    for vowel, viseme in {"aa": "viseme_aa", "ee": "viseme_E", "ih": "viseme_I", "oh": "viseme_O"}.items():
        assert weights(VRM, {viseme: 0.5}) == {vowel: 0.5}
        assert weights((viseme,), {vowel: 0.5}) == {viseme: 0.5}


def test_nothing_is_moved_twice() -> None:
    face = (*ARKIT, *VISEMES)
    assert weights(face, {"jawOpen": 1}) == {"jawOpen": 1}
    assert weights(face, {"jawOpen": 0.2, "aa": 1, "viseme_aa": 0.5}) == {"jawOpen": 0.2, "viseme_aa": 0.5}
    assert weights(VRM, {"blink": 0.5, "eyeBlinkLeft": 0.5}) == {"blink": 0.5, "blinkLeft": 0.5}
    assert weights(("blink",), {"blink": 0.5, "eyeBlinkLeft": 0.5}) == {"blink": 0.5}
    assert weights(("aa",), {"viseme_aa": 0.5, "jawOpen": 0.5}) == {"aa": 0.5}


def test_same_name_goes_before_another_spelling() -> None:
    assert weights(("A", "aa", "mouthOpen"), {"A": 1}) == {"A": 1}
    assert weights(("mouthOpen", "aa"), {"A": 1}) == {"aa": 1}
    assert weights(("mouthOpen",), {"jawOpen": 1}) == {"mouthOpen": 1}


def test_name_without_a_number_goes_before_one_with() -> None:
    lids = ("eyeUpperClose_25_L", "eyeUpperClose_L", "eyeUpperClose_R2")
    assert weights(lids, {"blink": 1}) == {"eyeUpperClose_L": 1, "eyeUpperClose_R2": 1}
    assert weights(("a.jawOpen1", "a1.jawOpen"), {"JawOpen": 1}) == {"a1.jawOpen": 1}


def test_names_of_nobody_match_only_themselves() -> None:
    assert weights(("Smoking", "jawOpen"), {"Smoking": 0.3, "smoke": 1}) == {"Smoking": 0.3}


def test_weights_by_whatever_names_become_those_that_follow() -> None:
    assert set_weights(VRM, {"jawOpen": 2, "cheekPuff": 1}) == {"aa": 1}
    assert set_weights(("aa", "x"), {"jawOpen": 0.5, "mouthClose": 0.75, "x": -1}) == {"aa": 0, "x": 0}
    assert set_weights(VRM, {"Smoking": 1}) == set_weights((), {"aa": 1}) == set_weights(VRM, {}) == {}


def test_no_names_make_an_empty_matrix() -> None:
    empty: Array = match_expressions((), ())
    assert empty.shape == (0, 0)
    assert match_expressions(ARKIT, ()).shape == (52, 0)
