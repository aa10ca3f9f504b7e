"""A shader's named constants: packed into the bytes of its constant buffer, and on their way to the device."""

import struct
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import wgpu

from mua.errors import InputError
from mua.gpu.reflect import Constant

FORMATS = {"uint": "<I", "int": "<i", "float": "<f"}
DTYPES = {"uint": "<u4", "int": "<i4", "float": "<f4"}
KINDS = {"uint": "biu", "int": "biu", "float": "biuf"}  # kinds of numpy values that each type of constant takes
ALIGNMENT = 256  # bytes; no device asks for more between the constants of two dispatches
CAPACITY = 1 << 20  # bytes: several thousand dispatches may wait for one submit


def block_size(constants: tuple[Constant, ...]) -> int:
    """Bytes of a constant buffer: a multiple of 16, as devices require."""
    return -(-max(constant.offset + constant.size for constant in constants) // 16) * 16


def pack(label: str, constants: Mapping[str, Constant], size: int, values: Mapping[str, Any]) -> bytes:
    """The constant buffer filled from `values`; an error for a wrong type or shape begins with `label`."""
    block = bytearray(size)
    for name, value in values.items():
        constant = constants.get(name)
        if constant is None:
            continue
        if constant.shape:
            _put_array(label, constant, block, value)
            continue
        try:
            struct.pack_into(FORMATS[constant.scalar], block, constant.offset, value)
        except (struct.error, OverflowError, TypeError) as error:
            raise InputError(f"{label}: constant {name} is {value!r}, expected one {constant.scalar}") from error
    return bytes(block)


def _put_array(label: str, constant: Constant, block: bytearray, value: Any) -> None:
    array = np.asarray(value)
    dtype = np.dtype(DTYPES[constant.scalar])
    expected = f"expected {constant.scalar} {list(constant.shape)}"
    if array.shape != constant.shape or array.dtype.kind not in KINDS[constant.scalar]:
        raise InputError(f"{label}: constant {constant.name} is {array.dtype} {list(array.shape)}, {expected}")
    if dtype.kind in "iu" and array.size and not np.can_cast(array.dtype, dtype):
        limits = np.iinfo(dtype)
        if array.min() < limits.min or array.max() > limits.max:
            raise InputError(f"{label}: constant {constant.name} is {array.tolist()}, {expected}")
    memory = np.ndarray(constant.shape, dtype, block, constant.offset, constant.strides)
    memory[...] = array


class Uniforms:
    """A ring of constants: a value stays until CAPACITY more bytes are placed, long after its submit."""

    def __init__(self, device: wgpu.GPUDevice) -> None:
        usage = wgpu.BufferUsage.UNIFORM | wgpu.BufferUsage.COPY_DST
        self.raw = device.create_buffer(label="constants", size=CAPACITY, usage=usage)
        self._queue = device.queue
        self._next = 0

    def place(self, blocks: Sequence[bytes]) -> list[int]:
        """Upload constants in one write and return the offset of each, in bytes."""
        padded = [block.ljust(-(-len(block) // ALIGNMENT) * ALIGNMENT, b"\0") for block in blocks]
        total = sum(map(len, padded))
        if total > CAPACITY:
            raise InputError(f"constants: {total} bytes for one submit are more than {CAPACITY}; submit in parts")
        if self._next + total > CAPACITY:
            self._next = 0
        offsets = []
        start = self._next
        for block in padded:
            offsets.append(self._next)
            self._next += len(block)
        if total:
            self._queue.write_buffer(self.raw, start, b"".join(padded))
        return offsets
