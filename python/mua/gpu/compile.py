"""HLSL to SPIR-V: compiled in the package, else by a compiler on this machine."""

from functools import lru_cache
from pathlib import Path

from mua.errors import InputError
from mua.gpu import glslang, packaged_spirv, sources

KEPT = 256  # entry points that this process has compiled


def spirv(path: Path, entry: str, *, stage: str = "comp") -> bytes:
    """The SPIR-V of one entry point of a shader: as it comes with the package, or compiled now.

    Raises InputError if a compiler is needed and absent, the file declares no such kernel, or it does not compile.
    """
    texts, options = made_from(path, entry, stage)
    digest = packaged_spirv.digest(texts.values(), options)
    code = packaged_spirv.find(path, options, digest)
    return _compiled_here(path, options, digest) if code is None else code


@lru_cache(KEPT)
def _compiled_here(path: Path, options: tuple[str, ...], digest: str) -> bytes:
    """Compiled once for each content; a process that reads the shader again after an edit asks with another digest."""
    return glslang.compile(path, options)


def made_from(path: Path, entry: str, stage: str) -> tuple[dict[Path, str], tuple[str, ...]]:
    """The texts of a shader and its includes, and (entry, stage, *defines).

    Raises InputError if the file declares no such kernel.
    """
    texts = sources.with_includes(path)
    if stage != "comp":
        return texts, (entry, stage)
    declared = sources.kernels(texts.get(path, ""))
    if entry not in declared:
        raise InputError(f"{path}: has no kernel {entry}; it has {', '.join(declared) or 'none'}")
    return texts, (entry, stage, *declared[entry])
