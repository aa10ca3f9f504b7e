"""The template: a dense character's surface in a few thousand vertices, its UV seams kept."""

from ctypes import c_float, c_size_t
from dataclasses import dataclass
from itertools import pairwise

import meshoptimizer
import numpy as np

from mua.arrays import Array, unique_rows
from mua.rig.character import Character, Mesh
from mua.rig.charts import areas

DENSE_ENOUGH = 1.2  # a mesh of at most this many times the wanted vertices is its own template
CLOSE_ENOUGH = 0.02  # tolerance as a share of the wanted vertices
ATTEMPTS = 6  # attempts: how many vertices a number of triangles leaves is only known afterwards
UV_WEIGHT = 4.0  # weight of an error in UV relative to the distance on the surface that it stands for
SKIN_WEIGHT = 0.5  # share of the character's size: the error of a vertex that moves with a wrong joint
SKIN_DIRECTIONS = 24  # dimensions of the space of skin weights; the library takes 32 attributes
FACE_SHARE = 4  # a quarter as many vertices come on top, or those that expressions move, where that is fewer
FACE_WEIGHT = (
    1000.0  # of a metre that an expression moves a vertex wrongly: the triangles about lips and lids are small
)
FACE_DIRECTIONS = 14  # random directions that stand for all expressions' offsets, where there are any
SKIN_BESIDE_FACE = 16  # dimensions of the space of skin weights beside these
NO_LIMIT = 1e9  # of errors: only the number of triangles ends the decimation
LARGEST_ERROR = 0.01  # of the extent, several times a person's: where some parts cannot, others are not to dissolve


@dataclass(frozen=True, eq=False)
class Template:
    """The surface whose vertices a student predicts; each is a vertex of the dense mesh, with its skin weights."""

    mesh: Mesh
    skin_indices: Array  # [V, 8] int32
    skin_weights: Array  # [V, 8] float32, rows sum to 1
    source_vertices: Array  # [V] int32 into the dense mesh's vertices
    source_uv: Array  # [T] int32 into the dense mesh's UVs


def make_template(character: Character, *, vertices: int = 5000) -> Template:
    """Decimate a character's mesh to about `vertices` by edge collapses that keep UV seams and chart borders.

    The quadrics measure positions, UVs, skin weights and expressions together (Garland and Heckbert 1998), so that
    chart borders, the bends at joints, lips and lids stay where they are. A face that moves gets vertices of its own
    on top, so that the body keeps its own.
    """
    mesh = character.mesh
    if character.expressions is not None:
        vertices += min(len(np.unique(character.expressions.vertices)), vertices // FACE_SHARE)
    if len(mesh.vertices) > DENSE_ENOUGH * vertices:
        mesh = _decimate(mesh, vertices, _skin_directions(character), _face_directions(character))
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
        source_uv=uv_kept.astype(np.int32),
    )


def _skin_directions(character: Character) -> Array:
    """The principal components [V, n] of the vertices' weights over all joints."""
    weights = np.zeros((len(character.skin_weights), character.skin_indices.max() + 1))
    np.add.at(weights, (np.arange(len(weights))[:, None], character.skin_indices), character.skin_weights)
    weights -= weights.mean(axis=0)
    count = SKIN_DIRECTIONS if character.expressions is None else SKIN_BESIDE_FACE
    return weights @ np.linalg.eigh(weights.T @ weights)[1][:, -count:]


def _face_directions(character: Character) -> Array:
    """How far expressions move the vertices, metres, along random directions [V, n] through all of them.

    Differences between vertices keep their length on average (Johnson and Lindenstrauss 1984), so that a blink counts
    beside a jaw that opens, which principal components would leave out.
    """
    expressions, count = character.expressions, len(character.mesh.vertices)
    found = np.zeros((count, 0 if expressions is None else FACE_DIRECTIONS))
    if expressions is not None:
        rng = np.random.default_rng(0)
        along = rng.standard_normal((len(expressions), 3, FACE_DIRECTIONS)) / np.sqrt(FACE_DIRECTIONS)
        for e, (start, stop) in enumerate(pairwise(expressions.starts)):
            found[expressions.vertices[start:stop]] += expressions.offsets[start:stop] @ along[e]
    return found


def _decimate(
    mesh: Mesh,
    vertices: int,
    skin: Array,  # [V, n]
    face: Array,  # [V, m] metres
) -> Mesh:
    """The mesh with fewer triangles between about `vertices` of the same vertices."""
    corners = np.stack([mesh.faces.ravel(), mesh.uv_faces.ravel()], axis=1)
    pairs, _, index = unique_rows(corners)  # a vertex once for each of its UVs
    positions = mesh.vertices[pairs[:, 0]].astype(np.float32)
    metres_per_uv = np.sqrt(areas(mesh.vertices[mesh.faces]).sum() / max(areas(mesh.uv[mesh.uv_faces]).sum(), 1e-12))
    extent = meshoptimizer.simplify_scale(positions)
    uv = mesh.uv[pairs[:, 1]] * (UV_WEIGHT * metres_per_uv / extent)
    skin, face = skin[pairs[:, 0]] * SKIN_WEIGHT, face[pairs[:, 0]] * (FACE_WEIGHT / extent)
    attributes = np.column_stack([uv, skin, face]).astype(np.float32)
    triangles = len(mesh.faces) * vertices / len(mesh.vertices)
    for _ in range(ATTEMPTS):
        left = pairs[_collapse(index, positions, attributes, triangles=int(triangles))]
        if len(left) > (1 + CLOSE_ENOUGH) * 3 * triangles:  # no more can go
            left = pairs[_collapse(index, positions, attributes, triangles=int(triangles), error=LARGEST_ERROR)]
            break
        count = len(np.unique(left[:, 0]))
        if abs(count - vertices) <= CLOSE_ENOUGH * vertices:
            break
        triangles *= vertices / count
    faces, uv_faces = left.reshape(-1, 3, 2).astype(np.int32).transpose(2, 0, 1)
    flat = (faces == np.roll(faces, 1, axis=1)).any(axis=1)  # between two UVs of one vertex, as at the pole of an eye
    faces, uv_faces = faces[~flat], uv_faces[~flat]
    return Mesh(vertices=mesh.vertices, faces=faces, uv=mesh.uv, uv_faces=uv_faces)


def _collapse(
    index: Array,  # [3 F] into the vertices
    positions: Array,  # [P, 3] float32
    attributes: Array,  # [P, n] float32, in units of the mesh's largest extent
    *,
    triangles: int,
    error: float = NO_LIMIT,  # in these units
) -> Array:
    """Indices [3 n] into the same vertices, of about `triangles` triangles.

    The binding declares no argument types for this function, so every number goes in as the C type that it expects.
    """
    left = np.empty(len(index), np.uint32)
    count = meshoptimizer.simplify_with_attributes(
        left,
        index.astype(np.uint32),
        positions,
        attributes,
        np.ones(attributes.shape[1], np.float32),
        index_count=c_size_t(len(index)),
        vertex_count=c_size_t(len(positions)),
        vertex_positions_stride=c_size_t(positions.strides[0]),
        vertex_attributes_stride=c_size_t(attributes.strides[0]),
        attribute_count=c_size_t(attributes.shape[1]),
        target_index_count=c_size_t(3 * triangles),
        target_error=c_float(error),
    )
    return left[:count]
