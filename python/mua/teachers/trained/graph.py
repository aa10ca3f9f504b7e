"""The embedded graph: a few nodes over the template, and how much each vertex follows which of them.

Nodes are spread by farthest points and weights fall with distance along the surface, where a step between vertices that
hang on different joints is longer than it looks: a sleeve that lies against the trunk follows nodes of the arm alone.
Pieces that touch nothing, as hair and shoes do, are linked to what lies nearest to them.
"""

from dataclasses import dataclass

import numpy as np
from scipy import sparse
from scipy.sparse import csgraph
from scipy.spatial import cKDTree

from mua.arrays import Array
from mua.rig.rig import Rig

INFLUENCES = 4  # nodes that a vertex follows
NEIGHBOURS = 6  # nodes beside a node
SKIN_LENGTH = 0.1  # of the figure's size: what a step from one joint's skin to another's adds to its length
LEAST_STEP = 1e-6  # of the figure's size; two vertices in one place are neighbours, not one


@dataclass(frozen=True, eq=False)
class EmbeddedGraph:
    """G nodes over V vertices; positions in the bind pose, metres."""

    nodes: Array  # [G] int64, the vertices that they are
    positions: Array  # [G, 3]
    neighbours: Array  # [G, N] int64 nodes, nearest first, its own left out
    indices: Array  # [V, K] int64 nodes, nearest first
    weights: Array  # [V, K] rows sum to 1, largest first


def build_graph(rig: Rig, *, nodes: int) -> EmbeddedGraph:
    """Spread up to `nodes` nodes over the template of a rig; the same at every call."""
    return spread_nodes(surface_steps(rig), rig.mesh.vertices, count=nodes)


def surface_steps(rig: Rig, *, skin_length: float = SKIN_LENGTH) -> sparse.csr_matrix:
    """Lengths [V, V] of the steps between neighbouring vertices, metres; every vertex can be reached from every other.

    `skin_length`, of the figure's size, is what a step between the skins of two joints adds.
    """
    vertices, faces = rig.mesh.vertices, rig.mesh.faces
    size = float(np.ptp(vertices, axis=0).max())
    features = np.concatenate([vertices, skin_length * size * _skin(rig)], axis=1)
    edges = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    links = np.concatenate([edges, _bridges(edges, features)])
    links = np.unique(np.sort(links, axis=1), axis=0)
    length = np.linalg.norm(features[links[:, 0]] - features[links[:, 1]], axis=1) + LEAST_STEP * size
    steps = sparse.csr_matrix((length, (links[:, 0], links[:, 1])), shape=(len(vertices), len(vertices)))
    return steps + steps.T


def spread_nodes(
    steps: sparse.csr_matrix,  # [V, V] lengths between neighbours
    vertices: Array,  # [V, 3]
    *,
    count: int,
) -> EmbeddedGraph:
    """Farthest points by the length of the way, the first of them farthest from the middle; weights by Gaussians."""
    nodes = [int(np.argmax(np.linalg.norm(vertices - vertices.mean(axis=0), axis=1)))]
    ways = [_ways(steps, nodes[0])]
    nearest = ways[0]
    while len(nodes) < min(count, len(vertices)):
        nodes.append(int(np.argmax(nearest)))
        ways.append(_ways(steps, nodes[-1]))
        nearest = np.minimum(nearest, ways[-1])
    indices, weights = _influences(np.stack(ways, axis=1))
    between = np.stack(ways)[:, nodes]
    np.fill_diagonal(between, -1.0)
    neighbours = np.argsort(between, axis=1, kind="stable")[:, 1 : 1 + NEIGHBOURS]
    return EmbeddedGraph(np.array(nodes), vertices[nodes], neighbours, indices, weights)


def _influences(
    ways: Array,  # [V, G] from every vertex to every node
) -> tuple[Array, Array]:
    """The nearest nodes [V, K] and their weights.

    A Gaussian whose width is half the way to the nearest node that is left out, less its value there: weights fade to
    zero where a node drops out.
    """
    order = np.argsort(ways, axis=1, kind="stable")
    kept = order[:, :INFLUENCES]
    near = np.take_along_axis(ways, kept, axis=1)
    if ways.shape[1] > INFLUENCES:
        reach = np.take_along_axis(ways, order[:, INFLUENCES : INFLUENCES + 1], axis=1)
    else:
        reach = 2 * near.max(axis=1, keepdims=True)
    width = np.maximum(reach / 2, np.finfo(float).tiny)
    weights = np.exp(-0.5 * (near / width) ** 2) - np.exp(-0.5 * (reach / width) ** 2)
    weights[:, 0] = np.maximum(weights[:, 0], np.finfo(float).tiny)  # all may be as far as the one left out
    return kept, weights / weights.sum(axis=1, keepdims=True)


def _ways(steps: sparse.csr_matrix, start: int) -> Array:
    """Lengths [V] of the shortest ways from a vertex."""
    return np.asarray(csgraph.dijkstra(steps, directed=False, indices=start))


def _skin(rig: Rig) -> Array:
    """How much each vertex hangs on each joint [V, J], scaled so that the skins of two joints are 1 apart."""
    weights = np.zeros((len(rig.mesh.vertices), len(rig.skeleton.names)))
    np.add.at(weights, (np.arange(len(weights))[:, None], rig.skin_indices), rig.skin_weights)
    return weights / np.sqrt(2)


def _bridges(
    edges: Array,  # [E, 2]
    features: Array,  # [V, c]
) -> Array:
    """Edges [B, 2] that join the pieces to one: in rounds, each piece to what is nearest in the others (Borůvka)."""
    count, found = len(features), np.empty((0, 2), np.int64)
    while True:
        linked = np.concatenate([edges, found])
        graph = sparse.csr_matrix((np.ones(len(linked)), (linked[:, 0], linked[:, 1])), shape=(count, count))
        pieces, piece = csgraph.connected_components(graph, directed=False)
        if pieces == 1:
            return found
        found = np.concatenate([found, [_nearest_outside(features, piece == own) for own in range(pieces)]])


def _nearest_outside(features: Array, inside: Array) -> tuple[int, int]:
    """The nearest pair of a vertex inside and one outside."""
    own, others = np.flatnonzero(inside), np.flatnonzero(~inside)
    away, at = cKDTree(features[others]).query(features[own])
    first = int(np.argmin(away))
    return int(own[first]), int(others[at[first]])
