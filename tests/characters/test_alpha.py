"""How materials are transparent: as their file says, as the user says, and where the file would hide the figure."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from fbx_files import figure, picture
from gltf_files import PICTURE, textured
from scenes import HERE, part, scene

from mua.atlas.character_surfaces import Surfaces
from mua.characters.alpha import read_alphas
from mua.characters.assemble import assemble
from mua.characters.read import read_surfaces
from mua.errors import InputError
from mua.scene import AlphaMode, Material, Scene

STORED = (40, 127, 200)  # the alphas of a picture's texels
FACES = 10  # of each part
WORDS = (("opaque", "opaque", [255] * 3), ("cut", "mask", STORED), ("blend", "blend", STORED))
TREATED = "Transparent materials (--alpha MATERIAL=opaque, cut, blend or skip treats one otherwise): "
HIDING = "Alpha would hide the figure and is ignored (--alpha MATERIAL=blend or =cut heeds it), in materials: "


def material(name: str, *, mode: AlphaMode = "opaque", opacity: float = 1.0) -> Material:
    image = np.full((1, 3, 4), 90, np.uint8)
    image[0, :, 3] = STORED
    return Material(name, image, alpha_mode=mode, opacity=opacity)


def figure_of(*materials: Material, colors: np.ndarray | None = None) -> Scene:
    """A part of each material."""
    parts = tuple(replace(part(group=m, seed=m), material=m, colors=colors) for m in range(len(materials)))
    return scene(parts=parts, materials=materials)


def read(whole: Scene, **alphas: str) -> Surfaces:
    return assemble(whole, HERE, alphas=read_alphas([f"{name}={value}" for name, value in alphas.items()]))


def opacities(surfaces: Surfaces) -> dict[str, list[int]]:
    return {one.name: one.image[0, :, 3].tolist() for one in surfaces.materials}


@pytest.mark.parametrize(
    ("mode", "opacity", "expected"),
    [("opaque", 0.5, (255, 255, 255)), ("blend", 1.0, STORED), ("blend", 0.5, (20, 64, 100)), ("mask", 1.0, STORED)],
)
def test_alpha_is_as_the_file_says(mode: AlphaMode, opacity: float, expected: tuple[int, ...]) -> None:
    found = read(figure_of(material("skin"), material("hair", mode=mode, opacity=opacity)))
    assert opacities(found) == {"skin": [255] * 3, "hair": list(expected)}
    assert [one.alpha_mode for one in found.materials] == ["opaque", mode]


@pytest.mark.parametrize("opacity", [1.0, 0.0])
@pytest.mark.parametrize("mode", ["opaque", "blend", "mask"])
def test_a_user_says_otherwise_whatever_the_file_says(mode: AlphaMode, opacity: float) -> None:
    whole = figure_of(material("skin"), material("hair", mode=mode, opacity=opacity))
    for asked, alpha, expected in WORDS:
        _, hair = read(whole, hair=asked).materials
        assert hair.alpha_mode == alpha
        assert hair.image[0, :, 3].tolist() == list(expected)
    left = read(whole, HAIR="skip")
    assert [one.name for one in left.materials] == ["skin"]
    assert len(left.faces) == FACES


def test_an_unknown_material_is_refused_with_those_there_are() -> None:
    whole = figure_of(material("skin"), material("Hair_back"), material("hair"))
    with pytest.raises(InputError) as refused:
        read(whole, hairs="cut")
    assert str(refused.value) == (
        "body.glb: --alpha hairs=cut: no material has this name; there are hair, Hair_back, skin"
    )


@pytest.mark.parametrize("wrong", ["hair", "hair=", "=cut", "hair=CUT", "hair=0.5"])
def test_a_value_that_is_none_of_the_four_is_refused(wrong: str) -> None:
    with pytest.raises(InputError, match=f"--alpha {wrong}: expected a material and one of opaque, cut, blend, skip"):
        read_alphas([wrong])


def test_names_may_hold_signs_and_count_once() -> None:
    assert read_alphas(["a=b=cut", "c.1=skip"]) == {"a=b": "cut", "c.1": "skip"}
    with pytest.raises(InputError, match="--alpha Hair=blend: Hair is named more than once"):
        read_alphas(["hair=cut", "Hair=blend"])


def test_what_is_transparent_is_noted() -> None:
    whole = figure_of(material("skin"), material("hair", mode="mask"), material("glass", mode="blend"))
    assert read(whole).notes[-1] == f"{TREATED}hair cut at 0.5, glass blended."
    solid = read(whole, hair="opaque", glass="skip")
    assert not any(note.startswith(TREATED) for note in solid.notes)


@pytest.mark.parametrize("mode", ["blend", "mask"])
def test_alpha_that_hides_the_whole_figure_is_ignored(mode: AlphaMode) -> None:
    hidden = figure_of(material("skin", mode=mode, opacity=0), material("hair", mode=mode, opacity=0.004))
    found = read(hidden)
    assert opacities(found) == {"skin": [255] * 3, "hair": [255] * 3}
    assert found.notes[-1] == f"{HIDING}skin, hair."
    asked = read(hidden, hair="blend")
    assert opacities(asked) == {"skin": [255] * 3, "hair": [0, 1, 1]}


def test_alpha_that_hides_one_of_several_materials_counts() -> None:
    found = read(figure_of(material("skin"), material("veil", mode="blend", opacity=0)))
    assert opacities(found)["veil"] == [0, 0, 0]
    assert not any(HIDING in note for note in found.notes)


def test_opacity_of_vertices_counts_where_the_material_is_transparent() -> None:
    colors = np.ones((FACES, 3, 4))
    colors[..., 3] = 0.25
    whole = figure_of(material("skin"), material("veil", mode="blend"), colors=colors)
    found = read(whole)
    assert found.corner_colors is not None
    by_material = [found.corner_colors[found.face_material == m, :, 3] for m in (0, 1)]
    assert (by_material[0] == 1).all()
    assert (by_material[1] == 0.25).all()
    assert read(whole, veil="opaque").corner_colors is None


@pytest.mark.parametrize(("mode", "factor"), [("OPAQUE", [1, 1, 1, 1]), ("BLEND", [0, 0, 0, 0])])
@pytest.mark.parametrize("asked", ["blend", "cut"])
def test_a_gltf_gets_the_alpha_of_its_picture_back(tmp_path: Path, mode: str, factor: list[int], asked: str) -> None:
    path = textured(PICTURE, alphaMode=mode, model={"baseColorFactor": factor}).save(tmp_path / "body.glb")
    (cloth,) = read_surfaces(path, alphas=read_alphas([f"cloth={asked}"])).materials
    np.testing.assert_array_equal(cloth.image, PICTURE)
    (solid,) = read_surfaces(path).materials
    np.testing.assert_array_equal(solid.image[..., :3], PICTURE[..., :3])
    assert (solid.image[..., 3] == 255).all()


def test_an_fbx_with_opacity_0_gets_the_alpha_of_its_picture_back(tmp_path: Path) -> None:
    fbx, _, body = figure()
    cloth = fbx.material(body, TransparentColor=(1, 1, 1), TransparencyFactor=1.0)
    fbx.texture(cloth, "cloth.png", picture((10, 60, 200, 100)))
    path = fbx.save(tmp_path / "figure.fbx")
    for asked, expected in (([], 255), (["cloth=blend"], 100)):
        (found,) = read_surfaces(path, alphas=read_alphas(asked)).materials
        assert found.image[0, 0].tolist() == [10, 60, 200, expected]


def test_all_of_many_transparent_materials_are_named_once() -> None:
    names = [f"card{k}" for k in range(12)]
    whole = figure_of(*(material(name, mode="blend") for name in (*names, names[0])))
    assert read(whole).notes[-1] == TREATED + ", ".join(f"{name} blended" for name in names) + "."
