"""What a USD stage shows: colours, glow, hidden prims, rigid parts that move, several skeletons."""

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from PIL import Image
from pxr import Gf, Sdf, Usd, UsdGeom, UsdShade, UsdSkel, Vt
from usd_files import edited, preview, write_character

from mua.atlas.character_surfaces import Surfaces
from mua.characters.read import read_surfaces
from mua.errors import InputError

Change = Callable[[Usd.Stage], object]


@pytest.fixture
def plain(tmp_path: Path) -> Path:
    return write_character(tmp_path / "man.usda", textured=False)


def body(stage: Usd.Stage) -> UsdGeom.Mesh:
    return UsdGeom.Mesh.Get(stage, "/Man/Body")


def corner_heights(surfaces: Surfaces) -> np.ndarray:
    return surfaces.vertices[surfaces.faces][..., 1]


def test_display_colour_of_points_reaches_the_corners(plain: Path) -> None:
    def ramp(stage: Usd.Stage) -> None:
        heights = [p[2] / 150 for p in body(stage).GetPointsAttr().Get()]
        primvar = body(stage).CreateDisplayColorPrimvar(UsdGeom.Tokens.vertex)
        primvar.Set([Gf.Vec3f(h, 1, 1) for h in heights])

    surfaces = read_surfaces(edited(plain, ramp))
    assert surfaces.corner_colors is not None
    assert surfaces.corner_colors is not None
    np.testing.assert_allclose(surfaces.corner_colors[..., 0], corner_heights(surfaces) / 1.5, atol=1e-6)
    assert (surfaces.corner_colors[..., 1:] == 1).all()
    np.testing.assert_array_equal(surfaces.materials[0].image[0, 0], 255)


