"""USD characters, written with pxr and compared with UsdSkel's own skinning."""

from pathlib import Path

import numpy as np
import pytest
from people import retarget
from pxr import Gf, Sdf, Usd, UsdGeom, UsdShade, UsdSkel, UsdUtils, Vt
from usd_files import JOINTS, edited, preview, write_character

from mua import rotation
from mua.atlas.character_surfaces import Surfaces
from mua.characters.read import read_surfaces
from mua.errors import InputError
from mua.motion.read import read_motion
from mua.pose.signed_expressions import UNIT

# Float32 points of about 150 centimetres skinned by a chain of matrices: a dozen roundings.
SKINNING_BOUND = 12 * 150 * 2**-23 * 0.01
TURN_BOUND = 16 * 2**-23  # rotations through float32 keys, matrices and back


def skinned_by_usd(path: Path, time: float) -> np.ndarray:
    """Points that UsdSkel itself deforms, in the stage's axes and unit."""
    stage = Usd.Stage.Open(str(path))
    root = UsdSkel.Root(stage.GetPrimAtPath("/Man"))
    cache = UsdSkel.Cache()
    cache.Populate(root, Usd.PrimDefaultPredicate)
    binding = cache.ComputeSkelBindings(root, Usd.PrimDefaultPredicate)[0]
    transforms = cache.GetSkelQuery(binding.GetSkeleton()).ComputeSkinningTransforms(time)
    target = binding.GetSkinningTargets()[0]
    points = UsdGeom.Mesh(target.GetPrim()).GetPointsAttr().Get()
    target.ComputeSkinnedPoints(transforms, points, time)
    return np.array(points, float)


def posed(surfaces: Surfaces, rotations: np.ndarray, translations: np.ndarray) -> np.ndarray:
    """Vertices that each follow their first joint."""
    transforms = surfaces.skeleton.skinning(rotations, translations)
    return rotation.dual_transform(transforms[surfaces.skin_indices[:, 0]], surfaces.vertices)


@pytest.fixture
def character(tmp_path: Path) -> Path:
    return write_character(tmp_path / "man.usda")


def test_brings_centimetres_and_z_up_to_metres_and_y_up(character: Path) -> None:
    surfaces = read_surfaces(character)
    np.testing.assert_allclose(surfaces.vertices.min(axis=0), [-0.1, 0, -0.08], atol=1e-7)
    np.testing.assert_allclose(surfaces.vertices.max(axis=0), [0.1, 1.5, 0.08], atol=1e-7)
    assert surfaces.skeleton.names == ("Hips", "Spine", "Head")
    assert surfaces.skeleton.parents.tolist() == [-1, 0, 1]


def test_y_up_stage_gives_the_same_character(tmp_path: Path, character: Path) -> None:
    (tmp_path / "y").mkdir()
    other = read_surfaces(write_character(tmp_path / "y" / "man.usdc", z_up=False))
    surfaces = read_surfaces(character)
    np.testing.assert_allclose(other.vertices, surfaces.vertices, atol=1e-7)
    np.testing.assert_array_equal(other.faces, surfaces.faces)


def test_bind_pose_reproduces_the_bind_vertices(character: Path) -> None:
    surfaces = read_surfaces(character)
    bind = surfaces.skeleton.bind_pose
    np.testing.assert_allclose(posed(surfaces, bind.rotations, bind.translations), surfaces.vertices, atol=1e-14)


@pytest.mark.parametrize("frame", [0, 4, 100])
def test_posed_clip_equals_usd_skinning(character: Path, frame: int) -> None:
    surfaces = read_surfaces(character)
    (clip,) = surfaces.clips
    ours = posed(surfaces, clip.rotations[frame], clip.translations[frame])
    theirs = skinned_by_usd(character, frame * 24 / clip.rate)[:, [0, 2, 1]] * [0.01, 0.01, -0.01]
    np.testing.assert_allclose(ours, theirs, atol=SKINNING_BOUND)


