"""Local coefficients: parts follow the joints near them, and their sum is what the whole would be."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import recordings
import torch
from limbs import limbs_apart, two_limbs
from people import upright
from synthetic_avatar import synthetic_rig
from synthetic_student import SETTINGS, new_student

from mua.pose.encoding import PoseEncoding
from mua.pose.joint_steps import joint_steps, nearest_encoded
from mua.recording import Recording
from mua.student.coarse import mesh_pca
from mua.student.components import Components
from mua.student.distil import prepare
from mua.student.factorize import truncated_svd
from mua.student.local import (
    POSE_FOR_LIGHT,
    Locality,
    Parts,
    body_parts,
    sample_locality,
    sample_owners,
    texture_locality,
)
from mua.student.model import Alphas
from mua.student.regress import factors, fit_local, visible, whitening
from mua.student.targets import Targets

# armature > hips > (spine > neck > head, thigh > shin)
PARENTS = [-1, 0, 1, 2, 3, 1, 5]
ARMATURE, HIPS, SPINE, NECK, HEAD, THIGH, SHIN = range(7)


BODY = upright([f"joint {joint}" for joint in range(len(PARENTS))], PARENTS, root=HIPS)


def test_steps_count_joints_along_the_skeleton() -> None:
    seen = [HIPS, SPINE, NECK, HEAD, THIGH, SHIN]
    expected = [
        [0, 1, 2, 3, 1, 2],
        [1, 0, 1, 2, 2, 3],
        [2, 1, 0, 1, 3, 4],
        [3, 2, 1, 0, 4, 5],
        [1, 2, 3, 4, 0, 1],
        [2, 3, 4, 5, 1, 0],
    ]
    assert joint_steps(BODY, seen).tolist() == expected


def test_steps_pass_over_joints_that_are_not_encoded() -> None:
    assert joint_steps(BODY, [HIPS, HEAD, SHIN]).tolist() == [[0, 1, 1], [1, 0, 2], [1, 2, 0]]


def test_a_joint_that_is_not_encoded_is_carried_by_the_one_above_it() -> None:
    assert nearest_encoded(BODY, [HIPS, SPINE, SHIN]).tolist() == [0, 0, 1, 1, 1, 0, 2]


def test_every_entry_of_the_descriptor_fades_with_its_joint_and_the_root_by_one_step() -> None:
    rig = synthetic_rig()
    encoding = PoseEncoding(joints=tuple(j for j in range(len(rig.skeleton.names)) if j != rig.skeleton.root), rate=30)
    parts = body_parts(rig, encoding)
    seen = [rig.skeleton.root, *encoding.joints]
    assert parts.steps.shape == (len(seen), encoding.width)
    parents = [int(rig.skeleton.parents[joint]) for joint in seen[1:]]
    assert [seen[part] for part in parts.above[1:].tolist()] == parents
    turned = 6 * len(encoding.joints)
    for part in range(len(seen)):
        steps = joint_steps(rig.skeleton, seen)[part]
        joints = [0.5 ** int(steps[column]) for column in range(1, len(seen)) for _ in range(6)]
        of_frames = ([1.0 if part == 0 else 0.5] * 9 + joints) * encoding.window
        assert parts.reach(0.5)[part].tolist() == [0.0] * turned + of_frames
        light = [*joints, *(POSE_FOR_LIGHT * share for share in of_frames)]
        assert parts.reach(0.5, light=True)[part].tolist() == pytest.approx(light)


def test_what_a_joint_is_translated_fades_as_its_rotation_does() -> None:
    """Also of a joint that moves without turning: it is a part, too."""
    rig = synthetic_rig()
    parts = body_parts(rig, PoseEncoding(joints=(1,), rate=30, window=2, translated=(1, 2)))
    steps = joint_steps(rig.skeleton, [0, 1, 2])
    frame = steps[:, [0] * 9 + [1] * 6 + [1] * 3 + [2] * 3]
    frame[:, :9] = np.minimum(frame[:, :9], 1)
    assert parts.steps.tolist() == np.hstack([steps[:, [1] * 6], frame, frame]).tolist()


def test_a_sample_belongs_to_the_part_that_most_of_its_texels_hang_on() -> None:
    image = np.zeros((4, 6, 3))
    image[0, 0, 2] = 1.0
    image[:2, 1, 1] = 0.6  # together more than the one texel of part 2
    image[2, 2, 2] = 1.0
    owners = sample_owners(image, 2)
    assert owners.tolist() == [[1, owners[0, 1], owners[0, 2]], [owners[1, 0], 2, 2]]
    assert owners[1, 0] in (1, 2)
    assert owners[0, 1] in (1, 2)


def two_parts() -> Parts:
    """A student whose texture's left half hangs on part 0 and right half on part 1."""
    coarse = torch.zeros(3, 3, dtype=torch.int64)
    coarse[:, 2:] = 1
    fine = torch.zeros(6, 6, dtype=torch.int64)
    fine[:, 4:] = 1
    return Parts(
        torch.tensor([[0, 1], [1, 0]]),
        torch.zeros(2, dtype=torch.bool),
        coarse,
        fine,
        torch.tensor([0, 0, 0, 1, 1, 1, 1]),
        torch.tensor([0, 0]),
    )


