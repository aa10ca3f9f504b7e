"""Triangles, texture coordinates, colours and weights of USD meshes."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from pxr import Usd, UsdGeom, UsdShade, UsdSkel

from mua.arrays import Array
from mua.characters.messages import Messages
from mua.characters.usd.materials import Look
from mua.characters.usd.shapes import read_targets
from mua.errors import InputError
from mua.scene import Part

NO_TIME = Usd.TimeCode.EarliestTime()


@dataclass(frozen=True, eq=False)
class _Topology:
    """How the polygons of a mesh fall into triangles."""

    points: int
    faces: int
    corners: Array  # [C] int point of each face corner
    triangles: Array  # [F, 3] int corner
    face: Array  # [F] int polygon

    def corner_values(self, primvar: UsdGeom.Primvar, width: int, where: str) -> Array:
        """A primvar's value [F, 3, width] at the corners of every triangle."""
        values = np.array(primvar.ComputeFlattened(NO_TIME), float).reshape(-1, width)
        interpolation = primvar.GetInterpolation()
        counts = {"constant": 1, "uniform": self.faces, "faceVarying": len(self.corners)}
        expected = counts.get(interpolation, self.points)
        if len(values) != expected or not np.isfinite(values).all():
            raise InputError(f"{where}.{primvar.GetName()} holds {len(values)} values, expected {expected} finite ones")
        if interpolation == "constant":
            return np.broadcast_to(values[0], (len(self.triangles), 3, width))
        if interpolation == "uniform":
            return np.repeat(values[self.face][:, None], 3, axis=1)
        return values[self.triangles if interpolation == "faceVarying" else self.corners[self.triangles]]


def subsets(mesh: UsdGeom.Mesh) -> list[tuple[Usd.Prim, Array]]:
    """The prims that bind a material, each with its faces; the mesh itself has those in no subset."""
    counts = mesh.GetFaceVertexCountsAttr().Get(NO_TIME)
    rest = np.ones(len(counts or []), bool)
    found = []
    for subset in UsdShade.MaterialBindingAPI(mesh.GetPrim()).GetMaterialBindSubsets():
        faces = np.array(subset.GetIndicesAttr().Get(NO_TIME), int)
        faces = faces[(faces >= 0) & (faces < len(rest))]
        rest[faces] = False
        found.append((subset.GetPrim(), faces))
    if rest.any():
        found.append((mesh.GetPrim(), np.flatnonzero(rest)))
    return found


