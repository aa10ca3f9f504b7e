"""What the editor shows of a file: the tables of mua-inspect, and a picture of the mesh at rest."""

from collections.abc import Callable, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from csharp import PROGRAMS, ROOT, RUNTIME, CSharp
from PIL import Image, ImageDraw
from rich.table import Table
from synthetic_avatar import synthetic_avatar

from mua.arrays import Array
from mua.asset import write
from mua.asset.avatar import Avatar
from mua.asset.read import decode_tree, load
from mua.asset.summary import summary
from mua.cli import inspect
from mua.kernels.inverse_dwt import inverse_dwt

EDITOR = ROOT / "unity-package" / "Editor"
GOLDEN = ROOT / "tests" / "golden" / "synthetic.muaavatar"
ENGINE_FREE = [EDITOR / f"{name}.cs" for name in ("AvatarSummary", "AvatarCost", "TexelColours", "Portrait")]
SIDE = 96  # pixels
FINE = 4  # of the oracle's samples along a pixel
TURN = np.deg2rad(25)  # of the eye about Y
AMBIENT = 0.65
MARGIN = 0.06
C0 = 0.28209479177387814
EDGE = 0.25  # pixels along the outline by which two samples and four samples of a pixel may differ
Draw = Callable[[Avatar], Array]


@pytest.fixture(scope="module")
def program(csharp: CSharp) -> Path:
    return csharp.build([RUNTIME / "Format", *ENGINE_FREE, PROGRAMS / "EditorProgram.cs"])


@pytest.fixture
def draw(csharp: CSharp, program: Path, tmp_path: Path) -> Draw:
    """A portrait [SIDE, SIDE, 4] as floats, the topmost row first."""

    def drawn(avatar: Avatar) -> Array:
        write(tmp_path / "a.muaavatar", avatar, storage="f32")
        csharp.run(program, "portrait", tmp_path / "a.muaavatar", SIDE, tmp_path / "a.rgba")
        return np.fromfile(tmp_path / "a.rgba", np.uint8).reshape(SIDE, SIDE, 4)[::-1] / 255

    return drawn


@pytest.mark.parametrize("storage", ["golden", "f32", "f16", "i8"])
def test_the_summary_is_that_of_mua_inspect(csharp: CSharp, program: Path, tmp_path: Path, storage: str) -> None:
    path = GOLDEN
    if storage != "golden":
        avatar = synthetic_avatar()
        clips = (avatar.clips[0], replace(avatar.clips[0], name="as slow as a glacier", rate=1.0))
        path = tmp_path / "a.muaavatar"
        write(path, replace(avatar, clips=clips, notes="two\nlines and a\ttab"), storage=storage)  # type: ignore[arg-type]
    found = [block.split("\n") for block in csharp.run(program, "summary", path).strip().split("\n\n")]
    *expected, clips_table = python_tables(path)
    assert found[:-1] == expected
    assert found[-1][1:] == clips_table[1:]
    assert found[-1][0].startswith(str(len(clips_table) - 2))


def python_tables(path: Path) -> list[list[str]]:
    """The tables of mua-inspect: title, names of the columns, rows, with cells apart by tabs."""
    tree = load(path)
    held = summary(path, tree, decode_tree(tree))
    overview = flattened(inspect._whole(held))[1:]  # without the path, which the editor shows itself
    overview[0] = overview[0].removeprefix("\t")
    rest = (inspect._bytes(held), inspect._costs(held), inspect._clips(held))
    return [overview, *map(flattened, rest)]


def flattened(table: Table) -> list[str]:
    rows = zip(*(column.cells for column in table.columns), strict=True)
    cells: list[Sequence[object]] = [[table.title], [column.header for column in table.columns], *rows]
    return ["\t".join(" ".join(str(cell).split()) for cell in row) for row in cells]


def test_a_portrait_is_the_silhouette_of_the_mesh(draw: Draw) -> None:
    """Upright and not mirrored."""
    avatar = synthetic_avatar()
    lopsided = avatar.coarse.mean.copy()
    lopsided[:3, 0] += np.float32(0.8)  # the lowest ring moves to the character's left, which is the eye's right
    avatar = replace(avatar, coarse=replace(avatar.coarse, mean=lopsided))
    found = draw(avatar)[..., 3]
    expected = silhouette(lopsided, avatar.rig.mesh.faces)
    outline = np.abs(np.diff(expected, axis=0)).sum() + np.abs(np.diff(expected, axis=1)).sum()
    assert np.abs(found - expected).sum() < EDGE * outline
    top, bottom = (half.sum(0) @ np.arange(SIDE) / half.sum() for half in (found[: SIDE // 2], found[SIDE // 2 :]))
    assert bottom > top + SIDE / 8


def silhouette(
    vertices: Array,  # [V, 3]
    faces: Array,  # [F, 3]
) -> Array:
    """Coverage [SIDE, SIDE] of the mesh as polygons, by another program."""
    flat = np.stack([vertices[:, 0] * np.cos(TURN) - vertices[:, 2] * np.sin(TURN), -vertices[:, 1]], axis=1)
    low, high = flat.min(0), flat.max(0)
    scale = SIDE * FINE * (1 - 2 * MARGIN) / (high - low).max()
    placed = (flat - (low + high) / 2) * scale + SIDE * FINE / 2
    image = Image.new("L", (SIDE * FINE, SIDE * FINE))
    pen = ImageDraw.Draw(image)
    for face in faces:
        pen.polygon([tuple(map(float, placed[corner])) for corner in face], fill=1)
    return np.asarray(image, np.float64).reshape(SIDE, FINE, SIDE, FINE).mean((1, 3))


def test_a_portrait_has_the_mean_colour_under_a_light(draw: Draw) -> None:
    avatar = synthetic_avatar()
    ll = np.zeros_like(avatar.appearance.ll_mean)
    ll[:3] = np.array([12, 4, -8], np.float32)[:, None, None]
    appearance = replace(avatar.appearance, ll_mean=ll, static=np.full_like(avatar.appearance.static, 0.1))
    texture = ll.astype(np.float64)
    for _ in range(avatar.wavelet.levels):
        texture = inverse_dwt(texture, None, avatar.wavelet.rec_lo, avatar.wavelet.rec_hi)
    colour = 0.5 + C0 * (texture[:3, 0, 0] + 0.1)
    found = draw(replace(avatar, appearance=appearance))
    shade = found[found[..., 3] == 1][:, :3] / colour
    np.testing.assert_allclose(shade, shade[:, :1] * [1, 1, 1], atol=1 / 255 / colour.min())
    assert AMBIENT - 0.01 < shade.min() < shade.max() < 1.01
    assert len(np.unique(shade.round(2))) > 2  # faces differ


@pytest.mark.parametrize("scale", [0.0, 1e-30, 3e4])
def test_a_portrait_of_a_strange_mesh_is_no_fault(draw: Draw, scale: float) -> None:
    avatar = synthetic_avatar()
    mean = (avatar.coarse.mean * scale).astype(np.float32)
    found = draw(replace(avatar, coarse=replace(avatar.coarse, mean=mean)))
    assert (found[..., 3].max() > 0) == (scale > 1)
