"""Stored tensors for the kernels' tests: what is uploaded, and the values that it stands for."""

from typing import NamedTuple

from mua.arrays import Array
from mua.asset.tensors import Element, pack, reals
from mua.gpu.tensor_words import Layout, upload_words

STORAGES: tuple[Element, ...] = ("f32", "f16", "i8")


class Stored(NamedTuple):
    words: Array  # uint32, as uploaded
    layout: Layout
    values: Array  # float64, exactly what the words stand for


def store(values: Array, storage: Element, *, rows: int = 1) -> Stored:
    """Pack `values`; i8 has one scale for each of `rows` equal parts."""
    tensor = pack(values, storage, rows=max(rows, 1))
    return Stored(*upload_words(tensor), reals(tensor, "tensor", values.shape).astype(float))


def groups(*counts: tuple[int, int]) -> tuple[int, int, int]:
    """How many groups cover (items, items for each group) along each axis."""
    x, y, z = (-(-items // each) for items, each in (*counts, (1, 1), (1, 1))[:3])
    return x, y, z
