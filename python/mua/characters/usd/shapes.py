"""Blend shapes of UsdSkel as expressions: how they move a mesh, and their weights over time."""

from collections.abc import Sequence

import numpy as np
from pxr import Usd, UsdSkel

from mua.arrays import Array
from mua.characters.messages import Messages
from mua.errors import InputError
from mua.pose.signed_expressions import as_weights
from mua.scene import Target

BETWEEN = "Shapes in between (inbetweens) are passed over; expressions move straight to the whole shape, of meshes: {}."


def read_targets(
    skinning: UsdSkel.SkinningQuery | None,  # None: the mesh is rigid
    points: int,
    where: str,
    messages: Messages,
) -> tuple[Target, ...]:
    """The blend shapes of a mesh by their names; an InputError names the attribute that does not fit."""
    if skinning is None or not skinning.HasBlendShapes():
        return ()
    stage, name = skinning.GetPrim().GetStage(), skinning.GetPrim().GetName()
    names = skinning.GetBlendShapesAttr().Get() or []
    paths = skinning.GetBlendShapeTargetsRel().GetTargets()
    if len(names) != len(paths):
        raise InputError(f"{where}.skel:blendShapes names {len(names)} shapes, but there are {len(paths)} targets")
    found: dict[str, Target] = {}
    for shape_name, path in zip(names, paths, strict=True):
        shape = UsdSkel.BlendShape(stage.GetPrimAtPath(path))
        if not shape:
            raise InputError(f"{where}.skel:blendShapeTargets names {path}, where no blend shape is")
        if shape.GetInbetweens():
            messages.add(BETWEEN, name)
        found.setdefault(str(shape_name), _target(shape, str(shape_name), points))
    return tuple(found.values())


def _target(shape: UsdSkel.BlendShape, name: str, points: int) -> Target:
    where = shape.GetPrim().GetPath()
    offsets = np.array(shape.GetOffsetsAttr().Get() or [], float).reshape(-1, 3)
    indices = shape.GetPointIndicesAttr().Get()
    at = np.arange(len(offsets)) if indices is None or not len(indices) else np.array(indices, int)
    if len(at) != len(offsets) or at.min(initial=0) < 0 or at.max(initial=-1) >= points:
        raise InputError(f"{where}.pointIndices does not fit {len(offsets)} offsets and {points} points")
    if not np.isfinite(offsets).all():
        raise InputError(f"{where}.offsets holds a number that is not finite")
    whole = np.zeros((points, 3))
    np.add.at(whole, at, offsets)
    moved = np.flatnonzero(whole.any(axis=1))
    return Target(name, moved, whole[moved])


def weight_times(animations: Sequence[UsdSkel.AnimQuery]) -> set[float]:
    """When the weights of blend shapes are stated."""
    return {time for animation in animations for time in animation.GetBlendShapeWeightTimeSamples()}


def read_weights(animations: Sequence[UsdSkel.AnimQuery], codes: Array) -> dict[str, Array]:
    """The weights [F] of each blend shape that an animation moves, at times [F], 0 to 1; the first of each name."""
    found: dict[str, Array] = {}
    for animation in animations:
        names = [str(name) for name in animation.GetBlendShapeOrder()]
        if not names:
            continue
        rows = [animation.ComputeBlendShapeWeights(Usd.TimeCode(float(code))) for code in codes]
        values = np.array([row if row and len(row) == len(names) else [0.0] * len(names) for row in rows], float)
        for name, weights in zip(names, np.nan_to_num(values).T, strict=True):
            for own, moved in as_weights(name, weights).items():
                if moved.any():
                    found.setdefault(own, moved)
    return found
