"""Exported USD: skeleton, skin, detailed geometry and splats as Pixar's own library reads them."""

import io
import os
import resource
from pathlib import Path

import numpy as np
import pytest
from commands import Commands
from people import upright
from PIL import Image
from pxr import Ar, Sdf, Usd, UsdGeom, UsdShade, UsdSkel, UsdUtils, UsdValidation, UsdVol
from synthetic_avatar import with_surface

import mua
from mua import rotation
from mua.export.splats import mean_colors, world_splats
from mua.export.surface import skinned_mesh
from mua.export.usd import joint_paths
from mua.kernels.dq_skinning import blend_vertices
from mua.motion.read import read_motion
from mua.player.surface import surface_mesh

EPSILON = 2.0**-23
PLACE_BOUND = 32 * EPSILON  # metres: forward kinematics of three joints of half a metre from float32 keys
SKIN_BOUND = 1e-5  # metres: dual quaternions blended in float32, there and here
FRAMES = range(1, 6, 2)


@pytest.fixture
def stored(avatar_file: Path) -> mua.Avatar:
    """The avatar as its file holds it."""
    mua.save(avatar_file, with_surface(mua.load(avatar_file)))
    return mua.load(avatar_file)


def exported(command: Commands, avatar_file: Path, tmp_path: Path, what: str, ending: str = "usdc") -> Usd.Stage:
    path = tmp_path / f"{what}.{ending}"
    ended = command("export", avatar_file, "-o", path, "--what", what, "--frames", "1:6:2")
    assert (ended.status, ended.err) == (0, "")
    return Usd.Stage.Open(str(path))


@pytest.mark.parametrize("what", ["mesh", "skeleton", "geometry", "splats"])
def test_a_stage_says_its_units_axis_times_and_default_prim(
    command: Commands, stored: mua.Avatar, avatar_file: Path, tmp_path: Path, what: str
) -> None:
    stage = exported(command, avatar_file, tmp_path, what)
    assert UsdGeom.GetStageUpAxis(stage) == "Y"
    assert UsdGeom.GetStageMetersPerUnit(stage) == 1
    assert (stage.GetTimeCodesPerSecond(), stage.GetStartTimeCode(), stage.GetEndTimeCode()) == (12, 0, 2)
    assert stage.GetDefaultPrim().GetName() == stored.name


@pytest.mark.parametrize("ending", ["usd", "usda", "usdc"])
def test_usdskel_finds_the_joints_where_they_were(
    command: Commands, stored: mua.Avatar, avatar_file: Path, tmp_path: Path, ending: str
) -> None:
    stage = exported(command, avatar_file, tmp_path, "skeleton", ending)
    query = UsdSkel.Cache().GetSkelQuery(UsdSkel.Skeleton(stage.GetPrimAtPath(f"/{stored.name}/Skeleton")))
    assert list(query.GetJointOrder()) == ["root", "root/middle", "root/middle/tip"]
    clip, skeleton = stored.clips[0], stored.rig.skeleton
    turned, placed = skeleton.world(clip.rotations, clip.translations)
    for time, frame in enumerate(FRAMES):
        worlds = np.array(query.ComputeJointSkelTransforms(time)).swapaxes(1, 2)
        np.testing.assert_allclose(worlds[:, :3, 3], placed[frame], atol=PLACE_BOUND)
        np.testing.assert_allclose(worlds[:, :3, :3], rotation.to_matrix(turned[frame]), atol=PLACE_BOUND)


def test_usdskel_skins_the_mesh_by_dual_quaternions_as_we_do(
    command: Commands, stored: mua.Avatar, avatar_file: Path, tmp_path: Path
) -> None:
    stage = exported(command, avatar_file, tmp_path, "mesh")
    root, cache = UsdSkel.Root(stage.GetDefaultPrim()), UsdSkel.Cache()
    cache.Populate(root, Usd.PrimDefaultPredicate)
    (binding,) = cache.ComputeSkelBindings(root, Usd.PrimDefaultPredicate)
    (target,) = binding.GetSkinningTargets()
    assert target.GetSkinningMethod() == "dualQuaternion"
    query = cache.GetSkelQuery(binding.GetSkeleton())
    mesh, rig, clip = UsdGeom.Mesh(target.GetPrim()), stored.rig, stored.clips[0]
    faces = np.array(mesh.GetFaceVertexIndicesAttr().Get()).reshape(-1, 3)
    for time, frame in enumerate(FRAMES):
        points = mesh.GetPointsAttr().Get()
        assert target.ComputeSkinnedPoints(query.ComputeSkinningTransforms(time), points, time)
        dual = rig.skeleton.skinning(clip.rotations[frame], clip.translations[frame])
        ours = rotation.dual_transform(blend_vertices(dual, rig.skin_indices, rig.skin_weights), rig.mesh.vertices)
        np.testing.assert_allclose(np.array(points)[faces], ours[rig.mesh.faces], atol=SKIN_BOUND)


