"""The coarse mesh: PCA against numpy's SVD, and an F_temp that follows the descriptor."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import torch
from synthetic_student import SETTINGS, run_in, samples, student_of

from mua.student.coarse import fit_coarse, mesh_pca, set_pca

FLOAT32 = float(np.finfo(np.float32).eps)


def random_meshes(frames: int, vertices: int, rank: int) -> torch.Tensor:
    generator = torch.Generator().manual_seed(1)
    modes = torch.randn(rank, vertices, 3, generator=generator) / (1 + torch.arange(rank))[:, None, None]
    return torch.tensordot(torch.randn(frames, rank, generator=generator), modes, dims=1) + 1.5


def rebuild(pca_of: torch.Tensor, components: int) -> torch.Tensor:
    pca = mesh_pca(pca_of, components, generator=torch.Generator().manual_seed(0))
    return pca.mean + torch.tensordot(pca.coefficients, pca.basis, dims=1)


def test_pca_leaves_what_numpys_svd_leaves() -> None:
    meshes = random_meshes(40, 13, 9)
    left = float((rebuild(meshes, 5) - meshes).double().square().sum())
    flat = (meshes - meshes.mean(0)).flatten(1).double().numpy()
    best = np.square(np.linalg.svd(flat, compute_uv=False)[5:]).sum()
    assert abs(left - best) < 1e-4 * best


def test_basis_is_orthonormal() -> None:
    basis = mesh_pca(random_meshes(30, 11, 8), 6, generator=torch.Generator().manual_seed(0)).basis.flatten(1)
    assert torch.allclose(basis @ basis.T, torch.eye(6), atol=33 * FLOAT32)


def test_meshes_are_exact_with_more_components_than_frames() -> None:
    meshes = random_meshes(4, 11, 8)
    assert torch.allclose(rebuild(meshes, 9), meshes, atol=100 * FLOAT32)


def test_a_mesh_that_never_moves_has_no_basis() -> None:
    pca = mesh_pca(torch.ones(5, 11, 3), 4, generator=torch.Generator().manual_seed(0))
    assert not pca.basis.any()
    assert not pca.coefficients.any()


def test_coarse_mesh_follows_the_descriptor(tmp_path: Path) -> None:
    data = samples()
    student = student_of(data)
    inputs, components, coarse = student.normalize(data.descriptors), student.components, student.coarse
    longer = replace(SETTINGS, regression=replace(SETTINGS.regression, steps=400))
    meshes, run = data.meshes(torch.arange(len(data))), run_in(tmp_path)
    fit_coarse(coarse, inputs, set_pca(coarse, meshes, run), components=components, settings=longer, run=run)
    error = (student.mesh(data.descriptors) - meshes).square().sum()
    assert error < 0.1 * (meshes - meshes.mean(0)).square().sum()
