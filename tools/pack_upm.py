"""Fold com.mua.avatar and its kernels into one tarball that Unity's "Install package from tarball" takes.

The kernels become com.mua.avatar/ComputeShaders, byte for byte and with the GUIDs that they have; shaders include them
from there, and the dependency goes. Golden files and the guide come along. The same checkout gives the same bytes.
--folder writes the same files as a folder, for a branch or repository that a git URL installs.
--check holds a tarball, or what would be packed where none is given, to the checkout and to Unity's rules.
"""

import argparse
import gzip
import io
import json
import re
import shutil
import sys
import tarfile
import tempfile
from collections.abc import Iterator, Mapping
from pathlib import Path, PurePosixPath

import gen_meta
import lint_upm

ROOT = Path(__file__).resolve().parents[1]
PACKAGE, KERNELS = ROOT / "unity-package", ROOT / "ComputeShaders"
GUIDE = ROOT / "docs" / "unity.md"
GUIDE_IN_PACKAGE = "Documentation~/com.mua.avatar.md"  # where Unity's "View documentation" looks

GOLDEN = (ROOT / "tests" / "parity" / "golden", ROOT / "tests" / "golden")
TESTS = "Tests"
GOLDEN_IN_PACKAGE = f"{TESTS}/Golden~"  # where Runtime/SelfTest/GoldenFolder.cs looks first

PREFIX = "package/"  # the root folder of npm's tarballs
FOLDER = KERNELS.name
NAME, FOLDED = "com.mua.avatar", "com.mua.kernels"
SEPARATE, TOGETHER = f"Packages/{FOLDED}/", f"Packages/{NAME}/{FOLDER}/"
SHADERS = (".shader", ".hlsl", ".cginc", ".compute")
LINK = re.compile(rb"!?\[([^\]]*)\]\((?!https?:|#)[^)]*\)")
MODE, TIME = 0o644, 946684800  # seconds; 2000-01-01, as some tools refuse the year 1970
LEVEL = 9


def contents() -> dict[str, bytes]:
    """Path and bytes of every file of the packed package."""
    found = {path: _packed(path, content) for path, content in _files(PACKAGE).items()}
    kernels = {path: content for path, content in _files(KERNELS).items() if path.split(".meta")[0] != "package.json"}
    found |= {f"{FOLDER}/{path}": content for path, content in kernels.items()}
    for folder in GOLDEN:
        golden = {path: content for path, content in _files(folder).items() if not path.endswith(".md")}
        found |= {f"{GOLDEN_IN_PACKAGE}/{path}": content for path, content in golden.items()}
    for folded in (FOLDER, TESTS):
        found[f"{folded}.meta"] = gen_meta.meta(NAME, folded, folder=True).encode()
    found[GUIDE_IN_PACKAGE] = unlinked(GUIDE.read_bytes())
    return dict(sorted(found.items()))


def _files(folder: Path) -> dict[str, bytes]:
    paths = [path for path in folder.rglob("*") if path.is_file()]
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in paths}


def _packed(path: str, content: bytes) -> bytes:
    if path == "package.json":
        manifest = json.loads(content)
        del manifest["dependencies"][FOLDED]
        return (json.dumps(manifest, indent=2) + "\n").encode()
    if path.endswith(".md"):
        return unlinked(content)
    return content.replace(SEPARATE.encode(), TOGETHER.encode()) if path.endswith(SHADERS) else content


def unlinked(page: bytes) -> bytes:
    """A page whose links into the repository, which lead nowhere from a tarball, are plain text."""
    return LINK.sub(rb"\1", page)


def pack(files: Mapping[str, bytes]) -> bytes:
    """A tarball of files: same files, same bytes."""
    tarball = io.BytesIO()
    with tarfile.open(fileobj=tarball, mode="w", format=tarfile.USTAR_FORMAT) as archive:
        for path, content in sorted(files.items()):
            member = tarfile.TarInfo(PREFIX + path)
            member.size, member.mode, member.mtime = len(content), MODE, TIME
            archive.addfile(member, io.BytesIO(content))
    return gzip.compress(tarball.getvalue(), LEVEL, mtime=0)


def faults(tarball: bytes, source: str) -> list[str]:
    """Faults of a tarball, one sentence each; `source` names it."""
    try:
        with tarfile.open(fileobj=io.BytesIO(tarball), mode="r:gz") as archive:
            found = list(_member_faults(archive.getmembers()))
        if not found:
            files = read(tarball)
            found = [*_content_faults(files), *_rule_faults(files)]
    except (tarfile.TarError, OSError, EOFError) as error:
        found = [f"{error}, expected a gzip-compressed tarball"]
    return [f"{source}: {fault}" for fault in found]


