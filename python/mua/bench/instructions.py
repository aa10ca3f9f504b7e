"""Instructions of a compiled shader, counted in its SPIR-V: one for each component that is computed.

Loads, stores and moves are not counted; each function is taken to be called once, and no branch is taken into account.
"""

import numpy as np

from mua.gpu import compile, sources
from mua.gpu.reflect import HEADER_WORDS, OP_VECTOR
from mua.player.draw import SHADER

# Opcodes and instructions of GLSL.std.450: SPIR-V specification 1.6, section 3.49.13, and its extended instructions.
OP_EXTENDED, OP_FIRST_ARITHMETIC, OP_DIVIDE, OP_DOT, OP_LAST_ARITHMETIC = 12, 126, 136, 148, 152
SLOW_EXTENDED = frozenset({*range(13, 33)})  # sines to roots, exponentials and logarithms among them
SLOW = 4  # instructions for one of those or a division: GPUs have a quarter as many units for them


def fragment_instructions() -> int:
    """Instructions of the player's compiled fragment shader of a splat."""
    return count_instructions(compile.spirv(sources.find(SHADER), "SplatFrag", stage="frag"))


def count_instructions(code: bytes) -> int:
    words = np.frombuffer(code, "<u4").tolist()
    components: dict[int, int] = {}  # by type
    types: dict[int, int] = {}  # by result
    total, at = 0, HEADER_WORDS
    while at < len(words):
        opcode, length = words[at] & 0xFFFF, words[at] >> 16
        operands = words[at + 1 : at + length]
        if opcode == OP_VECTOR:
            components[operands[0]] = operands[2]
        elif len(operands) > 1:
            types[operands[1]] = operands[0]
            wide = components.get(types.get(operands[2], 0) if opcode == OP_DOT else operands[0], 1)
            total += wide * _weight(opcode, operands)
        at += length
    return total


def _weight(opcode: int, operands: list[int]) -> int:
    """Instructions for one component; 0 for opcodes that compute nothing."""
    if opcode == OP_EXTENDED:
        return SLOW if operands[3] in SLOW_EXTENDED else 1
    if OP_FIRST_ARITHMETIC <= opcode <= OP_LAST_ARITHMETIC:
        return SLOW if opcode == OP_DIVIDE else 1
    return 0
