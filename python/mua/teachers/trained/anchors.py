"""The template's point that each tracked point shows: given by its file, or found where it was first seen."""

from dataclasses import dataclass

import numpy as np
from scipy.spatial import cKDTree

from mua.arrays import Array
from mua.capture.tracks import PointTracks
from mua.rig.character import Mesh
from mua.rig.surface_points import interpolate, nearest_barycentrics

NEAR = 16  # triangles by their middles, among which the nearest point is looked for
FARTHEST = 0.1  # metres on a person: a tracked point farther from the template is not on it
TOGETHER = 64  # rays that are cut with all triangles at once


@dataclass(frozen=True, eq=False)
class Anchors:
    """Points of the template; where `found` is False, the other values mean nothing."""

    triangles: Array  # [P]
    barycentrics: Array  # [P, 3]
    found: Array  # [P] bool


def anchors_of(
    tracks: PointTracks,
    mesh: Mesh,  # the template in its bind pose
    posed: Array,  # [F, V, 3] its skinned vertices in the frames of the tracks
    *,
    size: float,  # of the figure over that of a person
) -> Anchors:
    """One point of the template for each track, which follows it through all frames."""
    if tracks.bind is not None:
        return nearest_points(mesh.vertices, mesh.faces, tracks.bind, reach=FARTHEST * size)
    first = (tracks.weights > 0).argmax(axis=0)  # frame in which each is seen first
    count = len(first)
    triangles, barycentrics, found = np.zeros(count, np.int64), np.zeros((count, 3)), np.zeros(count, bool)
    for frame in np.unique(first):
        own = np.flatnonzero((first == frame) & (tracks.weights[frame] > 0))
        if tracks.directions is None:
            of_frame = nearest_points(posed[frame], mesh.faces, tracks.points[frame, own], reach=FARTHEST * size)
        else:
            rays = tracks.points[frame, own], tracks.directions[frame, own]
            of_frame = first_hits(posed[frame], mesh.faces, *rays)
        triangles[own], barycentrics[own] = of_frame.triangles, of_frame.barycentrics
        found[own] = of_frame.found
    return Anchors(triangles, barycentrics, found)


def nearest_points(vertices: Array, faces: Array, points: Array, *, reach: float) -> Anchors:
    """The nearest points of a surface to points [P, 3]."""
    # trimesh's search needs rtree and finds the same in 374 ms, in place of 148 (5,000 points, 11,024 triangles).
    corners = vertices[faces]
    near = cKDTree(corners.mean(axis=1)).query(points, k=min(NEAR, len(faces)))[1].reshape(len(points), -1)
    barycentrics = nearest_barycentrics(points[:, None], corners[near])
    away = np.linalg.norm(np.einsum("pkc,pkcd->pkd", barycentrics, corners[near]) - points[:, None], axis=2)
    best = (np.arange(len(points)), away.argmin(axis=1))
    return Anchors(near[best], barycentrics[best], away[best] < reach)


def first_hits(
    vertices: Array,  # [V, 3]
    faces: Array,  # [F, 3]
    origins: Array,  # [P, 3]
    directions: Array,  # [P, 3]
) -> Anchors:
    """Where rays first meet a surface (Moeller and Trumbore 1997)."""
    a, b, c = vertices[faces].swapaxes(0, 1)
    along, beside = b - a, c - a
    parts = []
    for start in range(0, len(origins), TOGETHER):
        ray, away = directions[start : start + TOGETHER, None], origins[start : start + TOGETHER, None] - a
        across, turned = np.cross(ray, beside), np.cross(away, along)
        volume = np.sum(along * across, axis=2)
        share = np.divide(1.0, volume, out=np.zeros_like(volume), where=volume != 0)
        u, v = np.sum(away * across, axis=2) * share, np.sum(ray * turned, axis=2) * share
        depth = np.sum(beside * turned, axis=2) * share
        met = (volume != 0) & (u >= 0) & (v >= 0) & (u + v <= 1) & (depth > 0)
        nearest = np.where(met, depth, np.inf).argmin(axis=1)
        row = np.arange(len(nearest))
        u, v = u[row, nearest], v[row, nearest]
        parts.append((nearest, np.stack([1 - u - v, u, v], axis=1), met[row, nearest]))
    if not parts:
        return Anchors(np.zeros(0, np.int64), np.zeros((0, 3)), np.zeros(0, bool))
    triangles, barycentrics, found = (np.concatenate(of) for of in zip(*parts, strict=True))
    return Anchors(triangles, barycentrics, found)


def places(anchors: Anchors, vertices: Array, faces: Array) -> Array:
    """Positions [P, 3] of the anchors on a posed surface."""
    return interpolate(vertices, faces[anchors.triangles], anchors.barycentrics)
