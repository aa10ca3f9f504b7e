"""How many parts of decodes and how many splats a displayed frame may hold, by how long frames took on this device.

unity-package/Runtime/FrameBudget.cs and web/frame_budget.js decide alike; tests hold all to it.
"""

from dataclasses import dataclass, replace

from mua.avatar.decode_turns import LONGEST, PARTS

MILLISECONDS = 1000 / 72  # of a frame where nothing else is asked for: a headset's
WINDOW = 36  # displayed frames from one decision to the next
FEW = 3  # frames of a window that may be longer, whatever else delayed them
ROOM = 0.8  # share of the budget that frames stay below before there is room for more
MISSED = 1.25  # times the budget; displayed frames that took longer missed their time
STEP = 0.8  # share of the splats that is left after a decision for fewer
PATIENCE = 64  # windows with room before more is tried, at most


@dataclass(frozen=True)
class FrameBudget:
    """What a frame may hold, and what is known of the frames since the last decision."""

    parts: int = 1  # parts of decodes
    splats: int | None = None  # of all avatars together; None: no limit
    frames: int = 0
    over: int = 0  # of these, longer than the budget
    near: int = 0  # of these, without room for more
    roomy: int = 0  # windows with room, one after the other
    patience: int = 1  # windows with room before more is tried
    raised: bool = False  # whether the last decision was for more


def measure(
    budget: FrameBudget,
    milliseconds: float,  # that the frame took
    *,
    most: float = MILLISECONDS,
    exact: bool = True,  # measured by the graphics device; else from one displayed frame to the next
    avatars: int = 1,  # in view
    splats: tuple[int, int] | None = None,  # shown, and of the finest levels; None: no limit is to be set
) -> FrameBudget:
    """The budget after another frame.

    Times between displayed frames say nothing of room, so that more is tried where none is missed. What was too much is
    tried again after twice as many windows.
    """
    over = milliseconds > most * (1 if exact else MISSED)
    near = over or (exact and milliseconds > ROOM * most)
    budget = replace(budget, frames=budget.frames + 1, over=budget.over + over, near=budget.near + near)
    if budget.frames < WINDOW:
        return budget
    started = replace(budget, frames=0, over=0, near=0)
    least = max(-(-PARTS * avatars // LONGEST), 1) if splats is not None else 1  # parts by which none waits longer
    if budget.over >= FEW:
        return _lower(started, least, splats)
    if budget.near >= FEW and budget.parts >= least:
        return replace(started, roomy=0)
    if budget.roomy + 1 < budget.patience:
        return replace(started, roomy=budget.roomy + 1)
    return _raise(started, least, avatars, splats)


def _lower(budget: FrameBudget, least: int, splats: tuple[int, int] | None) -> FrameBudget:
    """Fewer parts, then fewer splats; where all are at their coarsest, fewer parts than would do."""
    patience = min(2 * budget.patience, PATIENCE) if budget.raised else budget.patience
    budget = replace(budget, roomy=0, raised=False, patience=patience)
    if budget.parts > least:
        return replace(budget, parts=max(budget.parts // 2, least))
    if splats is None or (budget.splats is not None and budget.splats < splats[0]):
        return replace(budget, parts=max(budget.parts // 2, 1))
    return replace(budget, splats=int(STEP * splats[0]))


def _raise(budget: FrameBudget, least: int, avatars: int, splats: tuple[int, int] | None) -> FrameBudget:
    """As many parts as will do, then more splats, as many as there are, then more parts."""
    patience = max(budget.patience // 2, 1) if budget.raised else budget.patience
    budget = replace(budget, roomy=0, raised=True, patience=patience)
    if budget.parts < least:
        return replace(budget, parts=min(2 * budget.parts, least))
    if budget.splats is not None:
        more = int(budget.splats / STEP) + 1
        return replace(budget, splats=None if splats is None or more >= splats[1] else more)
    return replace(budget, parts=min(2 * budget.parts, max(PARTS * avatars, 1)))
