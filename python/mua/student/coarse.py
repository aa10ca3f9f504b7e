"""The coarse mesh: PCA of the teacher's canonical meshes and F_temp (paper, Animatable Coarse Geometry)."""

from dataclasses import dataclass

import torch
from torch import Tensor

from mua.student.components import Components
from mua.student.factorize import frame_weights, truncated_svd
from mua.student.local import Parts, sample_locality
from mua.student.model import Coarse
from mua.student.regress import MESH, SWUNG_MESH, regress
from mua.student.settings import Settings
from mua.training.optimise import Run


@dataclass(frozen=True, eq=False)
class MeshPca:
    """meshes = mean + coefficients @ basis; the basis is orthonormal, coefficients are metres."""

    mean: Tensor  # [V, 3]
    basis: Tensor  # [K, V, 3], zero beyond the rank of the meshes
    coefficients: Tensor  # [F, K]


def mesh_pca(
    meshes: Tensor,  # [F, V, 3] canonical vertices, metres
    components: int,
    *,
    generator: torch.Generator,
    weights: Tensor | None = None,  # [F] how much each frame counts
) -> MeshPca:
    """The leading principal components of canonical meshes; where frames or vertices are too few, the rest is zero."""
    counts = frame_weights(meshes, weights)
    mean = torch.einsum("f,fva->va", counts, meshes) / len(meshes)
    roots = counts.sqrt()[:, None]
    flat = (meshes - mean).flatten(1).mul_(roots)  # in place, because meshes may take hundreds of megabytes
    _, s, v = truncated_svd(flat, components, generator=generator)
    v = v * (s > torch.finfo(s.dtype).eps * max(flat.shape) * s.max())[:, None]  # directions without motion are noise
    basis = torch.nn.functional.pad(v, (0, 0, 0, components - len(v)))
    return MeshPca(mean, basis.unflatten(1, meshes.shape[1:]), flat @ basis.T / roots)


def set_pca(coarse: Coarse, meshes: Tensor, run: Run, weights: Tensor | None = None) -> MeshPca:
    """Set mean and basis of `coarse` from meshes [F, V, 3], metres, equal in all processes; returns the PCA."""
    pca = MeshPca(
        **run.once(
            "coarse components",
            lambda: vars(mesh_pca(meshes, len(coarse.basis), generator=run.generator, weights=weights)),
        )
    )
    coarse.mean.copy_(pca.mean)
    coarse.basis.copy_(pca.basis)
    return pca


def fit_coarse(
    coarse: Coarse,
    inputs: Tensor,  # [F, D] normalised descriptors
    pca: MeshPca,  # that `set_pca` has set
    *,
    components: Components,
    settings: Settings,
    run: Run,
    parts: Parts | None = None,
    weights: Tensor | None = None,  # [F] how much each frame counts
) -> None:
    """Fit F_temp of `coarse` to the coefficients of its PCA (paper, Animatable Coarse Geometry)."""
    fade = settings.generalisation.fade
    mlp = regress(
        inputs,
        pca.coefficients,
        components=components,
        locality=None if parts is None else sample_locality(parts, pca.basis, parts.vertices, fade=fade),
        hidden=settings.hidden,
        schedule=settings.regression,
        stage="coarse mesh",
        run=run,
        own=None if weights is None else weights == 1,
        fit=MESH if settings.generalisation.own else SWUNG_MESH,
        generalisation=settings.generalisation,
    )
    coarse.mlp.load_state_dict(mlp.folded().state_dict())
