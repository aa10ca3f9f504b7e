"""The length of a training and its learning rate."""

import math
from dataclasses import dataclass, replace


@dataclass(frozen=True)
class Schedule:
    """The schedule of one run of Adam."""

    steps: int
    batch: int  # frames per step
    lr: float  # learning rate at its highest
    cosine: bool = True  # whether the learning rate decays to zero along a cosine; else it is constant
    warm_up: float = 0.0  # share of the steps in which the learning rate rises from zero
    epochs: float = math.inf  # most epochs; with few frames they end the training before `steps`

    def over(self, frames: int) -> "Schedule":
        """The schedule for a number of training frames."""
        if math.isinf(self.epochs):
            return self
        return replace(self, steps=min(self.steps, max(math.ceil(self.epochs * frames / self.batch), 1)))

    def lr_at(self, step: int) -> float:
        """The learning rate of a step, counted from 0."""
        done = step / self.steps
        warm_up = min((done + 1 / self.steps) / self.warm_up, 1.0) if self.warm_up else 1.0
        return self.lr * warm_up * (cosine_decay(done) if self.cosine else 1.0)


def cosine_decay(done: float) -> float:
    """The factor of the learning rate when a share of a run is done: from one to zero along a cosine."""
    return 0.5 * (1 + math.cos(math.pi * done))