def test_the_mesh_has_its_uvs_upward_and_colours(
    command: Commands, stored: mua.Avatar, avatar_file: Path, tmp_path: Path
) -> None:
    stage = exported(command, avatar_file, tmp_path, "mesh")
    mesh = UsdGeom.Mesh(stage.GetPrimAtPath(f"/{stored.name}/Mesh"))
    faces = np.array(mesh.GetFaceVertexIndicesAttr().Get()).reshape(-1, 3)
    uv = np.array(UsdGeom.PrimvarsAPI(mesh).GetPrimvar("st").Get())[faces]
    expected = stored.rig.mesh.uv[stored.rig.mesh.uv_faces]
    np.testing.assert_allclose(uv, np.stack([expected[..., 0], 1 - expected[..., 1]], axis=-1), atol=EPSILON)
    colors = np.array(mesh.GetDisplayColorAttr().Get())
    assert colors.shape == (len(mesh.GetPointsAttr().Get()), 3)
    assert np.ptp(colors) > 0.01


def test_joints_whose_names_usd_takes_for_one_have_paths_of_their_own() -> None:
    skeleton = upright(("hips", "left leg", "left.leg", "left leg"), (-1, 0, 0, 2), [[0, 1, 0]] * 4)
    assert joint_paths(skeleton) == ["hips", "hips/left_leg", "hips/left_leg_", "hips/left_leg_/left_leg"]