def test_clip_has_the_animations_name_rate_and_length(character: Path) -> None:
    (clip,) = read_surfaces(character).clips
    assert (clip.name, clip.rate, len(clip)) == ("Wave", 30.0, 126)  # 100 codes at 24 a second, both ends
    assert all(note.startswith("Transparent materials") for note in read_surfaces(character).notes)


def test_texture_keeps_rows_and_turns_v_down(character: Path) -> None:
    surfaces = read_surfaces(character)
    (material,) = surfaces.materials
    assert (material.name, material.wrap_u, material.wrap_v) == ("Skin", "mirror", "repeat")
    np.testing.assert_array_equal(material.image[0, 0], [200, 10, 20, 128])
    top = surfaces.vertices[surfaces.faces][..., 1].max(axis=1) > 1.49
    assert surfaces.uv[surfaces.uv_faces[top]][..., 1].min() == pytest.approx(0, abs=1e-6)


def test_an_opacity_threshold_makes_a_mask(character: Path) -> None:
    assert read_surfaces(character).materials[0].alpha_mode == "blend"

    def cut(stage: Usd.Stage) -> None:
        shader = UsdShade.Shader.Get(stage, "/Man/Skin/Surface")
        shader.CreateInput("opacityThreshold", Sdf.ValueTypeNames.Float).Set(0.25)

    (material,) = read_surfaces(edited(character, cut)).materials
    assert (material.alpha_mode, material.alpha_cutoff) == ("mask", 0.25)


def test_a_textured_mesh_without_coordinates_is_named(character: Path) -> None:
    def bare(stage: Usd.Stage) -> None:
        UsdGeom.PrimvarsAPI(stage.GetPrimAtPath("/Man/Body")).RemovePrimvar("st")

    notes = read_surfaces(edited(character, bare)).notes
    assert any("without the texture coordinates that their material asks for: Body" in note for note in notes)


def test_texture_inside_a_package_is_read(tmp_path: Path, character: Path) -> None:
    package = tmp_path / "man.usdz"
    UsdUtils.CreateNewUsdzPackage(Sdf.AssetPath(str(character)), str(package))
    (tmp_path / "skin.png").unlink()
    np.testing.assert_array_equal(read_surfaces(package).materials[0].image[3, 0], [10, 200, 20, 255])


def test_mesh_without_material_takes_its_display_color(tmp_path: Path) -> None:
    def paint(stage: Usd.Stage) -> None:
        UsdGeom.Mesh(stage.GetPrimAtPath("/Man/Body")).CreateDisplayColorAttr([Gf.Vec3f(1, 0, 0.2140411)])

    path = edited(write_character(tmp_path / "plain.usda", textured=False), paint)
    np.testing.assert_array_equal(read_surfaces(path).materials[0].image[0, 0], [255, 0, 127, 255])


def test_several_influences_keep_the_weighted_joint(tmp_path: Path) -> None:
    surfaces = read_surfaces(write_character(tmp_path / "man.usda", influences=3))
    np.testing.assert_array_equal(surfaces.skin_weights[:, 0], 1)
    assert set(surfaces.skin_indices[:, 0].tolist()) == {0, 1, 2}


def test_polygons_become_fans(character: Path) -> None:
    surfaces = read_surfaces(character)
    assert surfaces.faces.shape == (24, 3)
    triangle = surfaces.vertices[surfaces.faces]
    outward = np.cross(triangle[:, 1] - triangle[:, 0], triangle[:, 2] - triangle[:, 0])
    centre = triangle.mean(axis=1) * [1, 0, 1]
    assert (np.sum(outward * centre, axis=1) > 0).all()


