"""Where the picture of an FBX texture is: in the file, or beside it, wherever the author's disk had it."""

from collections.abc import Iterator
from itertools import islice
from pathlib import Path, PureWindowsPath
from typing import Any

from mua.arrays import Array
from mua.atlas import pictures
from mua.characters.fbx.bindings import get

FOLDERS = ("textures", "texture", "../textures", "../texture", "materials", "../materials", "maps")
LISTED = 20_000  # entries of a folder beyond which it is no folder of pictures


def read_picture(texture: Any, path: Path) -> Array | None:
    """The picture [h, w, 4] of a texture, None where it is not found or cannot be decoded."""
    content = bytes(get(texture, "content"))
    if not content and get(texture, "video") is not None:
        content = bytes(get(texture, "video.content"))
    for found in ([content] if content else []), _contents(texture, path):
        for encoded in found:
            try:
                return pictures.decode_image(encoded)
            except ValueError:
                continue
    return None


def file_name(texture: Any) -> str:
    """The last part of a texture's path, as any system writes paths; the texture's own name where it has none.

    Blender writes "." for a picture that was packed into its own file.
    """
    paths = (get(texture, name) for name in ("relative_filename", "filename", "absolute_filename"))
    return PureWindowsPath(next(filter(None, paths), "")).name or str(get(texture, "name"))


def _contents(texture: Any, path: Path) -> Iterator[bytes]:
    for file in _places(texture, path):
        try:
            yield file.read_bytes()
        except (OSError, ValueError):
            continue


def _places(texture: Any, path: Path) -> Iterator[Path]:
    """Files that may be the texture's: as the file says, then by name where Unity looks; upper and lower case alike."""
    for field in ("relative_filename", "absolute_filename"):
        stated = str(get(texture, field)).replace("\\", "/")
        if stated:
            yield path.parent / stated
    name = file_name(texture).lower()
    for folder in (path.with_suffix(".fbm"), path.parent, *((path.parent / place).resolve() for place in FOLDERS)):
        yield from _named(folder, name)


def _named(folder: Path, name: str) -> Iterator[Path]:
    """Files of a folder, whose own name may be in upper or lower case, that have a name."""
    for place in _entries(folder.parent, folder.name.lower()) or [folder]:
        yield from _entries(place, name)


def _entries(folder: Path, name: str) -> list[Path]:
    """What a folder holds under a name in upper or lower case."""
    try:
        return [entry for entry in islice(folder.iterdir(), LISTED) if entry.name.lower() == name]
    except (OSError, ValueError):
        return []
