"""Names of expressions in the browser mean what they mean in the package, and move as much of one another."""

import json
from pathlib import Path

import numpy as np
from expression_sets import pairs
from web.test_modules import node, pytestmark  # noqa: F401  needs Node

from mua.pose.expression_names import match_expressions


def test_names_match_as_in_the_package(tmp_path: Path) -> None:
    file = tmp_path / "pairs.json"
    file.write_text(json.dumps(pairs()))
    for (avatar, source), answer in zip(pairs(), node("names", file), strict=True):
        found = np.array(answer, np.float32).reshape(len(avatar), len(source))
        np.testing.assert_array_equal(found, match_expressions(avatar, source), f"{avatar} {source}")
