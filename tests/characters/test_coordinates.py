"""Where pictures lie on a surface: second sets of coordinates, transforms and wraps of each material, in all formats.

What is compared is the colour in the middle of each triangle, with that which the format's own words give there.
"""

import io
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from fbx_files import Fbx, binds, layer, skeleton
from gltf_files import BONES, POINTS, TRIANGLES, UV, Glb, primitive, textured
from PIL import Image
from pxr import Gf, Sdf, Usd, UsdGeom, UsdShade
from usd_files import edited, write_character

from mua.arrays import Array
from mua.atlas.character_surfaces import Surfaces
from mua.characters.read import read_character, read_surfaces

CELLS = 8  # texels along a side of the picture, of which each has its own colour
OTHER = UV[:, ::-1] * 0.7 + [0.153, 0.211]  # a second set, which turns the picture

Fold = Callable[[Array], Array]
FOLDS: dict[str, Fold] = {
    "repeat": lambda at: at - np.floor(at),
    "mirror": lambda at: 1 - np.abs((at % 2) - 1),
    "clamp": lambda at: np.clip(at, 0, 1),
}


def palette() -> Array:
    """[CELLS, CELLS, 4]: red tells the column, green the row."""
    step = np.arange(CELLS) * 30 + 20
    image = np.full((CELLS, CELLS, 4), 255, np.uint8)
    image[..., 0], image[..., 1], image[..., 2] = step, step[:, None], 7
    return image


def encoded() -> bytes:
    content = io.BytesIO()
    Image.fromarray(palette()).save(content, "png")
    return content.getvalue()


def texels(at: Array, wraps: tuple[str, str]) -> tuple[Array, Array]:
    """Columns and rows [n] of the picture at points [n, 2], v down."""
    column, row = (FOLDS[wrap](at[:, k]) * CELLS for k, wrap in enumerate(wraps))
    return np.minimum(column.astype(int), CELLS - 1), np.minimum(row.astype(int), CELLS - 1)


def colours(at: Array, wraps: tuple[str, str]) -> Array:
    """The picture's colours [n, 3] at points [n, 2], v down."""
    column, row = texels(at, wraps)
    return palette()[row, column, :3]


def shown(surfaces: Surfaces) -> Array:
    """The colours [F, 3] of the materials in the middle of each triangle."""
    found = np.zeros((len(surfaces.faces), 3), np.uint8)
    at = surfaces.uv[surfaces.uv_faces].mean(axis=1)
    for index, material in enumerate(surfaces.materials):
        rows = surfaces.face_material == index
        assert material.image.shape == (CELLS, CELLS, 4)
        found[rows] = colours(at[rows], (material.wrap_u, material.wrap_v))
    return found


def middles(uv: Array) -> Array:
    return uv[TRIANGLES].mean(axis=1)


