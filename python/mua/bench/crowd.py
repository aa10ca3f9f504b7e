"""Avatars that all move and take turns with their decodes, displayed frame by frame on a device that is modelled.

Whole figures are seen by both eyes; their fragments fall off with the square of the distance. The milliseconds of a
frame are what the device would measure, and its budget follows them.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import cast

from mua.avatar.decode_turns import PARTS, Ask, Steps, Turns, take_turns
from mua.avatar.frame_budget import FrameBudget, measure
from mua.avatar.level_choice import LARGEST_TEXEL, Seen, choose_levels
from mua.bench.counts import Counts, LevelCounts, halves
from mua.bench.devices import ModelDevice
from mua.bench.frame_model import drawing_ms, parts_ms, pose_ms

SCENES = ((2.2, 2.2, 2.2), (1.0, 1.6, 2.2, 3.0, 4.0, 5.0, 6.5, 8.0, 10.0, 13.0))  # metres of each avatar
DISPLAYED, RATE = 72, 25  # displayed frames, and poses of an avatar, a second
SETTLED, FRAMES = 30 * DISPLAYED, 60 * DISPLAYED  # displayed frames before those that count, and all
EYES, END = 2, "likely"


@dataclass(frozen=True)
class Played:
    """Displayed frames in which avatars take turns."""

    longest: float  # milliseconds of a frame
    parts: int  # parts of decodes in it, at most
    splats: int  # of all avatars together
    oldest: float  # milliseconds by which a shown decode is older than its pose


@dataclass(frozen=True)
class Crowd:
    """Several avatars before both eyes."""

    metres: tuple[float, ...]
    together: float  # milliseconds of the frame in which all decode a half
    turns: Played  # one part in a frame, levels of detail by the distance
    budget: Played  # parts and splats as many as fit


@dataclass(frozen=True)
class _Level:
    """Milliseconds of one avatar at a level of detail and a distance."""

    splats: int
    parts: list[float]
    plain: float


def crowd(device: ModelDevice, counts: Counts, instructions: int, metres: tuple[float, ...]) -> Crowd:
    """Model avatars at these distances."""
    levels = [[_level(device, level, instructions, away) for level in counts.levels] for away in metres]
    rest = getattr(device.rest, END)
    chosen = _choose(counts, metres, None, [0] * len(metres))
    costs = [costs[level] for costs, level in zip(levels, chosen, strict=True)]
    together = rest + sum(cost.plain + max(map(sum, halves(cost.parts))) for cost in costs)
    by_turns, by_budget = (_play(counts, metres, levels, rest, adapts=adapts) for adapts in (False, True))
    return Crowd(metres, together, by_turns, by_budget)


def _level(device: ModelDevice, level: LevelCounts, instructions: int, away: float) -> _Level:
    triangles, fragments = drawing_ms(device, level.drawn, instructions, END)
    drawn = EYES * (triangles + fragments * (level.drawn.distance / away) ** 2)
    posed = pose_ms(device, level.pose, level.splats, EYES, END)
    return _Level(level.splats, parts_ms(device, level.decode, END), posed + drawn)


def _choose(counts: Counts, metres: Sequence[float], splats: int | None, shown: Sequence[int]) -> list[int]:
    """The levels of detail, one after another as they are shown."""
    sizes = tuple(level.splats for level in counts.levels)
    texel = LARGEST_TEXEL * counts.levels[1].chosen / 2 if len(sizes) > 1 else 0.0  # pixels, from a metre away
    seen = [Seen(away, texel / away, sizes, level) for away, level in zip(metres, shown, strict=True)]
    return choose_levels(seen, splats)


def _play(
    counts: Counts, metres: Sequence[float], levels: Sequence[Sequence[_Level]], rest: float, *, adapts: bool
) -> Played:
    turns, budget, chosen = Turns(), FrameBudget(), [0] * len(metres)
    longest, most, oldest, splats = 0.0, 0, 0.0, 0
    for frame in range(FRAMES):
        chosen = _choose(counts, metres, budget.splats, chosen)
        ages = [frame * RATE / DISPLAYED + i / len(metres) for i in range(len(metres))]  # poses since the start
        asks = {i: Ask(int(at), int(at) + 1, chosen[i], 1 / metres[i]) for i, at in enumerate(ages)}
        before = turns
        turns, steps = take_turns(before, asks, frame, parts=budget.parts)
        shown = {i: levels[i][state.shown.level] for i, state in turns.avatars.items() if state.shown is not None}
        taken = rest + sum(level.plain for level in shown.values()) + _decoded(before, turns, steps, levels)
        splats = sum(level.splats for level in shown.values())
        if adapts:
            finest = len(metres) * counts.splats
            budget = measure(budget, taken, avatars=len(metres), splats=(splats, finest))
        if frame >= SETTLED:
            longest, most = max(longest, taken), max(most, sum(each.parts for each in steps.values()))
            moments = {i: state.shown.moment for i, state in turns.avatars.items() if state.shown is not None}
            oldest = max(oldest, *(ages[i] - cast(int, moment) for i, moment in moments.items()))
    return Played(longest, most, splats, 1e3 * max(oldest - 1, 0) / RATE)


def _decoded(before: Turns, after: Turns, steps: Mapping[int, Steps], levels: Sequence[Sequence[_Level]]) -> float:
    """Milliseconds of the parts in a displayed frame."""
    taken = 0.0
    for i, step in steps.items():
        coming = after.avatars[i].coming
        if coming is not None and step.parts > 0:
            first = 0 if step.begin else PARTS - before.avatars[i].left
            taken += sum(levels[i][coming.level].parts[first : first + step.parts])
    return taken
