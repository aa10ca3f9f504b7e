"""Textures of glTF materials and their coordinates."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from gltf_files import PICTURE, TRIANGLES, UV, Glb, read, textured
from ktx2_files import ktx2
from PIL import Image

from mua.atlas import pictures
from mua.errors import InputError


def test_opaque_texture_has_full_opacity(tmp_path: Path) -> None:
    (material,) = read(textured(PICTURE), tmp_path).materials
    np.testing.assert_array_equal(material.image[..., :3], PICTURE[..., :3])
    assert (material.image[..., 3] == 255).all()
    assert (material.wrap_u, material.wrap_v) == ("clamp", "mirror")


def test_masked_texture_keeps_its_alpha_times_the_factor(tmp_path: Path) -> None:
    model = {"baseColorFactor": [1, 1, 1, 0.5]}
    (material,) = read(textured(PICTURE, alphaMode="MASK", alphaCutoff=0.2, model=model), tmp_path).materials
    np.testing.assert_array_equal(material.image[..., 3], np.round(PICTURE[..., 3] * 0.5))
    assert (material.alpha_mode, material.alpha_cutoff) == ("mask", 0.2)


@pytest.mark.parametrize("cutoff", [0.25, 0.0])
def test_reads_alpha_modes_and_cutoffs(tmp_path: Path, cutoff: float) -> None:
    (cut,) = read(textured(PICTURE, alphaMode="MASK", alphaCutoff=cutoff), tmp_path).materials
    assert (cut.alpha_mode, cut.alpha_cutoff) == ("mask", cutoff)
    assert read(textured(PICTURE, alphaMode="BLEND"), tmp_path).materials[0].alpha_mode == "blend"
    assert read(textured(PICTURE), tmp_path).materials[0].alpha_mode == "opaque"


def test_names_what_is_no_alpha_mode(tmp_path: Path) -> None:
    with pytest.raises(
        InputError, match=r"materials\[0\].alphaMode is 'MULTIPLY', expected one of OPAQUE, MASK, BLEND"
    ):
        read(textured(PICTURE, alphaMode="MULTIPLY"), tmp_path)


def test_factor_is_multiplied_in_linear_light(tmp_path: Path) -> None:
    picture = np.full((1, 1, 4), 188, np.uint8)  # sRGB 188 is half of the light of 255
    model = {"baseColorFactor": [0.5, 1, 0, 1]}
    (material,) = read(textured(picture, model=model), tmp_path).materials
    np.testing.assert_allclose(material.image[0, 0, :3], [137, 188, 0], atol=1)


def test_a_factor_doubles_light_and_opacity_at_most_to_the_whole() -> None:
    grey = np.full((1, 1, 4), 100, np.uint8)
    np.testing.assert_array_equal(pictures.tinted(grey, np.full(4, 2.0)), [[[138, 138, 138, 200]]])
    np.testing.assert_array_equal(pictures.tinted(grey, np.full(4, 9.0)), [[[255, 255, 255, 255]]])
    np.testing.assert_array_equal(pictures.tinted(grey, np.ones(4)), grey)


@pytest.mark.parametrize(("kind", "bound"), [("webp", 0), ("avif", 40)])  # AVIF is lossy
def test_reads_pictures_that_an_extension_names(kind: str, bound: int, tmp_path: Path) -> None:
    glb = textured(PICTURE, kind=kind, alphaMode="BLEND")
    glb.json["textures"] = [{"extensions": {f"EXT_texture_{kind}": {"source": 0}}}]
    glb.json["extensionsRequired"] = [f"EXT_texture_{kind}"]
    (material,) = read(glb, tmp_path).materials
    visible = PICTURE[..., 3] > 0
    np.testing.assert_allclose(material.image[visible].astype(int), PICTURE[visible], atol=bound)


def test_reads_texture_beside_the_file(tmp_path: Path) -> None:
    glb = textured(PICTURE)
    Image.fromarray(PICTURE).save(tmp_path / "cloth.png")
    glb.json["images"] = [{"uri": "cloth.png"}]
    assert read(glb, tmp_path).materials[0].image.shape == PICTURE.shape


def test_texture_that_is_missing_is_named(tmp_path: Path) -> None:
    glb = textured(PICTURE)
    glb.json["images"] = [{"uri": "cloth.png"}]
    with pytest.raises(InputError, match=r"images\[0\]\.uri names cloth\.png, which is not there; put it beside"):
        read(glb, tmp_path)


def test_texture_transform_scales_turns_and_moves(tmp_path: Path) -> None:
    glb = textured(PICTURE)
    transform = {"offset": [0.1, 0.2], "rotation": np.pi / 2, "scale": [2, 3]}
    info = {"index": 0, "texCoord": 1, "extensions": {"KHR_texture_transform": transform | {"texCoord": 0}}}
    glb.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = info
    glb.json["extensionsRequired"] = ["KHR_texture_transform"]
    surfaces = read(glb, tmp_path)
    u, v = np.moveaxis(UV[TRIANGLES], -1, 0)
    # a quarter turn counter-clockwise with v down takes +u to -v and +v to +u
    np.testing.assert_allclose(surfaces.uv[surfaces.uv_faces], np.stack([3 * v + 0.1, -2 * u + 0.2], -1), atol=1e-6)


@pytest.mark.parametrize(
    ("content", "found"),
    [
        (b"picture", "no known kind of picture"),
        (b"<!DOCTYPE html><html>", "an HTML page; it was probably saved"),
        (b"version https://git-lfs.github.com/spec/v1\n", "a Git LFS pointer; fetch the file"),
    ],
)
def test_texture_that_is_no_image_is_named(content: bytes, found: str, tmp_path: Path) -> None:
    glb = textured(PICTURE)
    glb.json["images"][0]["bufferView"] = glb.view(content)
    with pytest.raises(InputError, match=rf"images\[0\] is not a PNG.*: its content is {found}"):
        read(glb, tmp_path)


def test_glow_is_seen_where_it_is_brighter_than_the_colour(tmp_path: Path) -> None:
    picture = np.full((1, 1, 4), 188, np.uint8)  # sRGB 188 is half of the light of 255
    glow: dict[str, Any] = {"emissiveFactor": [1, 0, 0.1]}
    (material,) = read(textured(picture, **glow), tmp_path).materials
    np.testing.assert_allclose(material.image[0, 0], [255, 188, 188, 255], atol=1)


def test_strength_multiplies_glow(tmp_path: Path) -> None:
    strong: dict[str, Any] = {"extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": 5}}}
    glb = textured(np.zeros((1, 1, 4), np.uint8), emissiveFactor=[0.1, 1, 0], **strong)
    (material,) = read(glb, tmp_path).materials
    np.testing.assert_allclose(material.image[0, 0], [188, 255, 0, 255], atol=1)


def test_glowing_picture_lights_a_material_without_one(tmp_path: Path) -> None:
    glb = textured(PICTURE, emissiveFactor=[1, 1, 1], emissiveTexture={"index": 0})
    glb.json["materials"][0]["pbrMetallicRoughness"] = {"baseColorFactor": [0, 0, 0, 1]}
    (material,) = read(glb, tmp_path).materials
    np.testing.assert_array_equal(material.image[..., :3], PICTURE[..., :3])
    assert (material.wrap_u, material.wrap_v) == ("clamp", "mirror")


def test_glow_that_lies_elsewhere_than_the_colour_is_named(tmp_path: Path) -> None:
    moved = {"index": 0, "extensions": {"KHR_texture_transform": {"offset": [0.5, 0]}}}
    surfaces = read(textured(PICTURE, emissiveFactor=[1, 1, 1], emissiveTexture=moved), tmp_path)
    np.testing.assert_array_equal(surfaces.materials[0].image[..., :3], PICTURE[..., :3])
    assert "Emission with another UV mapping than the base colour is left out, in materials: cloth." in surfaces.notes


def transmission(factor: object, **texture: object) -> dict:
    return {"extensions": {"KHR_materials_transmission": {"transmissionFactor": factor, **texture}}}


@pytest.mark.parametrize(
    ("factor", "mode", "opacities"),
    [
        (0, {}, [255, 255, 255]),
        (1, {}, [255, 128, 0]),
        (0.5, {}, [255, 191, 128]),
        (1, {"alphaMode": "BLEND"}, [255, 128, 0]),
        (1, {"alphaMode": "MASK"}, [255, 255, 255]),
    ],
)
def test_bright_glass_is_clear_and_dark_glass_is_not(
    tmp_path: Path, factor: float, mode: dict, opacities: list[int]
) -> None:
    picture = np.full((1, 3, 4), 255, np.uint8)
    picture[0, :, :3] = np.array([0, 188, 255])[:, None]  # sRGB 188 is half of the light of 255
    (material,) = read(textured(picture, **mode, **transmission(factor)), tmp_path).materials
    np.testing.assert_allclose(material.image[0, :, 3], opacities, atol=1)
    np.testing.assert_array_equal(material.image[..., :3], picture[..., :3])


def test_a_picture_says_where_glass_is(tmp_path: Path) -> None:
    picture = np.full((1, 2, 4), 255, np.uint8)
    picture[0, 0, 0] = 0
    glb = textured(picture, **transmission(1, transmissionTexture={"index": 0}))
    (material,) = read(glb, tmp_path).materials
    assert material.image[0, :, 3].tolist() == [255, 0]
    moved = {"index": 0, "extensions": {"KHR_texture_transform": {"offset": [0.5, 0]}}}
    surfaces = read(textured(picture, **transmission(1, transmissionTexture=moved)), tmp_path)
    assert (surfaces.materials[0].image[..., 3] == 255).all()
    assert any(note.startswith("Transmission with another UV mapping") for note in surfaces.notes)


def test_broken_transmission_is_named(tmp_path: Path) -> None:
    with pytest.raises(InputError, match="transmissionFactor is 2, expected a number from 0 to 1"):
        read(textured(PICTURE, **transmission(2)), tmp_path)


def test_unlit_materials_and_variants_are_named(tmp_path: Path) -> None:
    glb = textured(PICTURE, extensions={"KHR_materials_unlit": {}})
    glb.json["extensions"] = {"KHR_materials_variants": {"variants": [{"name": "night"}, {"name": "day"}]}}
    notes = read(glb, tmp_path).notes
    assert "Unlit materials are shaded like the others: cloth." in notes
    assert "The file's material variants are left out, its default is drawn: night, day." in notes


COLORS = [[(255, 0, 0, 255), (0, 128, 7, 60)], [(9, 8, 250, 255), (1, 2, 3, 0)], [(90, 90, 90, 9), (200, 1, 30, 40)]]


def with_ktx2(content: bytes, **texture: Any) -> Glb:
    """The column with a KTX2 picture, which the file requires readers to know."""
    glb = textured(PICTURE, alphaMode="BLEND")
    glb.json["images"].append({"bufferView": glb.view(content), "mimeType": "image/ktx2"})
    source = {"source": len(glb.json["images"]) - 1}
    glb.json["textures"] = [{"extensions": {"KHR_texture_basisu": source}, **texture}]
    glb.json["extensionsRequired"] = ["KHR_texture_basisu"]
    return glb


def test_ktx2_pictures_are_read_texel_by_texel(tmp_path: Path) -> None:
    (material,) = read(with_ktx2(ktx2(COLORS)), tmp_path).materials
    expected = np.array(COLORS, np.uint8).repeat(4, axis=0).repeat(4, axis=1)
    np.testing.assert_array_equal(material.image, expected)


def test_a_png_goes_before_the_ktx2_beside_it(tmp_path: Path) -> None:
    (material,) = read(with_ktx2(ktx2(COLORS), source=0), tmp_path).materials
    assert material.image.shape == np.shape(PICTURE)


def test_broken_ktx2_pictures_are_named(tmp_path: Path) -> None:
    content = ktx2(COLORS)
    for broken in (content[:100], content[:-16], content[:12] + bytes(36) + content[48:]):
        with pytest.raises(InputError, match=r"images\[1\] is not a PNG, JPEG, WebP, AVIF or KTX2 that can be decoded"):
            read(with_ktx2(broken), tmp_path)


@pytest.mark.parametrize(
    ("fields", "sentence"),
    [
        ({"emissiveFactor": [1, 1]}, r"materials\[0\]\.emissiveFactor is \[1\.0, 1\.0\]"),
        (
            {"emissiveFactor": [1, 1, 1], "extensions": {"KHR_materials_emissive_strength": {"emissiveStrength": "x"}}},
            "emissiveStrength is x, expected a number",
        ),
    ],
)
def test_broken_glow_is_named(tmp_path: Path, fields: dict, sentence: str) -> None:
    with pytest.raises(InputError, match=sentence):
        read(textured(PICTURE, **fields), tmp_path)


@pytest.mark.parametrize(
    ("sampler", "squares"), [({"magFilter": 9728}, True), ({"magFilter": 9729}, False), ({}, False)]
)
def test_a_picture_that_is_not_interpolated_has_square_texels(
    tmp_path: Path, sampler: dict[str, int], squares: bool
) -> None:
    """Block figures are painted in few texels, whose edges are sharp."""
    glb = textured(np.array([[[255, 0, 0, 255], [0, 0, 255, 255]]], np.uint8))
    glb.json["samplers"] = [sampler]
    image = read(glb, tmp_path).materials[0].image
    middle = image[:, [image.shape[1] // 2 - 1, image.shape[1] // 2]]
    assert (image.shape[1] >= 16) == squares
    assert (middle[:, 0] == [255, 0, 0, 255]).all()
    assert (middle[:, 1] == [0, 0, 255, 255]).all()
