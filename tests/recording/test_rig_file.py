"""A rig on disk: what comes back, and what its hash tells apart."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from synthetic_avatar import synthetic_avatar, with_expressions, with_rules

from mua.recording.rig_file import read_rig, rig_hash, write_rig


def test_expressions_come_back(tmp_path: Path) -> None:
    rig = with_rules(with_expressions(synthetic_avatar())).rig
    write_rig(tmp_path / "rig.npz", rig)
    found = read_rig(tmp_path / "rig.npz")
    assert found.expressions
    assert rig.expressions
    assert found.expressions.names == rig.expressions.names
    for name in ("starts", "vertices", "offsets", "gains", "rules"):
        np.testing.assert_array_equal(getattr(found.expressions, name), getattr(rig.expressions, name))
    assert rig_hash(found) == rig_hash(rig)


@pytest.mark.parametrize("part", ["gains", "rules"])
def test_expressions_without_light_or_rules_have_none_and_another_hash(tmp_path: Path, part: str) -> None:
    nothing: dict[str, Any] = {part: None}
    rig = with_rules(with_expressions(synthetic_avatar())).rig
    assert rig.expressions
    without = replace(rig, expressions=replace(rig.expressions, **nothing))
    write_rig(tmp_path / "rig.npz", without)
    found = read_rig(tmp_path / "rig.npz").expressions
    assert found
    assert getattr(found, part) is None
    assert rig_hash(without) != rig_hash(rig)


def test_a_rig_without_expressions_has_none_and_another_hash(tmp_path: Path) -> None:
    rig = with_expressions(synthetic_avatar()).rig
    plain = replace(rig, expressions=None)
    write_rig(tmp_path / "rig.npz", plain)
    assert read_rig(tmp_path / "rig.npz").expressions is None
    assert rig_hash(plain) != rig_hash(rig)
