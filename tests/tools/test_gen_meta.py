"""Every asset of a UPM package has its .meta file, with a GUID that stays, and the package's version is Python's."""

import json
from pathlib import Path

import gen_meta
import pytest

import mua

PACKAGES = [folder for folder in gen_meta.PACKAGES if (folder / "package.json").is_file()]


@pytest.fixture
def package(tmp_path: Path) -> Path:
    """A small package with everything that is treated in a way of its own."""
    for name in (
        "package.json",
        "Runtime/Frame.cs",
        "Samples~/Viewer/Viewer.unity",
        "Documentation~/page.md",
        ".hidden/x",
    ):
        path = tmp_path / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text('{"name": "com.mua.test"}')
    (tmp_path / "Empty").mkdir()
    return tmp_path


@pytest.mark.parametrize("folder", PACKAGES, ids=lambda folder: folder.name)
def test_package_has_the_version_of_the_python_package(folder: Path) -> None:
    assert json.loads((folder / "package.json").read_text())["version"] == mua.__version__


def test_metas_cover_what_unity_imports(package: Path) -> None:
    gen_meta.write(package)
    assert sorted(path.relative_to(package).as_posix() for path in package.rglob("*.meta")) == [
        "Runtime.meta",
        "Runtime/Frame.cs.meta",
        "Samples~/Viewer.meta",
        "Samples~/Viewer/Viewer.unity.meta",
        "package.json.meta",
    ]


def test_guid_is_that_of_name_and_path(package: Path) -> None:
    gen_meta.write(package)
    assert (package / "Runtime/Frame.cs.meta").read_text().splitlines()[:3] == [
        "fileFormatVersion: 2",
        "guid: 0476898dd63cd681e0114f3a9318c4ac",
        "MonoImporter:",
    ]
    assert "folderAsset: yes" in (package / "Runtime.meta").read_text()


def test_reports_missing_changed_and_orphaned(package: Path) -> None:
    gen_meta.write(package)
    (package / "Runtime/Frame.cs.meta").unlink()
    (package / "package.json.meta").write_text("fileFormatVersion: 2\n")
    (package / "Gone.cs.meta").write_text("fileFormatVersion: 2\n")
    assert gen_meta.faults(package) == [
        "Runtime/Frame.cs.meta is missing or wrong",
        "package.json.meta is missing or wrong",
        "Gone.cs.meta has no asset",
    ]
    gen_meta.write(package)
    assert gen_meta.faults(package) == []