def gltf(info: dict[str, Any], wraps: tuple[int, int] = (10497, 10497)) -> Glb:
    """The column with two sets of coordinates, and a picture that `info` places."""
    glb = textured(palette())
    primitive(glb)["attributes"]["TEXCOORD_1"] = glb.accessor(OTHER)
    glb.json["samplers"] = [{"wrapS": wraps[0], "wrapT": wraps[1]}]
    glb.json["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = {"index": 0, **info}
    return glb


def moved(uv: Array, *, scale: tuple[float, float], angle: float, offset: tuple[float, float]) -> Array:
    """KHR_texture_transform: scaled, turned about the origin against the clock as one sees it, moved."""
    c, s = np.cos(angle), np.sin(angle)
    u, v = (uv * scale).T
    return np.stack([c * u + s * v, c * v - s * u], axis=1) + offset


TRANSFORM = {"scale": [3.0, 2.5], "rotation": 0.6, "offset": [0.37, -0.81]}


@pytest.mark.parametrize("own", [{}, {"texCoord": 1}])
@pytest.mark.parametrize("stated", [0, 1])
@pytest.mark.parametrize("wraps", [("repeat", "mirror"), ("clamp", "repeat"), ("mirror", "clamp")])
def test_gltf_transforms_choose_their_set_and_samplers_wrap(
    tmp_path: Path, own: dict[str, int], stated: int, wraps: tuple[str, str]
) -> None:
    codes = {"repeat": 10497, "clamp": 33071, "mirror": 33648}
    info = {"texCoord": stated, "extensions": {"KHR_texture_transform": TRANSFORM | own}}
    path = gltf(info, (codes[wraps[0]], codes[wraps[1]])).save(tmp_path / "body.glb")
    uv = OTHER if own or stated else UV
    expected = colours(moved(middles(uv), scale=(3, 2.5), angle=0.6, offset=(0.37, -0.81)), wraps)
    np.testing.assert_array_equal(shown(read_surfaces(path)), expected)


def test_gltf_materials_of_one_mesh_read_sets_of_their_own(tmp_path: Path) -> None:
    glb = gltf({"texCoord": 1})
    glb.json["textures"].append({"source": 0, "sampler": 1})
    glb.json["samplers"].append({"wrapS": 33648, "wrapT": 33071})
    scaled = {"index": 1, "extensions": {"KHR_texture_transform": {"scale": [2, 2]}}}
    glb.json["materials"].append({"name": "hem", "pbrMetallicRoughness": {"baseColorTexture": scaled}})
    glb.json["meshes"][0]["primitives"] = [
        primitive(glb) | {"indices": glb.accessor(half.reshape(-1), "u2"), "material": m}
        for m, half in enumerate((TRIANGLES[:12], TRIANGLES[12:]))
    ]
    first = colours(middles(OTHER)[:12], ("repeat", "repeat"))
    second = colours(2 * middles(UV)[12:], ("mirror", "clamp"))
    surfaces = read_surfaces(glb.save(tmp_path / "body.glb"))
    np.testing.assert_array_equal(shown(surfaces), np.concatenate([first, second]))


def test_gltf_meshes_without_the_second_set_are_named(tmp_path: Path) -> None:
    glb = gltf({"texCoord": 1})
    del primitive(glb)["attributes"]["TEXCOORD_1"]
    (note,) = read_surfaces(glb.save(tmp_path / "body.glb")).notes
    assert note == "Meshes without the texture coordinates that their material asks for: body."


def test_pictures_on_second_sets_end_in_the_atlas_times_vertex_colours(tmp_path: Path) -> None:
    glb = gltf({"texCoord": 1})
    light = np.tile([0.25, 1, 1], (len(POINTS), 1))
    primitive(glb)["attributes"]["COLOR_0"] = glb.accessor(light)
    character = read_character(glb.save(tmp_path / "body.glb"), atlas_size=512)
    mesh = character.mesh
    column, row = (mesh.uv[mesh.uv_faces].mean(axis=1) * 512).astype(int).T
    at = FOLDS["repeat"](middles(OTHER)) * CELLS % 1
    inner = (np.abs(at - 0.5) < 0.35).all(axis=1)  # away from where colours meet
    assert inner.sum() > 5
    expected = colours(middles(OTHER), ("repeat", "repeat"))[inner].astype(float)
    expected[:, 0] = 255 * ((expected[:, 0] / 255) ** 2.2 * 0.25) ** (1 / 2.2)
    np.testing.assert_allclose(character.base_color[row, column, :3][inner], expected, atol=14)  # of steps of 30


@pytest.mark.parametrize("named", ["map", "second", "none of these"])
@pytest.mark.parametrize("wraps", [("repeat", "clamp"), ("clamp", "repeat")])
def test_fbx_textures_name_their_set_and_are_moved(tmp_path: Path, named: str, wraps: tuple[str, str]) -> None:
    fbx = Fbx()
    bones = skeleton(fbx)
    body = fbx.model("body", "Mesh")
    up = np.stack([OTHER[:, 0], 1 - OTHER[:, 1]], axis=1)
    indices = TRIANGLES.astype(np.int32).ravel()
    second = layer("UV", "ByPolygonVertex", number=1, name="second", UV=up.ravel(), UVIndex=indices)
    fbx.skin(fbx.mesh(body, POINTS, second), bones, binds(fbx), weights=np.eye(3)[BONES])
    codes = {"repeat": 0, "clamp": 1}
    placed: dict[str, Any] = {"Translation": (0.3, -0.2, 0.0), "Scaling": (2.0, 3.0, 1.0), "UVSet": named}
    placed |= {"WrapModeU": codes[wraps[0]], "WrapModeV": codes[wraps[1]]}
    fbx.texture(fbx.material(body), "cloth.png", encoded(), **placed)
    uv = middles(OTHER if named == "second" else UV)
    # FBX moves the picture, as Blender and ufbx have it, and so the coordinates the other way
    expected = np.stack([(uv[:, 0] - 0.3) / 2, 1 - (1 - uv[:, 1] + 0.2) / 3], axis=1)
    np.testing.assert_array_equal(shown(read_surfaces(fbx.save(tmp_path / "hero.fbx"))), colours(expected, wraps))


def placed_in_usd(path: Path, stage: Usd.Stage, *, wraps: tuple[str, str], of: str) -> None:
    """The picture on the set `st1`, half of `st` and moved, on an input of the surface."""
    Image.fromarray(palette()).save(path.parent / "skin.png")
    primvars = UsdGeom.PrimvarsAPI(stage.GetPrimAtPath("/Man/Body"))
    st = np.array(primvars.GetPrimvar("st").Get())
    other = primvars.CreatePrimvar("st1", Sdf.ValueTypeNames.TexCoord2fArray, UsdGeom.Tokens.faceVarying)
    other.Set([Gf.Vec2f(*map(float, row)) for row in st * 0.5])
    other.SetIndices(list(range(len(st))))
    UsdShade.Shader.Get(stage, "/Man/Skin/Reader").GetInput("varname").Set("st1")
    move = UsdShade.Shader.Define(stage, "/Man/Skin/Move")
    move.CreateIdAttr("UsdTransform2d")
    move.CreateInput("scale", Sdf.ValueTypeNames.Float2).Set(Gf.Vec2f(5, 3))
    move.CreateInput("translation", Sdf.ValueTypeNames.Float2).Set(Gf.Vec2f(0.4, -0.7))
    reader = UsdShade.Shader.Get(stage, "/Man/Skin/Reader").GetOutput("result")
    move.CreateInput("in", Sdf.ValueTypeNames.Float2).ConnectToSource(reader)
    image = UsdShade.Shader.Get(stage, "/Man/Skin/Image")
    out = move.CreateOutput("result", Sdf.ValueTypeNames.Float2)
    image.GetInput("st").ConnectToSource(out)
    for name, wrap in zip(("wrapS", "wrapT"), wraps, strict=True):
        image.CreateInput(name, Sdf.ValueTypeNames.Token).Set(wrap)
    surface = UsdShade.Shader.Get(stage, "/Man/Skin/Surface")
    for name in {"diffuseColor", "opacity"} - {of}:
        surface.GetInput(name).ClearSources()


def usd_middles(surfaces: Surfaces, path: Path) -> Array:
    """The placed coordinates [F, 2], v down, in the middle of each triangle of the file's quads."""
    stage = Usd.Stage.Open(str(path))
    st = np.array(UsdGeom.PrimvarsAPI(stage.GetPrimAtPath("/Man/Body")).GetPrimvar("st").Get())
    corners = st.reshape(-1, 4, 2)[:, [[0, 1, 2], [0, 2, 3]]].reshape(-1, 3, 2)
    assert len(corners) == len(surfaces.faces)
    at = corners.mean(axis=1) * 0.5 * (5, 3) + (0.4, -0.7)
    return np.stack([at[:, 0], 1 - at[:, 1]], axis=1)


@pytest.mark.parametrize("wraps", [("repeat", "mirror"), ("clamp", "repeat"), ("mirror", "clamp")])
def test_usd_textures_name_their_primvar_and_are_moved(tmp_path: Path, wraps: tuple[str, str]) -> None:
    path = write_character(tmp_path / "man.usda")
    edited(path, lambda stage: placed_in_usd(path, stage, wraps=wraps, of="diffuseColor"))
    surfaces = read_surfaces(path)
    np.testing.assert_array_equal(shown(surfaces), colours(usd_middles(surfaces, path), wraps))


def test_opacity_lies_where_its_own_texture_is_in_usd(tmp_path: Path) -> None:
    """A plain colour that only a texture of its opacity, here its red, makes transparent."""
    path = write_character(tmp_path / "man.usda")

    def change(stage: Usd.Stage) -> None:
        placed_in_usd(path, stage, wraps=("mirror", "clamp"), of="opacity")
        image = UsdShade.Shader.Get(stage, "/Man/Skin/Image")
        opacity = UsdShade.Shader.Get(stage, "/Man/Skin/Surface").GetInput("opacity")
        opacity.ConnectToSource(image.CreateOutput("r", Sdf.ValueTypeNames.Float))

    surfaces = read_surfaces(edited(path, change))
    (material,) = surfaces.materials
    column, row = texels(surfaces.uv[surfaces.uv_faces].mean(axis=1), ("mirror", "clamp"))
    assert (material.wrap_u, material.wrap_v) == ("mirror", "clamp")
    expected = colours(usd_middles(surfaces, path), ("mirror", "clamp"))[:, 0]
    np.testing.assert_array_equal(material.image[row, column, 3], expected)
