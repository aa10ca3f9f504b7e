"""The trained student as an avatar: the numpy arrays that a `.muaavatar` file holds."""

from dataclasses import replace

import numpy as np
import torch
from torch import Tensor

from mua.arrays import Array
from mua.avatar import model
from mua.channels import APPEARANCE, GEOMETRY
from mua.pose.encoding import Components, Normalization
from mua.student.model import Branch, Coarse, Detail, Student, linear_layers

LARGEST_ROW = 1024.0  # limit of a last layer's weights: larger ones are exchanged for larger blendshapes


def export_components(student: Student) -> Components:
    normalization = Normalization(_array(student.mean), _array(student.scale))
    return Components(normalization, _array(student.directions), _array(student.ranges), _array(student.margins))


def export_coarse(coarse: Coarse) -> model.Coarse:
    return model.Coarse(_mlp(coarse.mlp), _array(coarse.mean), _array(coarse.basis))


def export_branches(student: Student) -> tuple[model.Branch, model.Branch]:
    """Geometry and appearance with their share of the static offset."""
    return _branch(student.geometry, student.static[GEOMETRY]), _branch(student.appearance, student.static[APPEARANCE])


def _branch(branch: Branch, static: Tensor) -> model.Branch:
    return within_range(
        model.Branch(
            mlp=_mlp(branch.mlp),
            ll_mean=_array(branch.ll_mean),
            ll_basis=_array(branch.ll_basis),
            details=(_detail(branch.d3), _detail(branch.d2)),
            static=_array(static),
        )
    )


def within_range(branch: model.Branch) -> model.Branch:
    """An equal function with no large number in the last layer.

    A blendshape times its coefficient is what counts: powers of two go from rows of the layer to blendshapes.
    """
    *hidden, last = branch.mlp
    row = np.maximum(np.abs(last.weight).max(axis=1), np.abs(last.bias)) / LARGEST_ROW
    powers = np.ceil(np.log2(np.maximum(row, 1))).astype(int)  # [M]
    if not powers.any():
        return branch
    layer = model.Layer(np.ldexp(last.weight, -powers[:, None]), np.ldexp(last.bias, -powers))
    sizes = np.cumsum([branch.channels * rank for rank in branch.ranks])[:-1]
    ll, *levels = (part.reshape(branch.channels, -1) for part in np.split(powers, sizes))
    details = tuple(_raised(band, own) for band, own in zip(branch.details, levels, strict=True))
    basis = np.ldexp(branch.ll_basis, ll[:, :, None, None])
    return replace(branch, mlp=(*hidden, layer), ll_basis=basis, details=details)


def _raised(
    band: model.DetailBand,
    powers: Array,  # [C, R]
) -> model.DetailBand:
    """Blendshapes times powers of two, shared by rows and columns."""
    half = powers // 2
    return replace(band, h=np.ldexp(band.h, (powers - half)[:, :, None]), w=np.ldexp(band.w, half[:, :, None]))


def _detail(detail: Detail) -> model.DetailBand:
    return model.DetailBand(_array(detail.mean), _array(detail.h), _array(detail.w))


def _mlp(mlp: torch.nn.Module) -> model.Mlp:
    return tuple(model.Layer(_array(layer.weight), _array(layer.bias)) for layer in linear_layers(mlp))


def _array(tensor: Tensor) -> Array:
    return tensor.detach().cpu().contiguous().numpy().copy()
