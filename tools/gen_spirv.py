"""Write python/mua/gpu/spirv, the SPIR-V of every kernel and draw; --check says whether it is up to date."""

import checkout  # noqa: F401
from check_shaders import entry_points
from compiled_folder import CompiledFolder

from mua.gpu import compile, glslang, packaged_spirv


def sources() -> dict[str, str]:
    """The digest of what each file is to be made from."""
    found = {}
    for path, entry, stage in entry_points():
        texts, options = compile.made_from(path, entry, stage)
        found[packaged_spirv.file_name(path, entry, stage)] = packaged_spirv.digest(texts.values(), options)
    return found


def codes() -> dict[str, bytes]:
    """The content of each file, compiled now."""
    found = {}
    for path, entry, stage in entry_points():
        _, options = compile.made_from(path, entry, stage)
        found[packaged_spirv.file_name(path, entry, stage)] = glslang.compile(path, options)
    return found


SPIRV = CompiledFolder("gen_spirv.py", packaged_spirv.FOLDER, ".spv", "glslang", sources, codes)

if __name__ == "__main__":
    SPIRV.run(__doc__)
