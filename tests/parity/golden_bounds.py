"""Whether a golden case is met."""

import numpy as np
from golden import DTYPES, Golden, values_of

from mua.arrays import Array


def assert_met(golden: Golden, found: dict[str, Array]) -> None:
    for described in golden.case["expected"]:
        expected = golden.array(described, described["count"], DTYPES[described["kind"]]).astype(float)
        values = values_of(described, found[described["buffer"]])
        excess = np.abs(values - expected) - described["absolute"] - described["relative"] * np.abs(expected)
        assert np.all(excess <= 0), f"{described['buffer']}: {excess.max():.3g} beyond the bound"
