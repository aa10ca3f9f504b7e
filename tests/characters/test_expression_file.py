"""Names that a person gives a character's expressions: one each, one for several, and what is wrong with them."""

from pathlib import Path

import numpy as np
import pytest
from characters.test_gltf_expressions import (
    AHEAD,
    UP,
    assert_top_moves,
    bind,
    names_of,
    second,
    with_targets,
    with_weights,
)

from mua.characters.expression_file import read_expression_names, write_expression_names
from mua.characters.read import read_surfaces
from mua.errors import InputError


def test_expressions_get_the_names_that_are_given(tmp_path: Path) -> None:
    path = with_targets(["mund", "Fcl_MTH_A", "rest"], [UP, AHEAD, UP]).save(tmp_path / "hero.glb")
    surfaces = read_surfaces(path, expression_names={"mund": "jawOpen", "Fcl_MTH_A": "aa"})
    assert names_of(surfaces) == ("jawOpen", "Fcl_MTH_A", "rest")  # what means its name already keeps its own
    assert_top_moves(surfaces, "jawOpen", UP)


def test_expressions_of_one_name_move_together(tmp_path: Path) -> None:
    path = with_targets(["JawOpen", "teeth"], [UP, AHEAD]).save(tmp_path / "hero.glb")
    surfaces = read_surfaces(path, expression_names=dict.fromkeys(("JawOpen", "teeth"), "jawOpen"))
    assert names_of(surfaces) == ("jawOpen",)
    assert_top_moves(surfaces, "jawOpen", UP + AHEAD)


def test_clips_and_rules_of_the_file_follow(tmp_path: Path) -> None:
    glb = second(with_targets(["a"], [UP]), {"happy": bind(0, 1, isBinary=True, overrideMouth="block")})
    path = with_weights(glb, [[0], [1]]).save(tmp_path / "hero.vrm")
    source = read_surfaces(path, expression_names={"happy": "grin"}).source
    assert source is not None
    rules = source.scene.face_rules
    assert (rules.switched, rules.overrides) == ({"grin"}, {"grin": {"mouth": "block"}})
    plain = with_weights(with_targets(["a", "b"], [UP, AHEAD]), [[0, 0], [1, 0.5]]).save(tmp_path / "plain.glb")
    surfaces = read_surfaces(plain, expression_names={"b": "blink"})
    assert names_of(surfaces) == ("a", "blink")
    np.testing.assert_allclose(np.asarray(surfaces.clips[0].expressions)[-1], [1, 0.5], atol=1e-6)


def test_a_file_to_start_from_changes_nothing_until_it_is_edited(tmp_path: Path) -> None:
    path = with_targets(["mund", "A", "Fcl_MTH_A"], [UP, AHEAD, UP]).save(tmp_path / "hero.glb")
    before = names_of(read_surfaces(path))
    write_expression_names(tmp_path / "names.json", before)
    assert (tmp_path / "names.json").read_text() == '{\n  "mund": "",\n  "A": "aa",\n  "Fcl_MTH_A": ""\n}\n'
    names = read_expression_names(tmp_path / "names.json")
    assert names_of(read_surfaces(path, expression_names=names)) == before


@pytest.mark.parametrize(
    ("text", "sentence"),
    [
        ("{", "names.json: cannot be read as names of expressions: "),
        ("[]", "expected a table of expressions and their names, found list"),
        ('{"a": 3}', "a: expected a name, found 3"),
        ('{"smile": "happy"}', r"hero.glb: --expression-names: it has no expression 'smile', only mund"),
    ],
)
def test_what_is_wrong_is_a_sentence(tmp_path: Path, text: str, sentence: str) -> None:
    path = with_targets(["mund"], [UP]).save(tmp_path / "hero.glb")
    (tmp_path / "names.json").write_text(text)
    with pytest.raises(InputError, match=sentence):
        read_surfaces(path, expression_names=read_expression_names(tmp_path / "names.json"))
