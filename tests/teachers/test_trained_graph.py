"""The embedded graph spreads over the template and keeps apart what moves apart."""

from dataclasses import replace

import numpy as np
import pytest
from scipy import sparse
from scipy.sparse import csgraph
from synthetic_avatar import synthetic_rig
from tube import HEIGHT, tube

from mua.rig.build import build_rig
from mua.rig.character import Mesh
from mua.rig.rig import Rig
from mua.teachers.trained.graph import INFLUENCES, NEIGHBOURS, SKIN_LENGTH, build_graph, spread_nodes, surface_steps

BOUND = 1e-12  # of sums of a few weights in float64


@pytest.fixture(scope="module")
def rig() -> Rig:
    return build_rig(tube(), texels=16)[0]


def beside(rig: Rig, *, shift: float, joint: int) -> Rig:
    """The rig with a copy of its mesh beside it, a piece of its own that hangs on one joint."""
    mesh, count = rig.mesh, len(rig.mesh.vertices)
    indices, weights = np.full_like(rig.skin_indices, joint), np.zeros_like(rig.skin_weights)
    weights[:, 0] = 1
    whole = Mesh(
        vertices=np.concatenate([mesh.vertices, mesh.vertices + np.array([shift, 0, 0])]),
        faces=np.concatenate([mesh.faces, mesh.faces + count]),
        uv=mesh.uv,
        uv_faces=np.concatenate([mesh.uv_faces, mesh.uv_faces]),
    )
    return replace(
        rig,
        mesh=whole,
        skin_indices=np.concatenate([rig.skin_indices, indices]),
        skin_weights=np.concatenate([rig.skin_weights, weights]),
    )


def test_nodes_are_spread_over_the_whole_surface(rig: Rig) -> None:
    graph = build_graph(rig, nodes=40)
    assert len(set(graph.nodes)) == 40
    away = np.linalg.norm(rig.mesh.vertices[:, None] - graph.positions, axis=2)
    between = away[graph.nodes]
    between[np.diag_indices(40)] = np.inf
    assert away.min(axis=1).max() <= 2 * between.min(axis=1).max()  # no hole wider than nodes lie apart
    assert np.ptp(graph.positions[:, 1]) == pytest.approx(HEIGHT)


def test_a_weight_is_a_gaussian_that_ends_where_the_next_node_is() -> None:
    """Its width is half the way there."""
    apart = np.arange(INFLUENCES + 2) ** 1.2
    steps = sparse.csr_matrix(np.diag(np.diff(apart), 1))
    line = np.stack([apart, 0 * apart, 0 * apart], axis=1)
    graph = spread_nodes(steps + steps.T, line, count=len(line))
    ways = np.sort(abs(apart - apart[1]))
    fall = np.exp(-2 * (ways / ways[INFLUENCES]) ** 2) - np.exp(-2)
    np.testing.assert_allclose(graph.weights[1], fall[:INFLUENCES] / fall[:INFLUENCES].sum(), atol=BOUND)


def test_a_step_is_as_long_as_the_edge_whichever_triangles_share_it(rig: Rig) -> None:
    """Two vertices in one place are a step apart too, or nothing would lead from one to the other."""
    weights = np.zeros_like(rig.skin_weights)
    weights[:, 0] = 1
    still = replace(rig, skin_indices=np.zeros_like(rig.skin_indices), skin_weights=weights)
    mesh = still.mesh
    a, b = mesh.faces[0, :2]
    vertices = mesh.vertices.copy()
    vertices[a] = vertices[b]
    for places in (mesh.vertices, vertices):
        steps = surface_steps(replace(still, mesh=replace(mesh, vertices=places)))
        edges = mesh.faces[:, [0, 1]]
        lengths = np.linalg.norm(places[edges[:, 0]] - places[edges[:, 1]], axis=1)
        found = np.asarray(steps[edges[:, 0], edges[:, 1]]).ravel()
        np.testing.assert_allclose(found, lengths, atol=2e-6 * np.ptp(places, axis=0).max())
        assert np.isfinite(csgraph.dijkstra(steps, indices=a)).all()
    assert steps[a, b] > 0


