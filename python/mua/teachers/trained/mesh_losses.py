"""Distance of a posed template from the measured surface of a frame, and the roughness of its deformation.

Nearest points are taken as fixed; gradients reach the template's vertices alone.
"""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import torch
import trimesh
from scipy.spatial import cKDTree
from torch import Tensor

from mua.arrays import Array
from mua.rig.character import Mesh
from mua.rig.charts import areas
from mua.rig.surface_points import face_normals, interpolate, spread_points

REACH = 0.1  # metres on a person: what is farther is no counterpart, as what hands hold or masks cut off
FACING = 0.02  # metres on a person for normals that are 1 apart: the inside of a sleeve is no match for its outside
SIDEWAYS = 0.05  # of an error along the surface: the nearest point of a cloud lies beside the nearest of the surface


@dataclass(frozen=True, eq=False)
class Cloud:
    """Points on a measured surface, in the world."""

    points: Array  # [S, 3] metres
    normals: Array  # [S, 3] unit, outward
    size: float = 1.0  # of the figure over that of a person

    @classmethod
    def of(cls, mesh: Mesh, count: int, *, size: float = 1.0) -> "Cloud":
        """`count` points at equal shares of a mesh's area."""
        triangles, barycentrics = spread_points(mesh, count)
        points = interpolate(mesh.vertices, mesh.faces[triangles], barycentrics)
        return cls(points, face_normals(mesh)[triangles], size)

    @cached_property
    def tree(self) -> cKDTree:
        """A tree over the points and their normals."""
        return cKDTree(self.features(self.points, self.normals))

    def features(self, points: Array, normals: Array) -> Array:
        """[S, 6] where far apart means far or facing another way."""
        return np.concatenate([points, FACING * self.size * normals], axis=1)


@dataclass(frozen=True, eq=False)
class Samples:
    """Points of the template, which follow it; B of them."""

    corners: Tensor  # [B, 3] int64 vertices about each
    barycentrics: Tensor  # [B, 3]
    spacing: float  # metres, the side of the square that is each one's share of the area

    @classmethod
    def of(cls, mesh: Mesh, count: int) -> "Samples":
        """`count` points at equal shares of the bind pose's area."""
        triangles, barycentrics = spread_points(mesh, count)
        spacing = float(np.sqrt(areas(mesh.vertices[mesh.faces]).sum() / max(len(triangles), 1)))
        return cls(torch.as_tensor(mesh.faces[triangles]).long(), torch.as_tensor(barycentrics), spacing)

    def on(
        self,
        posed: Tensor,  # [V, 3]
    ) -> tuple[Tensor, Tensor]:
        """Points and unit normals [B, 3]."""
        corners = gather(posed, self.corners)
        points = (self.barycentrics.to(posed)[..., None] * corners).sum(1)
        across = torch.linalg.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        return points, torch.nn.functional.normalize(across, dim=1, eps=1e-12)


def chamfer(
    posed: Tensor,  # [V, 3] world, metres
    samples: Samples,
    cloud: Cloud,
    *,
    sideways: float = SIDEWAYS,
) -> Tensor:
    """Mean squared distance from the template to the cloud and back, metres^2.

    Each point counts its distance across the other surface and a share `sideways` of that along it; with 1 this is the
    Chamfer distance. Pairs farther apart than REACH do not count.
    """
    points, normals = samples.on(posed)
    own = cloud.features(_array(points), _array(normals))
    _, there = cloud.tree.query(own)
    _, here = cKDTree(own).query(cloud.features(cloud.points, cloud.normals))
    to_points, to_normals = (torch.as_tensor(values).to(posed) for values in (cloud.points, cloud.normals))
    reach, there, here = REACH * cloud.size, torch.as_tensor(there), torch.as_tensor(here)
    away = _apart(points - to_points[there], to_normals[there], sideways, reach)
    back = _apart(gather(points, here) - to_points, to_normals, sideways, reach)
    return away + back


def roughness(
    field: Tensor,  # [..., V, c]
    edges: Tensor,  # [E, 2] int64
) -> Tensor:
    """Mean squared difference between the ends of edges: the energy whose gradient is the graph's Laplacian."""
    one, other = (field.index_select(-2, edges[:, end]) for end in (0, 1))
    return (one - other).square().sum(-1).mean()


def edges_of(mesh: Mesh) -> Tensor:
    """Edges [E, 2] int64 between vertices, each once."""
    return torch.tensor(trimesh.Trimesh(mesh.vertices, mesh.faces, process=False).edges_unique).long()


def gather(
    values: Tensor,  # [V, c]
    places: Tensor,  # [...] int64
) -> Tensor:
    """Values [..., c]; its gradient is added up in the same order every time."""
    return values.index_select(0, places.flatten()).unflatten(0, places.shape)


def _apart(
    away: Tensor,  # [S, 3] from points to their counterparts
    normals: Tensor,  # [S, 3] there
    sideways: float,
    reach: float,
) -> Tensor:
    across = (away * normals).sum(1).square()
    whole = away.square().sum(1)
    counts = (whole < reach**2).detach()
    return ((1 - sideways) * across + sideways * whole)[counts].sum() / counts.sum().clamp(min=1)


def _array(values: Tensor) -> Array:
    return np.asarray(values.detach().double().cpu())