def test_subsets_have_their_own_materials(character: Path) -> None:
    def split(stage: Usd.Stage) -> None:
        mesh = UsdGeom.Mesh.Get(stage, "/Man/Body")
        binding = UsdShade.MaterialBindingAPI(mesh.GetPrim())
        subset = binding.CreateMaterialBindSubset("shoes", Vt.IntArray([0, 1, 2, 3]))
        shader = preview(stage, "/Man/Leather", subset.GetPrim())
        shader.CreateInput("diffuseColor", Sdf.ValueTypeNames.Color3f).Set(Gf.Vec3f(0, 0, 1))
        shader.CreateInput("opacity", Sdf.ValueTypeNames.Float).Set(0.5)

    surfaces = read_surfaces(edited(character, split))
    low = surfaces.vertices[surfaces.faces][..., 1].max(axis=1) < 0.51
    assert {surfaces.materials[m].name for m in surfaces.face_material[low]} == {"Leather"}
    assert {surfaces.materials[m].name for m in surfaces.face_material[~low]} == {"Skin"}
    (leather,) = (m for m in surfaces.materials if m.name == "Leather")
    np.testing.assert_array_equal(leather.image[0, 0], [0, 0, 255, 128])
    assert len(surfaces.vertices) == 16  # the border is one row of vertices


def test_mesh_may_name_joints_in_its_own_order(character: Path) -> None:
    def reorder(stage: Usd.Stage) -> None:
        binding = UsdSkel.BindingAPI(stage.GetPrimAtPath("/Man/Body"))
        binding.CreateJointsAttr([JOINTS[2], JOINTS[0], JOINTS[1]])
        indices = np.array(binding.GetJointIndicesAttr().Get())
        binding.GetJointIndicesAttr().Set(Vt.IntArray([[1, 2, 0][i] for i in indices]))

    before = read_surfaces(character).skin_indices
    np.testing.assert_array_equal(read_surfaces(edited(character, reorder)).skin_indices, before)


def test_stage_without_rest_pose_or_clip_is_read(character: Path) -> None:
    def still(stage: Usd.Stage) -> None:
        stage.RemovePrim("/Man/Skeleton/Wave")
        stage.GetPrimAtPath("/Man/Skeleton").RemoveProperty("restTransforms")

    surfaces = read_surfaces(edited(character, still))
    assert surfaces.clips == ()
    np.testing.assert_allclose(surfaces.vertices.max(axis=0), [0.1, 1.5, 0.08], atol=1e-7)


def test_motion_without_a_mesh_is_the_identity_on_its_own_rig(character: Path) -> None:
    surfaces = read_surfaces(character)
    (source,) = read_motion(edited(character, lambda stage: stage.RemovePrim("/Man/Body")))
    clip, notes = retarget(source, surfaces.skeleton)
    np.testing.assert_allclose(clip.rotations, surfaces.clips[0].rotations, atol=TURN_BOUND)
    np.testing.assert_allclose(clip.translations, surfaces.clips[0].translations, atol=SKINNING_BOUND)
    assert not notes


@pytest.mark.parametrize(
    ("clips", "sentence"),
    [(True, "no Skeleton is bound to this SkelAnimation"), (False, "no skinned mesh, skeleton or animated nodes")],
)
def test_stage_without_mesh_and_animated_skeleton_is_no_motion(character: Path, clips: bool, sentence: str) -> None:
    def strip(stage: Usd.Stage) -> None:
        stage.RemovePrim("/Man/Body")
        stage.GetPrimAtPath("/Man/Skeleton").RemoveProperty("skel:animationSource")
        for prim in [] if clips else [one.GetPath() for one in stage.Traverse() if one.IsA(UsdSkel.Animation)]:
            stage.RemovePrim(prim)

    with pytest.raises(InputError, match=rf"man\.usda: (.*: )?{sentence}"):
        read_motion(edited(character, strip))


def test_placed_skeleton_carries_its_character_along(character: Path) -> None:
    def place(stage: Usd.Stage) -> None:
        UsdGeom.Xformable(stage.GetPrimAtPath("/Man")).AddTranslateOp().Set(Gf.Vec3d(100, 0, 0))

    surfaces = read_surfaces(edited(character, place))
    np.testing.assert_allclose(surfaces.vertices.min(axis=0), [0.9, 0, -0.08], atol=1e-7)
    np.testing.assert_allclose(surfaces.clips[0].translations[0, 0], [1, 0, 0], atol=1e-7)