def test_shares_of_the_parts_make_up_the_whole_texture() -> None:
    branch = new_student().geometry
    generator = torch.Generator().manual_seed(3)
    with torch.no_grad():
        for parameter in (branch.ll_basis, branch.d3.h, branch.d3.w, branch.d2.h, branch.d2.w):
            parameter.normal_(0, 1, generator=generator)
    weights = torch.rand(branch.channels, generator=generator) + 0.5
    flat = torch.randn(40, branch.channels * branch.ranks.total, generator=generator)

    def texture(alphas: Alphas) -> torch.Tensor:
        bands = branch.synthesize(alphas)
        return torch.cat([(band * weights[:, None, None]).flatten(1) for band in bands], dim=1)

    # orthonormal textures, and the coefficients that stand for them
    _, _, directions = truncated_svd(texture(branch.split(flat)), 8, generator=generator)
    expand = torch.linalg.lstsq(texture(branch.split(torch.eye(flat.shape[1]))).T, directions.T).solution.T
    expand = expand.detach()
    found = texture_locality(two_parts(), branch, Targets(torch.zeros(0, 8), expand), weights, fade=0.5)
    assert torch.allclose(found.shares.sum(0), torch.eye(8), atol=1e-3)
    left = torch.cat(
        [(two_parts().coarse == 0).expand(branch.channels, -1, -1).flatten()] * 4
        + [(two_parts().fine == 0).expand(branch.channels, -1, -1).flatten()] * 3
    )
    expected = (directions * left) @ directions.T
    assert torch.allclose(found.shares[0], expected, atol=1e-3)


def test_shares_of_the_mesh_follow_its_vertices() -> None:
    meshes = torch.randn(30, 7, 3, generator=torch.Generator().manual_seed(0))
    basis = mesh_pca(meshes, 5, generator=torch.Generator().manual_seed(0)).basis
    shares = sample_locality(two_parts(), basis, two_parts().vertices, fade=0.5).shares
    assert torch.allclose(shares.sum(0), torch.eye(5), atol=1e-5)
    assert torch.allclose(shares[1], torch.einsum("kvx,lvx->kl", basis[:, 3:], basis[:, 3:]), atol=1e-5)


def smooth(inputs: torch.Tensor, shown: torch.Tensor, fade: float) -> Callable[[torch.Tensor], torch.Tensor]:
    """The smooth function fitted to `inputs`, as a function of other inputs."""
    components = boundless(inputs)
    found = fit_local(inputs, shown, components, limbs_apart(fade), generator=torch.Generator().manual_seed(0))
    return lambda x: found(components(x))


def boundless(inputs: torch.Tensor) -> Components:
    """Whitened components that nothing bounds."""
    turn = whitening(inputs).T
    return Components(turn, torch.zeros(2, len(turn)), torch.full((len(turn),), torch.inf))


def test_a_far_joint_moves_a_part_the_less_the_more_it_fades() -> None:
    inputs, shown = two_limbs(200, seed=1, together=True)
    moved = inputs.clone()
    moved[:, 3:] += 1
    moves = []
    for fade in (1.0, 0.5, 0.1, 0.0):
        function = smooth(inputs, shown, fade)
        moves.append(float((function(moved) - function(inputs))[:, 0].abs().mean()))
    assert moves == sorted(moves, reverse=True)
    assert moves[0] > 0.1
    assert moves[-1] < 1e-5  # nothing but rounding


