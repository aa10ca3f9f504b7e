"""docs/architecture.md: every file that it names exists and defines the functions named after it."""

import ast
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
PAGE = ROOT / "docs" / "architecture.md"
SPAN = re.compile(r"`([^`]+)`")


def tables() -> list[list[list[str]]]:
    """Cells by table and row, headings first."""
    blocks = re.findall(r"(?:^\|.*\n)+", PAGE.read_text(), re.MULTILINE)
    return [[line.split("|")[1:-1] for line in block.splitlines()] for block in blocks]


def named() -> list[tuple[str, str]]:
    """Files and the names that stand after them; a heading may say which folder its column is in."""
    found = []
    for heading, _, *rows in tables():
        folders = ["".join(SPAN.findall(cell)) for cell in heading]
        for row in rows:
            for folder, cell in zip(folders, row, strict=False):
                path = ""
                for span in SPAN.findall(cell):
                    if "." in span and span.rpartition(".")[2] in ("py", "cs", "js", "hlsl", "compute"):
                        path = folder + span
                    found.append((path, "" if path == folder + span else span))
    return found


def defined(path: Path) -> set[str]:
    """Functions and classes of a file; those within a Python class as Class.name."""
    text = path.read_text()
    if path.suffix == ".js":
        return set(re.findall(r"^(?:  |export )(?:async |function )*(\w+)\(.*\{$", text, re.MULTILINE))
    if path.suffix != ".py":
        return set(re.findall(r"^\s*(?:[\w<>\[\],]+ )+(\w+)\(", text, re.MULTILINE))
    kinds = (ast.FunctionDef, ast.ClassDef)
    top = [node for node in ast.parse(text).body if isinstance(node, kinds)]
    methods = {f"{node.name}.{one.name}" for node in top for one in node.body if isinstance(one, ast.FunctionDef)}
    return {node.name for node in top} | methods


@pytest.mark.parametrize(("path", "name"), [pair for pair in named() if pair[1]])
def test_names_are_defined_where_the_page_says(path: str, name: str) -> None:
    assert name in defined(ROOT / path), path


def test_every_kernel_is_on_the_page() -> None:
    entries = {
        name
        for kernel in ROOT.glob("ComputeShaders/*.compute")
        for name in re.findall(r"^#pragma kernel (\w+)", kernel.read_text(), re.MULTILINE)
    }
    assert entries == {name for path, name in named() if name and path.endswith(".compute")}


def test_the_drawing_names_folders_that_are_there() -> None:
    labels = re.findall(r">([\w/ ]+/)<", (PAGE.parent / "images" / "architecture.svg").read_text())
    folders = {folder for label in labels for folder in label.split()}
    assert {"characters/", "student/", "kernels/", "web/"} < folders
    assert [folder for folder in folders if not (ROOT / "python" / "mua" / folder).is_dir()] == []


def test_a_name_that_is_not_there_is_found() -> None:
    assert "add" not in defined(ROOT / "python/mua/recording/writer.py")
    assert "TeacherWriter.add" in defined(ROOT / "python/mua/recording/writer.py")
    assert "Decode" in defined(ROOT / "unity-package/Runtime/AvatarFrame.cs")
    assert "sort" in defined(ROOT / "python/mua/web/splats.js")
    assert "draw" not in defined(ROOT / "python/mua/web/splats.js")
    assert "Sort" not in defined(ROOT / "unity-package/Runtime/AvatarFrame.cs")
