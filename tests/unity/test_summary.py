"""What the editor shows of a file: the tables of mua-inspect."""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import pytest
from csharp import PROGRAMS, ROOT, RUNTIME, CSharp
from rich.table import Table
from synthetic_avatar import synthetic_avatar, with_expressions, with_rules

from mua.asset import write
from mua.asset.read import decode_tree, load
from mua.asset.summary import summary
from mua.bench.random_avatar import random_avatar
from mua.cli import inspect
from mua.student.settings import preset

EDITOR = ROOT / "unity-package" / "Editor"
GOLDEN = ROOT / "tests" / "golden" / "synthetic.muaavatar"
ENGINE_FREE = [EDITOR / f"{name}.cs" for name in ("AvatarSummary", "AvatarCost")]


@pytest.fixture(scope="module")
def program(csharp: CSharp) -> Path:
    return csharp.build([RUNTIME / "Format", *ENGINE_FREE, PROGRAMS / "EditorProgram.cs"])


@pytest.mark.parametrize("storage", ["golden", "f32", "f16", "i8", "packed", "large"])
def test_the_summary_is_that_of_mua_inspect(csharp: CSharp, program: Path, tmp_path: Path, storage: str) -> None:
    """Also of costs that do not round to nothing, and of a rate with six digits."""
    path = GOLDEN
    if storage == "large":
        avatar = random_avatar(preset("tiny"))
        path = tmp_path / "a.muaavatar"
        write(path, replace(avatar, clips=(replace(avatar.clips[0], rate=29.9701),)))
    elif storage != "golden":
        avatar = with_rules(with_expressions(synthetic_avatar()))
        clips = (avatar.clips[0], replace(avatar.clips[0], name="as slow as a glacier", rate=1.0))
        path = tmp_path / "a.muaavatar"
        write(path, replace(avatar, clips=clips, notes="two\nlines and a\ttab"), storage=storage)  # type: ignore[arg-type]
    found = [block.split("\n") for block in csharp.run(program, path).strip().split("\n\n")]
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


def flattened(table: Table | str) -> list[str]:
    assert isinstance(table, Table)
    rows = zip(*(column.cells for column in table.columns), strict=True)
    cells: list[Sequence[object]] = [[table.title], [column.header for column in table.columns], *rows]
    return ["\t".join(" ".join(str(cell).split()) for cell in row) for row in cells]
