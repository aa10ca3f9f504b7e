"""Changes slangc's SPIR-V so that wgpu accepts it and keeps its meaning."""

import numpy as np

# slangc makes these two intrinsics of 16-bit integers, which wgpu refuses. What follows is what other compilers emit.
PRELUDE = """\
float halfToFloat(uint bits) { return unpackHalf2x16ToFloat(bits).x; }
uint floatToHalf(float value) { return packHalf2x16(float2(value, 0)); }
#define f16tof32 halfToFloat
#define f32tof16 floatToHalf
"""

# SPIR-V specification 1.6, section 3.49.17
OP_SELECTION_MERGE, OP_BRANCH, OP_SWITCH = 247, 249, 251
HEADER_WORDS = 5
LONE_SWITCH_WORDS = 3  # opcode, selector, default


def without_lone_switches(code: bytes) -> bytes:
    """The code with every switch that has a default and no case replaced by a branch.

    slangc wraps the body of a loop in one; wgpu takes the loop's end, a branch out of both, for one out of the switch.
    """
    words = np.frombuffer(code, "<u4").tolist()
    kept, at = words[:HEADER_WORDS], HEADER_WORDS
    while at < len(words):
        length = words[at] >> 16
        if _is(words, at, OP_SELECTION_MERGE) and _is(words, at + length, OP_SWITCH, LONE_SWITCH_WORDS):
            at += length
            kept += [2 << 16 | OP_BRANCH, words[at + 2]]
            length = LONE_SWITCH_WORDS
        else:
            kept += words[at : at + length]
        at += length
    return np.array(kept, "<u4").tobytes()


def _is(words: list[int], at: int, opcode: int, length: int | None = None) -> bool:
    return words[at] & 0xFFFF == opcode and length in (None, words[at] >> 16)
