"""The pretended graphics card refuses what a true one refuses."""

from collections.abc import Callable

import pytest
import torch
from pretended_card import CARD, pretended_card
from torch import Tensor


@pytest.mark.parametrize(
    "refused",
    [
        lambda here, there: here + there,
        lambda here, there: there.numpy(),
        lambda here, there: here[there.long()],
        lambda here, there: torch.stack([here, there]),
        lambda here, there: torch.nn.functional.linear(there, here[None]),
        lambda here, there: there.add_(here),
        lambda here, there: torch.rand(3, device=CARD, generator=torch.Generator()),
    ],
)
def test_two_devices_do_not_meet(refused: Callable[[Tensor, Tensor], object], monkeypatch: pytest.MonkeyPatch) -> None:
    with pretended_card(monkeypatch), pytest.raises((RuntimeError, TypeError), match="cuda"):
        refused(torch.zeros(3), torch.zeros(3).to("cuda"))


def test_what_is_made_there_stays_until_it_is_moved(monkeypatch: pytest.MonkeyPatch) -> None:
    with pretended_card(monkeypatch):
        model = torch.nn.Linear(3, 2).to(CARD)
        loss = model(torch.ones(4, 3, device="cuda")).square().sum()
        loss.backward()
        assert model.weight.grad is not None
        assert {one.device for one in (loss, model.weight.grad, torch.nn.Parameter(loss.detach()), loss + 1)} == {CARD}
        assert loss.to(torch.float64).device == loss.new_zeros(2)[torch.tensor([1])].device == CARD
        assert not loss.cpu().is_cuda
        assert torch.zeros(3).copy_(model.weight[0].detach()).device.type == "cpu"
