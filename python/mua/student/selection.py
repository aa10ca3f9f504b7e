"""Selection on held-out clips: of the steps of a fine-tuning, the one that does best on motion it is not trained on.

The clips that choose are a share of the training clips, so that those held out of the recording stay unseen until the
end. What chooses is not trained on at all: bases and regression do without it too, or the start would look too good.
"""

from collections.abc import Callable
from typing import Any

import torch
from torch import Tensor, nn

LOOKS = 20  # at the clips that choose, during a fine-tuning


def validation_rows(
    clips: Tensor,  # [F] int64, the clip of each frame
    share: float,  # of the frames, 0 to 1
    *,
    generator: torch.Generator,
) -> Tensor:
    """Which frames [F] choose, bool: whole clips drawn at random up to `share`, of one clip alone its end."""
    chosen = torch.zeros(len(clips), dtype=torch.bool)
    wanted = round(share * len(clips))
    names = clips.unique()
    for name in names[torch.randperm(len(names), generator=generator)]:
        own = clips == name
        if int((chosen | own).sum()) <= wanted:
            chosen |= own
    if not chosen.any() and wanted:
        chosen[len(clips) - wanted :] = True
    return chosen


class Selection:
    """Keeps the weights of a module at the step whose loss was the least so far."""

    def __init__(self, loss: Callable[[], float]) -> None:
        self._loss = loss
        self.step = -1
        self.least = float("inf")
        self._weights: dict[str, Tensor] = {}

    def look(self, module: nn.Module, step: int, steps: int) -> None:
        """After `step` of `steps`, where it is time: keep the module's weights if they are the best so far."""
        if step % max(steps // LOOKS, 1) and step != steps:
            return
        with torch.no_grad():
            loss = self._loss()
        if loss < self.least:
            self.step, self.least = step, loss
            self._weights = {name: tensor.detach().clone() for name, tensor in module.state_dict().items()}

    def put_back(self, module: nn.Module) -> None:
        """Give `module` the weights of the best step."""
        if self._weights:
            module.load_state_dict(self._weights)

    def state(self) -> dict[str, Any]:
        """What a checkpoint needs to hold."""
        return {"step": self.step, "least": self.least, "weights": self._weights}

    def resume(self, state: dict[str, Any]) -> None:
        """Go on from `state`."""
        self.step, self.least, self._weights = int(state["step"]), float(state["least"]), state["weights"]
