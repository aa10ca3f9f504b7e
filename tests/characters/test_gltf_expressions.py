"""Morph targets of glTF and the expressions of VRM avatars: names, offsets, what is noted and what is refused."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from gltf_files import FLOAT_BOUND, HEIGHTS, POINTS, TRIANGLES, Glb, animate, body, primitive, read

from mua.arrays import Array
from mua.atlas.character_surfaces import Surfaces
from mua.characters.facing import Facing
from mua.characters.figure_size import FigureSize
from mua.characters.read import read_character, read_surfaces
from mua.errors import InputError
from mua.motion.read import read_motion

UP, AHEAD = np.array([0, 0.1, 0]), np.array([0, 0, 0.2])
TOP = np.arange(12, 16)  # the points around the column's upper end


def with_targets(names: list[str] | None, offsets: list[Array], *, glb: Glb | None = None, **fields: Any) -> Glb:
    """A column whose targets move its upper end, or all points where offsets [16, 3] say so."""
    glb = glb or body()
    targets = []
    for offset in offsets:
        moved = np.zeros((16, 3))
        moved[TOP] = offset if offset.ndim == 1 else 0
        targets.append({"POSITION": glb.accessor(moved if offset.ndim == 1 else offset)})
    primitive(glb)["targets"] = targets
    glb.json["meshes"][0] |= fields | ({} if names is None else {"extras": {"targetNames": names}})
    return glb


def moved(surfaces: Surfaces, name: str) -> tuple[Array, Array]:
    """The points before and after weight 1 of an expression, as they are in `POINTS`' order of height."""
    expressions = surfaces.expressions
    assert expressions is not None
    weights = np.array([one == name for one in expressions.names], float)
    return surfaces.vertices, expressions.displacement(weights, vertices=len(surfaces.vertices))


def assert_top_moves(surfaces: Surfaces, name: str, offset: Array) -> None:
    points, by = moved(surfaces, name)
    top = points[:, 1] > points[:, 1].max() - 1e-3
    np.testing.assert_allclose(by, np.where(top[:, None], offset, 0), atol=FLOAT_BOUND)


def names_of(surfaces: Surfaces) -> tuple[str, ...]:
    return () if surfaces.expressions is None else surfaces.expressions.names


def test_targets_become_expressions(tmp_path: Path) -> None:
    surfaces = read(with_targets(["jawOpen", "smile"], [UP, AHEAD]), tmp_path)
    assert names_of(surfaces) == ("jawOpen", "smile")
    assert_top_moves(surfaces, "jawOpen", UP)
    assert_top_moves(surfaces, "smile", AHEAD)
    assert not surfaces.notes


def test_figure_without_targets_has_no_expressions(tmp_path: Path) -> None:
    assert read(body(), tmp_path).expressions is None


def test_names_of_univrm_stand_in_a_primitive(tmp_path: Path) -> None:
    glb = with_targets(None, [UP])
    primitive(glb)["extras"] = {"targetNames": ["A"]}
    assert names_of(read(glb, tmp_path)) == ("A",)


@pytest.mark.parametrize("extras", [None, 3, [], {}, {"targetNames": 4}, {"targetNames": [5, ""]}])
def test_targets_without_names_are_numbered(tmp_path: Path, extras: Any) -> None:
    glb = with_targets(None, [UP, AHEAD])
    glb.json["meshes"][0]["extras"] = extras
    assert names_of(read(glb, tmp_path)) == ("body.target 0", "body.target 1")


def test_first_of_equal_names_in_a_mesh_is_taken(tmp_path: Path) -> None:
    surfaces = read(with_targets(["a", "a"], [UP, AHEAD]), tmp_path)
    assert_top_moves(surfaces, "a", UP)
    assert surfaces.notes == ("Of morph targets of one name in a mesh the first is taken: body a.",)


