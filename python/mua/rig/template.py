"""The template: a dense character's surface in a few thousand vertices, its UV seams kept."""

from ctypes import c_float, c_size_t
from dataclasses import dataclass

import meshoptimizer
import numpy as np

from mua.arrays import Array
from mua.rig.character import Character, Mesh

DENSE_ENOUGH = 1.2  # a mesh of at most this many times the wanted vertices is its own template
CLOSE_ENOUGH = 0.02  # of the wanted vertices
ATTEMPTS = 6  # the number of vertices that a number of triangles leaves is only known afterwards
NO_ERROR_LIMIT = c_float(1e9)  # the number of triangles alone ends the decimation


@dataclass(frozen=True)
class Template:
    """The surface whose vertices a student predicts; each is a vertex of the dense mesh, with its skin weights."""

    mesh: Mesh
    skin_indices: Array  # [V, 8] int32
    skin_weights: Array  # [V, 8] float32, rows sum to 1
    source_vertices: Array  # [V] int32 into the dense mesh's vertices


def make_template(character: Character, *, vertices: int = 5000) -> Template:
    """Decimate a character's mesh to about `vertices` by edge collapses that keep UV seams and chart borders.

    The quadrics measure positions and UVs together (Garland and Heckbert 1998), a UV error counting like the distance
    on the surface that it stands for, so that chart borders stay where they are.
    """
    mesh = character.mesh
    if len(mesh.vertices) > DENSE_ENOUGH * vertices:
        mesh = _decimate(mesh, vertices)
    kept, faces = np.unique(mesh.faces, return_inverse=True)
    uv_kept, uv_faces = np.unique(mesh.uv_faces, return_inverse=True)
    return Template(
        mesh=Mesh(
            vertices=mesh.vertices[kept],
            faces=faces.reshape(-1, 3).astype(np.int32),
            uv=mesh.uv[uv_kept],
            uv_faces=uv_faces.reshape(-1, 3).astype(np.int32),
        ),
        skin_indices=character.skin_indices[kept],
        skin_weights=character.skin_weights[kept],
        source_vertices=kept.astype(np.int32),
    )


def _decimate(mesh: Mesh, vertices: int) -> Mesh:
    """The mesh with fewer triangles between about `vertices` of the same vertices."""
    corners = np.stack([mesh.faces.ravel(), mesh.uv_faces.ravel()], axis=1)
    pairs, index = np.unique(corners, axis=0, return_inverse=True)  # a vertex once for each of its UVs
    triangles = len(mesh.faces) * vertices / len(mesh.vertices)
    for _ in range(ATTEMPTS):
        left = pairs[_collapse(mesh, pairs, index.ravel(), int(triangles))]
        count = len(np.unique(left[:, 0]))
        if abs(count - vertices) <= CLOSE_ENOUGH * vertices:
            break
        triangles *= vertices / count
    faces, uv_faces = left.reshape(-1, 3, 2).astype(np.int32).transpose(2, 0, 1)
    return Mesh(vertices=mesh.vertices, faces=faces, uv=mesh.uv, uv_faces=uv_faces)


def _collapse(
    mesh: Mesh,
    pairs: Array,  # [P, 2] vertex, uv
    index: Array,  # [3 F] into pairs
    triangles: int,
) -> Array:
    """Indices [3 n] into pairs of about `triangles` triangles.

    The binding declares no argument types for this function, so every number goes in as the C type that it expects.
    """
    positions = mesh.vertices[pairs[:, 0]].astype(np.float32)
    uv = mesh.uv[pairs[:, 1]].astype(np.float32)
    metres_per_uv = np.sqrt(_area(mesh.vertices[mesh.faces]) / max(_area(mesh.uv[mesh.uv_faces]), 1e-12))
    weight = metres_per_uv / meshoptimizer.simplify_scale(positions)
    left = np.empty(len(index), np.uint32)
    count = meshoptimizer.simplify_with_attributes(
        left,
        index.astype(np.uint32),
        positions,
        uv,
        np.full(2, weight, np.float32),
        index_count=c_size_t(len(index)),
        vertex_count=c_size_t(len(pairs)),
        vertex_positions_stride=c_size_t(positions.strides[0]),
        vertex_attributes_stride=c_size_t(uv.strides[0]),
        attribute_count=c_size_t(2),
        target_index_count=c_size_t(3 * triangles),
        target_error=NO_ERROR_LIMIT,
    )
    return left[:count]


def _area(
    corners: Array,  # [F, 3, 2 or 3]
) -> float:
    """The sum of the triangles' areas."""
    a, b = corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]
    squares = (a * a).sum(axis=1) * (b * b).sum(axis=1) - (a * b).sum(axis=1) ** 2
    return float(np.sqrt(np.maximum(squares, 0)).sum() / 2)
