"""Training points of the MLPs: around frames, and where a part is as in another frame."""

from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
import torch
from limbs import limb_steps, limbs_apart, two_limbs

from mua.student.components import Components
from mua.student.conditioned import Conditioned
from mua.student.points import BLEND, CLOSE, FARTHEST, RADII, draw_close, draw_points, exchange, scatter
from mua.student.regress import MESH, POSED, SWUNG, regress
from mua.student.settings import Generalisation
from mua.training.checkpoint import Checkpoints
from mua.training.optimise import Run
from mua.training.schedule import Schedule

PLAIN = Components(torch.eye(6), 1e6 * torch.tensor([[-1.0], [1.0]]).expand(2, 6), torch.ones(6))


def seeded(seed: int = 0) -> torch.Generator:
    return torch.Generator().manual_seed(seed)


def fitted(directory: Path, inputs: torch.Tensor, targets: torch.Tensor, **options: Any) -> Conditioned:
    """An MLP fitted with these options of `regress`."""
    run = Run(seeded(), Checkpoints(directory, "k"), lambda _: None, torch.device("cpu"))
    schedule = Schedule(steps=600, batch=64, lr=3e-3)
    mlp = regress(inputs, targets, components=PLAIN, hidden=64, schedule=schedule, stage="x", run=run, **options)
    return mlp.requires_grad_(False)


def test_an_exchanged_part_is_whole_and_the_rest_is_that_of_one_frame() -> None:
    frames = torch.arange(50.0)[:, None].expand(-1, 6)
    mixed = exchange(frames, limb_steps(), 2000, generator=seeded())
    assert (mixed[:, :3] == mixed[:, :1]).all()
    assert (mixed[:, 3:] == mixed[:, 3:4]).all()
    apart = mixed[:, 0] != mixed[:, 3]
    assert 0.2 < apart.float().mean() < 0.3  # a radius of 0; any larger one takes both limbs from one frame
    assert mixed.unique().tolist() == list(range(50))


def test_an_exchanged_joint_brings_those_within_a_radius_along() -> None:
    """In a chain of ten, the last joint and up to a radius more: never none, never all."""
    chain = torch.arange(10)[None]
    frames = torch.arange(500.0)[:, None].expand(-1, 10)
    mixed = exchange(frames, chain, 3000, generator=seeded())
    brought = (mixed == mixed[:, :1]).sum(1)
    two = mixed[:, 0] != mixed[:, -1]  # but for points whose two frames are one
    assert two.float().mean() > 0.99
    assert sorted(brought[two].unique().tolist()) == list(range(1, RADII + 1))
    assert torch.allclose((brought[two] == 1).float().mean(), torch.tensor(1 / RADII), atol=0.05)


def test_scattered_points_lie_on_the_way_to_a_frame_but_for_noise() -> None:
    z = torch.randn(30, 4, generator=seeded(1))
    start = torch.zeros(500, 4)
    still = scatter(start, z, 0.0, generator=seeded(2))
    nearest = torch.nn.functional.normalize(still, dim=1) @ torch.nn.functional.normalize(z, dim=1).T
    assert (nearest.max(1).values > 1 - 1e-5).all()
    assert (still.norm(dim=1) <= BLEND * z.norm(dim=1).max()).all()
    moved = scatter(start, z, 0.5, generator=seeded(2)) - still
    assert torch.allclose(moved.std(0) / z.std(0), torch.full((4,), 0.5 / 3**0.5), atol=0.04)  # strengths are uniform


@pytest.mark.parametrize(("share", "expected"), [(0.0, 0), (0.75, 750), (1.0, 1000)])
def test_a_share_of_the_points_exchanges_parts(share: float, expected: int) -> None:
    frames = torch.arange(40.0)[:, None].expand(-1, 6)
    own = Generalisation(noise=0.0, exchanged=share, exchanged_noise=0.0, outside=0.0)
    points = draw_points(frames, PLAIN, 1000, steps=limb_steps(), generalisation=own, generator=seeded(3))
    assert len(points) == 1000
    together = (points[:, 0] - points[:, 3]).abs() < 1e-4
    assert together[: 1000 - expected].all()
    assert bool(together[1000 - expected :].all()) == (expected == 0)
    alone = draw_points(frames, PLAIN, 1000, steps=None, generalisation=own, generator=seeded(3))
    assert ((alone[:, 0] - alone[:, 3]).abs() < 1e-4).all()


def test_a_share_of_the_points_lies_far_out() -> None:
    """Where unseen motion goes; there the function fades to the mean."""
    frames = torch.nn.functional.normalize(torch.randn(40, 6, generator=seeded()), dim=1)
    own = Generalisation(noise=0.0, exchanged=0.0, exchanged_noise=0.0, outside=0.25)
    away = draw_points(frames, PLAIN, 1000, steps=None, generalisation=own, generator=seeded(3)).norm(dim=1)
    assert 0.15 < (away > 1.01).float().mean() < 0.25
    assert FARTHEST / 2 < away.max() < 1.01 * FARTHEST


