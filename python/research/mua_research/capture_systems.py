"""The systems of the paper's tables as entries of a comparison with images, each at several sizes.

All learn the same frames of one teacher. A scale multiplies what a system's textures are made of, so that its numbers
grow about as the scale does; the coarse mesh, the mean and the hidden layers of every MLP stay as the preset has them.
"""

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from mua.avatar.decode import Splats, pose_splats
from mua.evaluation.capture_scores import FilmedEntry, Show
from mua.evaluation.cost import Cost, learnt_cost
from mua.evaluation.entries import sentence
from mua.evaluation.settings import OURS
from mua.pose.clip import Clip
from mua.pose.windows import window_of
from mua_research.motion import motion_of
from mua_research.network import NetworkSystem
from mua_research.system import Sizes, Training, TrainingFrames
from mua_research.systems import SYSTEMS, train_or_restore

STEPS_OF_TWO = 8  # sizes that are tried for equal cost from one scale to its double
LARGEST, SMALLEST = 6, -8  # powers of two of the scales that are tried


@dataclass(frozen=True)
class Sized:
    """A system at a size."""

    system: str
    scale: float

    @property
    def name(self) -> str:
        return self.system if self.scale == 1 else f"{self.system} x{self.scale:.3g}"


def sized(names: Sequence[str], scales: Sequence[float], sizes: Sizes) -> list[Sized]:
    """Every system at every scale, and at the largest that costs no more than ours at scale 1, where there is one.

    Sizes that come to the same are there once.
    """
    most = cost_of(Sized(OURS, 1.0), sizes)
    found: dict[tuple[str, Cost], Sized] = {}
    for name in names:
        equal = [] if name == OURS else largest_within(name, most, sizes)
        for one in [*(Sized(name, scale) for scale in scales), *equal]:
            found.setdefault((name, cost_of(one, sizes)), one)
    order = {name: place for place, name in enumerate(names)}
    return sorted(found.values(), key=lambda one: (order[one.system], one.scale))


def largest_within(name: str, most: Cost, sizes: Sizes) -> list[Sized]:
    """The largest size of a system that costs neither more parameters nor more operations; none if there is none."""
    powers = np.arange(LARGEST * STEPS_OF_TWO, SMALLEST * STEPS_OF_TWO - 1, -1) / STEPS_OF_TWO
    tried = (Sized(name, float(2.0**power)) for power in powers)
    return [one for one in tried if cost_of(one, sizes).within(most)][:1]


def cost_of(one: Sized, sizes: Sizes) -> Cost:
    """What a system costs at a size, without its training."""
    system = _untrained(one, sizes)
    return learnt_cost(system.parameters, system.flops)


def trained_entries(
    wanted: Sequence[Sized],
    training: Training,
    *,
    begin: Callable[[str], None],  # called with the name of what is trained next
    failed: Callable[[str], None],  # called with a sentence
) -> Iterator[FilmedEntry]:
    """Train one after the other, or take up what an earlier run made; one that fails is reported, and left out."""
    for one in wanted:
        begin(one.name)
        system = _untrained(one, training.frames.sizes)
        try:
            train_or_restore(system, training, one.name)
        except Exception as error:  # whatever one system stumbles over, the others go on
            failed(f"{one.name}: {sentence(error)}")
            continue
        cost = learnt_cost(system.parameters, system.flops)
        yield FilmedEntry(one.name, _shown(system, training.frames), cost, one.system, one.scale)


def _untrained(one: Sized, sizes: Sizes) -> NetworkSystem:
    return SYSTEMS[one.system](replace(sizes, scale=one.scale))


def _shown(system: NetworkSystem, frames: TrainingFrames) -> Show:
    """A system's texture on the coarse mesh that all share."""

    def show(clip: Clip, frame: int) -> Splats:
        window = window_of(clip, frame, frames.student.encoding)
        oldest_first = window.cut(slice(None, None, -1))
        motion = motion_of(oldest_first, np.array([len(window) - 1]), rig=frames.rig, student=frames.student)
        (texture,), (canonical,) = system.textures(motion), motion.canonical
        return pose_splats(frames.rig, canonical.numpy(), texture=texture.numpy(), pose=clip.pose(frame))

    return show
