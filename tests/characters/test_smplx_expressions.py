"""SMPL-X's expressions of a character: shape keys of its add-on, and directions of a model file, here of a column."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from characters.test_gltf_expressions import AHEAD, UP, assert_top_moves, names_of, with_targets, with_weights
from gltf_files import BONES, FLOAT_BOUND, POINTS, TRIANGLES, Glb, body, primitive, weighted

from mua.arrays import Array
from mua.baking.sources import load_character
from mua.characters.facing import Facing, turn_about_y
from mua.characters.read import read_surfaces
from mua.errors import InputError
from mua.motion.load import load_motions
from mua.pose.signed_expressions import UNIT

PAIRS = tuple(f"Exp{number:03}{way}" for number in range(10) for way in "+-")
PLACE = np.array([0.1, -0.7, 0.2])  # of the model's column beside that of the file
BENT = 2e-2  # metres: how far a direction moves a vertex at most


def model(folder: Path, **changes: Any) -> tuple[Path, Array, Array]:
    """A file of a model whose template is the column in another order; its first shapes and expressions by point."""
    random = np.random.default_rng(4)
    order, count = random.permutation(16), changes.pop("count", 400)
    directions = random.uniform(-BENT, BENT, (16, 3, count))
    first = 300 if count == 400 else 10
    arrays = {"v_template": (POINTS + PLACE)[order], "shapedirs": directions[order]} | changes
    path = folder / "SMPLX_NEUTRAL.npz"
    np.savez(path, **{key: value for key, value in arrays.items() if value is not None})
    return path, directions[..., :10], directions[..., first : first + 10]


def column(points: Array, *, split: bool = False) -> Glb:
    """The column with other places of its points; split: with a vertex for each corner of a triangle."""
    glb = body(POSITION=None)
    own = TRIANGLES.ravel() if split else np.arange(16)
    joints, weights = weighted(BONES[own])
    primitive(glb)["attributes"] = {
        "POSITION": glb.accessor(points[own]),
        "JOINTS_0": glb.accessor(joints, "u1"),
        "WEIGHTS_0": glb.accessor(weights),
    }
    if split:
        primitive(glb)["indices"] = glb.accessor(np.arange(len(own)), "u2")
    return glb


def test_shape_keys_of_the_add_on_move_both_ways(tmp_path: Path) -> None:
    path = with_targets(["Exp000", "smile", "Exp001"], [UP, AHEAD, AHEAD]).save(tmp_path / "hero.glb")
    surfaces = read_surfaces(path)
    assert names_of(surfaces) == ("Exp000+", "Exp000-", "smile", "Exp001+", "Exp001-")
    for name, offset in (("Exp000+", UNIT * UP), ("Exp000-", -UNIT * UP), ("smile", AHEAD), ("Exp001-", -UNIT * AHEAD)):
        assert_top_moves(surfaces, name, offset)


def test_clips_that_move_these_keys_keep_both_ways(tmp_path: Path) -> None:
    glb = with_targets(["Exp000", "smile"], [UP, AHEAD])
    path = with_weights(glb, [[-UNIT, 0.5], [UNIT / 2, -1]]).save(tmp_path / "hero.glb")
    surfaces = read_surfaces(path)
    weights = np.asarray(surfaces.clips[0].expressions)
    np.testing.assert_allclose(weights[[0, -1]], [[0, 1, 0.5], [0.5, 0, 0]], atol=1e-6)
    (loaded,) = load_motions(path, surfaces.skeleton, mapping=None, rate=30.0, refuse=False, face=("Exp000-",))
    np.testing.assert_allclose(np.asarray(loaded.clip.expressions)[0], [1], atol=1e-6)


@pytest.mark.parametrize("count", [400, 20])
@pytest.mark.parametrize("split", [False, True])
@pytest.mark.parametrize("turn", [0.0, 30.0])
@pytest.mark.parametrize("shape", [0.0, 1.0])
def test_a_character_gets_the_models_expressions(
    tmp_path: Path, count: int, split: bool, turn: float, shape: float
) -> None:
    path, shapes, directions = model(tmp_path, count=count)
    points = POINTS + shape * shapes @ np.random.default_rng(1).normal(size=10)
    character = column(points, split=split).save(tmp_path / "hero.glb")
    surfaces = read_surfaces(character, smplx=path, facing=Facing(turn=turn))
    assert names_of(surfaces) == PAIRS
    assert surfaces.expressions is not None
    assert surfaces.source is not None
    turned = turn_about_y(turn).T
    at = np.linalg.norm(surfaces.vertices[:, None] - points @ turned, axis=2).argmin(axis=1)
    for number, name in enumerate(PAIRS):
        weights = np.eye(len(PAIRS))[number]
        found = surfaces.expressions.displacement(weights, vertices=len(surfaces.vertices))
        expected = (UNIT if name.endswith("+") else -UNIT) * directions[..., number // 2] @ turned
        np.testing.assert_allclose(found, expected[at], atol=8 * FLOAT_BOUND)
    assert {target.name for target in surfaces.source.scene.parts[0].targets} == {*PAIRS}  # as a check draws them


def test_meshes_that_are_not_the_models_stay_as_they_are(tmp_path: Path) -> None:
    path, _, _ = model(tmp_path)
    glb = column(POINTS)
    few = {"attributes": {"POSITION": glb.accessor(POINTS[[0, 1, 5]])}, "indices": glb.accessor(np.arange(3), "u2")}
    glb.json["meshes"].append({"name": "hat", "primitives": [few]})
    glb.json["nodes"].append({"mesh": 1, "name": "hat"})
    glb.json["nodes"][2].setdefault("children", []).append(4)
    surfaces = read_surfaces(glb.save(tmp_path / "hero.glb"), smplx=path)
    assert surfaces.source is not None
    assert {part.name: len(part.targets) for part in surfaces.source.scene.parts} == {"body": 20, "hat": 0}


def test_expressions_of_a_model_take_other_names(tmp_path: Path) -> None:
    path, _, _ = model(tmp_path)
    character = column(POINTS).save(tmp_path / "hero.glb")
    names = names_of(read_surfaces(character, smplx=path, expression_names={"Exp000+": "jawOpen"}))
    assert names == ("jawOpen", *PAIRS[1:])


@pytest.mark.parametrize(
    ("changes", "sentence"),
    [
        ({"v_template": None}, "lacks the array v_template"),
        ({"shapedirs": None}, "lacks the array shapedirs"),
        ({"v_template": np.zeros((16, 2))}, r"v_template: the shape is \[16, 2\]"),
        ({"shapedirs": np.zeros((15, 3, 20))}, "shapedirs: the shape is"),
        ({"shapedirs": np.zeros((16, 3, 300))}, "expected the 400 or 20 directions of SMPL-X"),
        ({"v_template": np.full((16, 3), np.nan)}, "v_template: a value is not finite"),
        (
            {"v_template": POINTS * 1.2},
            r"no mesh of the character is this model's in any shape: .* \d+\.\d mm",
        ),
    ],
)
def test_a_file_that_is_not_the_characters_model_is_a_sentence(
    tmp_path: Path, changes: dict[str, Any], sentence: str
) -> None:
    path, _, _ = model(tmp_path, **changes)
    character = column(POINTS).save(tmp_path / "hero.glb")
    with pytest.raises(InputError, match=sentence) as error:
        read_surfaces(character, smplx=path)
    assert str(path) in str(error.value)


def test_a_model_is_refused_where_no_mesh_is_to_get_expressions(tmp_path: Path) -> None:
    character = with_targets(["Exp000"], [UP]).save(tmp_path / "hero.glb")
    with pytest.raises(InputError, match="has expressions of SMPL-X already; leave the option out"):
        read_surfaces(character, smplx=model(tmp_path)[0])
    with pytest.raises(InputError, match=r"--smplx .*: needs a character from a file"):
        load_character(None, uv="auto", seed=0, smplx=model(tmp_path)[0])
