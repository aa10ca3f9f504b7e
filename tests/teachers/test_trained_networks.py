"""Networks of the template: their input, their start, and their output for poses far from training."""

import numpy as np
import pytest
import torch
from tube import swing, tube

from mua.pose.descriptor import describe
from mua.pose.encoding import PoseEncoding
from mua.rig.build import build_rig
from mua.rig.rig import Rig
from mua.teachers.trained.graph import build_graph
from mua.teachers.trained.graph_networks import NodeFeatures, skin_of_parts
from mua.teachers.trained.motion_deformation import FARTHEST, GraphSizes, MotionDeformation

ENCODING = PoseEncoding(joints=(1, 2), rate=30.0)
SIZES = GraphSizes(nodes=20, features=5)
ROUNDING = 1e-6  # some 20 float32 operations on lengths of up to 2 metres
CHEST = (
    slice(6, 12),
    slice(12 + 9 + 6, 12 + 9 + 12),
)  # entries: in the world, then in its parent


@pytest.fixture(scope="module")
def rig() -> Rig:
    return build_rig(tube(), texels=16)[0]


def descriptors(rig: Rig) -> torch.Tensor:
    clip = swing(tube())
    return torch.tensor(describe(rig.skeleton, ENCODING, clip.rotations, clip.translations)).float()


def moving(rig: Rig, seed: int = 0) -> MotionDeformation:
    """A deformation whose last layers are not zero any more."""
    generator = torch.Generator().manual_seed(seed)
    deformation = MotionDeformation(rig, ENCODING, SIZES)
    deformation.prepare(descriptors(rig), generator)
    with torch.no_grad():
        for readout in (deformation.node_motion, deformation.vertex_offsets):
            readout.weight.normal_(generator=generator)
    return deformation


def test_before_training_the_template_is_that_of_the_bind_pose(rig: Rig) -> None:
    deformation = MotionDeformation(rig, ENCODING, SIZES)
    deformation.prepare(descriptors(rig), torch.Generator().manual_seed(0))
    found = deformation(descriptors(rig)).detach().numpy()
    np.testing.assert_allclose(found, np.broadcast_to(rig.mesh.vertices, found.shape), rtol=0, atol=ROUNDING)


def test_a_node_sees_distant_joints_less(rig: Rig) -> None:
    graph = build_graph(rig, nodes=20)
    features = NodeFeatures(rig, ENCODING, graph, features=5, fade=0.5)
    features.seed(torch.Generator().manual_seed(0))
    hangs = skin_of_parts(rig, ENCODING)[graph.nodes]
    reach = torch.as_tensor(hangs).float() @ features.parts.reach
    lowest, highest = graph.positions[:, 1].argmin(), graph.positions[:, 1].argmax()
    for chest in CHEST:
        assert reach[highest, chest].min() > 2 * reach[lowest, chest].max()
    np.testing.assert_allclose(hangs.sum(axis=1), 1, atol=ROUNDING)


def test_a_part_sees_a_joint_less_with_every_joint_between_and_the_root_from_one_step(rig: Rig) -> None:
    """A chain: root, spine, chest; how the last two are turned in the world, then of every pose place and all turns."""
    reach = NodeFeatures(rig, ENCODING, build_graph(rig, nodes=9), features=5, fade=0.5).parts.reach
    rows = [[0, 1, 2], [1, 0, 1], [1, 1, 0]]  # joints from root, spine and chest to each
    limbs = [[spine] * 6 + [chest] * 6 for _, spine, chest in rows]
    expected = [own + ([root] * 9 + own) * 3 for (root, _, _), own in zip(rows, limbs, strict=True)]
    torch.testing.assert_close(reach, 0.5 ** torch.tensor(expected, dtype=torch.float32))


