"""Each player counts groups by as many elements as the kernels give to one: more would leave some out."""

import re
from pathlib import Path

import pytest

from mua.kernels import inverse_dwt
from mua.player import channels

ROOT = Path(__file__).resolve().parents[2]
UNITY = ROOT / "unity-package" / "Runtime" / "Kernels"
LISTS = re.compile(r"const \[([A-Z_, ]+)\] = \[([\d, ]+)\];")


def defined(file: str, name: str) -> int:
    """A number of a shader, or a product of numbers."""
    text = (ROOT / "ComputeShaders" / file).read_text()
    (value,) = re.findall(rf"^#define {name} (\(\w+ \* \w+\)|\d+)", text, re.MULTILINE)
    if value.isdigit():
        return int(value)
    first, second = re.findall(r"\w+", value)
    return defined(file, first) * defined(file, second)


def in_unity(name: str) -> int:
    (value,) = re.findall(rf"const int {name} = (\d+);", "".join(p.read_text() for p in sorted(UNITY.glob("*.cs"))))
    return int(value)


def in_browser(name: str) -> int:
    text = (ROOT / "python" / "mua" / "web" / "channels.js").read_text()
    found = {one: int(value) for one, value in re.findall(r"const ([A-Z_]+) = (\d+);", text)}
    for names, values in LISTS.findall(text):
        found |= dict(zip(names.split(", "), map(int, values.split(", ")), strict=True))
    return found[name]


@pytest.mark.parametrize(
    ("file", "define", "python", "unity", "browser"),
    [
        ("mlp_matmul.compute", "ROWS", channels.LAYER_ROWS, "LayerRows", "LAYER_ROWS"),
        ("mlp_matmul.compute", "COLUMNS", channels.MESH_COLUMNS, "MeshColumns", "MESH_COLUMNS"),
        ("blend_subbands.compute", "TEXELS", channels.LL_PAIRS, "LlPairs", "LL_PAIRS"),
        ("blend_subbands.compute", "TILE", channels.DETAIL_TILE, "DetailTile", "DETAIL_TILE"),
        ("upsample.hlsl", "TILE", channels.COARSE_TILE, "CoarseTile", "COARSE_TILE"),
        ("upsample.hlsl", "BATCH", inverse_dwt.BATCH, "ChannelBatch", "BATCH"),
    ],
)
def test_groups_are_as_large_as_the_kernel_has_them(
    file: str, define: str, python: int, unity: str, browser: str
) -> None:
    assert (python, in_unity(unity), in_browser(browser)) == (defined(file, define),) * 3
