"""What FBX materials look like: colours, opacity, and the search for textures."""

from pathlib import Path

import numpy as np
import pytest
from fbx_files import Fbx, figure, picture

from mua.characters.read import read_surfaces
from mua.scene import Material

BLUE = (10, 60, 200, 255)
FOREIGN = "D:\\Art\\hero\\Cloth_01.png"


def textured(path: str = FOREIGN, content: bytes = b"", of: str = "DiffuseColor") -> Fbx:
    fbx, _, body = figure()
    cloth = fbx.material(body, DiffuseColor=(0.5, 0.5, 0.5))
    fbx.texture(cloth, path, content, of)
    return fbx


def material(fbx: Fbx, folder: Path, *, binary: bool = False) -> tuple[Material, tuple[str, ...]]:
    read = read_surfaces(fbx.save(folder / "hero.fbx", binary=binary))
    return read.materials[0], read.notes


@pytest.mark.parametrize("binary", [False, True], ids=["text", "binary"])
def test_an_embedded_texture_is_the_base_colour(tmp_path: Path, binary: bool) -> None:
    found, notes = material(textured(content=picture(BLUE)), tmp_path, binary=binary)
    assert (found.image.reshape(-1, 4) == BLUE).all()
    assert not notes


@pytest.mark.parametrize(
    "place",
    [
        "cloth_01.png",
        "hero.fbm/Cloth_01.PNG",
        "textures/cloth_01.png",
        "Textures/CLOTH_01.png",
        "../textures/cloth_01.png",
    ],
)
def test_a_texture_is_found_by_its_name_beside_the_file(tmp_path: Path, place: str) -> None:
    folder = tmp_path / "models"
    (folder / place).parent.mkdir(parents=True, exist_ok=True)
    folder.mkdir(exist_ok=True)
    (folder / place).write_bytes(picture(BLUE))
    found, notes = material(textured(), folder)
    assert (found.image.reshape(-1, 4) == BLUE).all()
    assert not notes


def test_a_lost_texture_is_noted_and_the_colour_drawn(tmp_path: Path) -> None:
    found, notes = material(textured(), tmp_path)
    assert any("Cloth_01.png" in note for note in notes)
    assert found.image[0, 0].tolist() == [128, 128, 128, 255]


def test_a_lost_texture_without_a_path_is_noted_by_its_own_name(tmp_path: Path) -> None:
    _, notes = material(textured("."), tmp_path)
    assert any(note.endswith(": picture.") for note in notes), notes


def test_a_texture_that_is_no_picture_is_as_a_lost_one(tmp_path: Path) -> None:
    _, notes = material(textured(content=b"no picture"), tmp_path)
    assert any("Cloth_01.png" in note for note in notes)


def test_the_alpha_of_a_texture_counts_where_it_is_said_to_be_the_opacity(tmp_path: Path) -> None:
    half = picture((10, 60, 200, 100))
    opaque, _ = material(textured(content=half), tmp_path)
    assert (opaque.image[..., 3] == 255).all()
    assert opaque.alpha_mode == "opaque"
    fbx, _, body = figure()
    cloth = fbx.material(body)
    fbx.texture(cloth, FOREIGN, half)
    fbx.texture(cloth, FOREIGN, half, "TransparentColor")
    clear, _ = material(fbx, tmp_path)
    assert (clear.image[..., 3] == 100).all()
    assert clear.alpha_mode == "blend"


def test_a_shader_of_its_own_is_read_by_the_name_of_its_property(tmp_path: Path) -> None:
    fbx, _, body = figure()
    fbx.texture(fbx.material(body), FOREIGN, picture((10, 60, 200, 100)), "Maya|DiffuseTexture")
    found, _ = material(fbx, tmp_path)
    assert found.image[0, 0].tolist() == [10, 60, 200, 100]


def test_a_picture_of_the_light_around_is_no_base_colour(tmp_path: Path) -> None:
    """Maya's Stingray shader comes with a cube map of a sky, which hides the colour where it is taken for it."""
    fbx, _, body = figure()
    cloth = fbx.material(body, DiffuseColor=(1, 0, 0))
    fbx.texture(cloth, FOREIGN, picture((10, 60, 200, 3)), "Maya|TEX_global_diffuse_cube")
    found, notes = material(fbx, tmp_path)
    assert found.image[0, 0].tolist() == [255, 0, 0, 255]
    assert found.alpha_mode == "opaque"
    assert not notes


def test_opacity_0_on_every_material_means_nothing(tmp_path: Path) -> None:
    fbx, _, body = figure()
    fbx.material(body, DiffuseColor=(1, 0, 0), TransparentColor=(1, 1, 1), TransparencyFactor=1.0)
    found, _ = material(fbx, tmp_path)
    assert found.image[0, 0].tolist() == [255, 0, 0, 255]


def test_opacity_that_is_a_number_is_kept(tmp_path: Path) -> None:
    fbx, _, body = figure()
    fbx.material(body, DiffuseColor=(1, 0, 0), TransparentColor=(1, 1, 1), TransparencyFactor=0.75)
    found, _ = material(fbx, tmp_path)
    assert found.image[0, 0, 3] == 64
    assert found.alpha_mode == "blend"


def test_a_colour_that_glows_is_shown(tmp_path: Path) -> None:
    fbx, _, body = figure()
    fbx.material(body, DiffuseColor=(0, 0, 0), EmissiveColor=(0, 1, 0), EmissiveFactor=1.0)
    found, _ = material(fbx, tmp_path)
    np.testing.assert_array_equal(found.image[0, 0], [0, 255, 0, 255])