def test_targets_of_one_name_in_several_meshes_are_one_expression(tmp_path: Path) -> None:
    glb = with_targets(["open"], [UP])
    other = {**glb.json["meshes"][0], "name": "teeth"}
    other["primitives"] = [primitive(glb) | {"attributes": dict(primitive(glb)["attributes"])}]
    other["primitives"][0]["attributes"]["POSITION"] = glb.accessor(POINTS + np.eye(3)[0])
    glb.json["meshes"].append(other)
    glb.json["nodes"].append({"mesh": 1, "skin": 0, "name": "teeth"})
    glb.json["scenes"][0]["nodes"].append(4)
    surfaces = read(glb, tmp_path)
    assert names_of(surfaces) == ("open",)
    assert_top_moves(surfaces, "open", UP)
    assert len(surfaces.vertices) == 32


@pytest.mark.parametrize(("size", "noted"), [(1e-3, True), (0.2, False)])
def test_pieces_that_are_a_point_at_rest_are_noted(tmp_path: Path, size: float, noted: bool) -> None:
    glb = with_targets(["open"], [UP])
    star = {"attributes": primitive(glb)["attributes"] | {"POSITION": glb.accessor(size * POINTS)}}
    star |= {"indices": primitive(glb)["indices"], "targets": [{"POSITION": glb.accessor((1 - size) * POINTS)}]}
    glb.json["meshes"].append({"name": "star", "primitives": [star], "extras": {"targetNames": ["cheer"]}})
    glb.json["nodes"].append({"mesh": 1, "skin": 0, "name": "star"})
    glb.json["scenes"][0]["nodes"].append(4)
    note = "Pieces that are next to a point at rest have no texels and stay unseen in expressions: cheer."
    assert (note in read(glb, tmp_path).notes) == noted


def test_sparse_and_quantised_targets(tmp_path: Path) -> None:
    glb = body()
    rows = glb.view(TOP.astype("<u2").tobytes())
    values = glb.view(np.tile(UP, (4, 1)).astype("<f4").tobytes())
    sparse = {"count": 4, "indices": {"bufferView": rows, "componentType": 5123}, "values": {"bufferView": values}}
    glb.json["accessors"].append({"componentType": 5126, "count": 16, "type": "VEC3", "sparse": sparse})
    steps = np.zeros((16, 3), int)
    steps[TOP, 2] = 64
    quantised = glb.accessor(steps, "i1", normalized=True)
    primitive(glb)["targets"] = [{"POSITION": len(glb.json["accessors"]) - 2}, {"POSITION": quantised}]
    glb.json["meshes"][0]["extras"] = {"targetNames": ["a", "b"]}
    surfaces = read(glb, tmp_path)
    assert_top_moves(surfaces, "a", UP)
    assert_top_moves(surfaces, "b", np.array([0, 0, 64 / 127]))


def test_offsets_count_from_the_weights_at_rest(tmp_path: Path) -> None:
    surfaces = read(with_targets(["a", "b"], [AHEAD, UP], weights=[0.25, 1]), tmp_path)
    assert_top_moves(surfaces, "a", 0.75 * AHEAD)
    assert names_of(surfaces) == ("a",)
    assert surfaces.notes == ("Expressions that move nothing are left out: b.",)


@pytest.mark.parametrize(("offsets", "vertices"), [((0.1, 0.1), 16), ((0.1, -0.1), 32)])
def test_lips_stay_apart(tmp_path: Path, offsets: tuple[float, float], vertices: int) -> None:
    """Points that two primitives share are one where their targets agree, and two where they part."""
    glb = body()
    halves = []
    for offset, triangles in zip(offsets, (TRIANGLES[:12], TRIANGLES[12:]), strict=True):
        moved = {"POSITION": glb.accessor(np.tile([0, 0, offset], (16, 1)))}
        halves.append(primitive(glb) | {"indices": glb.accessor(triangles.reshape(-1), "u4"), "targets": [moved]})
    glb.json["meshes"][0]["primitives"] = halves
    assert len(read(glb, tmp_path).vertices) == vertices


