"""Joints that the rest pose scales to nothing, as games hide a weapon: what hangs on them is left out."""

from dataclasses import replace
from pathlib import Path

import numpy as np

from mua.arrays import Array
from mua.characters.messages import Messages
from mua.errors import InputError
from mua.scene import Part, Scene

HIDDEN = 0.5  # of a vertex's weight: with more than this on such joints it is not seen


def without_collapsed(scene: Scene, path: Path) -> Scene:
    """The scene without the triangles that joints with a scale of 0 hide; these joints get the axes of the one above.

    Raises an InputError that names `path` and such a node where no triangle is left.
    """
    flat = np.abs(np.linalg.det(scene.rest[:, :3, :3])) < np.finfo(np.float32).tiny
    if not flat.any():
        return scene
    messages = Messages()
    shown = (_seen(part, flat[scene.skins[part.skin].joints], messages) for part in scene.parts)
    parts = tuple(part for part in shown if len(part.faces))
    if (scene.parts and not parts) or flat.all():
        raise InputError(f"{path}: node {scene.node_names[flat.argmax()]} has a scale of 0 in the rest pose")
    rest = scene.rest.copy()
    for node in np.flatnonzero(flat):
        parent = scene.parents[node]
        rest[node, :3, :3] = rest[parent, :3, :3] if parent >= 0 else np.eye(3)
    return replace(scene, parts=parts, rest=rest, notes=(*scene.notes, *messages.notes()))


def _seen(
    part: Part,
    flat: Array,  # [n] bool, of the skin's joints
    messages: Messages,
) -> Part:
    """The part without the triangles whose three vertices are hidden, and without the vertices of these alone."""
    hidden = np.where(flat[part.joints], part.weights, 0).sum(axis=1) > HIDDEN * part.weights.sum(axis=1)
    seen = ~hidden[part.faces].all(axis=1)
    if seen.all():
        return part
    messages.add("Triangles on joints with a scale of 0 are left out, of meshes: {}.", part.node or part.name)
    used, faces = np.unique(part.faces[seen], return_inverse=True)
    return replace(
        part,
        positions=part.positions[used],
        joints=part.joints[used],
        weights=part.weights[used],
        targets=tuple(target.at(used) for target in part.targets),
        faces=faces.reshape(-1, 3),
        uv_faces=part.uv_faces[seen],
        colors=None if part.colors is None else part.colors[seen],
    )
