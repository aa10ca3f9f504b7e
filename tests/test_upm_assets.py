"""Every rule for paths, .meta files, references and includes finds its fault, and only that."""

from pathlib import Path

import gen_meta
import pytest
import upm_files
from upm_files import KERNEL_GUID, Break, edited, faults_after, put, replaced

META = "Runtime/Frame.cs.meta"
TAKEN = "0123456789abcdef0123456789abcdef"
LONG = f"Runtime/{'x' * 140}.txt"
BESIDE_GUID = gen_meta.guid("com.mua.test", "Runtime/beside.hlsl")


def empty_folder(root: Path) -> None:
    put(root / "Runtime/Empty.meta", gen_meta.meta("com.mua.test", "Runtime/Empty", folder=True))
    (root / "Runtime/Empty").mkdir()


# Whether .meta files are written again after the change, the change, and the one fault that it makes.
CASES: dict[str, tuple[bool, Break, str]] = {
    # .meta files
    "file without meta": (
        False,
        lambda root: (root / "Runtime/beside.hlsl.meta").unlink(),
        "Runtime/beside.hlsl: no .meta file, so that Unity ignores it in an installed package",
    ),
    "folder without meta": (
        False,
        lambda root: (root / "Runtime.meta").unlink(),
        "Runtime: no .meta file, so that Unity ignores it in an installed package",
    ),
    "sample without meta": (
        False,
        lambda root: (root / "Samples~/Viewer/Walk.cs.meta").unlink(),
        "Samples~/Viewer/Walk.cs: no .meta file, so that Unity ignores it in an installed package",
    ),
    "meta in a hidden folder": (
        False,
        lambda root: put(root / "Documentation~/com.mua.test.md.meta", ""),
        "Documentation~/com.mua.test.md.meta: a .meta file of what Unity does not import",
    ),
    "meta of Samples~": (
        False,
        lambda root: put(root / "Samples~.meta", ""),
        "Samples~.meta: a .meta file of what Unity does not import",
    ),
    "orphan": (
        False,
        lambda root: put(root / "Runtime/Gone.cs.meta", ""),
        "Runtime/Gone.cs.meta: a .meta file without its asset",
    ),
    "empty folder": (
        False,
        empty_folder,
        "Runtime/Empty.meta: a .meta file of an empty folder, which git does not keep",
    ),
    "format of a meta": (
        False,
        lambda root: replaced(root / META, "fileFormatVersion: 2", "fileFormatVersion: 1"),
        'Runtime/Frame.cs.meta: fileFormatVersion: not in line one, expected "fileFormatVersion: 2"',
    ),
    "folder of a meta": (
        False,
        lambda root: replaced(root / "Runtime.meta", "folderAsset: yes\n", ""),
        "Runtime.meta: folderAsset: expected yes for a folder and none for a file",
    ),
    "short GUID": (
        False,
        lambda root: put(root / "Runtime/beside.hlsl.meta", "fileFormatVersion: 2\nguid: 0123\n"),
        'Runtime/beside.hlsl.meta: guid: "0123", expected one of 32 hexadecimal digits, not all zero',
    ),
    "zero GUID": (
        False,
        lambda root: put(root / "Runtime/beside.hlsl.meta", f"fileFormatVersion: 2\nguid: {'0' * 32}\n"),
        f'Runtime/beside.hlsl.meta: guid: "{"0" * 32}", expected one of 32 hexadecimal digits, not all zero',
    ),
    "new GUID": (
        False,
        lambda root: put(root / "Runtime/beside.hlsl.meta", f"fileFormatVersion: 2\nguid: {TAKEN}\n"),
        f'Runtime/beside.hlsl.meta: guid: "{TAKEN}", expected "{BESIDE_GUID}", that of its '
        "place: run tools/gen_meta.py",
    ),
    # paths
    "long path": (True, lambda root: put(root / LONG, ""), f"{LONG}: 152 characters, expected at most 140"),
    "not ASCII": (
        True,
        lambda root: put(root / "Runtime/Größe.txt", ""),
        "Runtime/Größe.txt: name 'Gr\\xf6\\xdfe.txt', "
        "expected letters, digits, blanks and ._~+-, and no device of Windows",
    ),
    "device of Windows": (
        True,
        lambda root: put(root / "Runtime/aux.txt", ""),
        "Runtime/aux.txt: name 'aux.txt', expected letters, digits, blanks and ._~+-, and no device of Windows",
    ),
    "case": (
        True,
        lambda root: [put(root / name, "") for name in ("Runtime/Beside.txt", "Runtime/beside.txt")],
        "Runtime/beside.txt: differs from Runtime/Beside.txt in case only",
    ),
    "link": (
        True,
        lambda root: (root / "Runtime/link.txt").symlink_to(root / "README.md"),
        "Runtime/link.txt: a link, expected a file or folder of its own",
    ),
    "left by a system": (
        True,
        lambda root: put(root / "Runtime/Thumbs.db", ""),
        "Runtime/Thumbs.db: left by an operating system, expected only files of the package",
    ),
    "hidden file": (
        True,
        lambda root: put(root / "Runtime/.swap", ""),
        "Runtime/.swap: hidden from Unity, expected only what belongs to the package",
    ),
    "hidden folder": (
        True,
        lambda root: put(root / "Runtime/Old~/Frame.cs", "namespace Mua { class Frame { } }"),
        "Runtime/Old~: hidden from Unity, expected only Samples~, Documentation~, Tests/Golden~",
    ),
    # references
    "reference to nothing": (
        True,
        lambda root: replaced(root / "Runtime/Resources/Frame.asset", KERNEL_GUID, TAKEN),
        f'Runtime/Resources/Frame.asset:4: kernel: guid "{TAKEN}" is of no file here',
    ),
    "wrong number": (
        True,
        lambda root: replaced(root / "Runtime/Resources/Frame.asset", "7200000", "4800000"),
        "Runtime/Resources/Frame.asset:4: kernel: fileID 4800000, expected 7200000 for com.mua.other/kernel.compute",
    ),
    "broken reference": (
        True,
        lambda root: put(root / "Runtime/Resources/Frame.asset", f"kernel: {{guid: {KERNEL_GUID}}}\n"),
        f"Runtime/Resources/Frame.asset:1: kernel: 'kernel: {{guid: {KERNEL_GUID}}}', expected references like "
        "{fileID: 1, guid: ..., type: 3}",
    ),
    "include of nothing": (
        True,
        lambda root: put(root / "Runtime/Frame.shader", '#include "gone.hlsl"\n'),
        'Runtime/Frame.shader: include "gone.hlsl", expected a file of a package here',
    ),
    "include of a stranger": (
        True,
        lambda root: edited(root / "package.json", dependencies={}),
        'Runtime/Frame.shader: include "Packages/com.mua.other/kernel.hlsl", expected the package in dependencies',
    ),
}


@pytest.fixture
def packages(tmp_path: Path) -> list[Path]:
    return upm_files.write(tmp_path)


@pytest.mark.parametrize(("metas", "change", "fault"), CASES.values(), ids=list(CASES))
def test_finds_one_fault(packages: list[Path], metas: bool, change: Break, fault: str) -> None:
    assert faults_after(packages, change, metas=metas) == [f"com.mua.test/{fault}"]


def test_finds_a_guid_of_two_assets(packages: list[Path]) -> None:
    found = faults_after(
        packages, lambda root: (root / META).write_text((packages[1] / "kernel.hlsl.meta").read_text())
    )
    guid = gen_meta.guid("com.mua.other", "kernel.hlsl")
    assert f'com.mua.other/kernel.hlsl.meta: guid: "{guid}" is also that of com.mua.test/{META}' in found
