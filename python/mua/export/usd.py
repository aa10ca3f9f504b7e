"""Skeleton with motion, skinned template, detailed geometry and splats as USD, each with a time sample for each frame.

Metres, Y up; a time code for each exported frame, from 0. Colours are sRGB turned linear, as USD's display colours are;
the spherical harmonics of splats stay sRGB, as in 3D Gaussian Splatting.
"""

import errno
import re
import zipfile
from collections.abc import Iterable, Iterator
from contextlib import contextmanager
from pathlib import Path

import numpy as np
from pxr import Gf, Sdf, Tf, Usd, UsdGeom, UsdShade, UsdSkel, UsdUtils, UsdVol, Vt

from mua.arrays import Array
from mua.avatar.decode import Splats
from mua.errors import InputError
from mua.export.frames import ExportFrames
from mua.export.glb import to_linear
from mua.export.joints import bind_matrices, matrices
from mua.export.splats import mean_colors, world_splats
from mua.export.surface import DetailedMesh, SkinnedMesh
from mua.pose.skeleton import Skeleton

REASON = re.compile(r": '(.*?)'$", re.MULTILINE)  # of each error that the library lists, the first being the cause
SPLAT_SCHEMA = "ParticleField3DGaussianSplat"  # in OpenUSD 26.03 and later


def write_character(path: Path, frames: ExportFrames, mesh: SkinnedMesh | None, *, texture: str | None = None) -> None:
    """The skeleton with its motion, and the mesh if there is one, which UsdSkel deforms by dual quaternions.

    `texture` is the name of an image beside the file, which the mesh shows without light; without one it has colours
    at its vertices.
    """
    with _stage(path, frames) as (stage, name):
        UsdSkel.Root.Define(stage, name)
        skeleton = frames.avatar.rig.skeleton
        joints = joint_paths(skeleton)
        prim = UsdSkel.Skeleton.Define(stage, f"{name}/Skeleton")
        prim.CreateJointsAttr(joints)
        prim.CreateBindTransformsAttr(_usd_matrices(bind_matrices(skeleton)))
        prim.CreateRestTransformsAttr(_usd_matrices(matrices(skeleton.bind_rotations, skeleton.bind_translations)))
        animation = _animation(stage, f"{name}/Skeleton/Animation", joints, frames)
        UsdSkel.BindingAPI.Apply(prim.GetPrim()).CreateAnimationSourceRel().SetTargets([animation.GetPath()])
        if mesh is not None:
            skinned = _skinned(stage, f"{name}/Mesh", prim, mesh)
            if texture is not None:
                _unlit(stage, f"{name}/Material", skinned, texture)


def write_geometry(path: Path, frames: ExportFrames, posed: Iterable[Splats], mesh: DetailedMesh) -> None:
    """The detailed geometry of every frame, vertex by vertex."""
    with _stage(path, frames) as (stage, name):
        UsdGeom.Xform.Define(stage, name)
        prim = UsdGeom.Mesh.Define(stage, f"{name}/Geometry")
        _topology(prim, mesh.faces)
        colors = UsdGeom.PrimvarsAPI(prim).CreatePrimvar(
            "displayColor", Sdf.ValueTypeNames.Color3fArray, UsdGeom.Tokens.vertex
        )
        for time, splats in enumerate(posed):
            prim.GetPointsAttr().Set(_vectors(splats.centres), time)
            prim.GetExtentAttr().Set(_vectors(_extent(splats.centres)), time)
            colors.Set(_vectors(_display(mean_colors(splats.sh))), time)


def write_splats(path: Path, frames: ExportFrames, posed: Iterable[Splats]) -> None:
    """The splats of every frame; errors: InputError where the library is too old to know splats."""
    if not hasattr(UsdVol, SPLAT_SCHEMA):
        raise InputError(f"{path}: splats in USD need usd-core 26.3 or later, found {Usd.GetVersion()}")
    with _stage(path, frames) as (stage, name):
        UsdGeom.Xform.Define(stage, name)
        prim = UsdVol.ParticleField3DGaussianSplat.Define(stage, f"{name}/Splats")
        prim.CreateRadianceSphericalHarmonicsDegreeAttr(1)
        for time, each in enumerate(posed):
            splats = world_splats(each)
            reach = 3 * splats.scales.max(axis=1, keepdims=True)
            box = np.concatenate([splats.centres - reach, splats.centres + reach])
            prim.GetPositionsAttr().Set(_vectors(splats.centres), time)
            prim.GetOrientationsAttr().Set(_quaternions(splats.rotations), time)
            prim.GetScalesAttr().Set(_vectors(splats.scales), time)
            prim.GetOpacitiesAttr().Set(Vt.FloatArray.FromNumpy(splats.opacities.astype(np.float32)), time)
            prim.GetRadianceSphericalHarmonicsCoefficientsAttr().Set(_vectors(splats.sh.reshape(-1, 3)), time)
            prim.GetExtentAttr().Set(_vectors(_extent(box)), time)


