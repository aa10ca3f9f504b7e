"""Packs the compute shaders, which lie beside this project, into a wheel; all else is in pyproject.toml."""

import shutil
from pathlib import Path

from setuptools import setup
from setuptools.command.build_py import build_py

SHADERS = Path(__file__).resolve().parents[1] / "ComputeShaders"


class BuildWithShaders(build_py):
    """An editable install finds the shaders in the checkout; a wheel carries them as mua/shaders."""

    def run(self) -> None:
        super().run()
        if self.editable_mode:
            return
        shaders = [*SHADERS.glob("*.compute"), *SHADERS.glob("*.hlsl")]
        if not shaders:
            raise FileNotFoundError(f"{SHADERS}: no shaders to pack; build from a checkout")
        packed = Path(self.build_lib) / "mua" / "shaders"
        packed.mkdir(parents=True, exist_ok=True)
        for shader in shaders:
            shutil.copy2(shader, packed)


setup(cmdclass={"build_py": BuildWithShaders})