def test_offsets_follow_the_figures_size(tmp_path: Path) -> None:
    path = with_targets(["a"], [UP]).save(tmp_path / "a.glb")
    surfaces = read_surfaces(path)
    taller = read_surfaces(path, size=FigureSize(height=3 * float(np.ptp(surfaces.vertices[:, 1]))))
    assert_top_moves(taller, "a", 3 * UP)


def test_offsets_turn_with_a_figure_that_faces_elsewhere(tmp_path: Path) -> None:
    path = with_targets(["a"], [AHEAD]).save(tmp_path / "a.glb")
    assert_top_moves(read_surfaces(path, facing=Facing(towards="-z")), "a", -AHEAD)
    assert_top_moves(read_surfaces(path, facing=Facing(towards="-x")), "a", np.array([0.2, 0, 0]))


def test_offsets_follow_a_scaled_skeleton(tmp_path: Path) -> None:
    """A mesh in a space of its own, ten times as large: its offsets shrink with its points."""
    glb = body(POSITION=None)
    large = glb.accessor(10 * POINTS)
    primitive(glb)["attributes"]["POSITION"] = large
    binds = np.tile(np.diag([0.1, 0.1, 0.1, 1]), (3, 1, 1))
    binds[:, 1, 3] = -HEIGHTS
    glb.json["skins"][0]["inverseBindMatrices"] = glb.accessor(binds.swapaxes(1, 2))
    assert_top_moves(read(with_targets(["a"], [10 * UP], glb=glb), tmp_path), "a", UP)


def group(name: str | None, preset: str | None, *binds: tuple[int, float], **more: Any) -> dict[str, Any]:
    """An expression of VRM 0 that moves targets of mesh 0."""
    moved = [{"mesh": 0, "index": index, "weight": weight} for index, weight in binds]
    return {"name": name, "presetName": preset, "binds": moved} | more


def first(glb: Glb, *groups: Any) -> Glb:
    glb.json["extensions"] = {"VRM": {"blendShapeMaster": {"blendShapeGroups": [*groups]}}}
    return glb


def second(glb: Glb, preset: Any, custom: Any = None) -> Glb:
    glb.json["extensions"] = {"VRMC_vrm": {"specVersion": "1.0", "expressions": {"preset": preset, "custom": custom}}}
    return glb


def bind(index: int, weight: float, **more: Any) -> dict[str, Any]:
    return {"morphTargetBinds": [{"node": 3, "index": index, "weight": weight}]} | more


RAW = ["open", "EyeBlink_L", "raw"]


def test_expressions_of_vrm_0_combine_targets(tmp_path: Path) -> None:
    glb = with_targets(RAW, [UP, AHEAD, UP])
    glb = first(glb, group("Mouth", "a", (0, 50), (1, 100)), group("Grin", "unknown", (0, 100)), group("N", "neutral"))
    surfaces = read(glb, tmp_path)
    assert names_of(surfaces) == ("a", "Grin", "EyeBlink_L")  # beside the file's own, what perfect sync asks for
    assert_top_moves(surfaces, "a", UP / 2 + AHEAD)
    assert_top_moves(surfaces, "Grin", UP)
    assert_top_moves(surfaces, "EyeBlink_L", AHEAD)
    assert "Expressions that move nothing are left out: neutral." in surfaces.notes


def test_expressions_of_vrm_1_combine_targets(tmp_path: Path) -> None:
    glb = with_targets(RAW, [UP, AHEAD, UP])
    surfaces = read(second(glb, {"aa": bind(0, 0.5)}, {"eyeBlinkLeft": bind(1, 1), "Grin": bind(2, 1)}), tmp_path)
    assert names_of(surfaces) == ("aa", "eyeBlinkLeft", "Grin")
    assert_top_moves(surfaces, "aa", UP / 2)
    assert_top_moves(surfaces, "eyeBlinkLeft", AHEAD)


