"""Expressions of SMPL-X as pairs of weights from 0 to 1: Exp000+ moves one way, Exp000- the other.

A coefficient of SMPL-X has either sign and counts standard deviations of its training faces.
"""

import re
from collections.abc import Mapping

import numpy as np

from mua.arrays import Array

UNIT = 5.0  # standard deviations at weight 1; few recorded coefficients are larger
WAYS = {"+": 1.0, "-": -1.0}
_COEFFICIENT = re.compile(r"(?:.*\.)?(Exp\d{3})")  # as SMPL-X's Blender add-on names shape keys


def signed_name(name: str) -> str | None:
    """The coefficient of SMPL-X that an expression's name means; None for any other."""
    found = _COEFFICIENT.fullmatch(name)
    return found[1] if found else None


def as_weights(
    name: str,
    values: Array,  # [F] weights, of SMPL-X coefficients
) -> Mapping[str, Array]:
    """The weights [F], 0 to 1, of the expressions that a file's values of one stand for."""
    coefficient = signed_name(name)
    if coefficient is None:
        return {name: np.clip(values, 0, 1)}
    return {coefficient + way: np.clip(sign * values / UNIT, 0, 1) for way, sign in WAYS.items()}
