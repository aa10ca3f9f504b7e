"""Characters from .usd, .usda, .usdc and .usdz files, by UsdSkel."""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np
from pxr import Tf, Usd, UsdGeom, UsdShade, UsdSkel

from mua.arrays import Array
from mua.errors import InputError
from mua.rig.animation import Animation, bare_animation
from mua.rig.assemble import Surfaces, assemble
from mua.rig.scene import Material, Motion, Part, Scene, Skin
from mua.rig.usd_materials import Look, read_look

RATE = 30.0  # frames per second that clips of a file are sampled at
PREDICATE = Usd.TraverseInstanceProxies(Usd.PrimDefaultPredicate)
NO_TIME = Usd.TimeCode.EarliestTime()


@dataclass(frozen=True)
class _Bones:
    """One UsdSkel skeleton and where its nodes begin: its prim as a static node, then its joints."""

    query: UsdSkel.SkeletonQuery
    first: int  # node of the prim; joint j is node first + 1 + j
    paths: list[str]  # joint paths in the skeleton's order
    parents: Array  # [J] int
    binds: Array  # [J, 4, 4]


def read_usd(path: Path, *, leave_out: Sequence[str] = ()) -> Surfaces:
    """Read all skinned meshes of a stage, in metres and Y up, and the animation bound to their skeletons.

    `leave_out` names meshes or materials that are not part of the character.
    Raises an InputError that names the prim and attribute where the stage is broken or holds no skinned mesh.
    """
    return assemble(_meshes(_opened(path), path), path, leave_out=leave_out)


def read_usd_animation(path: Path) -> Animation:
    """Read the skeletons of a stage and the animation bound to them: those of its skinned meshes, else all animated.

    Raises an InputError where `read_usd` does, except that a mesh may be missing where a skeleton is animated.
    """
    stage = _opened(path)
    scene = _meshes(stage, path)
    if any(len(part.faces) for part in scene.parts):
        rig = assemble(scene, path)
        return Animation(rig.skeleton, rig.clips, ())
    skeletons: list[_Bones] = []
    for query in _animated(stage):
        skeletons.append(_bones(query, path, first=_node_count(skeletons)))
    joints = [bones.first + 1 + np.arange(len(bones.paths)) for bones in skeletons]
    skins = [Skin(at, np.linalg.inv(bones.binds)) for at, bones in zip(joints, skeletons, strict=True)]
    return bare_animation(_scene(stage, skeletons, skins, name=path.stem), path)


def _opened(path: Path) -> Usd.Stage:
    try:
        return Usd.Stage.Open(str(path))
    except Tf.ErrorException as broken:
        raise InputError(f"{path}: USD cannot open the stage: {str(broken).strip().splitlines()[-1]}") from broken


def _meshes(stage: Usd.Stage, path: Path) -> Scene:
    skeletons: list[_Bones] = []
    skins: list[Skin] = []
    parts: list[Part] = []
    materials: list[Material] = []
    notes: list[str] = []
    for skeleton, targets in _bindings(stage):
        bones = _bones(skeleton, path, first=_node_count(skeletons))
        skeletons.append(bones)
        for target in targets:
            skins.append(_skin(target, bones, path))
            mesh = UsdGeom.Mesh(target.GetPrim())
            if target.HasBlendShapes():
                notes.append(f"The blend shapes of mesh {target.GetPrim().GetName()} are left out.")
            for prim, faces in _subsets(mesh):
                look = read_look(mesh, prim, path)
                at = {"skin": len(skins) - 1, "bones": len(skins[-1].joints), "material": len(materials)}
                parts.append(_part(target, look, path, chosen=faces, notes=notes, **at))
                materials.append(look.material)
    scene = _scene(stage, skeletons, skins, name=path.stem)
    return replace(scene, parts=tuple(parts), materials=tuple(materials), notes=tuple(notes))


def _scene(stage: Usd.Stage, skeletons: list[_Bones], skins: list[Skin], *, name: str) -> Scene:
    world = _to_metres(stage)
    return Scene(
        name=name,
        node_names=tuple(name for bones in skeletons for name in _names(bones)),
        parents=np.concatenate([_parents(bones) for bones in skeletons]) if skeletons else np.zeros(0, int),
        rest=world @ np.concatenate([_worlds(bones, NO_TIME, at_rest=True) for bones in skeletons])
        if skeletons
        else np.zeros((0, 4, 4)),
        skins=tuple(skins),
        parts=(),
        materials=(),
        motions=tuple(_motions(stage, skeletons, world=world)),
        notes=(),
    )


def _node_count(skeletons: list[_Bones]) -> int:
    return sum(len(bones.paths) + 1 for bones in skeletons)