def package(path: Path, stage: Path) -> None:
    """A .usdz of a stage and the files that it refers to; errors: OSError where the library fails."""
    made = UsdUtils.CreateNewUsdzPackage(Sdf.AssetPath(str(stage)), str(path))
    if not made or not zipfile.is_zipfile(path):  # it tells nothing of a full disk
        raise OSError(errno.EIO, "the USD library could not write it all")


def joint_paths(skeleton: Skeleton) -> list[str]:
    """The path of each joint, as UsdSkel names it."""
    paths: list[str] = []
    for name, parent in zip(skeleton.names, skeleton.parents, strict=True):
        above = f"{paths[parent]}/" if parent >= 0 else ""
        own = Tf.MakeValidIdentifier(name)
        while above + own in paths:
            own += "_"
        paths.append(above + own)
    return paths


@contextmanager
def _stage(path: Path, frames: ExportFrames) -> Iterator[tuple[Usd.Stage, str]]:
    """A new stage and the path of its default prim, which is still to be defined; saved at the end.

    Errors: OSError where the system refuses to write, in the words of the library.
    """
    try:
        stage = Usd.Stage.CreateNew(str(path))
        yield stage, _begin(stage, frames)
        stage.Save()
    except Tf.ErrorException as error:
        said = REASON.search(str(error))
        raise OSError(errno.EIO, said[1] if said else "the USD library failed") from error


def _begin(stage: Usd.Stage, frames: ExportFrames) -> str:
    """Say units, axes and times of a new stage; the path of its default prim."""
    UsdGeom.SetStageUpAxis(stage, UsdGeom.Tokens.y)
    UsdGeom.SetStageMetersPerUnit(stage, 1)
    stage.SetTimeCodesPerSecond(frames.rate)
    stage.SetFramesPerSecond(frames.rate)
    stage.SetStartTimeCode(0)
    stage.SetEndTimeCode(len(frames.numbers) - 1)
    name = f"/{Tf.MakeValidIdentifier(frames.avatar.name or 'avatar')}"
    stage.SetDefaultPrim(stage.DefinePrim(name))
    return name


def _animation(stage: Usd.Stage, path: str, joints: list[str], frames: ExportFrames) -> UsdSkel.Animation:
    animation = UsdSkel.Animation.Define(stage, path)
    animation.CreateJointsAttr(joints)
    animation.CreateScalesAttr(Vt.Vec3hArray([Gf.Vec3h(1, 1, 1)] * len(joints)))
    rotations, translations = animation.CreateRotationsAttr(), animation.CreateTranslationsAttr()
    clip = frames.poses
    for time in range(len(clip)):
        rotations.Set(_quaternions(clip.rotations[time]), time)
        translations.Set(_vectors(clip.translations[time]), time)
    return animation


