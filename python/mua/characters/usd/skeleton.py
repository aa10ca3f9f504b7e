"""Skeletons of a USD stage by UsdSkel: their joints, what is bound to them, and where they stand at a time."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from pxr import Usd, UsdGeom, UsdSkel

from mua.arrays import Array
from mua.errors import InputError
from mua.scene import Skin

PREDICATE = Usd.TraverseInstanceProxies(Usd.PrimDefaultPredicate)
NO_TIME = Usd.TimeCode.EarliestTime()


@dataclass(frozen=True, eq=False)
class Bones:
    """One UsdSkel skeleton and where its nodes begin: its prim as a static node, then its joints."""

    query: UsdSkel.SkeletonQuery
    first: int  # node of the prim; joint j is node first + 1 + j
    paths: list[str]  # joint paths in the skeleton's order
    topology: Array  # [J] int parent of each joint
    binds: Array  # [J, 4, 4]

    @property
    def prims(self) -> list[Usd.Prim]:
        return [self.query.GetPrim()]

    @property
    def names(self) -> list[str]:
        return [self.query.GetPrim().GetName(), *(joint.rsplit("/", 1)[-1] for joint in self.paths)]

    @property
    def parents(self) -> Array:
        return np.concatenate([[-1], self.first + 1 + self.topology])

    def worlds(self, time: Usd.TimeCode, *, at_rest: bool) -> Array:
        """Node-to-stage matrices [1 + J, 4, 4]: the skeleton's prim, then its joints."""
        prim = columns(UsdGeom.Xformable(self.query.GetPrim()).ComputeLocalToWorldTransform(time))
        joints = self.query.ComputeJointSkelTransforms(time, at_rest)
        skeletal = columns(joints) if joints else self.binds  # no rest pose: the bind pose serves
        return np.concatenate([prim[None], prim @ skeletal])


def bindings(stage: Usd.Stage) -> list[tuple[UsdSkel.SkeletonQuery, list[UsdSkel.SkinningQuery]]]:
    """Each skeleton of the stage that has joints, with the meshes that it deforms."""
    found = []
    cache = UsdSkel.Cache()
    for prim in stage.Traverse(PREDICATE):
        if not prim.IsA(UsdSkel.Root):
            continue
        root = UsdSkel.Root(prim)
        cache.Populate(root, PREDICATE)
        for binding in cache.ComputeSkelBindings(root, PREDICATE):
            targets = [target for target in binding.GetSkinningTargets() if target.GetPrim().IsA(UsdGeom.Mesh)]
            query = cache.GetSkelQuery(binding.GetSkeleton())
            if targets and query and len(query.GetJointOrder()):
                found.append((query, targets))
    return found


def animated(stage: Usd.Stage) -> list[UsdSkel.SkeletonQuery]:
    """Each skeleton of the stage that an animation is bound to."""
    cache = UsdSkel.Cache()
    prims = list(stage.Traverse(PREDICATE))
    for prim in prims:
        if prim.IsA(UsdSkel.Root):
            cache.Populate(UsdSkel.Root(prim), PREDICATE)
    queries = [cache.GetSkelQuery(UsdSkel.Skeleton(prim)) for prim in prims if prim.IsA(UsdSkel.Skeleton)]
    return [query for query in queries if query and query.GetAnimQuery()]


def read_bones(query: UsdSkel.SkeletonQuery, path: Path, *, first: int) -> Bones:
    """A skeleton whose nodes begin at `first`; an InputError names what does not fit together."""
    where = query.GetPrim().GetPath()
    topology = query.GetTopology()
    valid, reason = topology.Validate()
    if not valid:
        raise InputError(f"{path}: {where}.joints is no hierarchy with parents first: {reason}")
    binds = query.GetJointWorldBindTransforms()
    joints = len(query.GetJointOrder())
    if len(binds) != joints or not joints:
        raise InputError(f"{path}: {where}.bindTransforms holds {len(binds)} matrices for {joints} joints")
    matrices = columns(binds)
    if not np.isfinite(matrices).all() or (np.abs(np.linalg.det(matrices)) < np.finfo(np.float32).tiny).any():
        raise InputError(f"{path}: {where}.bindTransforms holds a matrix that cannot be inverted")
    paths = [str(joint) for joint in query.GetJointOrder()]
    return Bones(query, first, paths, np.array(topology.GetParentIndices()), matrices)


def columns(matrices: object) -> Array:
    """Column-vector matrices [..., 4, 4] of USD's row-vector ones."""
    return np.swapaxes(np.array(matrices, float), -1, -2)


def read_skin(target: UsdSkel.SkinningQuery, bones: Bones, path: Path) -> Skin:
    """The joints that deform a mesh, in its own order."""
    order = target.GetJointOrder()
    index = {name: j for j, name in enumerate(bones.paths)}
    names = bones.paths if order is None else [str(name) for name in order]
    missing = [name for name in names if name not in index]
    if missing:
        raise InputError(f"{path}: {target.GetPrim().GetPath()}.skel:joints names {missing[0]}, which is no joint")
    joints = np.array([index[name] for name in names])
    inverse_binds = np.linalg.inv(bones.binds[joints]) @ columns(target.GetGeomBindTransform(NO_TIME))
    return Skin(bones.first + 1 + joints, inverse_binds)
