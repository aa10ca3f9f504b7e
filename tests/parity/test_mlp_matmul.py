"""The reference against exactly rounded sums, the shader against the reference."""

import math

import numpy as np
import pytest
from dispatch import run
from layer_cases import layer, shader_bound
from stored import STORAGES, Stored, groups, store

from mua.arrays import Array
from mua.asset.tensors import Element
from mua.gpu import Device
from mua.kernels.mlp_matmul import mlp_matmul

SIZES = [(0, 5), (1, 1), (1, 0), (7, 13), (130, 257)]
PAPER_LAYERS = [(384, 384), (4576, 384), (128, 384)]
PAPER_MESH = (3 * 5514, 128)
ROWS_PER_GROUP, COLUMNS_PER_GROUP = 8, 64
BEYOND = 5  # elements after y that the shader must leave alone, and after x that it must not read


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


def shader_layer(
    device: Device, weight: Stored, bias: Stored, x: Array, *, relu: bool = False, transposed: bool = False
) -> Array:
    """y by the shader, after checking that it touched nothing else."""
    outputs = len(bias.values)
    following = np.full(BEYOND, np.nan, np.float32)
    y = run(
        device,
        "mlp_matmul.compute",
        "MlpMatmulTransposed" if transposed else "MlpMatmul",
        groups((outputs, COLUMNS_PER_GROUP if transposed else ROWS_PER_GROUP)),
        {
            "weight": weight.words,
            "bias": bias.words,
            "x": np.concatenate([x, following]),
            "y": np.full(outputs + BEYOND, -7, np.float32),
        },
        weight_layout=weight.layout,
        bias_layout=bias.layout,
        inputs=len(x),
        outputs=outputs,
        **({} if transposed else {"relu": int(relu)}),
    )["y"]
    np.testing.assert_array_equal(y[outputs:], -7)
    return np.asarray(y[:outputs])


@pytest.mark.parametrize("storage", STORAGES)
@pytest.mark.parametrize("size", SIZES + PAPER_LAYERS)
def test_shader_equals_the_reference(device: Device, size: tuple[int, int], storage: Element) -> None:
    raw_weight, raw_bias, x = layer(*size, np.float32)
    weight, bias = store(raw_weight, storage, rows=size[0]), store(raw_bias, "f32")
    for relu in (False, True):
        expected = mlp_matmul(weight.values, bias.values, x.astype(float), relu=relu)
        y = shader_layer(device, weight, bias, x, relu=relu)
        assert np.all(np.abs(y - expected) <= shader_bound(weight.values, bias.values, x))


@pytest.mark.parametrize("storage", STORAGES)
@pytest.mark.parametrize("size", [*SIZES, PAPER_MESH])
def test_transposed_shader_equals_the_reference(device: Device, size: tuple[int, int], storage: Element) -> None:
    raw_weight, raw_bias, x = layer(*size, np.float32)
    basis, mean = store(np.ascontiguousarray(raw_weight.T), storage, rows=size[1]), store(raw_bias, storage)
    weight = basis.values.T
    expected = mlp_matmul(weight, mean.values, x.astype(float), relu=False)
    y = shader_layer(device, basis, mean, x, transposed=True)
    assert np.all(np.abs(y - expected) <= shader_bound(weight, mean.values, x))


@pytest.mark.parametrize("scales", [1, 3, 5, 15, 45, 315])
@pytest.mark.parametrize("transposed", [False, True])
def test_shader_takes_any_number_of_scales(device: Device, scales: int, transposed: bool) -> None:
    raw_weight, raw_bias, x = layer(21, 15, np.float32)
    raw_weight *= np.geomspace(1, 1000, raw_weight.size).reshape(raw_weight.shape)  # every scale is another
    weight = store(np.ascontiguousarray(raw_weight.T) if transposed else raw_weight, "i8", rows=scales)
    bias = store(raw_bias, "f16")
    matrix = weight.values.T if transposed else weight.values
    expected = mlp_matmul(matrix, bias.values, x.astype(float), relu=False)
    y = shader_layer(device, weight, bias, x, transposed=transposed)
    assert np.all(np.abs(y - expected) <= shader_bound(matrix, bias.values, x))
