"""The interface of a compiled entry point, by name, read off its SPIR-V."""

from collections import defaultdict
from dataclasses import dataclass, field

import numpy as np

from mua.errors import InputError

MAGIC = 0x07230203
HEADER_WORDS = 5

# Opcodes, decorations and storage classes: SPIR-V specification 1.6, sections 3.49, 3.20 and 3.7.
OP_NAME, OP_MEMBER_NAME, OP_EXECUTION_MODE = 5, 6, 16
OP_INT, OP_FLOAT, OP_VECTOR, OP_MATRIX, OP_ARRAY, OP_RUNTIME_ARRAY, OP_STRUCT, OP_POINTER = (
    21,
    22,
    23,
    24,
    28,
    29,
    30,
    32,
)
OP_CONSTANT, OP_VARIABLE, OP_LOAD, OP_ACCESS_CHAIN, OP_IN_BOUNDS_ACCESS_CHAIN = 43, 59, 61, 65, 66
OP_DECORATE, OP_MEMBER_DECORATE = 71, 72
BUFFER_BLOCK, ROW_MAJOR, ARRAY_STRIDE, MATRIX_STRIDE, NON_WRITABLE, BINDING, OFFSET = 3, 4, 6, 7, 24, 33, 35
UNIFORM, STORAGE_BUFFER = 2, 12
LOCAL_SIZE = 17


@dataclass(frozen=True)
class BufferSlot:
    """A buffer that the code uses."""

    name: str
    binding: int
    read_only: bool
    scalar: str  # uint, int or float
    stride: int  # bytes of one element


@dataclass(frozen=True)
class Constant:
    """A member of the constant buffer; `strides` are in bytes, one for each axis of `shape`, rows before columns."""

    name: str
    offset: int
    scalar: str  # uint, int or float
    shape: tuple[int, ...]
    strides: tuple[int, ...]
    used: bool  # whether this entry point reads it

    @property
    def size(self) -> int:
        return 4 + sum((n - 1) * stride for n, stride in zip(self.shape, self.strides, strict=True))


@dataclass(frozen=True)
class Interface:
    """Everything that one entry point binds."""

    buffers: tuple[BufferSlot, ...]  # by binding
    constants: tuple[Constant, ...]  # by offset
    constants_binding: int | None  # None if it has no constant buffer
    threads: tuple[int, int, int]  # threads of a group; ones if it is no compute shader


@dataclass
class _Module:
    """The instructions that describe types and bindings, by the id that they are about."""

    names: dict[int, str] = field(default_factory=dict)
    member_names: dict[tuple[int, int], str] = field(default_factory=dict)
    decorations: dict[int, dict[int, int]] = field(default_factory=lambda: defaultdict(dict))
    member_decorations: dict[tuple[int, int], dict[int, int]] = field(default_factory=lambda: defaultdict(dict))
    types: dict[int, tuple[int, list[int]]] = field(default_factory=dict)  # opcode and operands
    values: dict[int, int] = field(default_factory=dict)
    variables: dict[int, tuple[int, int]] = field(default_factory=dict)  # pointer type and storage class
    threads: tuple[int, int, int] = (1, 1, 1)
    members_used: dict[int, set[int]] = field(default_factory=lambda: defaultdict(set))  # by variable
    whole_used: set[int] = field(default_factory=set)


