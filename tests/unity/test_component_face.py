"""Expressions of AvatarRenderer in a player loop of stand-ins: what an application, a clip and a tracked face show."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from component import RATE, SECOND, Reports, Story
from frame_bounds import FRAME_ORDER
from replay import replay
from synthetic_avatar import synthetic_avatar, with_expressions

from mua.arrays import Array
from mua.asset import read, write
from mua.gpu import Device
from mua.pose.expression_names import match_expressions
from mua.pose.signed_expressions import as_weights

SETTLED = 8  # displayed frames, as in programs/ComponentFace.cs
SORTING = len(FRAME_ORDER) - FRAME_ORDER.index("SplatProject")
PLAIN, EXPRESSIVE = len(FRAME_ORDER) - SORTING, len(FRAME_ORDER) - SORTING + 3  # dispatches of a decode and its pose
ROUNDED = 4e-7  # metres: two sums of float32 of a metre


RULES = np.array([2, 3, 1, 64], np.int32)  # jawOpen and "nothing" hold the blink back, the last is a switch


@pytest.fixture(scope="module", params=[None, RULES], ids=["plain", "ruled"])
def face(folder: Path, request: pytest.FixtureRequest) -> Path:
    """The first avatar with expressions and weights in its clip, without rules and with some."""
    made = with_expressions(synthetic_avatar(1))
    assert made.rig.expressions
    expressions = replace(made.rig.expressions, rules=request.param)
    file = folder / ("face.muaavatar" if request.param is None else "ruled.muaavatar")
    write(file, replace(made, rig=replace(made.rig, expressions=expressions)), storage="f16")
    return file


@pytest.fixture(scope="module")
def told(story: Story, face: Path) -> Reports:
    return story("SetsExpressions", face.stem)


def numbers(line: str) -> list[float]:
    return [float(word) for word in line.split()]


def test_names_and_weights_are_those_of_the_file(told: Reports, face: Path) -> None:
    avatar = read(face)
    [clip] = avatar.clips
    assert clip.expressions is not None
    assert told["names"] == [",".join(avatar.expressions)]
    np.testing.assert_array_equal(
        np.array([numbers(line) for line in told["clip"]], np.float32), clip.expressions[[0, -1]]
    )
    assert told["log"] == []


def test_weights_move_the_mesh_by_as_much_as_the_file_says(told: Reports, face: Path, device: Device) -> None:
    """The first frame of the clip and the last, less what rules hold back; given back to the clip, the same bytes."""
    avatar, last = read(face), len(read(face).clips[0]) - 1
    expressions, vertices = avatar.rig.expressions, len(avatar.rig.mesh.vertices)
    assert expressions
    assert avatar.clips[0].expressions is not None
    kept = replay(device, face.with_name(f"{face.stem} set")).kept
    for frame, line in zip((0, last), told["held"], strict=True):
        assert numbers(line) == [0.5, 1, 0, 0]

        def mesh(name: str, frame: int = frame) -> Array:
            return kept[f"{name} {frame}"].view(np.float32).reshape(-1, 3)

        for name, weights in (("clip", avatar.clips[0].expressions[frame]), ("set", np.array([0.5, 1, 0, 0]))):
            expected = expressions.displacement(expressions.shown(weights), vertices=vertices)
            np.testing.assert_allclose(mesh(name) - mesh("plain"), expected, rtol=0, atol=ROUNDED)
            assert np.abs(expected).max() > 1000 * ROUNDED
        np.testing.assert_array_equal(mesh("again"), mesh("clip"))


def test_a_weight_that_changes_decodes_once_and_weights_of_0_cost_nothing(told: Reports) -> None:
    assert told["to plain"] == [str(PLAIN + SETTLED * SORTING)] * 2
    assert told["to set"] == [str(EXPRESSIVE + SETTLED * SORTING)] * 2
    assert told["idle"] == [str(SETTLED * SORTING)] * 2


def test_names_that_the_avatar_lacks_and_weights_that_are_no_numbers(told: Reports) -> None:
    assert (told["early"], told["unknown"], told["set"]) == (["False 0 0"], ["False 0"] * 2, ["True"] * 2)
    nan, infinite = told["refused"]
    assert nan.startswith("the weight of the expression jawOpen is NaN, expected a finite number")
    assert "Infinity" in infinite


def test_blend_shapes_of_equal_names_set_expressions(story: Story, face: Path) -> None:
    """Whatever their case and underscores; a whole blend shape is 100, what lies beyond is held to it."""
    reported, clip = story("FollowsFace", face.stem, "second"), read(face).clips[0]
    assert clip.expressions is not None
    own = [pytest.approx(weight, rel=1e-6) for weight in clip.expressions[0].tolist()]
    [followed], [beside], [after] = (reported[key] for key in ("followed", "beside", "after"))
    assert numbers(followed) == [0.5, 0, own[2], 1]
    assert numbers(beside) == [0.5, 0, 0.25, 1]
    assert numbers(after) == [*own[:2], 0.25, own[3]]  # as the mesh was destroyed
    assert len(reported["moving"]) == 2  # the face of a game that is paused moves too
    for moving in reported["moving"]:
        decodes, rest = divmod(int(moving) - SECOND * SORTING, EXPRESSIVE)
        assert (rest, abs(decodes - RATE) <= 1) == (0, True)
    lost, bulges, silent = (line.rpartition(": ")[2] for line in reported["log"])
    assert lost.startswith("the mesh whose blend shapes moved the avatar's face was destroyed")
    assert bulges == "no blend shape of box has the name of one of the avatar's expressions, such as jawOpen."
    assert silent == "the avatar has no expressions, so that the blend shapes of box move nothing."
    assert reported["said"] == [bulges, silent]


def test_a_trackers_names_move_what_the_avatar_has(story: Story, folder: Path) -> None:
    """As much as the package's clips do; other expressions stay with the clip."""
    avatar = with_expressions(synthetic_avatar(1))
    assert avatar.rig.expressions
    assert avatar.clips[0].expressions is not None
    names = ("aa", "blink", "oh", "Smoking")
    named = replace(avatar.rig, expressions=replace(avatar.rig.expressions, names=names))
    write(folder / "vrm.muaavatar", replace(avatar, rig=named), storage="f16")
    reported, clip = story("TakesTrackersNames", "vrm"), avatar.clips[0].expressions[0].tolist()

    def weights(source: dict[str, float], own: list[float]) -> object:
        matrix = match_expressions(names, [*source])
        found = np.clip(matrix @ np.array([*source.values()]), 0, 1)
        return pytest.approx([w if row.any() else o for w, row, o in zip(found, matrix, own, strict=True)], rel=1e-6)

    sent = {"jawOpen": 0.6, "cheekPuff": 1.0, "eyeBlinkLeft": 1.0, "eyeBlink_R": 0.5, "mouthClose": 0.2}
    assert reported["followed"] == ["True False True True True False"]
    assert numbers(reported["set"][0]) == weights(sent, clip)
    assert numbers(reported["set"][0]) == pytest.approx([0.4, 0.75, *clip[2:]])
    assert numbers(reported["anew"][0]) == weights({"jawOpen": 0.3}, clip)
    assert reported["allocated"] == ["0"]
    assert [numbers(line) for line in reported["reset"]] == [pytest.approx(clip, rel=1e-6)] * 2
    shapes = {"jawOpen": 0.9, "mouthClose": 0.7, "cheekPuff": 0.5, "eyeBlinkLeft": 0.3, "Smoking": 0.1}
    assert numbers(reported["tracked"][0]) == weights(shapes, clip)
    assert (reported["said"], reported["log"]) == ([""], [])


def test_coefficients_of_smplx_move_one_of_each_pair(story: Story, folder: Path) -> None:
    """By as much as `as_weights` says of a mesh's animation."""
    avatar, names = with_expressions(synthetic_avatar(1)), ("Exp000+", "Exp000-", "Exp001+", "Exp001-")
    assert avatar.rig.expressions
    named = replace(avatar.rig, expressions=replace(avatar.rig.expressions, names=names))
    write(folder / "smplx.muaavatar", replace(avatar, rig=named), storage="f16")
    coefficients = np.array([2.0, -4, 6, 0])
    expected = {**as_weights("Exp000", coefficients), **as_weights("Exp001", -coefficients / 2)}
    followed = np.array([numbers(line) for line in story("FollowsCoefficients", "smplx")["followed"]])
    np.testing.assert_allclose(followed, np.stack([expected[name] for name in names], axis=1), rtol=1e-6)
    assert followed.any(axis=0).all()


def test_a_face_or_an_avatar_that_goes_before_the_avatar_is_ready(story: Story, face: Path) -> None:
    assert story("FaceGoesEarly", face.stem)["state"] == ["Ready "]
