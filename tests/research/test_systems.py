"""Every compared system learns, within its budget, and the same each time."""

from dataclasses import replace

import numpy as np
import pytest
import torch
from compared_systems import EXPLAINED, STEPS, explained, few, trained
from torch import Tensor

from mua.errors import InputError
from mua.training.optimise import Progress
from mua_research.network import NetworkSystem
from mua_research.optimise import optimise
from mua_research.system import Budget, TrainingFrames
from mua_research.systems import SYSTEMS

FROM_NOISE = ("2d-conv+2d-conv", "2d-conv+blendshapes")  # whose LL has no closed form
CLOSED_FORMS = [name for name in SYSTEMS if name not in FROM_NOISE]
RANDOM_STEPS = 60


@pytest.mark.parametrize("name", CLOSED_FORMS)
def test_learns_more_than_the_mean_texture_from_a_closed_form(name: str, smooth_frames: TrainingFrames) -> None:
    system = trained(name, smooth_frames, Budget(steps=STEPS, batch=4))
    assert system.steps == STEPS
    assert explained(system, smooth_frames) > EXPLAINED


@pytest.mark.parametrize("name", FROM_NOISE)
def test_convolutions_learn_more_than_the_mean_texture_from_noise(name: str, smooth_frames: TrainingFrames) -> None:
    budget = Budget(steps=RANDOM_STEPS, batch=4, rate=1e-2)
    assert explained(trained(name, smooth_frames, budget), smooth_frames) > EXPLAINED


@pytest.mark.parametrize("name", SYSTEMS)
def test_a_budget_in_steps_gives_the_same_bytes(name: str, smooth_frames: TrainingFrames) -> None:
    found = []
    for seed in range(2):
        torch.manual_seed(seed)  # draws come from the generator alone
        found.append(trained(name, few(smooth_frames), Budget(steps=1, batch=4)))
    one, other = (system.textures(smooth_frames.motion) for system in found)
    assert torch.equal(one, other)


@pytest.mark.parametrize("name", SYSTEMS)
def test_what_was_learnt_is_taken_up_from_its_state(name: str, smooth_frames: TrainingFrames) -> None:
    system = trained(name, few(smooth_frames), Budget(steps=2))
    again = SYSTEMS[name](smooth_frames.sizes)
    again.restore(system.state(), smooth_frames)
    motion = smooth_frames.motion.of(torch.arange(3))
    assert torch.equal(again.textures(motion), system.textures(motion))
    assert isinstance(again, NetworkSystem)
    assert (again.steps, again.seconds) == (2, system.seconds)


def test_a_budget_without_an_end_is_refused(smooth_frames: TrainingFrames) -> None:
    with pytest.raises(InputError, match=r"^budget: neither seconds nor steps are given, expected one of them$"):
        trained("linear", smooth_frames, Budget())


def test_a_budget_that_a_closed_form_uses_up_leaves_no_step(smooth_frames: TrainingFrames) -> None:
    system = trained("linear", smooth_frames, Budget(seconds=0))
    assert system.steps == 0
    assert explained(system, smooth_frames) > EXPLAINED


def test_convolutions_start_at_the_mean_texture(smooth_frames: TrainingFrames) -> None:
    system = trained("2d-conv+2d-conv", smooth_frames, Budget(steps=0))
    found = system.textures(smooth_frames.motion.of(torch.arange(3)))
    assert torch.equal(found, smooth_frames.mean_texture.expand(3, -1, -1))


def test_the_rate_rises_then_falls_to_zero_over_the_budget() -> None:
    place = torch.nn.Parameter(torch.zeros(1))
    places, reported = [0.0], list[Progress]()

    def report(progress: Progress) -> None:
        places.append(float(place.detach()))
        reported.append(progress)

    def loss(_: Tensor) -> Tensor:
        return -place.sum()

    optimise(
        loss,
        [{"params": [place], "lr": 1.0}],
        frames=4,
        budget=Budget(steps=50),
        started=0.0,
        stage="Adam",
        generator=torch.Generator(),
        report=report,
    )
    assert [(each.stage, each.step, each.steps) for each in reported] == [("Adam", step, 50) for step in range(1, 51)]
    assert [each.loss for each in reported] == [-each for each in places[:-1]]
    moves = np.diff(places)  # under a steady gradient, Adam moves by the rate
    done = np.arange(50) / 50
    np.testing.assert_allclose(moves, np.minimum(done / 0.1, 1) * 0.5 * (1 + np.cos(np.pi * done)), atol=1e-4)


def test_the_linear_map_is_linear(smooth_frames: TrainingFrames) -> None:
    system = trained("linear", smooth_frames, Budget(steps=2))
    a, b = smooth_frames.motion.inputs[:2]
    between = replace(smooth_frames.motion.of(torch.arange(1)), inputs=(0.25 * a + 0.75 * b)[None])
    ends = system.textures(smooth_frames.motion.of(torch.arange(2)))
    torch.testing.assert_close(system.textures(between)[0], 0.25 * ends[0] + 0.75 * ends[1], rtol=1e-4, atol=1e-4)
