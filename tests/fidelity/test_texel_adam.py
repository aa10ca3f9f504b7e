"""Adam for texels of which an image shows some."""

import pytest
import torch

from mua.fidelity.texel_adam import BETAS, EPSILON, TexelAdam

TEXELS, NUMBERS = 5, 3


def by_formula(gradients: list[torch.Tensor]) -> torch.Tensor:
    """The last of these steps of one texel, as sums over all its gradients."""
    ages = torch.arange(len(gradients)).flip(0)[:, None]
    stacked = torch.stack(gradients)
    mean = (1 - BETAS[0]) * (BETAS[0] ** ages * stacked).sum(dim=0)
    weights = BETAS[1] ** ages
    return mean / ((weights * stacked.square()).sum(dim=0).div(weights.sum()).sqrt() + EPSILON)


def test_steps_of_a_texel_follow_from_the_gradients_of_images_that_show_it() -> None:
    adam, random = TexelAdam(TEXELS, NUMBERS), torch.Generator().manual_seed(0)
    had: dict[int, list[torch.Tensor]] = {texel: [] for texel in range(TEXELS)}
    for seen in ([0, 3], [1, 3, 4], [3], [0, 1], [4, 0], [3]):
        gradient = torch.randn(len(seen), NUMBERS, generator=random)
        steps = adam(torch.tensor(seen), gradient)
        for texel, own, step in zip(seen, gradient, steps, strict=True):
            had[texel].append(own)
            torch.testing.assert_close(step, by_formula(had[texel]))


def test_first_images_move_a_texel_less() -> None:
    adam, gradient = TexelAdam(1, NUMBERS), torch.ones(1, NUMBERS)
    sizes = [float(adam(torch.tensor([0]), gradient).mean()) for _ in range(20)]
    assert sizes == sorted(sizes)
    assert sizes[0] == pytest.approx((1 - BETAS[0]) * sizes[-1], rel=2 * BETAS[0] ** 20)


def test_images_that_show_nothing_move_nothing() -> None:
    steps = TexelAdam(TEXELS, NUMBERS)(torch.empty(0, dtype=torch.int64), torch.empty(0, NUMBERS))
    assert steps.shape == (0, NUMBERS)