def read_part(
    mesh: UsdGeom.Mesh,
    look: Look,
    path: Path,
    *,
    target: UsdSkel.SkinningQuery | None,  # None: the mesh is rigid
    chosen: Array,  # [n] faces of the mesh
    skin: int,
    bones: int,
    material: int,
    messages: Messages,
) -> Part:
    """The chosen faces of a mesh on a skin of `bones` joints; an InputError names an attribute that does not fit."""
    where = f"{path}: {mesh.GetPath()}"
    points = np.array(mesh.GetPointsAttr().Get(NO_TIME), float).reshape(-1, 3)
    if not np.isfinite(points).all():
        raise InputError(f"{where}.points holds a number that is not finite")
    topology = _topology(mesh, len(points), where, chosen=chosen)
    uv = _texture_coordinates(mesh, look, topology, where)
    if uv is None and look.needed:
        messages.add(
            "Meshes without the texture coordinates that their material asks for: {}.", mesh.GetPrim().GetName()
        )
    joints, weights = np.zeros((len(points), 1), int), np.ones((len(points), 1))
    if target is not None:
        joints, weights = _influences(target, len(points), where, bones=bones)
    return Part(
        name=mesh.GetPrim().GetName(),
        group=skin,
        positions=points,
        faces=topology.corners[topology.triangles],
        uv=np.zeros((0, 2)) if uv is None else uv.reshape(-1, 2),
        uv_faces=np.full_like(topology.triangles, -1) if uv is None else np.arange(uv.size // 2).reshape(-1, 3),
        material=material,
        skin=skin,
        joints=joints,
        weights=weights,
        node=mesh.GetPrim().GetParent().GetName(),
        colors=_colors(mesh, look, topology, where),
        targets=read_targets(target, len(points), where, messages),
    )


def _topology(mesh: UsdGeom.Mesh, points: int, where: str, *, chosen: Array) -> _Topology:
    counts = np.array(mesh.GetFaceVertexCountsAttr().Get(NO_TIME), int)
    corners = np.array(mesh.GetFaceVertexIndicesAttr().Get(NO_TIME), int)
    if counts.sum() != len(corners) or corners.min(initial=0) < 0 or corners.max(initial=-1) >= points:
        raise InputError(f"{where}.faceVertexIndices does not fit its {len(counts)} faces and {points} points")
    holes = mesh.GetHoleIndicesAttr().Get(NO_TIME)
    drawn = np.setdiff1d(chosen, np.array(holes if holes else [], int))
    triangles = _fans(counts, drawn)
    if mesh.GetOrientationAttr().Get() == UsdGeom.Tokens.leftHanded:
        triangles = triangles[:, [0, 2, 1]]
    face = np.repeat(drawn, np.maximum(counts[drawn] - 2, 0))
    return _Topology(points, len(counts), corners, triangles, face)


def _fans(counts: Array, chosen: Array) -> Array:
    """Triangles [F, 3] of corner numbers: each chosen polygon as a fan about its first corner."""
    starts = np.cumsum(counts) - counts
    triangles = np.maximum(counts[chosen] - 2, 0)
    first = np.repeat(starts[chosen], triangles)
    step = np.arange(len(first)) - np.repeat(np.cumsum(triangles) - triangles, triangles)
    return np.stack([first, first + step + 1, first + step + 2], axis=1)


def _colors(mesh: UsdGeom.Mesh, look: Look, topology: _Topology, where: str) -> Array | None:
    """Linear colours and opacity [F, 3, 4] of the triangles' corners; None where there are none but white."""
    rgba = np.ones((len(topology.triangles), 3, 4))
    primvars = UsdGeom.PrimvarsAPI(mesh)
    for name, first, width in ((look.color_primvar, 0, 3), (look.opacity_primvar, 3, 1)):
        primvar = primvars.FindPrimvarWithInheritance(name) if name else None
        if primvar and primvar.HasValue():
            rgba[..., first : first + width] = topology.corner_values(primvar, width, where)
    rgba = np.clip(rgba, 0, 1)
    return None if (rgba == 1).all() else rgba


def _texture_coordinates(mesh: UsdGeom.Mesh, look: Look, topology: _Topology, where: str) -> Array | None:
    """UVs [F, 3, 2] of the triangles' corners, v down; None where there are none."""
    primvars = UsdGeom.PrimvarsAPI(mesh)
    names = [look.primvar] if look.primvar else ["st", "UVMap", "st0", "map1"]
    primvar = next((found for name in names if (found := primvars.FindPrimvarWithInheritance(name)).HasValue()), None)
    if primvar is None:
        return None
    uv = topology.corner_values(primvar, 2, where)
    uv = uv @ look.matrix[:, :2].T + look.matrix[:, 2]
    return np.stack([uv[..., 0], 1 - uv[..., 1]], axis=-1)


def _influences(target: UsdSkel.SkinningQuery, points: int, where: str, *, bones: int) -> tuple[Array, Array]:
    """Joints [N, K] in the mesh's own order and their weights [N, K]."""
    influences = target.ComputeVaryingJointInfluences(points, NO_TIME)
    count = target.GetNumInfluencesPerComponent()
    if not influences or not influences[0] or len(influences[0]) != points * count:
        raise InputError(f"{where}.primvars:skel:jointIndices does not hold {count} influences for {points} points")
    joints = np.array(influences[0], int).reshape(points, count)
    weights = np.array(influences[1], float).reshape(points, count)
    if not np.isfinite(weights).all() or weights.min() < 0:
        raise InputError(f"{where}.primvars:skel:jointWeights holds a weight that is negative or not finite")
    beyond = (weights > 0) & ((joints < 0) | (joints >= bones))
    if beyond.any():
        raise InputError(f"{where}.primvars:skel:jointIndices holds {joints[beyond][0]}, but there are {bones} joints")
    return np.where(weights > 0, joints, 0), weights
