"""The exported avatar, evaluated in numpy, is the student."""

import numpy as np
import torch
from synthetic_student import INPUTS, bands_of_frames, random_student

from mua.arrays import Array
from mua.avatar import model
from mua.pose.components import read_components
from mua.student.export import LARGEST_ROW, export_branches, export_coarse, export_components
from mua.student.model import linear_layers

RELATIVE = 1e-5  # the project's bound for a float32 asset against the torch student


def numpy_mlp(mlp: model.Mlp, x: Array) -> Array:
    for i, layer in enumerate(mlp):
        x = x @ layer.weight.T.astype(float) + layer.bias
        x = np.maximum(x, 0) if i < len(mlp) - 1 else x
    return x


def numpy_bands(branch: model.Branch, x: Array) -> list[Array]:
    """LL [F, C, n, n] and the detail bands [F, 3, C, n, n], coarse first, in double precision."""
    flat = numpy_mlp(branch.mlp, x)
    sizes = np.cumsum([branch.channels * rank for rank in branch.ranks])
    alphas = [part.reshape(len(x), branch.channels, -1) for part in np.split(flat, sizes[:-1], axis=1)]
    bands = [branch.ll_mean + np.einsum("fcr,crij->fcij", alphas[0], branch.ll_basis)]
    for alpha, band in zip(alphas[1:], branch.details, strict=True):
        bands.append(band.mean + np.einsum("fcr,scri,scrj->fscij", alpha, band.h, band.w))
    return bands


def assert_close(found: Array, expected: torch.Tensor) -> None:
    assert np.abs(found - expected.numpy()).max() < RELATIVE * float(expected.abs().max())


def test_subbands_of_the_avatar_are_the_students() -> None:
    student = random_student()
    descriptors, _ = bands_of_frames(5)
    x = read_components(export_components(student), descriptors.double().numpy())[0]
    assert len(student.branches) == 2
    for exported, branch in zip(export_branches(student), student.branches, strict=True):
        expected = branch(student.read(descriptors))
        for found, band in zip(numpy_bands(exported, x), expected, strict=True):
            assert_close(found, band)


def test_rows_that_half_precision_cannot_hold_are_exchanged_for_larger_blendshapes() -> None:
    """Their product stays equal to the last bit, because the factors are powers of two."""
    student = random_student()
    branch = student.appearance
    grown = torch.tensor([1.0, 3e4, 7e6, 0.2])[torch.arange(branch.channels * branch.ranks.total) % 4]
    last = linear_layers(branch.mlp)[-1]
    before = numpy_bands(export_branches(student)[1], np.eye(INPUTS))
    last.weight.mul_(grown[:, None])
    last.bias.mul_(grown)
    ll, d3, d2 = (part[0] for part in branch.split(grown[None]))
    branch.ll_basis.div_(ll[:, :, None, None])
    branch.d3.h.div_(d3[:, :, None])
    branch.d2.w.div_(d2[:, :, None])
    exported = export_branches(student)[1]
    layer = exported.mlp[-1]
    assert max(np.abs(layer.weight).max(), np.abs(layer.bias).max()) <= LARGEST_ROW
    assert layer.weight.dtype == np.float32
    assert exported.ll_basis.dtype == exported.details[0].h.dtype == np.float32
    for found, expected in zip(numpy_bands(exported, np.eye(INPUTS)), before, strict=True):
        assert_close(found, torch.from_numpy(expected))


def test_a_last_layer_within_range_stays_as_it_is() -> None:
    student = random_student()
    exported, _ = export_branches(student)
    assert np.array_equal(exported.mlp[-1].weight, linear_layers(student.geometry.mlp)[-1].weight.numpy())


def test_mesh_of_the_avatar_is_the_students() -> None:
    student = random_student()
    x = torch.randn(4, INPUTS, generator=torch.Generator().manual_seed(0))
    coarse = export_coarse(student.coarse)
    found = coarse.mean + np.tensordot(numpy_mlp(coarse.mlp, x.double().numpy()), coarse.basis, axes=1)
    assert_close(found, student.coarse(x))


def test_arrays_do_not_share_memory_with_the_student() -> None:
    student = random_student()
    exported, _ = export_branches(student)
    before = exported.ll_mean.copy()
    student.geometry.ll_mean.zero_()
    assert np.array_equal(exported.ll_mean, before)
