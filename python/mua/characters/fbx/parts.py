"""The faces of an FBX mesh apart by material, each with what its material reads of the mesh."""

from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from mua.arrays import Array
from mua.characters.fbx.materials import Look, Looks
from mua.characters.fbx.mesh import Geometry
from mua.characters.messages import Messages
from mua.scene import Part


def by_material(
    whole: Part, geometry: Geometry, sources: Sequence[Any], looks: Looks, messages: Messages
) -> list[Part]:
    """The part of a whole mesh cut by its materials `sources`, each with only the vertices that its faces need.

    Faces whose material is missing are drawn in the default one.
    """
    found = []
    for number in np.unique(geometry.material):
        index = looks.index(sources[number] if number < len(sources) else None)
        part = _cut(whole, geometry, geometry.material == number, messages)
        found.append(_textured(replace(part, material=index), geometry, looks.read[index], messages))
    return found


def _cut(whole: Part, geometry: Geometry, chosen: Array, messages: Messages) -> Part:
    """The chosen [F] faces."""
    used, faces = np.unique(whole.faces[chosen], return_inverse=True)
    corners = geometry.triangles[chosen]
    if geometry.colors is not None:
        messages.add("Vertex colours are multiplied into the base colour, of meshes: {}.", whole.node)
    return replace(
        whole,
        positions=whole.positions[used],
        faces=faces.reshape(-1, 3),
        uv_faces=corners,  # of the mesh, until the material says which coordinates it reads
        joints=whole.joints[used],
        weights=whole.weights[used],
        targets=tuple(target.at(used) for target in whole.targets),
        colors=None if geometry.colors is None else geometry.colors[corners],
    )


def _textured(part: Part, geometry: Geometry, look: Look, messages: Messages) -> Part:
    """The part, whose `uv_faces` are corners of the mesh, with the texture coordinates that its material reads."""
    found = geometry.coordinates(look.uv_set)
    if found is None:
        if look.needed:
            messages.add("Meshes without the texture coordinates that their material asks for: {}.", part.node)
        return replace(part, uv_faces=np.full_like(part.uv_faces, -1))
    used, faces = np.unique(found[1][part.uv_faces], return_inverse=True)
    moved = found[0][used, :2] @ look.matrix[:, :2].T + look.matrix[:, 2]
    return replace(part, uv=np.stack([moved[:, 0], 1 - moved[:, 1]], axis=1), uv_faces=faces.reshape(-1, 3))
