"""A rig on disk: what comes back, and what its hash tells apart."""

from dataclasses import replace
from pathlib import Path

import numpy as np
from synthetic_avatar import synthetic_avatar, with_expressions

from mua.recording.rig_file import read_rig, rig_hash, write_rig


def test_expressions_come_back(tmp_path: Path) -> None:
    rig = with_expressions(synthetic_avatar()).rig
    write_rig(tmp_path / "rig.npz", rig)
    found = read_rig(tmp_path / "rig.npz")
    assert found.expressions
    assert rig.expressions
    assert found.expressions.names == rig.expressions.names
    for name in ("starts", "vertices", "offsets", "gains"):
        np.testing.assert_array_equal(getattr(found.expressions, name), getattr(rig.expressions, name))
    assert rig_hash(found) == rig_hash(rig)


def test_expressions_without_light_have_none_and_another_hash(tmp_path: Path) -> None:
    rig = with_expressions(synthetic_avatar()).rig
    assert rig.expressions
    unlit = replace(rig, expressions=replace(rig.expressions, gains=None))
    write_rig(tmp_path / "rig.npz", unlit)
    found = read_rig(tmp_path / "rig.npz").expressions
    assert found
    assert found.gains is None
    assert rig_hash(unlit) != rig_hash(rig)


def test_a_rig_without_expressions_has_none_and_another_hash(tmp_path: Path) -> None:
    rig = with_expressions(synthetic_avatar()).rig
    plain = replace(rig, expressions=None)
    write_rig(tmp_path / "rig.npz", plain)
    assert read_rig(tmp_path / "rig.npz").expressions is None
    assert rig_hash(plain) != rig_hash(rig)
