"""Random layers, and the bound of their products."""

import numpy as np

from mua.arrays import Array


def layer(outputs: int, inputs: int, dtype: type) -> tuple[Array, Array, Array]:
    rng = np.random.default_rng(outputs + inputs)
    return (
        rng.normal(size=(outputs, inputs)).astype(dtype),
        rng.normal(size=outputs).astype(dtype),
        rng.normal(size=inputs).astype(dtype),
    )


def shader_bound(weight: Array, bias: Array, x: Array) -> Array:
    """Two roundings for the element and its product, one for each term of the sum."""
    return np.asarray((len(x) + 3) * np.finfo(np.float32).eps * (np.abs(weight) @ np.abs(x) + np.abs(bias)))