def reflect(code: bytes) -> Interface:
    """Read the interface of SPIR-V code that holds one entry point; InputError if it is no SPIR-V."""
    words = np.frombuffer(code[: len(code) // 4 * 4], "<u4").tolist()
    if len(words) < HEADER_WORDS or words[0] != MAGIC:
        raise InputError("compiled shader: not SPIR-V")
    module = _Module()
    at = HEADER_WORDS
    while at < len(words):
        length = words[at] >> 16
        if length == 0 or at + length > len(words):
            raise InputError(f"compiled shader: SPIR-V is cut off at word {at}")
        _take(module, words[at] & 0xFFFF, words[at + 1 : at + length])
        at += length
    return _interface(module)


def _take(module: _Module, opcode: int, operands: list[int]) -> None:
    """Take in one instruction; instructions unrelated to types and bindings are skipped."""
    if opcode == OP_NAME:
        module.names[operands[0]] = _text(operands[1:])
    elif opcode == OP_MEMBER_NAME:
        module.member_names[operands[0], operands[1]] = _text(operands[2:])
    elif opcode == OP_EXECUTION_MODE and operands[1] == LOCAL_SIZE:
        module.threads = (operands[2], operands[3], operands[4])
    elif opcode == OP_DECORATE:
        module.decorations[operands[0]][operands[1]] = operands[2] if len(operands) > 2 else 1
    elif opcode == OP_MEMBER_DECORATE:
        module.member_decorations[operands[0], operands[1]][operands[2]] = operands[3] if len(operands) > 3 else 1
    elif OP_INT <= opcode <= OP_POINTER:
        module.types[operands[0]] = opcode, operands[1:]
    elif opcode == OP_CONSTANT:
        module.values[operands[1]] = operands[2]
    elif opcode == OP_VARIABLE:
        module.variables[operands[1]] = operands[0], operands[2]
    elif opcode in (OP_ACCESS_CHAIN, OP_IN_BOUNDS_ACCESS_CHAIN) and len(operands) > 3:
        if operands[2] in module.variables and operands[3] in module.values:
            module.members_used[operands[2]].add(module.values[operands[3]])
    elif opcode == OP_LOAD and operands[2] in module.variables:
        module.whole_used.add(operands[2])


def _text(words: list[int]) -> str:
    return np.array(words, "<u4").tobytes().split(b"\0")[0].decode()


def _interface(module: _Module) -> Interface:
    buffers: list[BufferSlot] = []
    constants: tuple[Constant, ...] = ()
    binding = None
    for variable, (pointer, storage) in module.variables.items():
        if storage not in (UNIFORM, STORAGE_BUFFER) or BINDING not in module.decorations[variable]:
            continue
        struct = module.types[pointer][1][1]
        if storage == STORAGE_BUFFER or BUFFER_BLOCK in module.decorations[struct]:
            buffers.append(_buffer(module, variable, struct))
            continue
        if binding is not None:
            raise InputError("compiled shader: more than one constant buffer, expected one named Constants")
        binding = module.decorations[variable][BINDING]
        constants = _constants(module, variable, struct)
    buffers.sort(key=lambda slot: slot.binding)
    return Interface(tuple(buffers), constants, binding, module.threads)


def _buffer(module: _Module, variable: int, struct: int) -> BufferSlot:
    own, array = module.decorations[variable], module.types[struct][1][0]
    read_only = NON_WRITABLE in own or NON_WRITABLE in module.member_decorations[struct, 0]
    scalar, _ = _element(module, module.types[array][1][0])
    stride = module.decorations[array][ARRAY_STRIDE]
    return BufferSlot(module.names[variable], own[BINDING], read_only, scalar, stride)


def _element(module: _Module, of: int) -> tuple[str, list[int]]:
    """The scalar under a type, and the lengths of the arrays, matrix columns and vectors around it."""
    opcode, operands = module.types[of]
    if opcode == OP_INT:
        return ("int" if operands[1] else "uint"), []
    if opcode == OP_FLOAT:
        return "float", []
    inner = operands[0]
    scalar, lengths = _element(module, inner)
    if opcode in (OP_VECTOR, OP_MATRIX):
        return scalar, [operands[1], *lengths]
    if opcode == OP_ARRAY:
        return scalar, [module.values[operands[1]], *lengths]
    return scalar, lengths  # a struct is its first member: enough for a buffer's kind of scalar


def _constants(module: _Module, variable: int, struct: int) -> tuple[Constant, ...]:
    found = []
    for index, member in enumerate(module.types[struct][1]):
        decorations = module.member_decorations[struct, index]
        scalar, shape = _element(module, member)
        used = variable in module.whole_used or index in module.members_used[variable]
        name, strides = module.member_names[struct, index], _strides(module, member, decorations)
        found.append(Constant(name, decorations[OFFSET], scalar, tuple(shape), strides, used))
    return tuple(sorted(found, key=lambda constant: constant.offset))


def _strides(module: _Module, of: int, decorations: dict[int, int]) -> tuple[int, ...]:
    """Bytes from one value to the next along each axis.

    A row of an HLSL matrix is a column in SPIR-V, so HLSL's column_major memory is decorated RowMajor.
    """
    opcode, operands = module.types[of]
    if opcode == OP_ARRAY:
        return (module.decorations[of][ARRAY_STRIDE], *_strides(module, operands[0], decorations))
    if opcode == OP_STRUCT:  # slangc wraps arrays in a struct
        return _strides(module, operands[0], module.member_decorations[of, 0])
    if opcode == OP_MATRIX:
        stride = decorations[MATRIX_STRIDE]
        return (4, stride) if ROW_MAJOR in decorations else (stride, 4)
    return (4,) if opcode == OP_VECTOR else ()
