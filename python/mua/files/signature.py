"""The kind of a file by its first bytes, so that a failed download is recognised."""

from pathlib import Path

from mua.errors import InputError

HEAD = 1024  # bytes that tell a file's kind
# The first bytes of each kind of file. Binary formats first: text may begin with anything.
MAGIC = (
    (b"Kaydara FBX Binary", "an FBX file"),
    (b"; FBX", "a text FBX file"),
    (b"BLENDER", "a Blender file"),
    (b"glTF", "a glTF binary"),
    (b"PXR-USDC", "a USD file"),
    (b"#usda", "a USD file"),
    (b"PK\x03\x04", "a ZIP archive"),
    (b"\x1f\x8b", "a gzip archive"),
    (b"\x28\xb5\x2f\xfd", "a Zstandard archive"),
    (b"7z\xbc\xaf\x27\x1c", "a 7z archive"),
    (b"Rar!", "a RAR archive"),
    (b"\x89PNG", "a PNG image"),
    (b"\xff\xd8\xff", "a JPEG image"),
    (b"GIF8", "a GIF image"),
    (b"%PDF", "a PDF document"),
    (b"version https://git-lfs.github.com/spec/", "a Git LFS pointer"),
    (b"HIERARCHY", "a BVH motion file"),
)
ADVICE = {
    "an HTML page": "it was probably saved from a web page instead of being downloaded",
    "a Git LFS pointer": "fetch the file that it stands for with git lfs pull",
    "a ZIP archive": "unpack it first",
    "a gzip archive": "unpack it first",
    "a Zstandard archive": "unpack it first",
    "a 7z archive": "unpack it first",
    "a RAR archive": "unpack it first",
    **dict.fromkeys(("an FBX file", "a text FBX file"), "name it .fbx"),
    "a Blender file": "open it in Blender and export it as glTF 2.0 (.glb)",
}
# Suffixes of other scene formats, which no reader here takes.
FOREIGN_SUFFIXES = {
    **dict.fromkeys((".blend", ".dae", ".obj", ".ply", ".stl", ".x3d", ".abc"), "Blender"),
    **dict.fromkeys((".ma", ".mb"), "Maya"),
    **dict.fromkeys((".max", ".3ds"), "3ds Max"),
    **dict.fromkeys((".pmx", ".pmd"), "Blender with an importer for MikuMikuDance models"),
    ".c4d": "Cinema 4D",
    ".uasset": "Unreal Engine",
}


def kind_of(head: bytes) -> str:
    """The kind of a file that begins with `head`, as a noun with its article; "" where it is unknown."""
    for magic, kind in MAGIC:
        if head.startswith(magic):
            return kind
    text = head.removeprefix(b"\xef\xbb\xbf").lstrip().lower()
    if text.startswith((b"<!doctype html", b"<html", b"<head", b"<body")) or b"<html" in text:
        return "an HTML page"
    if text.startswith(b"<?xml"):
        return "an XML document"
    return "JSON" if text.startswith((b"{", b"[")) else ""


def told_by(content: bytes) -> str:
    """What a file is by its first bytes and what to do about it, for a sentence; "" where that is unknown."""
    kind = kind_of(content[:HEAD])
    return f"{kind}; {ADVICE[kind]}" if kind in ADVICE else kind


def require_kind(path: Path, expected: str, *, kinds: tuple[str, ...]) -> None:
    """Raise an InputError where a file is empty or is plainly something else than `kinds`, such as an HTML page.

    `expected` names the format for the sentence. A file of unknown kind passes: its reader says more.
    """
    with path.open("rb") as file:
        head = file.read(HEAD)
    if not head:
        raise InputError(f"{path}: the file is empty, expected {expected}")
    kind = kind_of(head)
    if kind and kind not in kinds:
        advice = f"; {ADVICE[kind]}" if kind in ADVICE else ""
        raise InputError(f"{path}: is {kind}, not {expected}{advice}")


def refuse_foreign(path: Path) -> None:
    """Raise an InputError for an avatar, or that says how to convert a scene format that no reader here takes."""
    if path.suffix.lower() == ".muaavatar":
        raise InputError(f"{path}: is an avatar already; mua-view shows it, mua-export writes its motion as .bvh")
    tool = FOREIGN_SUFFIXES.get(path.suffix.lower())
    if tool:
        raise InputError(
            f"{path}: {path.suffix} files are not read; open it in {tool} and export it as glTF 2.0 (.glb) "
            f"with its skeleton and animation"
        )
