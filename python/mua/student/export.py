"""The trained student as an avatar: the numpy arrays that a `.muaavatar` file holds."""

import numpy as np
import torch
from torch import Tensor

from mua import model
from mua.arrays import Array
from mua.motion.encoding import Normalization
from mua.student.model import Branch, Coarse, Detail, Student, linear_layers
from mua.texture.channels import APPEARANCE, GEOMETRY
from mua.wavelets import filters

LEVELS = 4


def export_wavelet(student: Student) -> model.Wavelet:
    """The synthesis filters of the student's wavelet."""
    bank = filters(student.wavelet)
    return model.Wavelet(student.wavelet, LEVELS, np.asarray(bank.rec_lo), np.asarray(bank.rec_hi))


def export_normalization(student: Student) -> Normalization:
    return Normalization(_array(student.mean), _array(student.scale))


def export_coarse(coarse: Coarse) -> model.Coarse:
    return model.Coarse(_mlp(coarse.mlp), _array(coarse.mean), _array(coarse.basis))


def export_branches(student: Student) -> tuple[model.Branch, model.Branch]:
    """Geometry and appearance with their share of the static offset."""
    return _branch(student.geometry, student.static[GEOMETRY]), _branch(student.appearance, student.static[APPEARANCE])


def _branch(branch: Branch, static: Tensor) -> model.Branch:
    return model.Branch(
        mlp=_mlp(branch.mlp),
        ll_mean=_array(branch.ll_mean),
        ll_basis=_array(branch.ll_basis),
        details=(_detail(branch.d3), _detail(branch.d2)),
        static=_array(static),
    )


def _detail(detail: Detail) -> model.DetailBand:
    return model.DetailBand(_array(detail.mean), _array(detail.h), _array(detail.w))


def _mlp(mlp: torch.nn.Module) -> model.Mlp:
    return tuple(model.Layer(_array(layer.weight), _array(layer.bias)) for layer in linear_layers(mlp))


def _array(tensor: Tensor) -> Array:
    return tensor.detach().cpu().contiguous().numpy().copy()