def test_display_colour_of_faces_fills_each_of_them(plain: Path) -> None:
    def rows(stage: Usd.Stage) -> None:
        primvar = body(stage).CreateDisplayColorPrimvar(UsdGeom.Tokens.uniform)
        primvar.Set([Gf.Vec3f(face // 4 / 2, 1, 1) for face in range(12)])

    surfaces = read_surfaces(edited(plain, rows))
    assert surfaces.corner_colors is not None
    expected = np.floor(corner_heights(surfaces).min(axis=1) / 0.5 + 1e-6) / 2
    np.testing.assert_allclose(surfaces.corner_colors[..., 0], np.repeat(expected[:, None], 3, axis=1), atol=1e-6)


def test_display_opacity_becomes_opacity(plain: Path) -> None:
    surfaces = read_surfaces(edited(plain, lambda stage: body(stage).CreateDisplayOpacityPrimvar().Set([0.5])))
    assert surfaces.corner_colors is not None
    assert (surfaces.corner_colors[..., 3] == 0.5).all()


def test_colours_of_another_length_are_refused(plain: Path) -> None:
    def short(stage: Usd.Stage) -> None:
        body(stage).CreateDisplayColorPrimvar(UsdGeom.Tokens.vertex).Set([Gf.Vec3f(1)] * 3)

    with pytest.raises(InputError, match="primvars:displayColor holds 3 values, expected 16"):
        read_surfaces(edited(plain, short))


def surface(stage: Usd.Stage) -> UsdShade.Shader:
    return preview(stage, "/Man/Metal", body(stage).GetPrim())


def test_glow_lights_a_dark_material(plain: Path) -> None:
    def glow(stage: Usd.Stage) -> None:
        shader = surface(stage)
        shader.CreateInput("diffuseColor", Sdf.ValueTypeNames.Color3f).Set(Gf.Vec3f(0, 0.2140411, 0))
        shader.CreateInput("emissiveColor", Sdf.ValueTypeNames.Color3f).Set(Gf.Vec3f(4, 0, 0))

    np.testing.assert_array_equal(read_surfaces(edited(plain, glow)).materials[0].image[0, 0], [255, 127, 0, 255])


def test_a_material_without_a_colour_has_that_of_the_specification(plain: Path) -> None:
    picture = read_surfaces(edited(plain, surface)).materials[0].image[0, 0]
    assert (picture[:3] == round(255 * (1.055 * 0.18 ** (1 / 2.4) - 0.055))).all()  # 0.18 of light, in sRGB
    assert picture[3] == 255


def test_material_that_reads_colours_of_points_gets_them(plain: Path) -> None:
    def reader(stage: Usd.Stage) -> None:
        shader = surface(stage)
        source = UsdShade.Shader.Define(stage, "/Man/Metal/Reader")
        source.CreateIdAttr("UsdPrimvarReader_float3")
        source.CreateInput("varname", Sdf.ValueTypeNames.String).Set("paint")
        shader.CreateInput("diffuseColor", Sdf.ValueTypeNames.Color3f).ConnectToSource(
            source.CreateOutput("result", Sdf.ValueTypeNames.Float3)
        )
        primvars = UsdGeom.PrimvarsAPI(body(stage))
        paint = primvars.CreatePrimvar("paint", Sdf.ValueTypeNames.Color3fArray, UsdGeom.Tokens.vertex)
        paint.Set([Gf.Vec3f(0.25, 0.5, 1)] * 16)

    surfaces = read_surfaces(edited(plain, reader))
    assert surfaces.corner_colors is not None
    np.testing.assert_allclose(surfaces.corner_colors[..., :3], np.broadcast_to([0.25, 0.5, 1], (24, 3, 3)))
    np.testing.assert_array_equal(surfaces.materials[0].image[0, 0], 255)


def box(stage: Usd.Stage, path: str) -> UsdGeom.Mesh:
    """A triangle with sides of 10 units."""
    mesh = UsdGeom.Mesh.Define(stage, path)
    mesh.CreatePointsAttr([Gf.Vec3f(0, 0, 0), Gf.Vec3f(10, 0, 0), Gf.Vec3f(0, 0, 10)])
    mesh.CreateFaceVertexCountsAttr([3])
    mesh.CreateFaceVertexIndicesAttr([0, 1, 2])
    return mesh


HIDING: dict[str, tuple[Change, str]] = {
    "invisible": (lambda s: UsdGeom.Imageable(box(s, "/Man/Hat")).MakeInvisible(), "that the file hides are left out"),
    "proxy": (lambda s: box(s, "/Man/Hat").CreatePurposeAttr("proxy"), "Guide and proxy meshes are left out"),
    "unbound": (lambda s: box(s, "/Man/Hat"), "that no joint moves are left out"),
}


@pytest.mark.parametrize("name", HIDING)
def test_mesh_that_is_not_shown_is_left_out_by_name(plain: Path, name: str) -> None:
    change, sentence = HIDING[name]
    surfaces = read_surfaces(edited(plain, change))
    assert len(surfaces.faces) == 24
    assert any(sentence in note and note.endswith("Hat.") for note in surfaces.notes)


def test_hidden_skinned_mesh_is_left_out(plain: Path) -> None:
    with pytest.raises(InputError, match="no skinned mesh"):
        read_surfaces(edited(plain, lambda stage: UsdGeom.Imageable(body(stage)).MakeInvisible()))


def test_clip_ends_where_the_stage_does(plain: Path) -> None:
    def shorter(stage: Usd.Stage) -> None:
        stage.SetStartTimeCode(24)
        stage.SetEndTimeCode(48)

    whole, cut = read_surfaces(plain).clips[0], read_surfaces(edited(plain, shorter)).clips[0]
    assert len(cut) == 31
    np.testing.assert_allclose(cut.rotations, whole.rotations[30:61], atol=1e-6)


def robot(path: Path) -> Path:
    """A torso that stands still and an arm on it that turns; a floor beside both. Y up, metres."""
    stage = Usd.Stage.CreateNew(str(path))
    UsdGeom.SetStageUpAxis(stage, UsdGeom.Tokens.y)
    UsdGeom.SetStageMetersPerUnit(stage, 0.1)
    stage.SetTimeCodesPerSecond(30)
    UsdGeom.Xform.Define(stage, "/Robot").AddTranslateOp().Set(Gf.Vec3d(0, 10, 0))
    box(stage, "/Robot/Torso")
    for name, at in (("Arm", (5, 0, 0)), ("Arm/Hand", (0, 0, 5)), ("Leg", (0, -5, 0))):
        limb = UsdGeom.Xform.Define(stage, f"/Robot/{name}")
        limb.AddTranslateOp().Set(Gf.Vec3d(*at))
        turn = limb.AddRotateYOp()
        turn.Set(0.0, 0)
        turn.Set(90.0, 30)
        box(stage, f"/Robot/{name}/Shape")
    box(stage, "/Floor")
    stage.GetRootLayer().Save()
    return path


def test_rigid_parts_that_move_are_a_character(tmp_path: Path) -> None:
    surfaces = read_surfaces(robot(tmp_path / "robot.usda"))
    assert surfaces.skeleton.names == ("Robot", "Arm", "Hand", "Leg")
    assert surfaces.skeleton.parents.tolist() == [-1, 0, 1, 0]
    assert np.bincount(surfaces.skin_indices[:, 0]).tolist() == [3, 3, 3, 3]
    hand = surfaces.skin_indices[:, 0] == 2
    np.testing.assert_allclose(surfaces.vertices[hand].min(axis=0), [0.5, 1, 0.5], atol=1e-6)
    assert "Meshes that no joint moves are left out: Floor." in surfaces.notes
    (clip,) = surfaces.clips
    assert (clip.name, len(clip)) == ("Animation", 31)
    _, placed = surfaces.skeleton.world(clip.rotations[-1], clip.translations[-1])
    np.testing.assert_allclose(placed[2], [1.0, 1, 0], atol=1e-6)  # half a metre ahead became half a metre aside


def test_two_skeletons_are_one_character(plain: Path) -> None:
    def twin(stage: Usd.Stage) -> None:
        for source, target in (("/Man/Skeleton", "/Man/Tail"), ("/Man/Body", "/Man/Fur")):
            Sdf.CopySpec(stage.GetRootLayer(), source, stage.GetRootLayer(), target)
        fur = stage.GetPrimAtPath("/Man/Fur")
        UsdSkel.BindingAPI(fur).CreateSkeletonRel().SetTargets(["/Man/Tail"])
        UsdSkel.BindingAPI(stage.GetPrimAtPath("/Man/Tail")).GetAnimationSourceRel().SetTargets(["/Man/Tail/Wave"])
        moved = [Gf.Vec3f(*p) + Gf.Vec3f(0, 50, 0) for p in UsdGeom.Mesh(fur).GetPointsAttr().Get()]
        UsdGeom.Mesh(fur).GetPointsAttr().Set(Vt.Vec3fArray(moved))

    surfaces = read_surfaces(edited(plain, twin))
    assert set(surfaces.skeleton.names) == {"Hips", "Spine", "Head", "Hips_2", "Spine_2", "Head_2"}
    assert len(surfaces.faces) == 48
    np.testing.assert_allclose(surfaces.vertices.min(axis=0)[2], -0.58, atol=1e-6)


def test_material_that_reads_opacity_of_points_gets_it(plain: Path) -> None:
    def read(stage: Usd.Stage) -> None:
        shader = preview(stage, "/Man/Glass", body(stage).GetPrim())
        reader = UsdShade.Shader.Define(stage, "/Man/Glass/Reader")
        reader.CreateIdAttr("UsdPrimvarReader_float")
        reader.CreateInput("varname", Sdf.ValueTypeNames.String).Set("clarity")
        result = reader.CreateOutput("result", Sdf.ValueTypeNames.Float)
        shader.CreateInput("opacity", Sdf.ValueTypeNames.Float).ConnectToSource(result)
        heights = [p[2] / 150 for p in body(stage).GetPointsAttr().Get()]
        primvars = UsdGeom.PrimvarsAPI(body(stage))
        primvars.CreatePrimvar("clarity", Sdf.ValueTypeNames.FloatArray, UsdGeom.Tokens.vertex).Set(heights)

    surfaces = read_surfaces(edited(plain, read))
    assert surfaces.corner_colors is not None
    np.testing.assert_allclose(surfaces.corner_colors[..., 3], corner_heights(surfaces) / 1.5, atol=1e-6)


@pytest.mark.parametrize("wrap", ["mirror", "repeat"])
def test_glow_lies_where_the_colour_does_or_is_left_out_by_name(tmp_path: Path, wrap: str) -> None:
    path = write_character(tmp_path / "man.usda")
    dark = read_surfaces(path).materials[0].image

    def glow(stage: Usd.Stage) -> None:
        Image.fromarray(np.full((4, 4, 3), 255, np.uint8)).save(tmp_path / "glow.png")
        image = UsdShade.Shader.Define(stage, "/Man/Skin/Glow")
        image.CreateIdAttr("UsdUVTexture")
        image.CreateInput("file", Sdf.ValueTypeNames.Asset).Set("glow.png")
        image.CreateInput("wrapS", Sdf.ValueTypeNames.Token).Set(wrap)  # the colour's is mirrored
        reader = UsdShade.Shader.Get(stage, "/Man/Skin/Reader").GetOutput("result")
        image.CreateInput("st", Sdf.ValueTypeNames.Float2).ConnectToSource(reader)
        emission = UsdShade.Shader.Get(stage, "/Man/Skin/Surface").CreateInput(
            "emissiveColor", Sdf.ValueTypeNames.Color3f
        )
        emission.ConnectToSource(image.CreateOutput("rgb", Sdf.ValueTypeNames.Float3))

    surfaces = read_surfaces(edited(path, glow))
    notes = [note for note in surfaces.notes if "Emission with another UV mapping" in note]
    if wrap == "mirror":
        assert notes == []
        assert (surfaces.materials[0].image[..., :3] == 255).all()
    else:
        assert len(notes) == 1
        assert notes[0].endswith("Skin.")
        np.testing.assert_array_equal(surfaces.materials[0].image, dark)


STORED = {"auto": (200, 10, 20), "sRGB": (200, 10, 20), "raw": (229, 56, 79)}  # the picture's; as sRGB where linear


@pytest.mark.parametrize("space", STORED)
@pytest.mark.parametrize("scale", [1.0, 0.5])
def test_a_texture_declared_linear_is_brought_to_srgb(tmp_path: Path, space: str, scale: float) -> None:
    def declare(stage: Usd.Stage) -> None:
        image = UsdShade.Shader.Get(stage, "/Man/Skin/Image")
        image.CreateInput("sourceColorSpace", Sdf.ValueTypeNames.Token).Set(space)
        image.CreateInput("scale", Sdf.ValueTypeNames.Float4).Set(Gf.Vec4f(scale, scale, scale, 1))

    shown = read_surfaces(edited(write_character(tmp_path / "man.usda"), declare)).materials[0].image[0, 0]
    stored = np.array(STORED[space]) / 255
    # Light of the display.
    light = scale * np.where(stored <= 0.04045, stored / 12.92, ((stored + 0.055) / 1.055) ** 2.4)
    seen = 255 * np.where(light <= 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)
    np.testing.assert_allclose(shown[:3], STORED[space] if scale == 1 else seen, atol=1)
    assert shown[3] == 128  # a share, whatever the colours are


@pytest.mark.parametrize("channel", ["r", "a"])
def test_opacity_in_a_texture_declared_linear_is_what_is_stored(tmp_path: Path, channel: str) -> None:
    def declare(stage: Usd.Stage) -> None:
        image = UsdShade.Shader.Get(stage, "/Man/Skin/Image")
        image.CreateInput("sourceColorSpace", Sdf.ValueTypeNames.Token).Set("raw")
        image.CreateInput("scale", Sdf.ValueTypeNames.Float4).Set(Gf.Vec4f(0.5))
        opacity = UsdShade.Shader.Get(stage, "/Man/Skin/Surface").GetInput("opacity")
        opacity.ConnectToSource(image.CreateOutput(channel, Sdf.ValueTypeNames.Float))

    path = edited(write_character(tmp_path / "man.usda"), declare)
    assert read_surfaces(path).materials[0].image[0, 0, 3] == {"r": 100, "a": 64}[channel]
