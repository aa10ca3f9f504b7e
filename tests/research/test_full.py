"""Systems of the whole texture: their parts, components and outer products."""

from typing import Any

import numpy as np
import pytest
import torch
from compared_systems import SETTINGS, explained, few, trained
from torch import Tensor

from mua.student.conditioned import Conditioned
from mua.student.local import Locality
from mua.student.regress import regress
from mua.wavelets import synthesise_lowpass
from mua_research import full
from mua_research.full import Basis, LinearMap, finer, lines_to_full
from mua_research.system import Budget, TrainingFrames


@pytest.mark.parametrize("name", ["pca-only", "full-blendshapes", "single-level"])
def test_full_size_systems_are_taught_by_body_part(
    name: str, smooth_frames: TrainingFrames, monkeypatch: pytest.MonkeyPatch
) -> None:
    localities: list[Locality] = []

    def listening(*tensors: Tensor, locality: Locality, **settings: Any) -> Conditioned:
        localities.append(locality)
        return regress(*tensors, locality=locality, **settings)

    monkeypatch.setattr(full, "regress", listening)
    trained(name, few(smooth_frames), Budget(steps=1, batch=4))
    assert len(localities) == (1 if name == "pca-only" else 2)
    for locality in localities:
        energy = locality.shares.diagonal(dim1=1, dim2=2).sum(1)  # energy of the directions, by part
        assert (energy > 0).sum() > 1
        whole = locality.shares.sum(0)[:2, :2]  # the teacher moves two shapes: what lies beyond is rounding
        assert torch.allclose(whole, torch.eye(2), atol=1e-3)


def test_parts_of_the_quarter_image_are_those_of_its_texels(smooth_frames: TrainingFrames) -> None:
    assert smooth_frames.parts is not None
    row, column = torch.meshgrid(torch.arange(8), torch.arange(8), indexing="ij")
    owners = smooth_frames.parts.texel_owners(32 * 4 * row + 4 * column)
    assert torch.equal(finer(smooth_frames.parts.fine, 2), owners)


def test_components_are_those_of_a_full_svd(smooth_frames: TrainingFrames) -> None:
    system = trained("pca-only", smooth_frames, Budget(steps=0))
    (basis,) = system.network.get_submodule("registered").children()
    assert isinstance(basis, Basis)
    truth = smooth_frames.deviations(torch.arange(len(smooth_frames))).flatten(1).double().numpy()
    found = basis.shapes.detach().flatten(1).double().numpy()
    left = truth - truth @ np.linalg.pinv(found) @ found
    expected = np.linalg.svd(truth, compute_uv=False)[SETTINGS.components :]
    bound = np.finfo(np.float32).eps * np.square(truth).sum()  # the Gram matrix is of single precision
    np.testing.assert_allclose(np.square(left).sum(), np.square(expected).sum(), rtol=0, atol=bound)


@pytest.mark.parametrize("name", ["pca-only", "full-blendshapes", "single-level"])
def test_what_the_regression_teaches_is_most_of_the_frames_before_any_step(
    name: str, smooth_frames: TrainingFrames
) -> None:
    assert explained(trained(name, smooth_frames, Budget(steps=0)), smooth_frames) > 0.95


def test_a_linear_map_explains_what_its_cells_can_hold(smooth_frames: TrainingFrames) -> None:
    """The share before any step, and a change of all texels at once, which is one of all cells too."""
    system = trained("linear", smooth_frames, Budget(steps=0))
    assert explained(system, smooth_frames) > 0.5
    network = system.network
    assert isinstance(network, LinearMap)
    shift = torch.arange(23.0)[None, :, None].expand(2, -1, len(network.texels))
    cells = network._cell_means(shift).unflatten(1, (23, -1))
    torch.testing.assert_close(cells[..., network.cells], shift)


def test_closed_forms_look_at_frames_from_all_over(
    smooth_frames: TrainingFrames, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(full, "SAMPLED", 4)
    assert full.sampled(smooth_frames).tolist() == [0, 10, 20, 30]
    assert len(smooth_frames) == 40


@pytest.mark.parametrize("wavelet", ["bior1.1", "bior4.4"])
def test_outer_products_of_the_quarter_image_become_outer_products_of_the_texture(wavelet: str) -> None:
    h, w = torch.randn(2, 3, 2, 8, generator=torch.Generator().manual_seed(2), dtype=torch.double)  # [C, R, n]
    quarter = torch.einsum("cri,crj->crij", h, w)
    full = [lines_to_full(lines, wavelet) for lines in (h, w)]
    expected = synthesise_lowpass(quarter, wavelet, 2)
    torch.testing.assert_close(torch.einsum("cri,crj->crij", *full), expected)
