"""One layer against exactly rounded sums."""

import math

import numpy as np
import pytest

from mua.arrays import Array
from mua.kernels.mlp_matmul import mlp_matmul

SIZES = [(0, 5), (1, 1), (1, 0), (7, 13), (130, 257)]


def layer(outputs: int, inputs: int, dtype: type) -> tuple[Array, Array, Array]:
    rng = np.random.default_rng(outputs + inputs)
    return (
        rng.normal(size=(outputs, inputs)).astype(dtype),
        rng.normal(size=outputs).astype(dtype),
        rng.normal(size=inputs).astype(dtype),
    )


@pytest.mark.parametrize("dtype", [np.float32, np.float64])
@pytest.mark.parametrize("size", SIZES)
def test_equals_exactly_rounded_sums(size: tuple[int, int], dtype: type) -> None:
    weight, bias, x = layer(*size, dtype)
    y = mlp_matmul(weight, bias, x, relu=False)
    exact = [
        math.fsum([*(float(a) * float(b) for a, b in zip(row, x, strict=True)), b])
        for row, b in zip(weight, bias, strict=True)
    ]
    rounding_bound = (len(x) + 1) * np.finfo(dtype).eps * (np.abs(weight) @ np.abs(x) + np.abs(bias))
    assert y.dtype == dtype
    assert np.all(np.abs(y - np.array(exact)) <= rounding_bound)


def test_relu_stops_negative_outputs_only() -> None:
    weight, bias, x = layer(31, 9, np.float64)
    y = mlp_matmul(weight, bias, x, relu=False)
    assert (y < 0).any()
    np.testing.assert_array_equal(mlp_matmul(weight, bias, x, relu=True), np.where(y > 0, y, 0))