def test_texture_coordinates_are_turned_by_a_transform(character: Path) -> None:
    def turn(stage: Usd.Stage) -> None:
        transform = UsdShade.Shader.Define(stage, "/Man/Skin/Transform")
        transform.CreateIdAttr("UsdTransform2d")
        transform.CreateInput("rotation", Sdf.ValueTypeNames.Float).Set(90.0)
        transform.CreateInput("scale", Sdf.ValueTypeNames.Float2).Set(Gf.Vec2f(2, 3))
        reader = UsdShade.Shader.Get(stage, "/Man/Skin/Reader")
        transform.CreateInput("in", Sdf.ValueTypeNames.Float2).ConnectToSource(reader.GetOutput("result"))
        image = UsdShade.Shader.Get(stage, "/Man/Skin/Image")
        image.GetInput("st").ConnectToSource(transform.CreateOutput("result", Sdf.ValueTypeNames.Float2))

    plain = read_surfaces(character)
    turned = read_surfaces(edited(character, turn))
    u, v = np.moveaxis(plain.uv[plain.uv_faces], -1, 0)
    # scaled, then a quarter turn counter-clockwise with v up: (u, v) to (-3 v, 2 u)
    expected = np.stack([-3 * (1 - v), 1 - 2 * u], axis=-1)
    np.testing.assert_allclose(turned.uv[turned.uv_faces], expected, atol=1e-6)


BROKEN = {
    "bindTransforms": lambda s: (
        UsdSkel.Skeleton.Get(s, "/Man/Skeleton").GetBindTransformsAttr().Set(Vt.Matrix4dArray([Gf.Matrix4d(1)]))
    ),
    "points": lambda s: UsdGeom.Mesh.Get(s, "/Man/Body").GetPointsAttr().Set([Gf.Vec3f(float("nan"))] * 16),
    "faceVertexIndices": lambda s: UsdGeom.Mesh.Get(s, "/Man/Body").GetFaceVertexIndicesAttr().Set([0, 1, 99]),
    "jointIndices": lambda s: UsdSkel.BindingAPI(s.GetPrimAtPath("/Man/Body")).GetJointIndicesAttr().Set([9] * 16),
    "jointWeights": lambda s: UsdSkel.BindingAPI(s.GetPrimAtPath("/Man/Body")).GetJointWeightsAttr().Set([-1.0] * 16),
    "inputs:file": lambda s: UsdShade.Shader.Get(s, "/Man/Skin/Image").GetInput("file").Set("gone.png"),
    "no skinned mesh": lambda s: s.RemovePrim("/Man/Body"),
}


@pytest.mark.parametrize("diagonal", [0.0, float("nan")])
def test_a_bind_pose_that_cannot_be_inverted_is_named(character: Path, diagonal: float) -> None:
    def flatten(stage: Usd.Stage) -> None:
        attribute = UsdSkel.Skeleton.Get(stage, "/Man/Skeleton").GetBindTransformsAttr()
        matrices = list(attribute.Get())
        matrices[-1] = Gf.Matrix4d(diagonal)
        attribute.Set(Vt.Matrix4dArray(matrices))

    with pytest.raises(InputError, match=r"Skeleton\.bindTransforms holds a matrix that cannot be inverted"):
        read_surfaces(edited(character, flatten))


@pytest.mark.parametrize("field", BROKEN)
def test_broken_stage_names_the_field(character: Path, field: str) -> None:
    with pytest.raises(InputError, match=field) as raised:
        read_surfaces(edited(character, BROKEN[field]))
    assert "man.usda" in str(raised.value)


def test_garbage_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "bad.usda"
    path.write_text('#usda 1.0\ndef Xform "A" {\n  double x = \n}\n')
    with pytest.raises(InputError, match=r"cannot open the stage: .*bad\.usda:3:3: Expected }"):
        read_surfaces(path)