def test_an_mlp_follows_the_users_frames_and_the_others_roughly(tmp_path: Path) -> None:
    inputs, shown = two_limbs(200, seed=3, together=True)
    half = inputs[:, 0] > inputs[:, 0].median()
    goal = torch.where(half[:, None], shown, -shown)  # a jump, which no smooth function follows
    errors = {}
    for name, own, known in (("all", None, True), ("half", half, True), ("none", None, False)):
        generalisation = Generalisation(own=known)
        mlp = fitted(tmp_path / name, inputs, goal, own=own, fit=SWUNG, generalisation=generalisation)
        errors[name] = (mlp(inputs) - goal).square().sum(1)
    size = shown.square().sum(1)
    assert errors["half"][half].mean() < 0.5 * size[half].mean()
    assert errors["half"][~half].mean() > 0.7 * size[~half].mean()
    assert errors["none"].mean() > 1.5 * errors["all"].mean()


def test_what_the_pose_alone_shows_is_followed_beyond_the_users_frames(tmp_path: Path) -> None:
    inputs, shown = two_limbs(300, seed=3, together=True)
    unseen, truth = two_limbs(200, seed=4, together=True)
    own = inputs.norm(dim=1) < inputs.norm(dim=1).median()
    left = {}
    for name, fit in (("posed", POSED), ("swung", SWUNG)):
        mlp = fitted(tmp_path / name, inputs, shown, own=own, fit=fit)
        left[name] = (mlp(unseen) - truth).square().sum() / truth.square().sum()
    assert left["posed"] < 0.4
    assert left["posed"] < 0.7 * left["swung"]


def test_close_points_are_those_of_a_frame_but_for_little_noise() -> None:
    frames = torch.randn(50, 6, generator=seeded(2)) * torch.tensor([1.0, 1, 1, 1, 1, 9])
    close = draw_close(frames, 400, generator=seeded(1))
    distance, nearest = torch.cdist(close, frames).min(1)
    assert 0 < distance.mean() < 0.1 * frames.std(0).norm()
    assert len(nearest.unique()) == len(frames)
    noise = (close - frames[nearest]).std(0)
    torch.testing.assert_close(noise, CLOSE * frames.std(0), rtol=0.2, atol=0)


def test_a_final_fit_follows_the_users_frames_more_closely(tmp_path: Path) -> None:
    inputs, shown = two_limbs(200, seed=3, together=True)
    own = inputs.norm(dim=1) < inputs.norm(dim=1).median()
    goal, errors = torch.where(own[:, None], shown, 3 * shown), {}
    for name, fit in (("start", POSED), ("final", MESH)):
        mlp = fitted(tmp_path / name, inputs, goal, own=own, fit=fit)
        errors[name] = (mlp(inputs) - shown)[own].norm(dim=1).median()
    assert errors["final"] < 0.8 * errors["start"]


def test_a_third_of_the_points_of_a_final_fit_is_close_to_the_users_frames(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """No other point says anything here."""
    inputs, shown = two_limbs(200, seed=3, together=True)
    own = inputs[:, 0] > inputs[:, 0].median()
    drawn = []

    def nowhere(inputs: torch.Tensor, components: Components, count: int, **_: Any) -> torch.Tensor:
        drawn.append(count)
        return torch.zeros(count, len(components), dtype=torch.float16)

    monkeypatch.setattr("mua.student.regress.draw_points", nowhere)
    away = (fitted(tmp_path, inputs, shown, own=own, fit=MESH)(inputs) - shown).norm(dim=1)
    assert drawn[0] == pytest.approx(2 / 3 * 600 * 64 / MESH.visits, abs=1)
    assert away[own].median() < 0.2 * shown[own].norm(dim=1).median()
    assert away[own].median() < 0.5 * away[~own].median()


def test_weights_of_a_regression_decay(tmp_path: Path) -> None:
    inputs, shown = two_limbs(200, seed=3, together=True)
    lengths = []
    for decay in (0.0, 10.0):
        mlp = fitted(tmp_path / str(decay), inputs, shown, generalisation=Generalisation(weight_decay=decay))
        lengths.append(torch.nn.utils.parameters_to_vector(mlp.parameters()).norm())
    assert lengths[1] < 0.5 * lengths[0]


def test_an_mlp_fitted_to_exchanged_parts_carries_over_to_limbs_that_move_apart(tmp_path: Path) -> None:
    inputs, shown = two_limbs(300, seed=3, together=True)
    unseen, truth = two_limbs(200, seed=4, together=False)
    errors = []
    for share in (0.0, 0.75):
        generalisation = replace(Generalisation(), exchanged=share)
        mlp = fitted(tmp_path / f"{share}", inputs, shown, locality=limbs_apart(0.0), generalisation=generalisation)
        errors.append(float((mlp(unseen) - truth).square().mean()))
    assert errors[1] < 0.8 * errors[0]