def test_parts_that_do_not_fade_make_the_function_of_the_whole() -> None:
    inputs, shown = two_limbs(100, seed=2, together=True)
    components = boundless(inputs)
    whole = fit_local(inputs, shown, components, None, generator=torch.Generator().manual_seed(0))
    assert torch.allclose(smooth(inputs, shown, 1.0)(inputs), whole(components(inputs)), atol=1e-3)


def test_a_part_is_fitted_in_the_directions_that_it_varies_in() -> None:
    directions = torch.linalg.qr(torch.randn(12, 3, generator=torch.Generator().manual_seed(0))).Q
    for own in (directions, directions[:, :0]):  # the second has no samples
        share = own @ own.T
        narrow, wide = factors(share)
        assert torch.allclose(narrow @ wide, share, atol=1e-5)
        assert own.shape[1] == 0 or narrow.shape == (12, 3)


def test_a_part_that_hardly_varies_is_fitted_with_the_one_above() -> None:
    """Of a chain of parts with a coordinate each, the third varies too little and so do both that hang on it."""
    above, reach = torch.tensor([0, 0, 1, 2, 2]), torch.rand(5, 4, generator=torch.Generator().manual_seed(0))
    shares = torch.diag_embed(torch.eye(5))
    goal = torch.tensor([1.0, 1.0, 1e-2, 1e-2, 1e-2]) * torch.randn(50, 5, generator=torch.Generator().manual_seed(1))
    seen, left = Locality(reach.long(), above, reach, shares).fewer(goal)
    assert torch.equal(seen, reach[:2])
    assert torch.equal(left, torch.stack([shares[0], shares[1:].sum(0)]))
    seen, left = Locality(reach.long(), above, reach, shares).fewer(goal / goal.std(0))
    assert torch.equal(seen, reach)
    assert torch.equal(left, shares)


def test_small_parts_that_vary_together_are_one_part() -> None:
    above, shares = torch.tensor([0, 0, 1, 1, 1]), torch.diag_embed(torch.eye(5))
    goal = torch.tensor([1.0, 1.0, 0.04, 0.04, 0.04]) * torch.ones(10, 5)
    goal[:, 1] = 0.04  # each 0.16 % of all, the four together 0.64 %
    _, left = Locality(above[:, None], above, torch.ones(5, 1), shares).fewer(goal)
    assert torch.equal(left, torch.stack([shares[0], shares[1:].sum(0)]))


def test_a_part_is_blind_to_joints_that_tell_frames_hardly_apart() -> None:
    inputs = torch.randn(500, 30, generator=torch.Generator().manual_seed(0))
    reach = torch.tensor([1.0] * 10 + [1e-3] * 20)
    seen = visible(inputs * reach)
    assert seen.tolist() == [True] * 10 + [False] * 20
    whole, part = (inputs * reach) @ whitening(inputs * reach), inputs[:, seen] @ whitening(inputs[:, seen])
    distances = (torch.cdist(some[:250], some[250:]) for some in (part, whole))
    torch.testing.assert_close(*distances, rtol=1e-3, atol=0)


def test_local_parts_carry_over_to_limbs_that_move_apart() -> None:
    inputs, shown = two_limbs(300, seed=3, together=True)
    unseen, truth = two_limbs(200, seed=4, together=False)
    errors = [float((smooth(inputs, shown, fade)(unseen) - truth).square().mean()) for fade in (1.0, 0.5)]
    assert errors[1] < 0.8 * errors[0]


def test_a_texel_belongs_to_the_part_of_its_sample() -> None:
    texels = torch.tensor([0, 31, 32, 47, 48 * 47 + 32])  # in a texture of 48 x 48; part 1 begins at column 32
    assert two_parts().texel_owners(texels).tolist() == [0, 0, 1, 1, 1]


def test_a_recording_is_prepared_with_its_parts(tmp_path: Path) -> None:
    recordings.write(tmp_path)
    recording = Recording(tmp_path)
    settings = replace(SETTINGS, texels=recording.rig.texels.size)
    student, samples = prepare(recording, settings)
    assert samples.parts is not None
    assert samples.parts.steps.shape[1] == student.encoding.width
    assert samples.parts.fine.shape == student.geometry.d2.mean.shape[-2:]
    alike = replace(settings, generalisation=replace(settings.generalisation, fade=1.0))
    assert prepare(recording, alike)[1].parts is None