def _to_metres(stage: Usd.Stage) -> Array:
    """The matrix [4, 4] from the stage's axes and unit to Y up and metres."""
    world = np.eye(4)
    if UsdGeom.GetStageUpAxis(stage) == UsdGeom.Tokens.z:
        world[:3, :3] = [[1, 0, 0], [0, 0, 1], [0, -1, 0]]
    world[:3, :3] *= UsdGeom.GetStageMetersPerUnit(stage)
    return world


def _bindings(stage: Usd.Stage) -> list[tuple[UsdSkel.SkeletonQuery, list[UsdSkel.SkinningQuery]]]:
    """Each skeleton of the stage with the meshes that it deforms."""
    found = []
    cache = UsdSkel.Cache()
    for prim in stage.Traverse(PREDICATE):
        if not prim.IsA(UsdSkel.Root):
            continue
        root = UsdSkel.Root(prim)
        cache.Populate(root, PREDICATE)
        for binding in cache.ComputeSkelBindings(root, PREDICATE):
            targets = [target for target in binding.GetSkinningTargets() if target.GetPrim().IsA(UsdGeom.Mesh)]
            if targets:
                found.append((cache.GetSkelQuery(binding.GetSkeleton()), targets))
    return found


def _animated(stage: Usd.Stage) -> list[UsdSkel.SkeletonQuery]:
    """Each skeleton of the stage that an animation is bound to."""
    cache = UsdSkel.Cache()
    prims = list(stage.Traverse(PREDICATE))
    for prim in prims:
        if prim.IsA(UsdSkel.Root):
            cache.Populate(UsdSkel.Root(prim), PREDICATE)
    queries = [cache.GetSkelQuery(UsdSkel.Skeleton(prim)) for prim in prims if prim.IsA(UsdSkel.Skeleton)]
    return [query for query in queries if query and query.GetAnimQuery()]


def _bones(query: UsdSkel.SkeletonQuery, path: Path, *, first: int) -> _Bones:
    where = query.GetPrim().GetPath()
    topology = query.GetTopology()
    valid, reason = topology.Validate()
    if not valid:
        raise InputError(f"{path}: {where}.joints is no hierarchy with parents first: {reason}")
    binds = query.GetJointWorldBindTransforms()
    joints = len(query.GetJointOrder())
    if len(binds) != joints or not joints:
        raise InputError(f"{path}: {where}.bindTransforms holds {len(binds)} matrices for {joints} joints")
    matrices = _columns(binds)
    if not np.isfinite(matrices).all() or (np.abs(np.linalg.det(matrices)) < np.finfo(np.float32).tiny).any():
        raise InputError(f"{path}: {where}.bindTransforms holds a matrix that cannot be inverted")
    return _Bones(
        query, first, [str(joint) for joint in query.GetJointOrder()], np.array(topology.GetParentIndices()), matrices
    )


def _columns(matrices: object) -> Array:
    """Column-vector matrices [..., 4, 4] of USD's row-vector ones."""
    return np.swapaxes(np.array(matrices, float), -1, -2)


def _names(bones: _Bones) -> list[str]:
    return [bones.query.GetPrim().GetName(), *(joint.rsplit("/", 1)[-1] for joint in bones.paths)]


def _parents(bones: _Bones) -> Array:
    return np.concatenate([[-1], bones.first + 1 + bones.parents])


def _worlds(bones: _Bones, time: Usd.TimeCode, *, at_rest: bool) -> Array:
    """Node-to-stage matrices [1 + J, 4, 4]: the skeleton's prim, then its joints."""
    prim = _columns(UsdGeom.Xformable(bones.query.GetPrim()).ComputeLocalToWorldTransform(time))
    joints = bones.query.ComputeJointSkelTransforms(time, at_rest)
    skeletal = _columns(joints) if joints else bones.binds  # no rest pose: the bind pose serves
    return np.concatenate([prim[None], prim @ skeletal])


def _skin(target: UsdSkel.SkinningQuery, bones: _Bones, path: Path) -> Skin:
    order = target.GetJointOrder()
    index = {name: j for j, name in enumerate(bones.paths)}
    names = bones.paths if order is None else [str(name) for name in order]
    missing = [name for name in names if name not in index]
    if missing:
        raise InputError(f"{path}: {target.GetPrim().GetPath()}.skel:joints names {missing[0]}, which is no joint")
    joints = np.array([index[name] for name in names])
    inverse_binds = np.linalg.inv(bones.binds[joints]) @ _columns(target.GetGeomBindTransform(NO_TIME))
    return Skin(bones.first + 1 + joints, inverse_binds)


def _subsets(mesh: UsdGeom.Mesh) -> list[tuple[Usd.Prim, Array]]:
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


