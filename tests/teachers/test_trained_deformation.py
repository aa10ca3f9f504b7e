"""Embedded deformation against a plain loop, and what it keeps."""

import numpy as np
import pytest
import torch
from scipy.spatial.transform import Rotation
from tube import tube

from mua.rig.build import build_rig
from mua.rig.rig import Rig
from mua.teachers.trained.deformation import EmbeddedDeformation, quaternions
from mua.teachers.trained.graph import EmbeddedGraph, build_graph

BOUND = 1e-12  # some 50 operations on lengths of up to 2 metres in float64
BUFFER_BOUND = 1e-6  # positions and weights are held in float32


@pytest.fixture(scope="module")
def rig() -> Rig:
    return build_rig(tube(), texels=16)[0]


@pytest.fixture(scope="module")
def graph(rig: Rig) -> EmbeddedGraph:
    return build_graph(rig, nodes=25)


def random(seed: int, *shape: int) -> torch.Tensor:
    return torch.randn(shape, generator=torch.Generator().manual_seed(seed), dtype=torch.float64)


def test_it_is_the_sum_over_nodes_of_the_formula(rig: Rig, graph: EmbeddedGraph) -> None:
    turns, moves = random(0, 2, 25, 3), 0.1 * random(1, 2, 25, 3)
    found = EmbeddedDeformation(graph, rig).double()(turns, moves)
    for frame in range(2):
        turned = Rotation.from_rotvec(turns[frame].numpy())
        for v, place in enumerate(rig.mesh.vertices):
            expected = np.zeros(3)
            for node, weight in zip(graph.indices[v], graph.weights[v], strict=True):
                centre = graph.positions[node]
                expected += weight * (turned[node].apply(place - centre) + centre + moves[frame, node].numpy())
            np.testing.assert_allclose(found[frame, v], expected, rtol=0, atol=BUFFER_BOUND)


def test_nothing_moves_at_zero(rig: Rig, graph: EmbeddedGraph) -> None:
    zero = torch.zeros(3, 25, 3, dtype=torch.float64)
    deformation = EmbeddedDeformation(graph, rig).double()
    np.testing.assert_allclose(deformation(zero, zero)[1], rig.mesh.vertices, rtol=0, atol=BUFFER_BOUND)
    assert deformation.rigidity_error(zero, zero) == 0


def test_a_rigid_motion_of_all_nodes_is_one_of_the_template_and_costs_nothing(rig: Rig, graph: EmbeddedGraph) -> None:
    deformation = EmbeddedDeformation(graph, rig).double()
    turn = torch.tensor([0.3, -1.0, 0.4], dtype=torch.float64)
    turned = torch.tensor(Rotation.from_rotvec(turn.numpy()).as_matrix())
    moves = deformation.positions @ turned.T - deformation.positions + torch.tensor([0.1, 0.2, 0.3]).double()
    turns = turn.expand(1, 25, 3)
    expected = deformation.vertices @ turned.T + torch.tensor([0.1, 0.2, 0.3]).double()
    torch.testing.assert_close(deformation(turns, moves[None])[0], expected, rtol=0, atol=BUFFER_BOUND)
    assert deformation.rigidity_error(turns, moves[None]) < BOUND**2
    moves[7, 1] += 0.01
    assert deformation.rigidity_error(turns, moves[None]) > 1e-7


def test_gradients_are_those_of_finite_differences_where_nothing_is_turned_too(rig: Rig, graph: EmbeddedGraph) -> None:
    deformation = EmbeddedDeformation(graph, rig).double()
    towards, weights = random(2, 2, 1, 25, 3), random(3, 1, len(rig.mesh.vertices), 3)

    def value(turns: torch.Tensor, moves: torch.Tensor) -> torch.Tensor:
        return (weights * deformation(turns, moves)).sum() + 100 * deformation.rigidity_error(turns, moves)

    for at in (torch.zeros(2, 1, 25, 3, dtype=torch.float64), 0.5 * random(4, 2, 1, 25, 3)):
        leaf = at.clone().requires_grad_()
        value(*leaf).backward()
        assert leaf.grad is not None
        difference = (value(*(at + 1e-6 * towards)) - value(*(at - 1e-6 * towards))) / 2e-6
        torch.testing.assert_close((leaf.grad * towards).sum(), difference, rtol=1e-6, atol=1e-6)


def test_quaternions_are_those_of_scipy() -> None:
    turns = random(5, 100, 3)
    expected = Rotation.from_rotvec(turns.numpy()).as_quat(scalar_first=True)
    sign = np.sign((quaternions(turns).numpy() * expected).sum(axis=1, keepdims=True))
    np.testing.assert_allclose(quaternions(turns), sign * expected, rtol=0, atol=BOUND)