def test_what_a_vrm_expression_does_besides_is_noted(tmp_path: Path) -> None:
    colours = {"materialColorBinds": [{"material": 0, "type": "color", "targetValue": [1, 0, 0, 1]}]}
    preset = {"happy": bind(0, 1, overrideBlink="block"), "sad": bind(1, 1, isBinary=True, overrideMouth="none")}
    glb = second(with_targets(RAW, [UP, AHEAD, UP]), preset, {"blush": colours})
    notes = read(glb, tmp_path).notes
    assert "Colours and textures that an expression changes stay as they are: blush." in notes


def test_rules_of_a_vrm_are_those_of_its_expressions_by_any_name(tmp_path: Path) -> None:
    preset = {"happy": bind(0, 1, overrideBlink="block"), "blink": bind(1, 1, isBinary=True, overrideMouth="none")}
    glb = second(with_targets(RAW, [UP, AHEAD, UP]), preset, {"wow": bind(2, 1, overrideBlink="blend")})
    path = glb.save(tmp_path / "body.glb")
    for called in ({}, {"wow": "Wow!"}):
        held = read_surfaces(path, expression_names=called).expressions
        assert held is not None
        assert held.names == ("happy", "blink", called.get("wow", "wow"), "EyeBlink_L")
        np.testing.assert_allclose(held.shown(np.array([0.1, 1, 0, 0.2])), [0.1, 0, 0, 0.2])
        np.testing.assert_allclose(held.shown(np.array([0, 0.4, 0, 0])), [0, 0, 0, 0])
        np.testing.assert_allclose(held.shown(np.array([0, 1, 0.1, 0])), [0, 0, 0.1, 0])


@pytest.mark.parametrize(
    ("damaged", "sentence"),
    [
        (lambda g: first(g, 3), r"blendShapeGroups\[0\] is 3, expected an object"),
        (lambda g: first(g, {"binds": 3}), r"blendShapeGroups\[0\]\.binds is 3, expected an array"),
        (lambda g: first(g, {"binds": [{"mesh": 9, "index": 0}]}), r"binds\[0\]\.mesh is 9, but meshes holds 1"),
        (lambda g: first(g, group("x", "a", (-1, 1))), r"binds\[0\]\.index is -1, expected the number"),
        (
            lambda g: first(g, group("x", "a", (0, float("nan")))),
            r"binds\[0\]\.weight is nan, expected a number from 0",
        ),
        (lambda g: second(g, {"aa": 3}), r"expressions\.preset\.aa is 3, expected an object"),
        (lambda g: second(g, [1]), r"expressions\.preset is \[1\], expected an object"),
        (lambda g: second(g, {"aa": bind(0, "x")}), r"aa\.morphTargetBinds\[0\]\.weight is x, expected"),  # type: ignore[arg-type]
        (lambda g: second(g, {"aa": {"morphTargetBinds": [{"node": "3"}]}}), r"morphTargetBinds\[0\]\.node is 3"),
    ],
)
def test_broken_expressions_are_named(tmp_path: Path, damaged: Any, sentence: str) -> None:
    with pytest.raises(InputError, match=sentence):
        read(damaged(with_targets(RAW, [UP, AHEAD, UP])), tmp_path)


def test_binds_of_targets_that_are_not_there_move_nothing(tmp_path: Path) -> None:
    assert names_of(read(second(with_targets(["x"], [UP]), {"aa": bind(7, 1), "ih": bind(0, 1)}), tmp_path)) == ("ih",)


def test_character_keeps_its_expressions(tmp_path: Path) -> None:
    character = read_character(with_targets(["jawOpen"], [UP]).save(tmp_path / "a.glb"), atlas_size=16)
    assert character.expressions is not None
    moved = character.expressions.displacement(np.ones(1), vertices=len(character.mesh.vertices))
    top = character.mesh.vertices[:, 1] > 1.4
    np.testing.assert_allclose(moved, np.where(top[:, None], UP, 0), atol=FLOAT_BOUND)


def with_weights(glb: Glb, values: list[list[float]], **sampler: Any) -> Glb:
    """A clip of weights of the mesh's targets, a key each half second."""
    times = glb.accessor(0.5 * np.arange(len(values)))
    sampler |= {"input": times, "output": glb.accessor(np.array(values).reshape(-1, 1))}
    channel = {"sampler": 0, "target": {"node": 3, "path": "weights"}}
    glb.json["animations"] = [{"name": "talk", "samplers": [sampler], "channels": [channel]}]
    return glb


