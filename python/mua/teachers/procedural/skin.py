"""The welded mesh and its skin weights, eased where arms meet the trunk; weights are cut to the strongest few."""

import numpy as np
from scipy.sparse import coo_matrix, csr_matrix

from mua.arrays import Array
from mua.rig.character import Mesh
from mua.teachers.procedural.grid import smoothstep
from mua.teachers.procedural.joints import PLACES


def _neighbours(mesh: Mesh) -> csr_matrix:
    """Averages over the vertices one edge away, [V, V]."""
    a = mesh.faces.reshape(-1)
    b = mesh.faces[:, [1, 2, 0]].reshape(-1)
    edges = coo_matrix((np.ones(2 * len(a)), (np.r_[a, b], np.r_[b, a])), shape=(len(mesh.vertices),) * 2).tocsr()
    edges.data[:] = 1
    return csr_matrix(edges.multiply(1 / edges.sum(axis=1)))


def eased(mesh: Mesh, values: Array, *, rounds: int) -> Array:
    """Values [V, c] averaged over neighbours across the shoulders, where the arms' rings meet those of the trunk."""
    average = _neighbours(mesh)
    away = np.min([np.linalg.norm(mesh.vertices - PLACES[f"{side}Arm"], axis=1) for side in ("Left", "Right")], axis=0)
    share = 0.5 * smoothstep(0.15, 0.10, away)[:, None]
    for _ in range(rounds):
        values = (1 - share) * values + share * (average @ values)
    return values


def strongest(weights: Array, count: int) -> tuple[Array, Array]:
    """Indices [V, count] int32 and weights [V, count] float32, largest first, sum 1, of weights [V, J]."""
    order = np.argsort(-weights, axis=1, kind="stable")[:, :count]
    kept = np.take_along_axis(weights, order, axis=1)
    kept = np.where(kept < 1e-3, 0, kept)
    kept = kept / kept.sum(axis=1, keepdims=True)
    return np.where(kept > 0, order, 0).astype(np.int32), kept.astype(np.float32)
