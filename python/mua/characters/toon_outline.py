"""Outlines of toon figures: shells around the body, wound inside out so that viewers see but their far sides."""

from collections.abc import Sequence

import numpy as np
from scipy.spatial import cKDTree

from mua.arrays import Array

COPIED = 0.8  # of a shell's triangles that are triangles of the body, the other way round
NEAR = 0.05  # of the figure's size between shell and body at most
SAME_PLACE = 1e-6  # of the figure's size


def outlines(
    vertices: Array,  # [V, 3]
    faces: Array,  # [F, 3]
    part: Array,  # [F] int, the part that a triangle belongs to
    candidates: Sequence[int],  # parts that may be outlines
) -> list[int]:
    """Which of the candidates are copies of the other parts, inflated and wound inside out.

    A lining is no outline: it is a copy on the inside.
    """
    size = float(np.ptp(vertices[np.unique(faces)], axis=0).max()) if len(faces) else 0.0
    _, places = np.unique(
        np.round(vertices / max(size * SAME_PLACE, np.finfo(float).tiny)), axis=0, return_inverse=True
    )
    faces = places.reshape(-1)[faces]
    at = np.zeros((int(places.max(initial=-1)) + 1, 3))
    at[places.reshape(-1)] = vertices
    return [
        one
        for one in candidates
        if _volume(at, faces[part == one]) < 0 and _is_shell(at, faces[part == one], faces[part != one], size)
    ]


def _volume(at: Array, faces: Array) -> float:
    """The volume that a surface encloses; below 0 where it faces inward."""
    if not len(faces):
        return 0.0
    a, b, c = np.moveaxis(at[faces] - at[np.unique(faces)].mean(axis=0), 1, 0)
    return float(np.einsum("ni,ni->", a, np.cross(b, c)))


def _is_shell(at: Array, shell: Array, body: Array, size: float) -> bool:
    """Whether most triangles of `shell` lie outside one of `body` and are that one turned over."""
    if len(body) < COPIED * len(shell):
        return False
    own, inward = _normals(at, shell)
    skin = np.unique(body)
    tree = cKDTree(at[skin])
    far, _ = tree.query(at[own])
    apart = float(np.median(far))
    if apart > NEAR * size:
        return False
    _, nearest = tree.query(at[own] + apart * inward)
    match = np.zeros(len(at), int)
    match[own] = skin[nearest]
    outside = np.einsum("ni,ni->n", at[own] - at[match[own]], inward) < 0
    seen = np.zeros(len(at), bool)
    seen[own] = outside
    turned = match[shell][:, ::-1]
    copied = _is_one_of(turned, body, len(at)) & seen[shell].all(axis=1)
    return bool(np.mean(copied) >= COPIED)


def _normals(at: Array, faces: Array) -> tuple[Array, Array]:
    """The vertices that faces use, and their unit normals."""
    corners = at[faces]
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    sums = np.zeros_like(at)
    for corner in range(3):
        np.add.at(sums, faces[:, corner], normal)
    used = np.unique(faces)
    length = np.linalg.norm(sums[used], axis=1, keepdims=True)
    return used, sums[used] / np.where(length > 0, length, 1)


def _is_one_of(faces: Array, others: Array, count: int) -> Array:
    """Which faces [N] are among others, whichever corner comes first."""

    def keys(triangles: Array) -> Array:
        first = np.argmin(triangles, axis=1)
        a, b, c = (np.take_along_axis(triangles, ((first + k) % 3)[:, None], axis=1)[:, 0] for k in range(3))
        return np.asarray((a * count + b) * count + c)

    return np.isin(keys(faces), keys(others))
