"""Triangles, texture coordinates and colours of FBX meshes."""

from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from mua.arrays import Array
from mua.atlas.pictures import LINEAR
from mua.characters.fbx.bindings import array, get, items
from mua.characters.fbx.polygons import triangulated
from mua.characters.fbx.shapes import morphed
from mua.characters.messages import Messages
from mua.errors import InputError
from mua.scene import Target


@dataclass(frozen=True, eq=False)
class Geometry:
    """A mesh in its own space."""

    source: Any
    name: str
    where: str  # file and mesh, for errors
    positions: Array  # [V, 3] with the blend shapes of the rest pose
    corners: Array  # [C] vertex of each corner of a polygon
    triangles: Array  # [F, 3] corners
    material: Array  # [F] int into the materials of the node
    colors: Array | None  # [C, 4] linear colour and opacity
    targets: tuple[Target, ...]  # the blend shapes from there on

    def coordinates(self, uv_set: str) -> tuple[Array, Array] | None:
        """Texture coordinates [T, 2], v up, of the set of this name, else of the first; and their index [C]."""
        sets = list(items(self.source, "uv_sets"))
        if not sets:
            return None
        named = [found for found in sets if get(found, "name") == uv_set]
        return _attribute((named or sets)[0], "vertex_uv", len(self.corners), self.where)


def read_geometry(source: Any, name: str, path: Path, messages: Messages) -> Geometry:
    """The mesh of a node called `name`; what is left out goes to `messages`.

    Raises InputError where indices or numbers do not fit.
    """
    where = f"{path}: mesh {name}"
    positions = array(source, "vertices").reshape(-1, 3)
    corners = array(source, "vertex_indices").astype(int).ravel()
    if corners.max(initial=-1) >= len(positions) or not np.isfinite(positions).all():
        raise InputError(f"{where}.PolygonVertexIndex does not fit its {len(positions)} vertices")
    faces = array(source, "faces").astype(int).reshape(-1, 2)
    holes = array(source, "face_hole").ravel()
    counts = np.where(holes, 0, faces[:, 1]) if len(holes) else faces[:, 1]
    triangles, polygon = triangulated(positions[corners], faces[:, 0], counts)
    moved, targets = morphed(source, positions, name, where, messages)
    material = array(source, "face_material").astype(int).ravel()
    return Geometry(
        source=source,
        name=name,
        where=where,
        positions=moved,
        corners=corners,
        triangles=triangles,
        material=material[polygon] if len(material) else np.zeros(len(polygon), int),
        colors=_colors(source, len(corners), where),
        targets=targets,
    )


def _attribute(owner: Any, name: str, corners: int, where: str) -> tuple[Array, Array] | None:
    """The values [n, ...] of a vertex attribute and which of them [C] each corner has; None where it is absent."""
    attribute = get(owner, name)
    if not get(attribute, "exists"):
        return None
    values, indices = array(attribute, "values"), array(attribute, "indices").astype(int).ravel()
    if len(indices) != corners or indices.max(initial=-1) >= len(values) or not np.isfinite(values[indices]).all():
        raise InputError(f"{where}.{name} does not fit its {corners} corners")
    return np.nan_to_num(values), indices  # values that no corner has are of any kind


def _colors(source: Any, corners: int, where: str) -> Array | None:
    """Linear colours and opacity [C, 4] of the corners; None where there are none but white or but black.

    FBX does not state their colour space; programs show them as sRGB. Opacity that is 0 everywhere is none.
    """
    found = _attribute(source, "vertex_color", corners, where)
    if found is None:
        return None
    colors = np.clip(found[0][found[1]], 0, 1)
    if not colors[:, 3].any():
        colors[:, 3] = 1
    if not colors[:, :3].any() or (colors == 1).all():
        return None
    colors[:, :3] = np.interp(colors[:, :3] * 255, np.arange(256), LINEAR)
    return colors