def test_blocks_add_to_what_a_node_knows(rig: Rig) -> None:
    features = NodeFeatures(rig, ENCODING, build_graph(rig, nodes=20), features=5, fade=0.5)
    features.seed(torch.Generator().manual_seed(0))
    inputs = torch.randn(2, ENCODING.width, generator=torch.Generator().manual_seed(1))
    own = torch.relu(features.mix @ features.parts(inputs) + features.code)
    with torch.no_grad():
        for block in features.blocks:
            block.weight.zero_()  # type: ignore[operator]
    torch.testing.assert_close(features(inputs), own)


def test_networks_start_from_small_weights(rig: Rig) -> None:
    features = NodeFeatures(rig, ENCODING, build_graph(rig, nodes=20), features=64, fade=0.5)
    features.seed(torch.Generator().manual_seed(0))
    first, code = features.parts.layer.weight.detach(), features.code.detach()
    assert float(first.std()) == pytest.approx(0.3 * ENCODING.width**-0.5, rel=0.1)
    assert float(code.std()) == pytest.approx(0.1, rel=0.1)


def test_a_graph_of_one_node_has_no_neighbours_to_ask(rig: Rig) -> None:
    features = NodeFeatures(rig, ENCODING, build_graph(rig, nodes=1), features=5, fade=0.5)
    assert torch.isfinite(features(torch.ones(1, ENCODING.width))).all()


def test_what_fades_to_nothing_changes_nothing(rig: Rig) -> None:
    """With a fade of 0, a part is moved by its own joint and the root alone."""
    graph = build_graph(rig, nodes=20)
    features = NodeFeatures(rig, ENCODING, graph, features=5, fade=0.0)
    features.seed(torch.Generator().manual_seed(0))
    inputs = torch.randn(1, ENCODING.width, generator=torch.Generator().manual_seed(1))
    for chest in CHEST:
        other = inputs.clone()
        other[:, chest] += 1
        apart = (features.parts(inputs) - features.parts(other)).abs().amax(dim=2)[0]
        assert apart[1] == 0  # the spine
        assert apart[2] > 0.01


def test_neighbours_know_of_each_other(rig: Rig) -> None:
    graph = build_graph(rig, nodes=20)
    features = NodeFeatures(rig, ENCODING, graph, features=5, fade=0.5)
    features.seed(torch.Generator().manual_seed(0))
    inputs = torch.zeros(1, ENCODING.width)
    before = features(inputs)
    with torch.no_grad():
        features.code[4] += 1
    changed = (features(inputs) - before).abs().amax(dim=2)[0] > 0
    near = (graph.neighbours == 4).any(axis=1)
    assert changed[near].float().mean() > 0.5
    two_steps = near | near[graph.neighbours].any(axis=1)
    two_steps[4] = True
    assert not changed[~two_steps].any()


def test_both_networks_add_up(rig: Rig) -> None:
    deformation = moving(rig)
    whole, nodes = (deformation.deform(descriptors(rig), offsets=offsets) for offsets in (True, False))
    torch.testing.assert_close(whole.vertices, nodes.vertices + whole.offsets, rtol=0, atol=ROUNDING)
    assert nodes.offsets.abs().max() == 0
    assert whole.offsets.abs().max() > 1e-3
    expected = deformation.graph(whole.turns, whole.moves)
    torch.testing.assert_close(nodes.vertices, expected, rtol=0, atol=ROUNDING)


def test_a_pose_beyond_all_that_was_seen_deforms_like_one_at_the_border(rig: Rig) -> None:
    deformation = moving(rig)
    direction = torch.ones(1, ENCODING.width)
    border, beyond = (deformation(deformation.mean + k * deformation.scale * direction) for k in (FARTHEST, 50.0))
    inside = deformation(deformation.mean + 0.5 * deformation.scale * direction)
    torch.testing.assert_close(beyond, border, rtol=0, atol=ROUNDING)
    assert (inside - border).abs().max() > 1e-3


def test_the_seed_decides_where_training_starts(rig: Rig) -> None:
    one, same, other = (moving(rig, seed).state_dict() for seed in (0, 0, 1))
    assert all(torch.equal(one[name], same[name]) for name in one)
    assert not torch.equal(one["node_features.code"], other["node_features.code"])