def test_clips_carry_the_weights_of_targets(tmp_path: Path) -> None:
    glb = with_weights(with_targets(["a", "b"], [UP, AHEAD]), [[0, 0], [1, 0.5], [0, 2]])
    surfaces = read(glb, tmp_path)
    (clip,) = surfaces.clips
    assert clip.expressions is not None
    expected = np.array([[0, 0], [1, 0.5], [0, 1.0]])
    np.testing.assert_allclose(clip.expressions[[0, 15, 30]], expected, atol=FLOAT_BOUND)
    assert not np.ptp(clip.rotations, axis=0).any()
    assert not surfaces.notes
    (source,) = read_motion(tmp_path / "body.glb")
    assert source.expressions == ("a", "b")
    assert np.array_equal(np.asarray(source.clip.expressions), clip.expressions)


def test_weights_of_clips_count_from_those_at_rest(tmp_path: Path) -> None:
    glb = with_weights(with_targets(["a", "b"], [UP, AHEAD], weights=[0.5, 0.25]), [[0.5, 0.25], [1, 0.25]])
    surfaces = read(glb, tmp_path)
    (clip,) = surfaces.clips
    assert clip.expressions is not None
    np.testing.assert_allclose(clip.expressions[-1], [1, 0], atol=FLOAT_BOUND)
    assert_top_moves(surfaces, "a", UP / 2)


def test_clips_of_raw_targets_move_the_expressions_of_a_vrm(tmp_path: Path) -> None:
    glb = second(with_targets(["Fcl_MTH_A"], [UP]), {"aa": bind(0, 1)})
    (clip,) = read(with_weights(glb, [[0], [1]]), tmp_path).clips
    assert clip.expressions is not None
    np.testing.assert_allclose(clip.expressions[-1], [1], atol=FLOAT_BOUND)


def test_a_clip_whose_weights_stay_at_rest_moves_nothing(tmp_path: Path) -> None:
    surfaces = read(with_weights(with_targets(["a"], [UP]), [[0], [0]]), tmp_path)
    assert not surfaces.clips
    assert surfaces.notes == ("Clips that move no joint are left out: talk.",)


def test_broken_weights_are_named(tmp_path: Path) -> None:
    glb = with_weights(with_targets(["a", "b"], [UP, AHEAD]), [[0], [1]])
    with pytest.raises(InputError, match=r"samplers\[0\]\.output holds 2 elements, expected 4 for its LINEAR keys"):
        read(glb, tmp_path)


def test_vrm_animations_carry_weights_as_a_nodes_x(tmp_path: Path) -> None:
    glb = body()
    glb.json["nodes"].append({"name": "happy"})
    glb.json["scenes"][0]["nodes"].append(4)
    extension = {"humanoid": {"humanBones": {"hips": {"node": 0}}}, "expressions": {"preset": {"happy": {"node": 4}}}}
    glb.json["extensions"] = {"VRMC_vrm_animation": extension}
    animate(glb, 1, "rotation", times=[0.0, 1.0], values=[[0, 0, 0, 1], [0, 0, 1, 0]])
    animate(glb, 4, "translation", times=[0.0, 1.0], values=[[0, 0, 0], [1, 5, 5]])
    (source,) = read_motion(glb.save(tmp_path / "smile.vrma"))
    assert source.expressions == ("happy",)
    assert source.clip.expressions is not None
    np.testing.assert_allclose(source.clip.expressions[:, 0], np.linspace(0, 1, 31), atol=FLOAT_BOUND)
    extension["expressions"] = {"custom": {"grin": {"node": 9}}}
    with pytest.raises(InputError, match=r"expressions\.custom\.grin\.node is 9, but nodes holds 5"):
        read_motion(glb.save(tmp_path / "smile.vrma"))
