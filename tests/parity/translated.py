"""Runs what the package has for browsers in place of the SPIR-V: the same callers, kernels by the same names."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import gen_wgsl
import pytest
from wgsl_compile import Shader

from mua.gpu import Device, Kernel, compile, draw, kernel

SHADERS = gen_wgsl.read()


def kernel_of(device: Device, shader: Shader) -> Kernel:
    """A kernel of WGSL, which says nothing on its interface: that comes beside it."""
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(kernel, "reflect", lambda _: shader.interface)
        return device.kernel_of(shader.entry, shader.code)  # type: ignore[arg-type]


def use(patch: pytest.MonkeyPatch, shaders: Mapping[tuple[str, str], Shader] = SHADERS) -> None:
    """Every kernel and pipeline made from here on is of WGSL."""
    interfaces = {shader.code: shader.interface for shader in shaders.values()}

    def code(path: Path, entry: str, *, stage: str = "comp") -> Any:
        return shaders[path.stem, entry].code

    patch.setattr(compile, "spirv", code)
    patch.setattr(kernel, "reflect", interfaces.__getitem__)
    patch.setattr(draw, "reflect", interfaces.__getitem__)