def test_weights_fall_with_distance_and_sum_to_one(rig: Rig) -> None:
    graph = build_graph(rig, nodes=40)
    assert graph.weights.shape == (len(rig.mesh.vertices), INFLUENCES)
    assert np.abs(graph.weights.sum(axis=1) - 1).max() < BOUND
    assert (graph.weights >= 0).all()
    assert (np.diff(graph.weights, axis=1) <= BOUND).all()
    assert (graph.indices[graph.nodes, 0] == np.arange(40)).all()
    assert graph.neighbours.shape == (40, NEIGHBOURS)
    assert not (graph.neighbours == np.arange(40)[:, None]).any()


def test_weights_are_continuous_where_a_node_drops_out() -> None:
    line = np.linspace(0, 1, 4001)[:, None] * [1.0, 0, 0]
    ends = np.stack([np.arange(4000), np.arange(1, 4001)], axis=1)
    steps = sparse.csr_matrix((np.full(4000, 1 / 4000), ends.T), shape=(4001, 4001))
    graph = spread_nodes(steps + steps.T, line, count=9)
    dense = np.zeros((4001, 9))
    np.put_along_axis(dense, graph.indices, graph.weights, axis=1)
    assert np.abs(np.diff(dense, axis=0)).max() < 0.01


def test_pieces_are_linked_and_every_vertex_has_a_node_of_its_own_piece(rig: Rig) -> None:
    both = beside(rig, shift=0.3, joint=0)
    graph = build_graph(both, nodes=60)
    steps = surface_steps(both)
    assert csgraph.connected_components(steps, directed=False)[0] == 1
    count = len(rig.mesh.vertices)
    assert ((graph.nodes >= count)[graph.indices[:, 0]] == (np.arange(2 * count) >= count)).all()


def test_steps_are_as_long_as_edges_and_longer_where_the_skin_changes(rig: Rig) -> None:
    vertices, faces = rig.mesh.vertices, rig.mesh.faces
    ends = np.concatenate([faces[:, [0, 1]], faces[:, [1, 2]], faces[:, [2, 0]]])
    edges = np.linalg.norm(vertices[ends[:, 0]] - vertices[ends[:, 1]], axis=1)
    plain, skinned = (
        np.asarray(surface_steps(rig, skin_length=length)[ends[:, 0], ends[:, 1]])[0] for length in (0, 0.5)
    )
    np.testing.assert_allclose(plain, edges, rtol=0, atol=1e-5)
    weights = np.zeros((len(vertices), len(rig.skeleton.names)))
    np.add.at(weights, (np.arange(len(weights))[:, None], rig.skin_indices), rig.skin_weights)
    apart = np.linalg.norm(weights[ends[:, 0]] - weights[ends[:, 1]], axis=1) / np.sqrt(2)
    whole = np.hypot(edges, 0.5 * np.ptp(vertices, axis=0).max() * apart)
    np.testing.assert_allclose(skinned, whole, rtol=0, atol=1e-5)


def test_vertices_follow_nodes_that_move_as_they_do(rig: Rig) -> None:
    """The upper half of a tube hangs on one joint, the lower on another."""
    upper = rig.mesh.vertices[:, 1] > HEIGHT / 2
    indices, weights = np.zeros_like(rig.skin_indices), np.zeros_like(rig.skin_weights)
    indices[:, 0], weights[:, 0] = np.where(upper, 2, 0), 1
    split = replace(rig, skin_indices=indices, skin_weights=weights)

    def foreign(skin_length: float) -> float:
        graph = spread_nodes(surface_steps(split, skin_length=skin_length), split.mesh.vertices, count=20)
        return float((graph.weights * (upper[graph.nodes][graph.indices] != upper[:, None])).sum(axis=1).mean())

    assert foreign(SKIN_LENGTH) < foreign(0.0) / 2


def test_the_same_graph_at_every_call(rig: Rig) -> None:
    one, two = build_graph(rig, nodes=20), build_graph(rig, nodes=20)
    assert vars(one)
    for name in vars(one):
        np.testing.assert_array_equal(getattr(one, name), getattr(two, name))


def test_a_template_of_fewer_vertices_has_a_node_at_each() -> None:
    rig = synthetic_rig()
    graph = build_graph(rig, nodes=500)
    assert sorted(graph.nodes) == list(range(len(rig.mesh.vertices)))
