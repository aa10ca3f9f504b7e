"""Every rule for paths, .meta files, references and includes finds its fault, and only that."""

from pathlib import Path

import gen_meta
import pytest
from upm_files import KERNEL_GUID, Break, edited, faults_after, put, replaced

META = "Runtime/Frame.cs.meta"
TAKEN = "0123456789abcdef0123456789abcdef"
LONGEST, LONG = (f"Runtime/{'x' * count}.txt" for count in (128, 129))
BESIDE_GUID = gen_meta.guid("com.mua.test", "Runtime/beside.hlsl")


def empty_folder(root: Path) -> None:
    put(root / "Runtime/Empty.meta", gen_meta.meta("com.mua.test", "Runtime/Empty", folder=True))
    (root / "Runtime/Empty").mkdir()


NO_META = "no .meta file, so that Unity ignores it in an installed package"
NOT_IMPORTED = "a .meta file of what Unity does not import"
GUID = "expected one of 32 hexadecimal digits, not all zero"
NAME = "expected letters, digits, blanks and ._~+-, and no device of Windows"


@pytest.mark.parametrize("name", ["Runtime/beside.hlsl", "Runtime", "Samples~/Viewer/Walk.cs"])
def test_finds_what_has_no_meta(packages: list[Path], name: str) -> None:
    found = faults_after(packages, lambda root: (root / f"{name}.meta").unlink())
    assert found == [f"com.mua.test/{name}: {NO_META}"]


def guid_of(guid: str) -> str:
    return f"fileFormatVersion: 2\nguid: {guid}\n"


# A file, what is written there, and the one fault that it makes; other .meta files are written again then.
WRITTEN: list[tuple[str, str, str]] = [
    ("Documentation~/com.mua.test.md.meta", "", NOT_IMPORTED),
    ("Samples~.meta", "", NOT_IMPORTED),
    ("Runtime/Gone.cs.meta", "", "a .meta file without its asset"),
    ("Runtime/beside.hlsl.meta", guid_of("0123"), f'guid: "0123", {GUID}'),
    ("Runtime/beside.hlsl.meta", guid_of("0" * 32), f'guid: "{"0" * 32}", {GUID}'),
    (
        "Runtime/beside.hlsl.meta",
        guid_of(TAKEN),
        f'guid: "{TAKEN}", expected "{BESIDE_GUID}", that of its place: run tools/gen_meta.py',
    ),
    ("Runtime/Größe.txt", "", f"name 'Gr\\xf6\\xdfe.txt', {NAME}"),
    ("Runtime/aux.txt", "", f"name 'aux.txt', {NAME}"),
    ("Runtime/.swap", "", "hidden from Unity, expected only what belongs to the package"),
    ("Runtime/Frame.shader", '#include "gone.hlsl"\n', 'include "gone.hlsl", expected a file of a package here'),
]


@pytest.mark.parametrize(("name", "text", "fault"), WRITTEN, ids=[name for name, _, _ in WRITTEN])
def test_finds_the_fault_of_a_file(packages: list[Path], name: str, text: str, fault: str) -> None:
    found = faults_after(packages, lambda root: put(root / name, text), metas=not name.endswith(".meta"))
    assert found == [f"com.mua.test/{name}: {fault}"]


ASSET = "Runtime/Resources/Frame.asset"
# Whether .meta files are written again after the change, the change, and the one fault that it makes.
CASES: list[tuple[bool, Break, str]] = [
    (False, empty_folder, "Runtime/Empty.meta: a .meta file of an empty folder, which git does not keep"),
    (
        False,
        lambda root: replaced(root / META, "fileFormatVersion: 2", "fileFormatVersion: 1"),
        'Runtime/Frame.cs.meta: fileFormatVersion: not in line one, expected "fileFormatVersion: 2"',
    ),
    (
        False,
        lambda root: replaced(root / "Runtime.meta", "folderAsset: yes\n", ""),
        "Runtime.meta: folderAsset: expected yes for a folder and none for a file",
    ),
    (
        True,
        lambda root: [put(root / name, "") for name in ("Runtime/Beside.txt", "Runtime/beside.txt")],
        "Runtime/beside.txt: differs from Runtime/Beside.txt in case only",
    ),
    (
        True,
        lambda root: (root / "Runtime/link.txt").symlink_to(root / "README.md"),
        "Runtime/link.txt: a link, expected a file or folder of its own",
    ),
    (
        True,
        lambda root: put(root / "Runtime/Old~/Frame.cs", "namespace Mua { class Frame { } }"),
        "Runtime/Old~: hidden from Unity, expected only Samples~, Documentation~, Tests/Golden~",
    ),
    (
        True,
        lambda root: replaced(root / ASSET, KERNEL_GUID, TAKEN),
        f'{ASSET}:4: kernel: guid "{TAKEN}" is of no file here',
    ),
    (
        True,
        lambda root: [put(root / path, "") for path in (LONGEST, LONG)],
        f"{LONG}: 141 characters, expected at most 140",
    ),
    (
        True,
        lambda root: replaced(root / ASSET, "7200000", "4800000"),
        f"{ASSET}:4: kernel: fileID 4800000, expected 7200000 for com.mua.other/kernel.compute",
    ),
    (
        True,
        lambda root: put(root / ASSET, f"kernel: {{guid: {KERNEL_GUID}}}\n"),
        f"{ASSET}:1: kernel: 'kernel: {{guid: {KERNEL_GUID}}}', expected references like "
        "{fileID: 1, guid: ..., type: 3}",
    ),
    (
        True,
        lambda root: edited(root / "package.json", dependencies={}),
        'Runtime/Frame.shader: include "Packages/com.mua.other/kernel.hlsl", expected the package in dependencies',
    ),
]


@pytest.mark.parametrize(("metas", "change", "fault"), CASES, ids=[fault[:50] for _, _, fault in CASES])
def test_finds_one_fault(packages: list[Path], metas: bool, change: Break, fault: str) -> None:
    assert faults_after(packages, change, metas=metas) == [f"com.mua.test/{fault}"]


def test_finds_a_guid_of_two_assets(packages: list[Path]) -> None:
    found = faults_after(
        packages, lambda root: (root / META).write_text((packages[1] / "kernel.hlsl.meta").read_text())
    )
    guid = gen_meta.guid("com.mua.other", "kernel.hlsl")
    assert f'com.mua.other/kernel.hlsl.meta: guid: "{guid}" is also that of com.mua.test/{META}' in found
