"""Skins of scenes: influences of a vertex, and which vertices are one."""

from dataclasses import replace

import numpy as np
import pytest
from scenes import DOUBLE_BOUND, HERE, at, part, scene

from mua.characters.assemble import assemble, limit_influences
from mua.scene import Skin


def test_keeps_the_eight_largest_influences() -> None:
    generator = np.random.default_rng(1)
    weights = generator.dirichlet(np.ones(13), size=7)
    joints = np.stack([generator.permutation(20)[:13] for _ in range(7)])
    indices, kept, lost = limit_influences(joints, weights)
    for row in range(7):
        best = np.argsort(-weights[row])[:8]
        np.testing.assert_array_equal(indices[row], joints[row, best])
        np.testing.assert_allclose(kept[row], weights[row, best] / weights[row, best].sum(), atol=DOUBLE_BOUND)
    assert lost == pytest.approx(1 - np.sort(weights, axis=1)[:, -8:].sum(axis=1).min())


def test_a_joint_named_twice_counts_once() -> None:
    indices, kept, lost = limit_influences(np.array([[4, 2, 4, 0]]), np.array([[0.3, 0.4, 0.3, 0.0]]))
    assert indices.tolist() == [[4, 2, 0, 0, 0, 0, 0, 0]]
    np.testing.assert_allclose(kept[0, :3], [0.6, 0.4, 0])
    assert lost == pytest.approx(0)


def test_more_than_eight_influences_are_noted() -> None:
    joints = np.tile(np.arange(9), (30, 1))
    names = tuple(f"bone{k}" for k in range(9))
    bind = np.tile(at(0, 1, 0), (9, 1, 1))
    whole = scene(
        node_names=names,
        parents=np.arange(-1, 8),
        rest=bind,
        skins=(Skin(np.arange(9), np.linalg.inv(bind)),),
        parts=(replace(part(), joints=joints, weights=np.full((30, 9), 1 / 9)),),
    )
    assert assemble(whole, HERE).notes == (
        "Mesh part0 has vertices with more than 8 influences; up to 11 % of a vertex's weight is dropped.",
    )


def test_vertex_without_weight_goes_to_its_first_joint() -> None:
    surfaces = assemble(scene(parts=(replace(part(), weights=np.zeros((30, 2))),)), HERE)
    np.testing.assert_array_equal(surfaces.skin_indices[surfaces.faces.ravel(), 0], np.arange(30) % 5)


def test_welds_equal_vertices_of_a_mesh_only() -> None:
    twice = (part(), part(), part(group=1))
    surfaces = assemble(scene(parts=twice), HERE)
    assert len(surfaces.vertices) == 60  # the copy in the same mesh is gone, the one in another stays
    assert len(surfaces.faces) == 20
    assert surfaces.notes == ("10 duplicate triangles are dropped.",)


def test_other_weights_keep_vertices_apart() -> None:
    other = replace(part(), weights=part().weights[:, ::-1])
    assert len(assemble(scene(parts=(part(), other)), HERE).vertices) == 60