def test_truncated_package_is_refused(tmp_path: Path, character: Path) -> None:
    package = tmp_path / "man.usdz"
    UsdUtils.CreateNewUsdzPackage(Sdf.AssetPath(str(character)), str(package))
    package.write_bytes(package.read_bytes()[:200])
    with pytest.raises(InputError, match=r"man\.usdz"):
        read_surfaces(package)


def with_shapes(stage: Usd.Stage) -> None:
    """Two blend shapes of the body, one of which the animation moves."""
    mesh = next(prim for prim in stage.Traverse() if prim.IsA(UsdGeom.Mesh))
    count = len(UsdGeom.Mesh(mesh).GetPointsAttr().Get())
    open_, wide = (UsdSkel.BlendShape.Define(stage, mesh.GetPath().AppendChild(name)) for name in ("Open", "Wide"))
    open_.CreateOffsetsAttr([Gf.Vec3f(0, 10, 0)] * 2)
    open_.CreatePointIndicesAttr([0, 1])
    wide.CreateOffsetsAttr([Gf.Vec3f(5, 0, 0)] * count)
    wide.CreateInbetween("half")
    binding = UsdSkel.BindingAPI.Apply(mesh)
    binding.CreateBlendShapesAttr(["jawOpen", "wide"])
    binding.CreateBlendShapeTargetsRel().SetTargets([open_.GetPath(), wide.GetPath()])
    animation = next(UsdSkel.Animation(prim) for prim in stage.Traverse() if prim.IsA(UsdSkel.Animation))
    animation.CreateBlendShapesAttr(["wide"])
    times = animation.GetRotationsAttr().GetTimeSamples()
    weights = animation.CreateBlendShapeWeightsAttr()
    weights.Set([0.0], times[0])
    weights.Set([1.0], times[-1])


def test_blend_shapes_become_expressions_with_their_weights(character: Path) -> None:
    path = edited(character, with_shapes)
    surfaces = read_surfaces(path)
    assert surfaces.expressions is not None
    assert surfaces.expressions.names == ("jawOpen", "wide")
    lengths = np.linalg.norm(surfaces.expressions.offsets, axis=1)
    first = surfaces.expressions.starts[1]
    np.testing.assert_allclose(lengths[:first], 0.1, atol=1e-6)  # centimetres of the file
    np.testing.assert_allclose(lengths[first:], 0.05, atol=1e-6)
    assert len(lengths) - first == len(surfaces.vertices)
    assert any("inbetweens" in note for note in surfaces.notes)
    weights = np.asarray(surfaces.clips[0].expressions)
    assert not weights[0].any()
    assert weights[-1, 1] > 0.9
    assert (np.diff(weights[:, 1]) > 0).all()
    (source,) = read_motion(path)
    assert source.expressions == ("wide",)


def test_shape_keys_of_smplx_move_both_ways(character: Path) -> None:
    def keyed(stage: Usd.Stage) -> None:
        with_shapes(stage)
        animation = next(UsdSkel.Animation(prim) for prim in stage.Traverse() if prim.IsA(UsdSkel.Animation))
        animation.GetBlendShapesAttr().Set(["Exp000"])
        weights = animation.GetBlendShapeWeightsAttr()
        weights.Set([-UNIT / 2], weights.GetTimeSamples()[0])

    (source,) = read_motion(edited(character, keyed))
    assert source.expressions == ("Exp000+", "Exp000-")
    weights = np.asarray(source.clip.expressions)
    np.testing.assert_allclose(weights[0], [0, 0.5], atol=1e-6)
    assert 0.9 / UNIT < weights[-1, 0] <= 1 / UNIT


def test_blend_shapes_that_do_not_fit_are_named(character: Path) -> None:
    def damage(stage: Usd.Stage) -> None:
        with_shapes(stage)
        shape = next(UsdSkel.BlendShape(p) for p in stage.Traverse() if p.IsA(UsdSkel.BlendShape))
        shape.GetPointIndicesAttr().Set([0, 99999])

    with pytest.raises(InputError, match=r"Open\.pointIndices does not fit 2 offsets and \d+ points"):
        read_surfaces(edited(character, damage))
