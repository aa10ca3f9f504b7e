"""Files whose content differs from their suffix."""

from pathlib import Path

import pytest

from mua.characters.read import read_surfaces
from mua.errors import InputError
from mua.motion.read import read_motion

LFS = b"version https://git-lfs.github.com/spec/v1\noid sha256:4d7a\nsize 12345\n"
WRONG = {
    "page": (b"\n<!DOCTYPE html>\n<html><body>404</body></html>", "is an HTML page, not a glTF file; it was probably"),
    "page with a comment": (b"<!-- mirror --><html>", "is an HTML page"),
    "pointer": (LFS, "is a Git LFS pointer, not a glTF file; fetch the file that it stands for"),
    "zip": (b"PK\x03\x04" + bytes(30), "is a ZIP archive, not a glTF file; unpack it first"),
    "picture": (b"\x89PNG\r\n\x1a\n" + bytes(30), "is a PNG image"),
    "fbx": (b"Kaydara FBX Binary  \x00" + bytes(30), "is an FBX file, not a glTF file; name it .fbx"),
    "xml": (b'<?xml version="1.0"?><Error><Code>AccessDenied</Code></Error>', "is an XML document"),
    "nothing": (b"", "the file is empty, expected a glTF file"),
}


@pytest.mark.parametrize("suffix", [".glb", ".gltf", ".vrm"])
@pytest.mark.parametrize("name", WRONG)
def test_file_under_a_wrong_name_is_called_what_it_is(tmp_path: Path, name: str, suffix: str) -> None:
    path = tmp_path / f"hero{suffix}"
    content, sentence = WRONG[name]
    path.write_bytes(content)
    with pytest.raises(InputError, match=sentence) as raised:
        read_surfaces(path)
    assert str(raised.value).startswith(str(path))


@pytest.mark.parametrize("suffix", [".usda", ".usdc", ".usdz", ".usd"])
def test_page_named_as_a_stage_is_called_a_page(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"hero{suffix}"
    path.write_bytes(WRONG["page"][0])
    with pytest.raises(InputError, match="is an HTML page, not a USD stage"):
        read_surfaces(path)


@pytest.mark.parametrize("suffix", [".bvh", ".npz"])
def test_pointer_named_as_motion_is_called_a_pointer(tmp_path: Path, suffix: str) -> None:
    path = tmp_path / f"walk{suffix}"
    path.write_bytes(LFS)
    with pytest.raises(InputError, match="is a Git LFS pointer"):
        read_motion(path)


@pytest.mark.parametrize(("suffix", "tool"), [(".dae", "Blender"), (".BLEND", "Blender"), (".max", "3ds Max")])
def test_scene_of_another_program_is_refused_with_the_way_to_convert_it(tmp_path: Path, suffix: str, tool: str) -> None:
    path = tmp_path / f"hero{suffix}"
    path.write_bytes(b"anything")
    for read in (read_surfaces, read_motion):
        with pytest.raises(InputError, match=rf"open it in {tool} and export it as glTF 2\.0"):
            read(path)


@pytest.mark.parametrize("name", ["hero.muaavatar", "HERO.MUAAVATAR"])
def test_an_avatar_in_place_of_a_character_or_motion_is_named(tmp_path: Path, name: str) -> None:
    path = tmp_path / name
    path.write_bytes(b"anything")
    for read in (read_surfaces, read_motion):
        with pytest.raises(InputError, match="is an avatar already; mua-view shows it"):
            read(path)
