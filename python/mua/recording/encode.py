"""The encoding of a texture: its difference from the reference frame, and the dynamic subbands of that."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import torch

from mua import wavelets
from mua.arrays import Array
from mua.channels import ATTRIBUTES, CHANNELS
from mua.errors import InputError
from mua.files.npz import read_npz
from mua.files.write import replacing
from mua.recording.layout import Header
from mua.texture.fill import Fill


@dataclass(frozen=True, eq=False)
class Dynamic:
    """The subbands that vary with the frame; detail bands in the order of pywt's (cH, cV, cD)."""

    ll: Array  # [C, n, n]
    d3: Array  # [3, C, n, n]
    d2: Array  # [3, C, 2n, 2n]

    def half(self) -> "Dynamic":
        return Dynamic(self.ll.astype(np.float16), self.d3.astype(np.float16), self.d2.astype(np.float16))

    @property
    def peak(self) -> float:
        return float(max(np.abs(band).max() for band in (self.ll, self.d3, self.d2)))


@dataclass(frozen=True, eq=False)
class Reference:
    """The frame that all others are stored relative to, and the hemisphere that their rotations are brought to."""

    texture: Array  # [N, 23] float32
    subbands: Dynamic  # float32


def filled_subbands(
    texture: Array,  # [N, C] float32 at the valid texels
    fill: Fill,
    *,
    wavelet: str,
) -> Dynamic:
    """The subbands that vary with the frame, of a texture whose empty texels are filled."""
    return Dynamic(*(band.numpy() for band in wavelets.dynamic_subbands(fill(torch.from_numpy(texture)), wavelet)))


def align_rotations(
    texture: Array,  # [N, 23]
    reference: Array,  # [N, 23]
) -> Array:
    """A copy whose raw quaternions lie in the hemisphere of the reference's; q and -q are one rotation."""
    rotation = ATTRIBUTES["rotation"]
    aligned = texture.copy(order="K")  # teachers give a plane for each channel: turned round it takes 20 times as long
    turned = np.einsum("nc,nc->n", texture[:, rotation], reference[:, rotation]) < 0
    aligned[turned, rotation] *= -1
    return aligned


def save_reference(path: Path, reference: Reference) -> None:
    with replacing(path) as temporary:
        np.savez(temporary, texture=np.ascontiguousarray(reference.texture), **vars(reference.subbands))


def load_reference(path: Path, header: Header) -> Reference:
    """Load a reference. Raises InputError for a file that is missing, damaged or of other sizes."""
    shapes = {name: shape[1:] for name, (shape, _) in header.shapes(0, 1).items() if name in ("ll", "d3", "d2")}
    shapes["texture"] = (header.valid_texels, CHANNELS)
    arrays = read_npz(path, shapes)
    for name, shape in shapes.items():
        if arrays[name].shape != shape:
            raise InputError(f"{path}: {name} has shape {arrays[name].shape}, expected {shape}")
        if not np.isfinite(arrays[name]).all():
            raise InputError(f"{path}: {name} holds a value that is no number, expected finite ones")
    return Reference(arrays.pop("texture"), Dynamic(**arrays))