def _part(
    target: UsdSkel.SkinningQuery,
    look: Look,
    path: Path,
    *,
    chosen: Array,  # [n] faces of the mesh
    skin: int,
    bones: int,
    material: int,
    notes: list[str],
) -> Part:
    mesh = UsdGeom.Mesh(target.GetPrim())
    where = f"{path}: {mesh.GetPath()}"
    points = np.array(mesh.GetPointsAttr().Get(NO_TIME), float).reshape(-1, 3)
    if not np.isfinite(points).all():
        raise InputError(f"{where}.points holds a number that is not finite")
    counts = np.array(mesh.GetFaceVertexCountsAttr().Get(NO_TIME), int)
    corners = np.array(mesh.GetFaceVertexIndicesAttr().Get(NO_TIME), int)
    if counts.sum() != len(corners) or corners.min(initial=0) < 0 or corners.max(initial=-1) >= len(points):
        raise InputError(f"{where}.faceVertexIndices does not fit its {len(counts)} faces and {len(points)} points")
    holes = mesh.GetHoleIndicesAttr().Get(NO_TIME)
    triangles = _fans(counts, np.setdiff1d(chosen, np.array(holes if holes else [], int)))
    if mesh.GetOrientationAttr().Get() == UsdGeom.Tokens.leftHanded:
        triangles = triangles[:, [0, 2, 1]]
    uv, uv_corners = _texture_coordinates(mesh, look, len(points), corners=corners, where=where)
    if uv is None:
        notes.append(f"Mesh {mesh.GetPrim().GetName()} has no texture coordinates.")
    joints, weights = _influences(target, len(points), where, bones=bones)
    return Part(
        name=mesh.GetPrim().GetName(),
        group=skin,
        positions=points,
        faces=corners[triangles],
        uv=np.zeros((0, 2)) if uv is None else uv,
        uv_faces=np.full_like(triangles, -1) if uv is None else uv_corners[triangles],
        material=material,
        skin=skin,
        joints=joints,
        weights=weights,
    )


def _fans(counts: Array, chosen: Array) -> Array:
    """Triangles [F, 3] of corner numbers: each chosen polygon as a fan about its first corner."""
    starts = np.cumsum(counts) - counts
    triangles = np.maximum(counts[chosen] - 2, 0)
    first = np.repeat(starts[chosen], triangles)
    step = np.arange(len(first)) - np.repeat(np.cumsum(triangles) - triangles, triangles)
    return np.stack([first, first + step + 1, first + step + 2], axis=1)


def _texture_coordinates(
    mesh: UsdGeom.Mesh, look: Look, points: int, *, corners: Array, where: str
) -> tuple[Array | None, Array]:
    """UVs [T, 2] with v down, and the one of each face corner."""
    primvars = UsdGeom.PrimvarsAPI(mesh)
    names = [look.primvar] if look.primvar else ["st", "UVMap", "st0", "map1"]
    primvar = next((found for name in names if (found := primvars.FindPrimvarWithInheritance(name)).HasValue()), None)
    if primvar is None:
        return None, corners
    uv = np.array(primvar.ComputeFlattened(NO_TIME), float).reshape(-1, 2)
    per_corner = primvar.GetInterpolation() == UsdGeom.Tokens.faceVarying
    expected = len(corners) if per_corner else points
    if len(uv) != expected or not np.isfinite(uv).all():
        raise InputError(f"{where}.{primvar.GetName()} holds {len(uv)} values, expected {expected} finite ones")
    if look.matrix is not None:
        uv = uv @ look.matrix[:, :2].T + look.matrix[:, 2]
    return np.stack([uv[:, 0], 1 - uv[:, 1]], axis=1), np.arange(len(corners)) if per_corner else corners


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


def _motions(stage: Usd.Stage, skeletons: list[_Bones], *, world: Array) -> list[Motion]:
    """The one clip of the stage, on all its skeletons at once; none where nothing changes over time."""
    animations = [bones.query.GetAnimQuery() for bones in skeletons]
    times = [t for animation in animations if animation for t in animation.GetJointTransformTimeSamples()]
    per_second = stage.GetTimeCodesPerSecond()
    if not times or (max(times) - min(times)) / per_second < 0.5 / RATE:
        return []
    count = int(np.floor((max(times) - min(times)) / per_second * RATE + 1e-3)) + 1
    codes = min(times) + np.arange(count) * per_second / RATE
    worlds = [
        np.concatenate([_worlds(bones, Usd.TimeCode(float(code)), at_rest=False) for bones in skeletons])
        for code in codes
    ]
    name = next(animation.GetPrim().GetName() for animation in animations if animation)
    return [Motion(name, RATE, world @ np.array(worlds))]
