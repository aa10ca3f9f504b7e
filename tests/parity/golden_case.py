"""A golden case: what one dispatch is given and what it must leave behind."""

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

import numpy as np
from packed_splats import LEAST_NORMAL_HALF, MANTISSA_BITS

from mua.arrays import Array

Kind = Literal["uint", "float", "half"]
UNTOUCHED = np.float32(-7)  # what stands in a buffer of floats before the dispatch
UNWRITTEN = np.uint32(0xFFFFFFFF)  # and in one of words


@dataclass(frozen=True)
class Expected:
    """What stands in `length` of every `period` words of a buffer, from word `first` on.

    A value may differ by absolute + relative |value|; of a half there are two values to a word, the low one first.
    """

    buffer: str
    kind: Kind
    values: Array
    absolute: float = 0.0
    relative: float = 0.0
    first: int = 0
    length: int = 1
    period: int = 1


@dataclass(frozen=True)
class Case:
    name: str
    entry: str
    groups: tuple[int, int, int]
    constants: Mapping[str, int | float | tuple[int, ...] | Array]
    buffers: Mapping[str, Array]  # as they are before the dispatch
    expected: tuple[Expected, ...]


def halves(buffer: str, values: Array, bound: float, *, first: int = 0, length: int = 1, period: int = 1) -> Expected:
    """Half floats within a bound of the float32 that they are made from: rounded either way, subnormals flushed."""
    step = 2.0**-MANTISSA_BITS
    return Expected(buffer, "half", values, bound * (1 + step) + LEAST_NORMAL_HALF, step, first, length, period)
