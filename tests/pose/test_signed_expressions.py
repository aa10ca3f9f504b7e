"""Coefficients of SMPL-X as pairs of weights from 0 to 1."""

import numpy as np
import pytest

from mua.pose.expression_names import match_expressions
from mua.pose.signed_expressions import UNIT, as_weights, signed_name


def test_a_coefficient_moves_one_of_a_pair_and_is_held_to_its_whole_weight() -> None:
    weights = as_weights("Exp007", UNIT * np.array([0, 0.5, -0.25, 1.5, -2]))
    assert [*weights] == ["Exp007+", "Exp007-"]
    np.testing.assert_allclose(weights["Exp007+"], [0, 0.5, 0, 1, 0])
    np.testing.assert_allclose(weights["Exp007-"], [0, 0, 0.25, 0, 1])


def test_other_expressions_keep_their_weight() -> None:
    weights = as_weights("jawOpen", np.array([-1, 0.5, 2]))
    assert [*weights] == ["jawOpen"]
    np.testing.assert_allclose(weights["jawOpen"], [0, 0.5, 1])


@pytest.mark.parametrize(
    ("name", "coefficient"),
    [("Exp012", "Exp012"), ("SMPLX.Exp012", "Exp012"), ("Exp12", None), ("Exp012+", None), ("Expand001", None)],
)
def test_coefficients_are_told_by_the_names_of_the_add_on(name: str, coefficient: str | None) -> None:
    assert signed_name(name) == coefficient


def test_a_pair_moves_itself_and_nothing_else() -> None:
    names = ("Exp000+", "Exp000-", "Exp001+", "Exp001-")
    np.testing.assert_array_equal(match_expressions(names, names), np.eye(4))
    assert not match_expressions(("jawOpen", "aa", "happy"), names).any()
