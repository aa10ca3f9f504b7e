"""The tarball holds the package and every kernel byte for byte as Unity takes it, and --check reports differences."""

import gzip
import io
import json
import tarfile
from pathlib import Path

import lint_upm
import pack_upm
import pytest

KERNELS = sorted(path.name for path in pack_upm.KERNELS.glob("*.compute"))


@pytest.fixture(scope="module")
def files() -> dict[str, bytes]:
    return pack_upm.contents()


@pytest.fixture(scope="module")
def tarball(files: dict[str, bytes]) -> bytes:
    return pack_upm.pack(files)


def read(tarball: bytes) -> dict[str, bytes]:
    with tarfile.open(fileobj=io.BytesIO(tarball)) as archive:
        members = [member for member in archive.getmembers() if member.isfile()]
        return {member.name: archive.extractfile(member).read() for member in members}  # type: ignore[union-attr]


def test_what_is_packed_has_no_fault(tarball: bytes) -> None:
    assert pack_upm.faults(tarball, "the tarball") == []


def test_packs_the_same_bytes_twice(tarball: bytes) -> None:
    assert pack_upm.pack(dict(reversed(pack_upm.contents().items()))) == tarball


def test_holds_every_kernel_byte_for_byte(tarball: bytes) -> None:
    packed = read(tarball)
    assert "mlp_matmul.compute" in KERNELS
    for path in pack_upm.KERNELS.iterdir():
        if path.name not in ("package.json", "package.json.meta"):
            assert packed[f"package/ComputeShaders/{path.name}"] == path.read_bytes()


def test_holds_the_golden_files_where_the_self_test_looks(tarball: bytes) -> None:
    packed = read(tarball)
    look_up = packed["package/Runtime/SelfTest/GoldenFolder.cs"].decode()
    assert f'"{pack_upm.GOLDEN_IN_PACKAGE}"' in look_up
    for stem in (Path(name).stem for name in KERNELS):
        for ending in ("json", "bin"):
            source = pack_upm.ROOT / "tests" / "parity" / "golden" / f"{stem}.{ending}"
            assert packed[f"package/{pack_upm.GOLDEN_IN_PACKAGE}/{stem}.{ending}"] == source.read_bytes()


def test_is_one_package(tarball: bytes) -> None:
    packed = read(tarball)
    manifest = json.loads(packed["package/package.json"])
    assert manifest["name"] == "com.mua.avatar"
    assert not any(name.startswith("com.mua.") for name in manifest["dependencies"])
    assert [name for name in packed if name.endswith("package.json")] == ["package/package.json"]


def test_shaders_include_the_folded_kernels(tarball: bytes) -> None:
    shaders = {name: content for name, content in read(tarball).items() if name.endswith(".shader")}
    assert shaders
    for name, content in shaders.items():
        assert b"Packages/com.mua.kernels" not in content
        assert b'#include "Packages/com.mua.avatar/ComputeShaders/' in content or "/Samples~/" in name


def test_pages_link_to_nothing_that_is_not_there(tarball: bytes) -> None:
    packed = read(tarball)
    assert packed["package/Documentation~/com.mua.avatar.md"].startswith(b"# ")
    for name in ("package/README.md", "package/Documentation~/com.mua.avatar.md"):
        assert b"](../" not in packed[name]
        assert b"](docs/" not in packed[name]


def test_a_link_becomes_its_text() -> None:
    page = b"![a shot](images/a.png) [the page](../b.md#c) [out](https://host/x) [here](#part)"
    assert pack_upm.unlinked(page) == b"a shot the page [out](https://host/x) [here](#part)"


# A file of the package, what is there in place of it, and the fault.
CHANGES: list[tuple[str, bytes | None, str]] = [
    ("ComputeShaders/splat_sort.compute", None, "ComputeShaders/splat_sort.compute: missing"),
    (
        "ComputeShaders/mlp_matmul.compute",
        b"#pragma kernel A\n",
        "ComputeShaders/mlp_matmul.compute: other bytes than in the checkout",
    ),
    ("ComputeShaders.meta", None, "ComputeShaders.meta: missing"),
    ("Runtime/Notes.txt", b"", "Runtime/Notes.txt: not in the checkout"),
    (
        "Runtime/Notes.cs",
        b'"Packages/com.mua.kernels/x.hlsl"',
        "Runtime/Notes.cs: names Packages/com.mua.kernels/, expected only shaders to, which are rewritten",
    ),
]
OUTSIDE = ("../Notes.txt", b"", "package/../Notes.txt: path, expected one below package/")