def test_the_detailed_geometry_has_points_and_colours_at_every_frame(
    command: Commands, stored: mua.Avatar, avatar_file: Path, tmp_path: Path
) -> None:
    stage = exported(command, avatar_file, tmp_path, "geometry")
    mesh = UsdGeom.Mesh(stage.GetPrimAtPath(f"/{stored.name}/Geometry"))
    faces = np.array(mesh.GetFaceVertexIndicesAttr().Get()).reshape(-1, 3)
    np.testing.assert_array_equal(faces, surface_mesh(stored).triangles)
    assert set(mesh.GetFaceVertexCountsAttr().Get()) == {3}
    assert mesh.GetSubdivisionSchemeAttr().Get() == "none"
    assert mesh.GetPointsAttr().GetTimeSamples() == [0, 1, 2]
    for time, frame in enumerate(FRAMES):
        splats = stored.decode("wave", frame)
        np.testing.assert_array_equal(mesh.GetPointsAttr().Get(time), splats.centres)
        box = np.stack([splats.centres.min(axis=0), splats.centres.max(axis=0)])
        np.testing.assert_array_equal(mesh.GetExtentAttr().Get(time), box)
        linear = np.array(mesh.GetDisplayColorAttr().Get(time))
        srgb = np.where(linear <= 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
        np.testing.assert_allclose(srgb, np.clip(mean_colors(splats.sh), 0, 1), atol=1e-5)


def test_the_splats_are_those_of_every_frame(
    command: Commands, stored: mua.Avatar, avatar_file: Path, tmp_path: Path
) -> None:
    stage = exported(command, avatar_file, tmp_path, "splats")
    prim = UsdVol.ParticleField3DGaussianSplat(stage.GetPrimAtPath(f"/{stored.name}/Splats"))
    assert prim.GetRadianceSphericalHarmonicsDegreeAttr().Get() == 1
    for time, frame in enumerate(FRAMES):
        posed = stored.decode("wave", frame)
        np.testing.assert_array_equal(prim.GetPositionsAttr().Get(time), posed.centres)
        turns = [(q.GetReal(), *q.GetImaginary()) for q in prim.GetOrientationsAttr().Get(time)]
        np.testing.assert_array_equal(turns, posed.rotations)
        np.testing.assert_allclose(prim.GetScalesAttr().Get(time), posed.scales, rtol=4 * EPSILON)
        np.testing.assert_allclose(prim.GetOpacitiesAttr().Get(time), posed.opacities, atol=4 * EPSILON)
        coefficients = np.array(prim.GetRadianceSphericalHarmonicsCoefficientsAttr().Get(time))
        np.testing.assert_array_equal(coefficients.reshape(-1, 12), world_splats(posed).sh)
        low, high = np.array(prim.GetExtentAttr().Get(time))
        assert (posed.centres > low).all()
        assert (posed.centres < high).all()


def test_rejects_a_library_without_splats(
    command: Commands, avatar_file: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delattr(UsdVol, "ParticleField3DGaussianSplat")
    message = command("export", avatar_file, "-o", tmp_path / "a.usdc", "--what", "splats").sentence
    assert "splats in USD need usd-core 26.3 or later, found" in message
    assert list(tmp_path.iterdir()) == []


def test_our_own_reader_finds_the_same_motion(
    command: Commands, stored: mua.Avatar, avatar_file: Path, tmp_path: Path
) -> None:
    exported(command, avatar_file, tmp_path, "mesh")
    (motion,) = read_motion(tmp_path / "mesh.usdc")
    clip, skeleton = stored.clips[0], stored.rig.skeleton
    _, placed = skeleton.world(clip.rotations, clip.translations)
    _, found = motion.skeleton.world(motion.clip.rotations, motion.clip.translations)
    order = [motion.skeleton.names.index(name) for name in skeleton.names]
    np.testing.assert_allclose(found[[0, -1]][:, order], placed[[1, 5]], atol=PLACE_BOUND)


@pytest.mark.parametrize("what", ["mesh", "skeleton", "geometry", "splats"])
def test_a_package_holds_the_same_and_pixar_finds_nothing_wrong(
    command: Commands, stored: mua.Avatar, avatar_file: Path, tmp_path: Path, what: str
) -> None:
    stage = exported(command, avatar_file, tmp_path, what, "usdz")
    assert stage.GetDefaultPrim().GetName() == stored.name
    assert [path.name for path in tmp_path.iterdir()] == [f"{what}.usdz"]
    rules = UsdValidation.ValidationRegistry().GetOrLoadAllValidators()
    assert rules
    assert [error.GetMessage() for error in UsdValidation.ValidationContext(rules).Validate(stage)] == []


def test_the_mesh_of_a_package_shines_in_its_texture(
    command: Commands, stored: mua.Avatar, avatar_file: Path, tmp_path: Path
) -> None:
    stage = exported(command, avatar_file, tmp_path, "mesh", "usdz")
    mesh = stage.GetPrimAtPath(f"/{stored.name}/Mesh")
    material, _ = UsdShade.MaterialBindingAPI(mesh).ComputeBoundMaterial()
    surface, _, _ = material.ComputeSurfaceSource()
    ((source,), _) = surface.GetInput("emissiveColor").GetConnectedSources()
    image = UsdShade.Shader(source.source.GetPrim())
    assert image.GetInput("sourceColorSpace").Get() == "sRGB"  # "raw" would be seen too pale
    asset = Ar.GetResolver().OpenAsset(Ar.ResolvedPath(image.GetInput("file").Get().resolvedPath))
    with Image.open(io.BytesIO(bytes(asset.GetBuffer()))) as picture:
        pixels = np.asarray(picture)
    expected = skinned_mesh(stored, stored.decode("wave", 1)).texture
    np.testing.assert_array_equal(pixels, expected)


@pytest.mark.parametrize("ending", ["usdc", "usda"])
def test_a_disk_without_room_is_reported_in_a_sentence_and_leaves_nothing(
    command: Commands, avatar_file: Path, tmp_path: Path, ending: str
) -> None:
    out, before = tmp_path / f"out.{ending}", resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (2000, before[1]))
    try:
        ended = command("export", avatar_file, "-o", out, "--what", "geometry")
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, before)
    assert ended.sentence.startswith(f"error: {out}: cannot be written (")
    assert list(tmp_path.iterdir()) == []


def test_a_package_that_the_library_cuts_short_is_refused(
    command: Commands, avatar_file: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """As it does on a full disk, where it says that all went well."""
    make = UsdUtils.CreateNewUsdzPackage

    def make_half(source: Sdf.AssetPath, target: str) -> bool:
        made = make(source, target)
        os.truncate(target, Path(target).stat().st_size // 2)
        return bool(made)

    monkeypatch.setattr(UsdUtils, "CreateNewUsdzPackage", make_half)
    ended = command("export", avatar_file, "-o", tmp_path / "out.usdz", "--what", "skeleton")
    assert (
        ended.sentence == f"error: {tmp_path / 'out.usdz'}: cannot be written (the USD library could not write it all)"
    )
    assert list(tmp_path.iterdir()) == []