def _skinned(stage: Usd.Stage, path: str, skeleton: UsdSkel.Skeleton, mesh: SkinnedMesh) -> UsdGeom.Mesh:
    prim = UsdGeom.Mesh.Define(stage, path)
    _topology(prim, mesh.faces)
    prim.GetPointsAttr().Set(_vectors(mesh.vertices))
    prim.GetExtentAttr().Set(_vectors(_extent(mesh.vertices)))
    prim.GetNormalsAttr().Set(_vectors(mesh.normals))
    prim.SetNormalsInterpolation(UsdGeom.Tokens.vertex)
    primvars, kinds = UsdGeom.PrimvarsAPI(prim), Sdf.ValueTypeNames
    upward = np.column_stack([mesh.uv[:, 0], 1 - mesh.uv[:, 1]])  # USD counts v from below
    uv = primvars.CreatePrimvar("st", kinds.TexCoord2fArray, UsdGeom.Tokens.vertex)
    uv.Set(Vt.Vec2fArray.FromNumpy(np.ascontiguousarray(upward, np.float32)))
    colors = primvars.CreatePrimvar("displayColor", kinds.Color3fArray, UsdGeom.Tokens.vertex)
    colors.Set(_vectors(_display(mesh.colors)))
    binding = UsdSkel.BindingAPI.Apply(prim.GetPrim())
    binding.CreateSkeletonRel().SetTargets([skeleton.GetPath()])
    binding.CreateGeomBindTransformAttr(Gf.Matrix4d().SetIdentity())
    influences = mesh.joints.shape[1]
    joints = Vt.IntArray.FromNumpy(np.ascontiguousarray(mesh.joints.ravel(), np.int32))
    weights = Vt.FloatArray.FromNumpy(np.ascontiguousarray(mesh.weights.ravel(), np.float32))
    binding.CreateJointIndicesPrimvar(constant=False, elementSize=influences).Set(joints)
    binding.CreateJointWeightsPrimvar(constant=False, elementSize=influences).Set(weights)
    binding.CreateSkinningMethodAttr(UsdSkel.Tokens.dualQuaternion)
    return prim


def _unlit(stage: Usd.Stage, path: str, mesh: UsdGeom.Mesh, texture: str) -> None:
    """A material that shines in the colours of a texture: they have their light in them."""
    types = Sdf.ValueTypeNames
    material = UsdShade.Material.Define(stage, path)
    place = UsdShade.Shader.Define(stage, f"{path}/Place")
    place.CreateIdAttr("UsdPrimvarReader_float2")
    place.CreateInput("varname", types.String).Set("st")
    image = UsdShade.Shader.Define(stage, f"{path}/Texture")
    image.CreateIdAttr("UsdUVTexture")
    image.CreateInput("file", types.Asset).Set(texture)
    image.CreateInput("sourceColorSpace", types.Token).Set("sRGB")
    image.CreateInput("st", types.Float2).ConnectToSource(place.CreateOutput("result", types.Float2))
    surface = UsdShade.Shader.Define(stage, f"{path}/Surface")
    surface.CreateIdAttr("UsdPreviewSurface")
    surface.CreateInput("diffuseColor", types.Color3f).Set(Gf.Vec3f(0))
    surface.CreateInput("roughness", types.Float).Set(1.0)
    shine = surface.CreateInput("emissiveColor", types.Color3f)
    shine.ConnectToSource(image.CreateOutput("rgb", types.Float3))
    material.CreateSurfaceOutput().ConnectToSource(surface.CreateOutput("surface", types.Token))
    UsdShade.MaterialBindingAPI.Apply(mesh.GetPrim()).Bind(material)


def _topology(prim: UsdGeom.Mesh, faces: Array) -> None:
    prim.CreateFaceVertexCountsAttr(Vt.IntArray.FromNumpy(np.full(len(faces), 3, np.int32)))
    prim.CreateFaceVertexIndicesAttr(Vt.IntArray.FromNumpy(np.ascontiguousarray(faces.ravel(), np.int32)))
    prim.CreateSubdivisionSchemeAttr(UsdGeom.Tokens.none)
    prim.CreateDoubleSidedAttr(True)


def _extent(points: Array) -> Array:
    return np.stack([points.min(axis=0), points.max(axis=0)])


def _display(colors: Array) -> Array:
    return to_linear(np.clip(colors, 0, 1))


def _vectors(values: Array) -> Vt.Vec3fArray:
    return Vt.Vec3fArray.FromNumpy(np.ascontiguousarray(values, np.float32))


def _quaternions(rotations: Array) -> Vt.QuatfArray:
    """USD quaternions from wxyz; USD's arrays have the real part last."""
    return Vt.QuatfArray.FromNumpy(np.ascontiguousarray(np.roll(rotations, -1, axis=-1), np.float32))


def _usd_matrices(values: Array) -> Vt.Matrix4dArray:
    """USD's matrices act on row vectors."""
    return Vt.Matrix4dArray.FromNumpy(np.ascontiguousarray(values.swapaxes(1, 2)))
