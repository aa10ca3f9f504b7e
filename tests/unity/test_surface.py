"""The package's surfaces: the texel grid that mono builds is the desktop player's."""

import os
from pathlib import Path

import numpy as np
import pytest
from csharp import PROGRAMS, ROOT, RUNTIME, CSharp

from mua.arrays import Array
from mua.asset import read
from mua.player.surface import build_surface

GRID = [RUNTIME / f"{name}.cs" for name in ("TexelGrid", "TexelRest", "TexelCharts", "TexelSeams", "TexelHoles")]
ASSET = os.environ.get("MUA_TEST_AVATAR", "")  # a real avatar file


@pytest.fixture(scope="module")
def grid_program(csharp: CSharp) -> Path:
    file = csharp.build([RUNTIME / "Format"], library=True)
    return csharp.build([*GRID, PROGRAMS / "SurfaceProgram.cs"], references=[file])


def arrays(path: Path) -> list[Array]:
    """Int32 arrays, each after its length."""
    words, found = np.fromfile(path, np.int32), list[Array]()
    while len(words):
        found.append(words[1 : 1 + words[0]])
        words = words[1 + words[0] :]
    return found


def check_grid(csharp: CSharp, program: Path, file: Path, target: Path) -> None:
    rig = read(file).rig
    surface = build_surface(rig.mesh, rig.texels)
    csharp.run(program, file, target)
    for found, exact in zip(arrays(target), (surface.triangles, surface.ring_starts, surface.ring), strict=True):
        np.testing.assert_array_equal(found, exact.ravel().astype(np.int32))


def test_the_grid_of_the_golden_file_is_the_desktop_players(csharp: CSharp, grid_program: Path, tmp_path: Path) -> None:
    check_grid(csharp, grid_program, ROOT / "tests" / "golden" / "synthetic.muaavatar", tmp_path / "grid")


@pytest.mark.skipif(not ASSET, reason="set MUA_TEST_AVATAR to an avatar file")
def test_the_grid_of_a_real_avatar_is_the_desktop_players(csharp: CSharp, grid_program: Path, tmp_path: Path) -> None:
    check_grid(csharp, grid_program, Path(ASSET), tmp_path / "grid")
