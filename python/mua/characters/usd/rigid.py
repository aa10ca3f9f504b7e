"""Prims of a USD stage that move rigid meshes without any skeleton, such as the limbs of a robot."""

from dataclasses import dataclass

import numpy as np
from pxr import Sdf, Usd, UsdGeom

from mua.arrays import Array
from mua.characters.usd.skeleton import PREDICATE, columns


@dataclass(frozen=True)
class Movers:
    """Prims whose place changes over time, and maybe a still one that all of them stand on; each is a node."""

    prims: list[Usd.Prim]  # parents first
    first: int  # node of the first prim

    @property
    def names(self) -> list[str]:
        return [prim.GetName() for prim in self.prims]

    @property
    def parents(self) -> Array:
        nodes = {prim.GetPath(): self.first + p for p, prim in enumerate(self.prims)}
        return np.array([_nearest(prim.GetPath().GetParentPath(), nodes) for prim in self.prims], int)

    def worlds(self, time: Usd.TimeCode, *, at_rest: bool) -> Array:
        """Prim-to-stage matrices [n, 4, 4]; the rest pose is that of the earliest time."""
        cache = UsdGeom.XformCache(Usd.TimeCode.EarliestTime() if at_rest else time)
        matrices = [columns(cache.GetLocalToWorldTransform(prim)) for prim in self.prims]
        return np.array(matrices).reshape(-1, 4, 4)

    def holder(self, mesh: Usd.Prim) -> int | None:
        """The node that carries a rigid mesh; None where it stands still beside all of them."""
        node = _nearest(mesh.GetPath(), {prim.GetPath(): self.first + p for p, prim in enumerate(self.prims)})
        return None if node < 0 else node


def find_movers(stage: Usd.Stage, meshes: list[Usd.Prim], *, first: int) -> Movers:
    """The prims that move one of `meshes`, and the lowest prim above all of these, which carries what is still."""
    moving = {}
    for mesh in meshes:
        prim = mesh
        while prim and not prim.IsPseudoRoot():
            xform = UsdGeom.Xformable(prim)
            if xform and xform.TransformMightBeTimeVarying():
                moving[prim.GetPath()] = prim
            prim = prim.GetParent()
    if not moving:
        return Movers([], first)
    base = next(iter(moving))
    for path in moving:
        base = base.GetCommonPrefix(path)
    if len(moving) == 1:  # the part that moves is one of a body's
        base = base.GetParentPath()
    prim = stage.GetPrimAtPath(base)
    if base not in moving and prim and not prim.IsPseudoRoot():
        moving[base] = prim
    order = [prim for prim in stage.Traverse(PREDICATE) if prim.GetPath() in moving]
    return Movers(order, first)


def _nearest(path: Sdf.Path, nodes: dict[Sdf.Path, int]) -> int:
    """The node of a path or of the nearest one above it that has one, else -1."""
    return next((nodes[above] for above in (path, *path.GetAncestorsRange()) if above in nodes), -1) if nodes else -1