def read(tarball: bytes) -> dict[str, bytes]:
    """Path in the package and bytes of every plain file of a tarball."""
    with tarfile.open(fileobj=io.BytesIO(tarball), mode="r:gz") as archive:
        opened = {member.name: archive.extractfile(member) for member in archive.getmembers() if member.isreg()}
        return {name.removeprefix(PREFIX): file.read() for name, file in opened.items() if file is not None}


def _member_faults(members: list[tarfile.TarInfo]) -> Iterator[str]:
    names = [member.name for member in members]
    if names != sorted(set(names)):
        yield "members, expected each once, in order of their names"
    for member in members:
        path = PurePosixPath(member.name)
        if not member.name.startswith(PREFIX) or ".." in path.parts or "\\" in member.name or path.is_absolute():
            yield f"{member.name}: path, expected one below {PREFIX}"
        if not member.isreg():
            yield f"{member.name}: type {member.type!r}, expected a plain file"
        if (member.uid, member.gid, member.uname, member.gname) != (0, 0, "", ""):
            yield f"{member.name}: owner {member.uid}:{member.gid}, expected none"
        if (member.mode, member.mtime) != (MODE, TIME):
            yield f"{member.name}: mode {member.mode:o} and time {member.mtime}, expected {MODE:o} and {TIME}"


def _content_faults(files: Mapping[str, bytes]) -> Iterator[str]:
    """Every file of the checkout is there with the bytes that it should have, and no other."""
    expected = contents()
    yield from (f"{path}: missing" for path in expected.keys() - files.keys())
    yield from (f"{path}: not in the checkout" for path in files.keys() - expected.keys())
    for path in sorted(expected.keys() & files.keys()):
        if files[path] != expected[path]:
            yield f"{path}: other bytes than in the checkout"
    for path, content in sorted(files.items()):
        if SEPARATE.encode() in content and path != GUIDE_IN_PACKAGE:
            yield f"{path}: names {SEPARATE}, expected only shaders to, which are rewritten"


def _rule_faults(files: Mapping[str, bytes]) -> list[str]:
    with tempfile.TemporaryDirectory() as scratch:
        unpack(files, Path(scratch))
        return lint_upm.faults([Path(scratch)])


def unpack(files: Mapping[str, bytes], folder: Path) -> None:
    """Write files of a tarball, whose paths were checked, below a folder."""
    for path, content in files.items():
        target = folder / path
        target.parent.mkdir(parents=True, exist_ok=True)
        target.write_bytes(content)


def write_folder(files: Mapping[str, bytes], folder: Path) -> None:
    """Put the package in place of a folder's files; hidden ones, such as .git, stay."""
    kept = [path for path in folder.iterdir() if not path.name.startswith(".")] if folder.is_dir() else []
    if kept and not (folder / "package.json").is_file():
        raise SystemExit(f"{folder}: holds {kept[0].name} and no package.json, expected an older package or no files")
    for path in kept:
        shutil.rmtree(path) if path.is_dir() else path.unlink()
    unpack(files, folder)


def default_output() -> Path:
    """The tarball's path, named by its version."""
    version = json.loads((PACKAGE / "package.json").read_text())["version"]
    return ROOT / "build" / f"{NAME}-{version}.tgz"


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--check", nargs="?", const="", metavar="FILE", help="hold a tarball to this checkout")
    parser.add_argument("-o", "--output", type=Path, default=None, metavar="FILE", help="build/<name>-<version>.tgz")
    parser.add_argument("--folder", type=Path, metavar="FOLDER", help="write a folder in place of a tarball")
    arguments = parser.parse_args()
    packed = Path(arguments.check).read_bytes() if arguments.check else pack(contents())
    if found := faults(packed, arguments.check or "the tarball"):
        sys.exit("\n".join(found))
    output = arguments.folder or arguments.output or default_output()
    if arguments.folder:
        write_folder(contents(), output)
    elif arguments.check is None:
        output.parent.mkdir(parents=True, exist_ok=True)
        partial = output.with_name(output.name + ".part")
        partial.write_bytes(packed)
        partial.replace(output)
    count = len(contents())
    print(f"{arguments.check or ('packs to' if arguments.check == '' else output)}: {count} files, {len(packed)} bytes")


if __name__ == "__main__":
    main()
