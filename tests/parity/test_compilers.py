"""Two compilers' builds of every entry point, run on the same inputs, agree within what either may be off."""

from functools import cache

import numpy as np
import pytest
import shader_compilers
from golden import Golden, read_golden, replay, values_of

from mua.arrays import Array
from mua.gpu import Device, sources
from mua.gpu.compile import spirv
from mua.gpu.reflect import reflect

ALL = read_golden()
OTHERS = [name for name in shader_compilers.SPIRV if name != "glslang" and shader_compilers.find(name)]


def both(described: dict[str, object], found: tuple[dict[str, Array], dict[str, Array]]) -> tuple[Array, Array]:
    first, second = (values_of(described, words[str(described["buffer"])]) for words in found)
    return first, second


@cache  # many cases are of one kernel
def built_by(name: str, kernel: str, entry: str) -> bytes:
    """A kernel as a compiler builds it."""
    compiler = shader_compilers.find(name)
    assert compiler is not None
    return shader_compilers.spirv(compiler, sources.find(kernel), entry)


def test_there_are_two_compilers() -> None:
    assert shader_compilers.find("glslang")
    assert "slang" in OTHERS, "the development requirements bring slangc in the package slangtorch"


@pytest.mark.parametrize("other", OTHERS)
@pytest.mark.parametrize("golden", ALL, ids=str)
def test_builds_agree(device: Device, golden: Golden, other: str) -> None:
    """Whole numbers are equal; each build may be off by the bound of the case, so two differ by twice that at most."""
    entry = golden.case["entry"]
    kernel = device.kernel_of(entry, built_by(other, golden.kernel, entry))
    found = replay(device, golden), replay(device, golden, kernel)
    assert golden.case["expected"]
    for described in golden.case["expected"]:
        first, second = both(described, found)
        bound = 2 * (described["absolute"] + described["relative"] * np.maximum(np.abs(first), np.abs(second)))
        assert np.all(np.abs(first - second) <= bound), f"{described['buffer']} by {other}"


@pytest.mark.parametrize("other", OTHERS)
def test_builds_bind_alike(other: str) -> None:
    kernels = {(golden.kernel, golden.case["entry"]) for golden in ALL}
    assert kernels
    for kernel, entry in kernels:
        first, second = reflect(spirv(sources.find(kernel), entry)), reflect(built_by(other, kernel, entry))
        assert first.threads == second.threads
        assert {(b.name, b.scalar, b.stride) for b in first.buffers} == {
            (b.name, b.scalar, b.stride) for b in second.buffers
        }
        assert [(c.name, c.scalar, c.shape) for c in first.constants] == [
            (c.name, c.scalar, c.shape) for c in second.constants
        ]
