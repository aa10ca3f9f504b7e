"""One-rings in blocks: every edge once, and the constraints against a plain loop over vertices."""

from typing import Any

import numpy as np
import pytest
import warp as wp
from tube import tube

from mua.arrays import Array
from mua.teachers.simulated.rings import DEVICE, LANES, in_blocks, relax
from mua.teachers.simulated.simulation import one_rings

SINGLE = 32 * float(np.finfo(np.float32).eps)  # metres; sums of some ten terms of up to 2 m


def rings() -> tuple[Array, Array, Array]:
    mesh = tube().mesh
    starts, neighbours = one_rings(mesh.faces, len(mesh.vertices))
    return mesh.vertices, starts, neighbours


@pytest.mark.parametrize("count", [0, 1, LANES, LANES + 1, 61])
def test_blocks_hold_every_edge_of_the_chosen_vertices(count: int) -> None:
    vertices, starts, _ = rings()
    chosen = np.random.default_rng(count).permutation(len(vertices))[:count]
    blocks = in_blocks(starts, chosen)
    held = blocks.edges >= 0
    own = np.repeat(np.arange(len(vertices)), np.diff(starts))
    assert set(blocks.edges[held]) == set(np.flatnonzero(np.isin(own, chosen)))
    assert set(blocks.vertices.ravel()) == set(chosen)
    np.testing.assert_array_equal(own[blocks.edges[held]], blocks.owners[held])


def test_relaxing_is_that_of_a_plain_loop() -> None:
    vertices, starts, neighbours = rings()
    rng = np.random.default_rng(1)
    chosen = np.sort(rng.permutation(len(vertices))[:50])
    edges = rng.uniform(0.0, 1.0, (3, len(neighbours)))
    edges[0] *= 0.2  # metres: some edges are too long, others too short
    even = rng.normal(0, 0.01, vertices.shape)
    expected = vertices.copy()
    for i in chosen:
        expected[i] -= even[i]
        for k in range(starts[i], starts[i + 1]):
            edge = vertices[neighbours[k]] - vertices[i]
            stretch = 1 - edges[0, k] / np.linalg.norm(edge)
            stretch *= 0.3 if stretch < 0 else 1.0
            expected[i] += edge * (stretch * edges[1, k] + edges[2, k])
    np.testing.assert_allclose(relaxed(vertices, chosen, edges, even), expected, atol=SINGLE)


def relaxed(vertices: Array, chosen: Array, edges: Array, even: Array) -> Array:
    _, starts, neighbours = rings()
    blocks = in_blocks(starts, chosen)
    to = np.where(blocks.edges >= 0, neighbours[blocks.edges], blocks.owners)
    lengths, shares, evenings = (
        blocks.by_edge(values, none=none) for values, none in zip(edges, (1, 0, 0), strict=True)
    )
    whole: list[Any] = [
        wp.array(values.ravel(), dtype=int, device=DEVICE) for values in (blocks.vertices, blocks.starts, to)
    ]
    real: list[Any] = [wp.array(values.ravel(), dtype=float, device=DEVICE) for values in (lengths, shares, evenings)]
    places: list[Any] = [wp.array(values.ravel(), dtype=float, device=DEVICE) for values in (even, vertices, vertices)]
    wp.launch(relax, dim=len(blocks.vertices), inputs=[*whole, *real, 0.3, *places], device=DEVICE)
    return np.asarray(places[-1].numpy()).reshape(-1, 3)
