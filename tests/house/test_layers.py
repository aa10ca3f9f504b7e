"""Modules import only from modules listed above them in python/mua/README.md."""

import ast
from functools import cache
from graphlib import TopologicalSorter
from pathlib import Path

import mua

PACKAGE = Path(mua.__file__).parent
ORDER = [
    line.split("`")[1].rstrip("/")
    for line in (PACKAGE / "README.md").read_text().splitlines()
    if line.startswith("| `")
]


def layer(module: str) -> str:
    """The listed module or package that holds a module."""
    held = module.partition(".")[0]
    assert held in ORDER, f"python/mua/README.md does not list {held}"
    return held


@cache
def modules() -> dict[str, Path]:
    """Every module of the package by its name below `mua`."""
    paths = sorted(PACKAGE.rglob("*.py"))
    named = {".".join(p.relative_to(PACKAGE).with_suffix("").parts).removesuffix(".__init__"): p for p in paths}
    return {name: path for name, path in named.items() if name != "__init__"}


def imports(path: Path) -> set[str]:
    """Modules of the package that a file imports, at any depth of its code."""
    found = set()
    for node in ast.walk(ast.parse(path.read_text())):
        if isinstance(node, ast.Import):
            found |= {alias.name for alias in node.names}
        elif isinstance(node, ast.ImportFrom) and node.module:
            names = {f"{node.module}.{alias.name}" for alias in node.names}
            known = {f"mua.{name}" for name in modules()}
            found |= (names & known) or {node.module}
    return {name.removeprefix("mua.") for name in found if name.startswith("mua.")}


def test_the_page_lists_whole_packages_and_single_modules_once() -> None:
    assert sorted(ORDER) == sorted({name.partition(".")[0] for name in modules()})


def test_no_modules_import_each_other_in_a_circle() -> None:
    TopologicalSorter({name: imports(path) for name, path in modules().items()}).prepare()


def test_modules_import_only_from_above() -> None:
    wrong = []
    for name, path in modules().items():
        for imported in imports(path):
            if ORDER.index(layer(imported)) > ORDER.index(layer(name)):
                wrong.append(f"{name} imports {imported}")
    assert wrong == []