@pytest.mark.parametrize("changes", [CHANGES, [OUTSIDE]], ids=["inside", "outside"])
def test_finds_all_that_is_wrong(files: dict[str, bytes], changes: list[tuple[str, bytes | None, str]]) -> None:
    changed = {**files, **{name: content for name, content, _ in changes if content is not None}}
    for name, content, _ in changes:
        if content is None:
            del changed[name]
    found = pack_upm.faults(pack_upm.pack(changed), "x.tgz")
    assert [fault for _, _, fault in changes if f"x.tgz: {fault}" not in found] == []


def member(**fields: object) -> bytes:
    """A tarball of one member with fields of its own."""
    info = tarfile.TarInfo("package/package.json")
    info.mode, info.mtime = pack_upm.MODE, pack_upm.TIME
    for name, value in fields.items():
        setattr(info, name, value)
    packed = io.BytesIO()
    with tarfile.open(fileobj=packed, mode="w:gz") as archive:
        archive.addfile(info)
    return packed.getvalue()


@pytest.mark.parametrize(
    ("tarball", "fault"),
    [
        (member(name="/etc/notes"), "/etc/notes: path, expected one below package/"),
        (member(name="package\\notes"), "package\\notes: path, expected one below package/"),
        (member(type=tarfile.SYMTYPE, linkname="/x"), "package/package.json: type b'2', expected a plain file"),
        (member(type=tarfile.LNKTYPE, linkname="x"), "package/package.json: type b'1', expected a plain file"),
        (member(type=tarfile.DIRTYPE), "package/package.json: type b'5', expected a plain file"),
        (member(uid=1000), "package/package.json: owner 1000:0, expected none"),
        (member(uname="me"), "package/package.json: owner 0:0, expected none"),
        (member(mode=0o777), "package/package.json: mode 777 and time 946684800, expected 644 and 946684800"),
    ],
    ids=lambda value: value if isinstance(value, str) else "",
)
def test_refuses_members_that_no_package_has(tarball: bytes, fault: str) -> None:
    assert pack_upm.faults(tarball, "x.tgz") == [f"x.tgz: {fault}"]


@pytest.mark.parametrize(
    "content", [b"", b"PK\x03\x04", gzip.compress(b"x" * 600), "cut"], ids=["empty", "zip", "gzip", "cut"]
)
def test_refuses_what_is_no_tarball(tarball: bytes, content: bytes | str) -> None:
    found = pack_upm.faults(tarball[:-4000] if isinstance(content, str) else content, "x.tgz")
    assert len(found) == 1
    assert found[0].endswith("expected a gzip-compressed tarball")


def test_writes_and_checks(tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    target = tmp_path / "build" / "avatar.tgz"
    for arguments in (["-o", str(target)], ["--check", str(target)], ["--check"]):
        monkeypatch.setattr("sys.argv", ["pack_upm.py", *arguments])
        pack_upm.main()
    size = target.stat().st_size
    assert [line.split(": ")[1] for line in capsys.readouterr().out.splitlines()] == [
        f"{len(read(target.read_bytes()))} files, {size} bytes"
    ] * 3
    assert [path.name for path in target.parent.iterdir()] == ["avatar.tgz"]
    assert pack_upm.default_output().name == "com.mua.avatar-0.1.0.tgz"


def test_a_folder_holds_what_the_tarball_does_and_keeps_its_git(files: dict[str, bytes], tmp_path: Path) -> None:
    (tmp_path / ".git").mkdir()
    (tmp_path / ".git" / "HEAD").write_text("ref: refs/heads/upm\n")
    (tmp_path / "package.json").write_text("{}")
    (tmp_path / "Gone").mkdir()
    (tmp_path / "Gone" / "older.cs").write_text("")
    pack_upm.write_folder(files, tmp_path)
    assert (tmp_path / ".git" / "HEAD").is_file()
    written = {path.relative_to(tmp_path).as_posix(): path for path in tmp_path.rglob("*") if path.is_file()}
    assert {path: file.read_bytes() for path, file in written.items() if not path.startswith(".git/")} == files
    (tmp_path / ".git" / "HEAD").unlink()
    (tmp_path / ".git").rmdir()
    assert lint_upm.faults([tmp_path]) == []


def test_a_folder_of_something_else_is_left_alone(files: dict[str, bytes], tmp_path: Path) -> None:
    (tmp_path / "thesis.txt").write_text("mine")
    with pytest.raises(SystemExit, match=r"thesis\.txt and no package\.json"):
        pack_upm.write_folder(files, tmp_path)
    assert (tmp_path / "thesis.txt").read_text() == "mine"
